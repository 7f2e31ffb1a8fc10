//! Axes with what drives and corrects them, and their run along a path one after the other: nothing lies between them.

use std::sync::Arc;

use axis_sim::{ClosedLoop, Measured};
use compensator::Compensator;
use toolpath::FeedProfile;

use crate::error::{MOST_SAMPLES, MachineError};
use crate::machine::whole_parts;
use crate::motion::AxisMotion;
use crate::traced::Traced;

type Sense<'a> = Box<dyn FnMut(&mut Measured) + 'a>;

/// An axis of a machine: its loop, what corrects it, and what its sensors make of what they see.
pub struct Driven<'a> {
    closed_loop: &'a ClosedLoop,
    compensator: Box<dyn Compensator + 'a>,
    sense: Sense<'a>,
}

impl<'a> Driven<'a> {
    /// With the sensors of the axis.
    pub fn new(closed_loop: &'a ClosedLoop, compensator: Box<dyn Compensator + 'a>) -> Self {
        Self {
            closed_loop,
            compensator,
            sense: Box::new(|_| ()),
        }
    }

    /// With sensors that show something else besides, as [`ClosedLoop::run_sensed`] takes it.
    #[must_use]
    pub fn sensing(self, sense: impl FnMut(&mut Measured) + 'a) -> Self {
        Self {
            sense: Box::new(sense),
            ..self
        }
    }
}

/// Runs all axes along a path from standstill, each from where its motions begin; positions are taken at the control
/// periods of the slowest axis.
///
/// # Errors
/// [`MachineError`] if an axis stops on its way, if periods share no instants, or for a motion that is too long.
pub fn trace<const D: usize>(
    profile: &FeedProfile<D>,
    axes: [Driven<'_>; D],
) -> Result<Traced<D>, MachineError> {
    let periods = axes
        .each_ref()
        .map(|driven| driven.closed_loop.axis().period);
    let longest = periods.iter().copied().fold(0.0, f64::max);
    let mut parts = [1; D];
    for (axis, period) in periods.into_iter().enumerate() {
        parts[axis] = whole_parts(axis, period, longest)?;
    }
    let (duration, samples) = (profile.duration(), profile.duration() / longest);
    if samples > MOST_SAMPLES {
        return Err(MachineError::TooLong { duration, samples });
    }
    let shared = Arc::new(profile.clone());
    let mut columns: [Vec<f64>; D] = std::array::from_fn(|_| Vec::new());
    for (axis, mut driven) in axes.into_iter().enumerate() {
        let start = driven.closed_loop.axis().stroke.start;
        let motion = AxisMotion::new(shared.clone(), axis, start);
        let (every, mut cycle) = (parts[axis], 0);
        let column = &mut columns[axis];
        let observe = |seen: &axis_sim::Cycle| {
            if cycle % every == 0 {
                column.push(seen.position - motion.zero());
            }
            cycle += 1;
        };
        let outcome = driven.closed_loop.run_sensed(
            &motion,
            &mut *driven.compensator,
            &mut driven.sense,
            observe,
        );
        let stopped = |why| MachineError::Stopped {
            axis: axis + 1,
            why,
        };
        outcome.completed().map_err(stopped)?;
    }
    let count = columns.iter().map(Vec::len).min().unwrap_or(0);
    let at = |k: usize| std::array::from_fn(|axis| columns[axis][k]);
    Ok(Traced::new(shared, longest, (0..count).map(at).collect()))
}
