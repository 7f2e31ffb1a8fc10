//! The steady-state curve of the runs, as far as they show it.

use lugre::identify::{FrictionIdentifyError, StaticFit, identify_coulomb, identify_static};

use super::error::IdentifyLogsError;
use super::found::{Open, SpeedRun};
use super::varying::correlation_time;

/// Fewest different speeds for Coulomb's and viscous friction.
pub(super) const LEAST_SPEEDS: usize = 4;

/// The curve, and what of it the runs leave open.
pub(super) struct Fitted {
    pub statics: StaticFit,
    pub open: Option<Open>,
}

/// Fits the curve; where the runs do not show friction fall with speed, Coulomb's and viscous
/// friction alone. `unit` is that of the law's speed, for messages.
pub(super) fn fit(runs: &[SpeedRun], unit: &str) -> Result<Fitted, IdentifyLogsError> {
    let points: Vec<_> = runs.iter().map(|run| run.run).collect();
    let whole = identify_static(&points);
    let why = match whole {
        Ok(mut statics) => {
            widen(&mut statics, runs);
            return Ok(Fitted {
                statics,
                open: None,
            });
        }
        Err(why) => why,
    };
    let mut statics = identify_coulomb(&points).map_err(IdentifyLogsError::Curve)?;
    widen(&mut statics, runs);
    let slowest = statics.stribeck_speed.value;
    let (why, run) = match why {
        FrictionIdentifyError::NoStribeckEffect { .. } => (
            "friction does not fall with speed in these runs by more than their scatter".to_owned(),
            format!(
                "if it should, run slower than {slowest:.3e} {unit} and at more speeds (each both ways)"
            ),
        ),
        FrictionIdentifyError::OneSideOfStribeckSpeed {
            side,
            found,
            stribeck_speed,
        } => (
            format!(
                "only {found} quiet speed(s) lie {side} the speed of about {stribeck_speed:.3e} {unit} at which friction falls"
            ),
            format!("run at two or more other speeds {side} it, both ways"),
        ),
        FrictionIdentifyError::TooFewSpeeds { found, needed, .. } => (
            format!(
                "the fall of friction with speed takes {needed} different speeds, and {found} are there"
            ),
            "run at more speeds, the slowest a thousandth of the fastest, both ways".to_owned(),
        ),
        other => (other.to_string(), "repeat the runs".to_owned()),
    };
    let open = Some(Open {
        parameters: vec!["T_S", "Ω_S"],
        why,
        run,
    });
    Ok(Fitted { statics, open })
}

/// Standard errors widened where the runs' residuals are alike from one to the next, in their
/// order of
/// time: friction that changes with temperature or place is no noise of its own in each run.
fn widen(fit: &mut StaticFit, runs: &[SpeedRun]) {
    let law = fit.parameters();
    let offset = fit.torque_offset.value;
    let level = |speed: f64| {
        let fall = (-(speed / law.stribeck_speed).powi(2)).exp();
        law.coulomb + (law.stiction - law.coulomb) * fall
    };
    let mut used = fit.used.clone();
    used.sort_by(|&a, &b| {
        let key = |i: usize| (runs[i].log, runs[i].time[0]);
        let ((log, time), (other, later)) = (key(a), key(b));
        log.cmp(&other).then(time.total_cmp(&later))
    });
    let residuals: Vec<f64> = used
        .iter()
        .map(|&i| {
            let run = &runs[i].run;
            let curve = level(run.speed).copysign(run.speed) + law.viscous * run.speed + offset;
            let error = run.torque_standard_error.unwrap_or(fit.residual_rms);
            (run.torque - curve) / error.max(f64::MIN_POSITIVE)
        })
        .collect();
    let by = correlation_time(&residuals);
    fit.covariance
        .iter_mut()
        .flatten()
        .for_each(|value| *value *= by);
    for estimate in [
        &mut fit.coulomb,
        &mut fit.stiction,
        &mut fit.stribeck_speed,
        &mut fit.viscous,
        &mut fit.torque_offset,
    ] {
        estimate.standard_error *= by.sqrt();
    }
}
