//! The steps a motion program is made of.

use axis_scalar::Scalar;

use crate::{Chirp, Limits, Sine, TrajectoryError};

/// One step of a motion program. It begins at rest where the step before it ended.
///
/// With the feature `serde` a step in `f64` is read and written under the name of its kind, with one key
/// per value and the unit in the key; unknown keys are refused:
///
/// ```toml
/// start_mm = 600.0
///
/// [[steps]]
/// move = { to_mm = 900.0, velocity_mm_s = 100.0, acceleration_mm_s2 = 225.0, jerk_mm_s3 = 1200.0 }
/// [[steps]]
/// dwell = { duration_s = 0.5 }
/// [[steps]]
/// move_by = { by_mm = -50.0, velocity_mm_s = 20.0, acceleration_mm_s2 = 225.0, jerk_mm_s3 = 1200.0 }
/// [[steps]]
/// sine = { amplitude_mm = 1.0, frequency_hz = 5.0, cycles = 10 }
/// [[steps]]
/// # `ramp_s` may be left out (a tenth of the duration), `sweep` too (linear).
/// chirp = { amplitude_mm = 0.1, from_frequency_hz = 1.0, to_frequency_hz = 100.0, duration_s = 10.0, ramp_s = 1.0, sweep = "logarithmic" }
/// ```
///
/// Of an axis that turns the keys are in degrees: `start_deg`, `to_deg`, `by_deg`, `amplitude_deg`,
/// `velocity_deg_s`, `acceleration_deg_s2`, `jerk_deg_s3`. A program is in the one or the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step<T = f64> {
    /// Time-optimal S-curve to a position of the axis. With a long travel, a constant-speed run.
    Move {
        /// Position to reach, m.
        to: T,
        /// Limits of the move.
        limits: Limits<T>,
    },
    /// Time-optimal S-curve over a distance from the present position.
    MoveBy {
        /// Signed distance, m.
        by: T,
        /// Limits of the move.
        limits: Limits<T>,
    },
    /// Standing still.
    Dwell {
        /// How long, s; from zero to [`maximum::DURATION`](crate::maximum::DURATION).
        duration: T,
    },
    /// Sine about the present position.
    Sine(Sine<T>),
    /// Chirp about the present position.
    Chirp(Chirp<T>),
}

impl<T: Scalar> Step<T> {
    /// Name of the step's kind, as used in files and errors.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Move { .. } => "move",
            Self::MoveBy { .. } => "move_by",
            Self::Dwell { .. } => "dwell",
            Self::Sine(_) => "sine",
            Self::Chirp(_) => "chirp",
        }
    }

    /// The same step, each number rounded to the nearest of another scalar.
    ///
    /// # Errors
    /// As [`Limits::cast`].
    pub fn cast<U: Scalar>(&self) -> Result<Step<U>, TrajectoryError> {
        let cast = |value: T| U::of(value.to_f64());
        Ok(match *self {
            Self::Move { to, limits } => Step::Move {
                to: cast(to),
                limits: limits.cast()?,
            },
            Self::MoveBy { by, limits } => Step::MoveBy {
                by: cast(by),
                limits: limits.cast()?,
            },
            Self::Dwell { duration } => Step::Dwell {
                duration: cast(duration),
            },
            Self::Sine(sine) => Step::Sine(Sine {
                amplitude: cast(sine.amplitude),
                frequency: cast(sine.frequency),
                cycles: sine.cycles,
            }),
            Self::Chirp(chirp) => Step::Chirp(Chirp {
                amplitude: cast(chirp.amplitude),
                from_frequency: cast(chirp.from_frequency),
                to_frequency: cast(chirp.to_frequency),
                duration: cast(chirp.duration),
                ramp: cast(chirp.ramp),
                sweep: chirp.sweep,
            }),
        })
    }
}
