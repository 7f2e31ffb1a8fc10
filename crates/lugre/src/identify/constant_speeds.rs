//! `T_C`, `T_S`, `Ω_S` and `σ2` from constant-speed runs.

use super::curve::Curve;
use super::error::{FrictionIdentifyError, LARGEST, MAGNITUDE, is_measurable};
use super::record::ConstantSpeedRun;
use super::report::report;
use super::static_fit::{LeftOut, Reason, StaticFit};

/// Relative vibration above which a run is left out, unless told otherwise.
///
/// At a relative amplitude `v` the mean of the curve departs from the curve
/// itself by about `v² ω² T_ss''/4`, at most `0.42 v² (T_S − T_C)` over all
/// speeds: 0.4 % of `T_S − T_C` at 0.1, where self-excited vibrations reach
/// 0.5 to 1.
pub const VIBRATION_LIMIT: f64 = 0.1;

/// Fits the steady-state curve, equation (4), to constant-speed runs; those
/// that vibrate by more than [`VIBRATION_LIMIT`] are left out and listed.
///
/// # Errors
/// As [`identify_static_within`].
pub fn identify_static(runs: &[ConstantSpeedRun]) -> Result<StaticFit, FrictionIdentifyError> {
    identify_static_within(runs, VIBRATION_LIMIT)
}

/// As [`identify_static`], with another limit of the relative vibration
/// (infinite: every run is used, which is biased where the axis vibrates).
///
/// Given `Ω_S` the curve is linear in the rest, so a search over `Ω_S` with
/// linear least squares inside finds the start, and Levenberg–Marquardt on
/// all parameters the minimum and the covariance.
///
/// Runs are weighted by their standard errors (with a floor of 1e-6 of the
/// largest torque). Those that know none share one: what they scatter about
/// the curve, but not less than the largest known, so that no run gains weight
/// by saying nothing.
///
/// # Errors
/// [`FrictionIdentifyError`]: a number is not finite or beyond 1e100, a standard error
/// not positive, a vibration or `vibration_limit` negative or NaN; fewer than 6 different speeds are left; fewer than 2 on either
/// side of `Ω_S`; friction does not fall with speed significantly (3 standard
/// errors).
pub fn identify_static_within(
    runs: &[ConstantSpeedRun],
    vibration_limit: f64,
) -> Result<StaticFit, FrictionIdentifyError> {
    check_runs(runs)?;
    if vibration_limit.is_nan() || vibration_limit < 0.0 {
        return Err(FrictionIdentifyError::BadNumber {
            quantity: "vibration_limit",
            index: 0,
            value: vibration_limit,
            valid: "at least 0",
        });
    }
    let (used, left_out) = select(runs, vibration_limit);
    let kept: Vec<ConstantSpeedRun> = used.iter().map(|&i| runs[i]).collect();
    require_speeds(&kept, left_out.len())?;
    let mut curve = Curve::new(&kept);
    let minimum = curve.fit().ok_or(FrictionIdentifyError::NoStribeckEffect {
        rise: 0.0,
        standard_error: f64::INFINITY,
    })?;
    let fit = report(&curve, minimum, used, left_out)?;
    require_both_sides(&kept, fit.stribeck_speed.value)?;
    let c = &fit.covariance;
    let rise = fit.stiction.value - fit.coulomb.value;
    let standard_error = (c[0][0] + c[1][1] - 2.0 * c[0][1]).max(0.0).sqrt();
    if rise > 3.0 * standard_error {
        Ok(fit)
    } else {
        Err(FrictionIdentifyError::NoStribeckEffect {
            rise,
            standard_error,
        })
    }
}

pub(super) fn check_runs(runs: &[ConstantSpeedRun]) -> Result<(), FrictionIdentifyError> {
    const POSITIVE: &str = "greater than 0 and at most 1e100 (none if it is not known)";
    let bad = |index, quantity, value, valid| FrictionIdentifyError::BadNumber {
        quantity,
        index,
        value,
        valid,
    };
    for (index, run) in runs.iter().enumerate() {
        for (quantity, value) in [("speed", run.speed), ("torque", run.torque)] {
            if !is_measurable(value) {
                return Err(bad(index, quantity, value, MAGNITUDE));
            }
        }
        let errors = [
            ("speed_standard_error", run.speed_standard_error),
            ("torque_standard_error", run.torque_standard_error),
        ];
        for (quantity, value) in errors {
            if let Some(value) = value.filter(|&e| !(e > 0.0 && e <= LARGEST)) {
                return Err(bad(index, quantity, value, POSITIVE));
            }
        }
        // Infinite is what a vibration about a standstill gives.
        if run.vibration.is_nan() || run.vibration < 0.0 {
            return Err(bad(index, "vibration", run.vibration, "at least 0"));
        }
    }
    Ok(())
}

pub(super) fn select(runs: &[ConstantSpeedRun], limit: f64) -> (Vec<usize>, Vec<LeftOut>) {
    let (mut used, mut left_out) = (Vec::new(), Vec::new());
    for (run, r) in runs.iter().enumerate() {
        if r.is_at_rest() {
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
pub(super) fn distinct_speeds(runs: &[ConstantSpeedRun]) -> Vec<f64> {
    let mut speeds: Vec<f64> = runs.iter().map(|r| r.speed.abs()).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup_by(|next, kept| *next <= 1.01 * *kept);
    speeds
}

fn require_speeds(kept: &[ConstantSpeedRun], left_out: usize) -> Result<(), FrictionIdentifyError> {
    const NEEDED: usize = 6;
    let found = distinct_speeds(kept).len();
    if found >= NEEDED {
        return Ok(());
    }
    Err(FrictionIdentifyError::TooFewSpeeds {
        found,
        needed: NEEDED,
        left_out,
    })
}

fn require_both_sides(
    kept: &[ConstantSpeedRun],
    stribeck: f64,
) -> Result<(), FrictionIdentifyError> {
    let speeds = distinct_speeds(kept);
    let below = speeds.iter().filter(|&&s| s < stribeck).count();
    for (side, found) in [("below", below), ("above", speeds.len() - below)] {
        if found < 2 {
            return Err(FrictionIdentifyError::OneSideOfStribeckSpeed {
                side,
                found,
                stribeck_speed: stribeck,
            });
        }
    }
    Ok(())
}
