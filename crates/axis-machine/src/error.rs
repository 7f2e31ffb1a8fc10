//! Why a machine was not made, did not run, or was not identified.

use axis_pipeline::PipelineError;
use axis_sim::{RunStopped, SetupError};
use thiserror::Error;
use toolpath::ToolpathError;

/// Why a machine was not made, or did not run along a path.
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
    /// A value of what lies between axes is out of its range.
    #[error("{what} of axis {axis} (from 1) is {value} {unit}; valid: {valid}")]
    Invalid {
        /// What it is.
        what: &'static str,
        /// Which axis, from 1.
        axis: usize,
        /// The value, SI units.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// What would be valid.
        valid: String,
    },
    /// An axis whose load turns.
    #[error("the load of axis {axis} (from 1) turns; valid: an axis that moves along a line")]
    Rotary {
        /// Which axis, from 1.
        axis: usize,
    },
    /// Not one law for each drive.
    #[error(
        "{laws} laws for {drives} drives; valid: one for each drive, that of a gantry's second after its first"
    )]
    Laws {
        /// How many there are.
        laws: usize,
        /// Drives of the machine.
        drives: usize,
    },
    /// A closed loop cannot be made or started.
    #[error("axis {axis} (from 1): {source}")]
    Setup {
        /// Which axis, from 1.
        axis: usize,
        /// Why.
        source: SetupError,
    },
    /// A strategy of compensation refuses an axis or a motion.
    #[error("axis {axis} (from 1): {source}")]
    Strategy {
        /// Which axis, from 1.
        axis: usize,
        /// Why.
        source: PipelineError,
    },
}

/// Most positions that are held of a run: 160 MB for two axes.
pub(crate) const MOST_SAMPLES: f64 = 5e6;

/// Why squareness and cross-talk were not found from circles.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CircleFitError {
    /// Circles that cannot tell the unknowns apart.
    #[error("the circles determine {rank} of {unknowns} unknowns: {why}; valid: {valid}")]
    Rank {
        /// How many combinations of the unknowns they tell.
        rank: usize,
        /// How many unknowns there are.
        unknowns: usize,
        /// Which are not told apart.
        why: &'static str,
        /// What would be valid.
        valid: &'static str,
    },
    /// A value that cannot be.
    #[error("{what} of circle {circle} (from 1) is {value}; valid: {valid}")]
    Circle {
        /// What it is.
        what: &'static str,
        /// Which circle, from 1.
        circle: usize,
        /// The value.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// No circle at all.
    #[error("no circle; valid: at least two, run at two feeds")]
    None,
    /// A circle was refused.
    #[error(transparent)]
    Toolpath(#[from] ToolpathError),
}
