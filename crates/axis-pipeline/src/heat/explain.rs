//! Whether growth and warming friction explain slow logs, as states of the axis' thermal network.

use axis_log::Log;
use axis_sim::Axis;
use axis_thermal::{HeatExplained, HeldLog, ThermalModel};

use super::identify::{fitted_part, for_fit, with_segments_of};
use super::{HeatError, SlowLog};

/// Share of the logs that is held out if there is no log to check on.
const HELD_OUT: f64 = 0.25;

/// Slowest rate of a log that shows a loop or a torque balance, Hz. A replay reads 100 Hz and more. A balance
/// differentiates the motion twice and follows it up to a twenty-fifth of the rate: below 10 Hz that is below 0.4 Hz, slower
/// than the second or less in which feed axes accelerate, and a log shows no force of inertia any more.
const SLOWEST_MOTION: f64 = 10.0;

/// Whether a log is one of hours that only heat can be read of: slower than 10 Hz, or with the channels of such a log.
pub fn is_slow(log: &Log) -> bool {
    let mut steps: Vec<f64> = log.time().windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let usual = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
    let has = |name: &str| log.channels().iter().any(|c| c.name == name);
    // Clocks may be a little off.
    usual * SLOWEST_MOTION > 1.0 + 1e-3 || has("duty_1")
}

/// What growth and warming friction explain of `fit`, judged on `check`, or on the last quarter of each log if there is
/// none to check on.
///
/// # Errors
/// [`HeatError`] if the axis has no screw, or the logs have too few readings.
pub fn explain(
    axis: &Axis,
    fit: &[SlowLog<'_>],
    check: &[SlowLog<'_>],
) -> Result<HeatExplained, HeatError> {
    let assumed = for_fit(axis)?;
    let model = ThermalModel::new(assumed.clone())?;
    let fitted = fit.iter().map(|log| {
        let log = log.stretches(&model);
        let fitted = match check.is_empty() {
            true => fitted_part(&log, HELD_OUT),
            false => log.stretches.len(),
        };
        HeldLog { log, fitted }
    });
    let checked = check.iter().map(|log| HeldLog {
        log: log.stretches(&model),
        fitted: 0,
    });
    let logs: Vec<HeldLog> = fitted.chain(checked).collect();
    let mut found = assumed.explain(&logs)?;
    with_segments_of(axis, &mut found.parameters);
    Ok(found)
}
