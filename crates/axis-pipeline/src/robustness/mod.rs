//! How compensation holds when the model is wrong: many draws, each a point.
//!
//! A [`Study`] is a list of draws. Each draws a model, a machine or a motion from its own
//! seed and makes moves one after the other under one strategy; what it leaves is compared
//! with the machine without compensation on the same moves.

mod draws;
mod machines;
mod studies;

use axis_sim::{Axis, ClosedLoop, Measured};
use compensator::DriveModel;
use serde::{Deserialize, Serialize};

pub use draws::{constant_speed, pre_roll, random_program, wrong_model};
pub use machines::{Machine, machines};
pub(crate) use studies::WRONG;
pub use studies::{Draws, Goal, Study, room, studies};

use crate::moves::{Moves, NamedMotion};
use crate::strategies::{NONE, Predictors, STRATEGIES, named};
use crate::{Figures, PipelineError};

/// Noise of the machine's sensors; the same seed gives the same noise.
pub type Sense<'a> = &'a (dyn Fn(u64) -> Box<dyn FnMut(&mut Measured)> + Sync);

/// One draw, ready to be made.
pub struct Draw {
    /// What the compensator assumes.
    pub assumed_model: DriveModel,
    /// What moves.
    pub machine: Axis,
    /// Moves in their order.
    pub motions: Vec<NamedMotion>,
    /// Moves at the end that count; those before are learned from.
    pub counted: usize,
    /// Seed of the sensors' noise.
    pub seed: u64,
}

/// What came of a draw: a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Without compensation, each counted move, µm or µrad.
    pub none: Vec<Figures>,
    /// With it.
    pub compensated: Vec<Figures>,
}

impl Point {
    /// Share of the peak that was taken away on a counted move, %.
    pub fn peak_taken(&self, at: usize) -> f64 {
        100.0 * (1.0 - self.compensated[at].max / self.none[at].max)
    }

    /// Share of the mean, %.
    pub fn mean_taken(&self, at: usize) -> f64 {
        100.0 * (1.0 - self.compensated[at].mean / self.none[at].mean)
    }
}

/// Makes a draw under the strategy of a name; `sense` gives its sensors' noise, where they
/// have some.
///
/// # Errors
/// [`PipelineError`] if a move does not come to its end.
pub fn make(
    axis: &Axis,
    strategy: &str,
    draw: &Draw,
    sense: Option<Sense<'_>>,
) -> Result<Point, PipelineError> {
    let closed_loop = ClosedLoop::new(&draw.machine)?;
    let predictors = Predictors {
        assumed_model: Some(draw.assumed_model),
        ..Predictors::of(axis)
    };
    let kind = named(STRATEGIES, strategy)
        .ok_or_else(|| PipelineError::NoStrategy(strategy.to_owned()))?;
    let uncounted = draw.motions.len() - draw.counted;
    let figures = |kind: &crate::strategies::StrategyKind, from: usize| {
        let noise = |seed| -> Box<dyn FnMut(&mut Measured)> {
            match sense {
                Some(sense) => sense(seed),
                None => Box::new(|_| ()),
            }
        };
        let mut moves = Moves::new(&closed_loop, noise(draw.seed));
        let mut strategy = kind.strategy(&predictors)?;
        let made = draw.motions[from..].iter();
        let made = made.map(|motion| Ok(moves.make(&mut *strategy, motion)?.figures));
        made.collect::<Result<Vec<_>, PipelineError>>()
    };
    Ok(Point {
        none: figures(&NONE, uncounted)?,
        compensated: figures(kind, 0)?.split_off(uncounted),
    })
}
