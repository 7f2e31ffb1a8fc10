//! `T_C`, `T_S`, `Ω_S` and `σ2` from constant-speed runs.

use super::Estimate;
use super::curve::Curve;
use super::error::IdentifyError;
use super::least_squares::Outcome;
use super::record::ConstantSpeedRun;
use crate::parameters::Parameters;

/// Relative vibration above which a run is left out, unless told otherwise.
///
/// At a relative amplitude `v` the mean of the curve departs from the curve
/// itself by about `v² ω² T_ss''/4`, at most `0.42 v² (T_S − T_C)` over all
/// speeds: 0.4 % of `T_S − T_C` at 0.1, where self-excited vibrations reach
/// 0.5 to 1.
pub const VIBRATION_LIMIT: f64 = 0.1;

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
        /// Relative amplitude, as in [`ConstantSpeedRun::vibration`].
        amplitude: f64,
        /// Hz, 0 where it is not known.
        frequency: f64,
    },
    /// The mean speed is zero: friction at rest is not a point of the curve.
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

/// Result of [`identify_static`].
#[derive(Debug, Clone, PartialEq)]
pub struct StaticFit {
    /// `T_C`, N·m.
    pub coulomb: Estimate,
    /// `T_S`, N·m.
    pub stiction: Estimate,
    /// `Ω_S`, rad/s.
    pub stribeck_speed: Estimate,
    /// `σ2`, N·m·s/rad; not negative.
    pub viscous: Estimate,
    /// A torque that does not change with the direction (sensor offset,
    /// gravity), N·m; fixed at 0 unless at least two runs go either way.
    pub torque_offset: Estimate,
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
    pub outcome: Outcome,
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

/// Fits the steady-state curve, equation (4), to constant-speed runs; those
/// that vibrate by more than [`VIBRATION_LIMIT`] are left out and listed.
///
/// # Errors
/// As [`identify_static_within`].
pub fn identify_static(runs: &[ConstantSpeedRun]) -> Result<StaticFit, IdentifyError> {
    identify_static_within(runs, VIBRATION_LIMIT)
}

/// As [`identify_static`], with another limit of the relative vibration
/// (infinite: every run is used, which is biased where the axis vibrates).
///
/// Given `Ω_S` the curve is linear in the rest, so a search over `Ω_S` with
/// linear least squares inside finds the start, and Levenberg–Marquardt on
/// all parameters the minimum and the covariance. Runs are weighted by their
/// standard errors (with a floor of 1e-6 of the largest torque).
///
/// # Errors
/// [`IdentifyError`]: a number is not finite, or a standard error or vibration
/// negative; fewer than 6 different speeds are left; fewer than 2 on either
/// side of `Ω_S`; friction does not fall with speed significantly (3 standard
/// errors).
pub fn identify_static_within(
    runs: &[ConstantSpeedRun],
    vibration_limit: f64,
) -> Result<StaticFit, IdentifyError> {
    check_runs(runs)?;
    let (used, left_out) = select(runs, vibration_limit);
    let kept: Vec<ConstantSpeedRun> = used.iter().map(|&i| runs[i]).collect();
    require_speeds(&kept, left_out.len())?;
    let curve = Curve::new(&kept);
    let start = curve.search().ok_or(IdentifyError::NoStribeckEffect {
        rise: 0.0,
        standard_error: f64::INFINITY,
    })?;
    let fit = curve.report(curve.refine(start), used, left_out)?;
    require_both_sides(&kept, fit.stribeck_speed.value)?;
    let c = &fit.covariance;
    let rise = fit.stiction.value - fit.coulomb.value;
    let standard_error = (c[0][0] + c[1][1] - 2.0 * c[0][1]).max(0.0).sqrt();
    if rise > 3.0 * standard_error {
        Ok(fit)
    } else {
        Err(IdentifyError::NoStribeckEffect {
            rise,
            standard_error,
        })
    }
}

fn check_runs(runs: &[ConstantSpeedRun]) -> Result<(), IdentifyError> {
    for (index, run) in runs.iter().enumerate() {
        let numbers = [
            ("speed", run.speed, true),
            ("torque", run.torque, true),
            ("torque_standard_error", run.torque_standard_error, false),
        ];
        for (quantity, value, signed) in numbers {
            if !value.is_finite() || (!signed && value < 0.0) {
                return Err(IdentifyError::BadNumber {
                    quantity,
                    index,
                    value,
                    valid: if signed {
                        "finite"
                    } else {
                        "finite and at least 0"
                    },
                });
            }
        }
        // Infinite is what a vibration about a standstill gives.
        if run.vibration.is_nan() || run.vibration < 0.0 {
            return Err(IdentifyError::BadNumber {
                quantity: "vibration",
                index,
                value: run.vibration,
                valid: "at least 0",
            });
        }
    }
    Ok(())
}

fn select(runs: &[ConstantSpeedRun], limit: f64) -> (Vec<usize>, Vec<LeftOut>) {
    let (mut used, mut left_out) = (Vec::new(), Vec::new());
    for (run, r) in runs.iter().enumerate() {
        if r.speed == 0.0 {
            let reason = Reason::AtRest;
            left_out.push(LeftOut { run, reason });
        } else if r.vibration > limit {
            let reason = Reason::Vibrates {
                amplitude: r.vibration,
                frequency: r.vibration_frequency,
            };
            left_out.push(LeftOut { run, reason });
        } else {
            used.push(run);
        }
    }
    (used, left_out)
}

/// Different |speeds|; those within 1 % of the one before are taken as repeats.
fn distinct_speeds(runs: &[ConstantSpeedRun]) -> Vec<f64> {
    let mut speeds: Vec<f64> = runs.iter().map(|r| r.speed.abs()).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup_by(|next, kept| *next <= 1.01 * *kept);
    speeds
}

fn require_speeds(kept: &[ConstantSpeedRun], left_out: usize) -> Result<(), IdentifyError> {
    const NEEDED: usize = 6;
    let found = distinct_speeds(kept).len();
    if found >= NEEDED {
        return Ok(());
    }
    Err(IdentifyError::TooFewSpeeds {
        found,
        needed: NEEDED,
        left_out,
    })
}

fn require_both_sides(kept: &[ConstantSpeedRun], stribeck: f64) -> Result<(), IdentifyError> {
    let speeds = distinct_speeds(kept);
    let below = speeds.iter().filter(|&&s| s < stribeck).count();
    for (side, found) in [("below", below), ("above", speeds.len() - below)] {
        if found < 2 {
            return Err(IdentifyError::OneSideOfStribeckSpeed {
                side,
                found,
                stribeck_speed: stribeck,
            });
        }
    }
    Ok(())
}
