//! What constant speeds tell: the static parameters, and what they rest on.

use super::estimate::ParameterEstimate;
use super::least_squares::FitOutcome;
use crate::parameters::Parameters;

/// The four parameters that constant speeds show, units as in [`Parameters`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticParameters {
    /// `T_C`, N·m.
    pub coulomb: f64,
    /// `T_S`, N·m.
    pub stiction: f64,
    /// `Ω_S`, rad/s.
    pub stribeck_speed: f64,
    /// `σ2`, N·m·s/rad.
    pub viscous: f64,
}

impl StaticParameters {
    /// All six, with the bristles' `σ0` (N·m/rad) and `σ1` (N·m·s/rad).
    #[must_use]
    pub fn with_bristles(self, stiffness: f64, damping: f64) -> Parameters {
        Parameters {
            coulomb: self.coulomb,
            stiction: self.stiction,
            stribeck_speed: self.stribeck_speed,
            stiffness,
            damping,
            viscous: self.viscous,
        }
    }
}

/// The static parameters and how well they are known, as the pre-sliding
/// fit takes them. From [`StaticParameters`]: known exactly; from
/// `&`[`StaticFit`]: with its covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticKnowledge {
    /// The values.
    pub parameters: StaticParameters,
    /// Covariance of (`T_C`, `T_S`, `Ω_S`, `σ2`), in products of their units.
    pub covariance: [[f64; 4]; 4],
}

impl From<StaticParameters> for StaticKnowledge {
    fn from(parameters: StaticParameters) -> Self {
        Self {
            parameters,
            covariance: [[0.0; 4]; 4],
        }
    }
}

impl From<&StaticFit> for StaticKnowledge {
    fn from(fit: &StaticFit) -> Self {
        Self {
            parameters: fit.parameters(),
            covariance: core::array::from_fn(|i| core::array::from_fn(|j| fit.covariance[i][j])),
        }
    }
}

/// Why a run was not used.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The speed oscillated: the mean torque is that of a vibration, not a
    /// point of the steady-state curve.
    Vibrates {
        /// Relative amplitude, as in [`super::ConstantSpeedRun::vibration`].
        amplitude: f64,
        /// Hz, 0 if it is not known.
        frequency: f64,
    },
    /// The mean speed cannot be told from zero
    /// ([`super::ConstantSpeedRun::is_at_rest`]): friction at rest is not a point of
    /// the curve.
    AtRest,
}

impl core::fmt::Display for Reason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Vibrates {
                amplitude,
                frequency,
            } => write!(
                f,
                "vibrates by {:.0} % of its speed at {frequency:.1} Hz",
                100.0 * amplitude
            ),
            Self::AtRest => write!(f, "at rest"),
        }
    }
}

/// A run that was not used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOut {
    /// Index into the runs given.
    pub run: usize,
    /// Why.
    pub reason: Reason,
}

/// Result of [`super::identify_static`].
#[derive(Debug, Clone, PartialEq)]
pub struct StaticFit {
    /// `T_C`, N·m.
    pub coulomb: ParameterEstimate,
    /// `T_S`, N·m.
    pub stiction: ParameterEstimate,
    /// `Ω_S`, rad/s.
    pub stribeck_speed: ParameterEstimate,
    /// `σ2`, N·m·s/rad; not negative.
    pub viscous: ParameterEstimate,
    /// A torque that does not change with the direction (sensor offset,
    /// gravity), N·m; fixed at 0 unless at least two runs go either way.
    pub torque_offset: ParameterEstimate,
    /// Covariance of (`T_C`, `T_S`, `Ω_S`, `σ2`, offset).
    pub covariance: [[f64; 5]; 5],
    /// RMS of the torque residuals, N·m.
    pub residual_rms: f64,
    /// Sum of squares of residuals over their standard errors.
    pub chi_squared: f64,
    /// Runs used less parameters fitted.
    pub degrees_of_freedom: usize,
    /// The factor on all standard errors: 1 where `chi_squared` agrees with
    /// the runs' own standard errors, `√(chi_squared / degrees_of_freedom)`
    /// where it lies more than three standard deviations above.
    pub error_scale: f64,
    /// Indices of the runs used.
    pub used: Vec<usize>,
    /// The other runs.
    pub left_out: Vec<LeftOut>,
    /// How the fit ended.
    pub outcome: FitOutcome,
}

impl StaticFit {
    /// The four values.
    #[must_use]
    pub fn parameters(&self) -> StaticParameters {
        StaticParameters {
            coulomb: self.coulomb.value,
            stiction: self.stiction.value,
            stribeck_speed: self.stribeck_speed.value,
            viscous: self.viscous.value,
        }
    }
}
