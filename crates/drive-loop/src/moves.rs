//! The axis' own moves, simulated with the noise of its sensors.

use axis_sim::{Axis, ClosedLoop, Outcome};
use compensator::NoCompensation;
use schemars::JsonSchema;
use serde::Serialize;
use trajectories::{Motion, SCurve, Setpoint};

use crate::error::LoopError;

/// Standstill after each move over which its ringing is looked at, s: the second half of it.
const STANDSTILL: f64 = 0.4;

/// One move of an axis, simulated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MoveFigures {
    /// Greatest tracking error, m or rad; none where the run was given up.
    pub peak_error: Option<f64>,
    /// Its mean, from the start to the end of the move.
    pub mean_error: Option<f64>,
    /// Control cycles in which the command, or a voltage that it asks for, is at its limit.
    pub saturated_cycles: u64,
    /// Deviation (RMS) of the command about its mean in the standstill after the move, as a share of
    /// the greatest command.
    pub ringing: f64,
}

/// A move with standstill behind it.
struct Dwelling(SCurve);

impl Motion for Dwelling {
    fn duration(&self) -> f64 {
        self.0.duration() + STANDSTILL
    }

    fn at(&self, t: f64) -> Setpoint {
        self.0.at(t)
    }
}

/// All moves of the axis' file, simulated from standstill with the noise of the sensors (seed 0).
///
/// # Errors
/// [`LoopError::Setup`] where the axis makes no closed loop.
pub fn moves(axis: &Axis) -> Result<Vec<MoveFigures>, LoopError> {
    let closed = ClosedLoop::new(axis)?;
    let plans = axis.trajectories.iter().map(|spec| axis.plan(spec));
    // A move that has no S-curve is refused with the file.
    let plans = plans.filter_map(Result::ok);
    Ok(plans.map(|plan| one(&closed, plan)).collect())
}

fn one(closed: &ClosedLoop, plan: SCurve) -> MoveFigures {
    let end = plan.duration();
    let (mut peak, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    let mut saturated = 0;
    let mut commands = Vec::new();
    let outcome = closed.run(&Dwelling(plan), &mut NoCompensation, |cycle| {
        let error = cycle.error().abs();
        if cycle.time <= end {
            peak = peak.max(error);
            sum += error;
            count += 1.0;
        } else if cycle.time >= end + 0.5 * STANDSTILL {
            commands.push(cycle.command.effort);
        }
        saturated += u64::from(cycle.command.saturated);
    });
    let completed = matches!(outcome, Outcome::Completed);
    let mean = commands.iter().sum::<f64>() / commands.len().max(1) as f64;
    let squares = commands
        .iter()
        .map(|u| (u - mean) * (u - mean))
        .sum::<f64>();
    let deviation = (squares / commands.len().max(1) as f64).sqrt();
    MoveFigures {
        peak_error: completed.then_some(peak),
        mean_error: completed.then_some(sum / count),
        saturated_cycles: saturated,
        ringing: match completed {
            true => deviation / closed.axis().actuator.limit(),
            false => 1.0,
        },
    }
}
