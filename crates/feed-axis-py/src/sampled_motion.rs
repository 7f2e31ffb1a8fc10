//! Samples of motions: as arrays, and motions through them.

use axis_log::{Channel, Log, TIME_CHANNEL};
use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, LoggedReference};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use trajectories::Motion;

use crate::errors::{MotionError, raise};

/// Most samples of a motion that are given at once.
const MOST_SAMPLES: f64 = 1e8;

/// A motion every `period` (s), as arrays by the names of channels.
pub(crate) fn sampled<'py>(
    py: Python<'py>,
    motion: &dyn Motion,
    period: f64,
    freedom: Freedom,
) -> PyResult<Bound<'py, PyDict>> {
    let count = motion.duration() / period;
    if !(period > 0.0 && count < MOST_SAMPLES) {
        return Err(MotionError::new_err(format!(
            "period_s is {period:?}, but must be greater than 0 and give at most {MOST_SAMPLES:e} samples"
        )));
    }
    // An end that rounding has put a hair before its instant is one.
    let instants: Vec<f64> = (0..=(count + 1e-9) as usize)
        .map(|k| k as f64 * period)
        .collect();
    let column = |of: fn(trajectories::Setpoint) -> f64| -> Vec<f64> {
        instants.iter().map(|&t| of(motion.at(t))).collect()
    };
    let names = match freedom {
        Freedom::Linear => ["position_m", "speed_m_s", "acceleration_m_s2", "jerk_m_s3"],
        Freedom::Rotary => [
            "position_rad",
            "speed_rad_s",
            "acceleration_rad_s2",
            "jerk_rad_s3",
        ],
    };
    let columns = names.into_iter().zip([
        column(|at| at.position),
        column(|at| at.velocity),
        column(|at| at.acceleration),
        column(|at| at.jerk),
    ]);
    let dict = PyDict::new(py);
    for (name, column) in columns {
        dict.set_item(name, column.into_pyarray(py))?;
    }
    dict.set_item("t_s", instants.into_pyarray(py))?;
    Ok(dict)
}

/// Share of a period by which time stamps may be off an even grid: what printing them with four
/// digits a period leaves.
const UNEVEN: f64 = 1e-3;

/// The motion through positions, as a log's reference is taken.
pub(crate) fn sampled_reference(
    axis: &Axis,
    instants: Option<&[f64]>,
    positions: &[f64],
) -> PyResult<LoggedReference> {
    let refused = |words: String| Err(MotionError::new_err(words));
    let count = positions.len();
    if count < 2 {
        return refused(format!(
            "there are {count} positions; valid: two at least, one each period"
        ));
    }
    for (name, numbers) in [("positions", positions), ("t_s", instants.unwrap_or(&[]))] {
        if let Some(k) = numbers.iter().position(|x| !x.is_finite()) {
            let bad = numbers[k];
            return refused(format!(
                "{name}[{k}] is {bad}; valid: finite numbers, without holes"
            ));
        }
    }
    let period = match instants {
        None => axis.period,
        Some(instants) if instants.len() != count => {
            let stamps = instants.len();
            return refused(format!(
                "there are {stamps} instants t_s and {count} positions; valid: as many of both"
            ));
        }
        Some(instants) => {
            let period = (instants[count - 1] - instants[0]) / (count - 1) as f64;
            let off = |(k, t): (usize, &f64)| (t - instants[0] - k as f64 * period).abs();
            if period <= 0.0 {
                return refused("t_s does not rise; valid: instants in s, evenly apart".to_owned());
            }
            let uneven = instants.iter().enumerate();
            if let Some((k, t)) = uneven.into_iter().find(|at| off(*at) > UNEVEN * period) {
                return refused(format!(
                    "t_s[{k}] is {t}, off the even grid of {period} s that the ends of t_s give; valid: instants evenly apart (numpy.interp makes them so)"
                ));
            }
            period
        }
    };
    let instants = (0..count).map(|k| k as f64 * period).collect();
    let name = match axis.freedom() {
        Freedom::Linear => "position_ref_m",
        Freedom::Rotary => "position_ref_rad",
    };
    let channels = [(TIME_CHANNEL, instants), (name, positions.to_vec())];
    let channels = channels.map(|(name, samples)| Channel::new(name, samples));
    let channels = channels.into_iter().collect::<Result<Vec<_>, _>>();
    let log = Log::new(channels.map_err(raise::<MotionError>)?).map_err(raise::<MotionError>)?;
    LoggedReference::new(&log, period).map_err(raise::<MotionError>)
}
