//! Axes with what drives and corrects them, and their run along a path.

use std::sync::Arc;

use axis_sim::{ClosedLoop, Measured, RunStopped};
use compensator::Compensator;
use thiserror::Error;
use toolpath::FeedProfile;

use crate::motion::AxisMotion;
use crate::traced::Traced;

/// Why a machine did not run along a path.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MachineError {
    /// An axis stopped on its way.
    #[error("axis {axis} (from 1): {why}")]
    Stopped {
        /// Which axis, from 1.
        axis: usize,
        /// When and why.
        why: RunStopped,
    },
    /// Control periods that share no instants.
    #[error(
        "axis {axis} (from 1) has a control period of {period} s, and the slowest of all has {longest} s; valid: whole parts of the slowest"
    )]
    Periods {
        /// Which axis, from 1.
        axis: usize,
        /// Its period, s.
        period: f64,
        /// The longest of all, s.
        longest: f64,
    },
    /// So long that its positions are not held.
    #[error(
        "the motion lasts {duration} s, {samples:.0} control periods; valid: at most {MOST_SAMPLES}"
    )]
    TooLong {
        /// Of the motion, s.
        duration: f64,
        /// Control periods of the slowest axis.
        samples: f64,
    },
}

/// Most positions that are held of a run: 160 MB for two axes.
const MOST_SAMPLES: f64 = 5e6;

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
    let parts = periods.map(|period| longest / period);
    let is_whole = |&(_, part): &(usize, &f64)| (part - part.round()).abs() > 1e-9 * part;
    if let Some((axis, _)) = parts.iter().enumerate().find(is_whole) {
        return Err(MachineError::Periods {
            axis: axis + 1,
            period: periods[axis],
            longest,
        });
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
        let (every, mut cycle) = (parts[axis].round() as usize, 0);
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
    Ok(Traced::new(shared, longest, &columns))
}
