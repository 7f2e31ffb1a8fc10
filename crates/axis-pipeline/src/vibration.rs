//! The self-excited vibration at constant speed.

use axis_sim::effects::Scales;
use axis_sim::{Axis, ClosedLoop};
use compensator::NoCompensation;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use trajectories::{Limits, Motion, SCurve};

use crate::measured::{PeakToPeak, Speed};
use crate::{ErrorUnit, PipelineError};

/// What the tracking error does at one constant speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Vibration {
    /// Speed of the load.
    #[serde(flatten)]
    pub speed: Speed<f64>,
    /// Peak to peak of the tracking error.
    #[serde(flatten)]
    pub peak_to_peak: PeakToPeak<f64>,
    /// Frequency from the crossings of the mean, Hz; none if it is quiet.
    pub frequency_hz: Option<f64>,
}

/// Peak to peak below which a run counts as quiet, µm or µrad.
pub const QUIET: f64 = 0.5;

/// Runs the axis at each of the speeds (mm/s or mrad/s) for 4 s and looks at the last second.
///
/// # Errors
/// [`PipelineError`] if a run diverges or does not fit the stroke.
pub fn vibration(axis: &Axis, speeds: &[f64]) -> Result<Vec<Vibration>, PipelineError> {
    let closed_loop = ClosedLoop::new(axis)?;
    let one = |&speed: &f64| one(&closed_loop, speed);
    speeds.par_iter().map(one).collect()
}

fn one(closed_loop: &ClosedLoop, thousandths: f64) -> Result<Vibration, PipelineError> {
    let plan = |e| PipelineError::Trajectory {
        index: 0,
        source: e,
    };
    let (axis, speed) = (closed_loop.axis(), 1e-3 * thousandths);
    let unit = ErrorUnit::of(axis);
    let start = axis.stroke.start;
    // In proportion to the stroke.
    let length = Scales::of(axis).motion / Scales::REFERENCE.motion;
    let limits = Limits::new(speed, 0.1 * length, length).map_err(plan)?;
    let motion = SCurve::plan(start, start + 4.0 * speed, &limits).map_err(plan)?;
    let (begin, end) = motion.cruise().unwrap_or((0.0, motion.duration()));
    let from = begin.max(end - 1.0);
    let mut errors = Vec::new();
    let outcome = closed_loop.run(&motion, &mut NoCompensation, |cycle| {
        if (from..end).contains(&cycle.time) {
            errors.push(1e6 * cycle.error());
        }
    });
    outcome.completed().map_err(|source| PipelineError::Run {
        what: format!("constant speed {thousandths} {}/s", unit.thousand()),
        source,
    })?;
    let (least, most) =
        (errors.iter()).fold((f64::MAX, f64::MIN), |(l, m), e| (l.min(*e), m.max(*e)));
    let peak_to_peak = most - least;
    let frequency_hz = (peak_to_peak > QUIET).then(|| frequency(&errors, axis.period));
    Ok(Vibration {
        speed: Speed::new(unit, thousandths),
        peak_to_peak: PeakToPeak::new(unit, peak_to_peak),
        frequency_hz,
    })
}

/// Frequency from the first to the last upward crossing of the mean.
fn frequency(samples: &[f64], period: f64) -> f64 {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    let crossings: Vec<usize> = (1..samples.len())
        .filter(|&k| samples[k - 1] < mean && samples[k] >= mean)
        .collect();
    match (crossings.first(), crossings.last()) {
        (Some(first), Some(last)) if last > first => {
            (crossings.len() - 1) as f64 / ((last - first) as f64 * period)
        }
        _ => 0.0,
    }
}
