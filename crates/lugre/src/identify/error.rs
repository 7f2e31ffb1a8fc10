//! What keeps an identification from being one.

use thiserror::Error;

use crate::parameters::LugreError;

/// Why no parameters were identified: what is wrong, or missing, in the data.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FrictionIdentifyError {
    /// A number is NaN, infinite or beyond 1e100, or negative where that has no
    /// meaning.
    #[error("`{quantity}` of entry {index} is {value}, but must be {valid}")]
    BadNumber {
        /// Which input.
        quantity: &'static str,
        /// Its place in that input; 0 for a scalar.
        index: usize,
        /// The value found.
        value: f64,
        /// What would be accepted.
        valid: &'static str,
    },
    /// Two channels of one record differ in length.
    #[error("the record has {motion} samples of motion but {torque} of torque")]
    LengthMismatch {
        /// Samples of speed or displacement.
        motion: usize,
        /// Samples of torque.
        torque: usize,
    },
    /// The record is too short.
    #[error("the record has {found} samples, at least {needed} are needed")]
    TooFewSamples {
        /// Samples in the record.
        found: usize,
        /// The least number that works.
        needed: usize,
    },
    /// Too few different speeds are left for the four static parameters.
    #[error(
        "{found} different speeds are left ({left_out} runs left out), at least {needed} are needed"
    )]
    TooFewSpeeds {
        /// Different |speeds| among the runs used.
        found: usize,
        /// The least number that works.
        needed: usize,
        /// Runs not used, for vibration or standstill.
        left_out: usize,
    },
    /// The runs lie on one side of the Stribeck speed only.
    #[error(
        "only {found} quiet speeds lie {side} the Stribeck speed (about {stribeck_speed} rad/s); \
         at least 2 are needed on either side"
    )]
    OneSideOfStribeckSpeed {
        /// `"below"` or `"above"`: the side where runs are missing.
        side: &'static str,
        /// Different speeds found there.
        found: usize,
        /// The Stribeck speed that fits the runs there are, rad/s.
        stribeck_speed: f64,
    },
    /// Friction does not fall with speed by more than its uncertainty, so
    /// that `T_S` and `Ω_S` have no meaning in these data.
    #[error(
        "friction falls with speed by {rise} N·m with a standard error of {standard_error} N·m: \
         too little to find the Stribeck speed"
    )]
    NoStribeckEffect {
        /// The fitted `T_S − T_C`, N·m.
        rise: f64,
        /// Its standard error, N·m.
        standard_error: f64,
    },
    /// Nothing in the record moves.
    #[error("nothing moves in the record")]
    NoMotion,
    /// Everything in the record slides: the bristles stay at their steady
    /// deflection, where stiffness and damping do not show.
    #[error(
        "only {found} samples lie in the pre-sliding range (bristles more than a tenth away from \
         steady sliding), at least {needed} are needed: reverse more often, or sample faster"
    )]
    NoPreslidingMotion {
        /// Samples in the pre-sliding range.
        found: usize,
        /// The least number that works.
        needed: usize,
    },
    /// The data leave a parameter open.
    #[error(
        "the record does not determine `{parameter}`: {value} with a standard error of {standard_error}"
    )]
    NotIdentifiable {
        /// Name of the field in [`crate::Parameters`].
        parameter: &'static str,
        /// The value that fits best.
        value: f64,
        /// Its standard error (infinite if the data say nothing).
        standard_error: f64,
    },
    /// The law has more numbers than a fit holds.
    #[error("the law has {found} numbers, at most {most} can be fitted: fewer elements")]
    TooManyNumbers {
        /// Numbers of the law.
        found: usize,
        /// The most that are possible.
        most: usize,
    },
    /// Parameters that make no law were given or found.
    #[error(transparent)]
    Law(#[from] LugreError),
}

/// The largest magnitude of a measured number: sums of squares of such do not
/// overflow.
pub(super) const LARGEST: f64 = 1e100;
pub(super) const MAGNITUDE: &str = "finite, with a magnitude of at most 1e100";

/// Neither NaN nor beyond [`LARGEST`].
pub(super) fn is_measurable(value: f64) -> bool {
    (-LARGEST..=LARGEST).contains(&value)
}

/// Refuses NaN, infinities and what squares beyond all numbers.
pub(super) fn check_finite(
    quantity: &'static str,
    values: &[f64],
) -> Result<(), FrictionIdentifyError> {
    match values.iter().position(|&v| !is_measurable(v)) {
        None => Ok(()),
        Some(index) => Err(FrictionIdentifyError::BadNumber {
            quantity,
            index,
            value: values[index],
            valid: MAGNITUDE,
        }),
    }
}

/// Refuses a scalar that is not finite and positive.
pub(super) fn check_positive(
    quantity: &'static str,
    value: f64,
) -> Result<(), FrictionIdentifyError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(FrictionIdentifyError::BadNumber {
            quantity,
            index: 0,
            value,
            valid: "finite and greater than 0",
        })
    }
}
