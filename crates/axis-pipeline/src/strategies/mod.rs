//! Compensation strategies: a registry.
//!
//! A [`StrategyKind`] is one file and one line of [`STRATEGIES`]. By that the command
//! line takes it (`simulate --compensation`), [`crate::compensation::compensate`] runs it,
//! and summary and tables show it. A strategy that is made elsewhere goes into a list of
//! one's own, which [`crate::compensation::compensate_with`] takes.

mod adaptive;
mod adaptive_feedback;
mod cycle_law;
mod drive_terms;
mod feedback;
mod feedback_helps;
mod feedforward;
mod iterative;
mod learned;
mod lugre;
mod network;
mod network_lugre;
mod network_lugre_printed;
mod none;
mod plan;
mod plan_based;
mod predictors;
mod transfer_function;
mod transfer_function_lugre;

use std::collections::BTreeMap;
use std::sync::Arc;

use compensator::{Compensator, Correction, HomedAt, LearnedMove, Sample};
use trajectories::Motion;

use crate::PipelineError;
pub use crate::cycle_names::CYCLE_BY_CYCLE;
use crate::heat::HeatAhead;
pub use crate::need::Need;
use crate::residuals::AnyLearner;
pub use cycle_law::{CycleLaw, PositionLaw, StreamedPlan};
pub use drive_terms::reversal_start;
pub use feedforward::Feedforward;
pub use network::KIND as NETWORK;
pub use network_lugre::KIND as NETWORK_LUGRE;
pub use none::KIND as NONE;
pub use plan_based::assumed_feedback;
pub(crate) use predictors::BothPredictors;
pub use predictors::{DesignOnce, NetworkStrategy, Predictors, TransferModels};

/// All strategies, one line each, in the order of summary and tables; without [`NONE`],
/// which is what they are compared with.
pub const STRATEGIES: &[&StrategyKind] = &[
    &network::KIND,
    &network_lugre::KIND,
    &transfer_function::KIND,
    &transfer_function_lugre::KIND,
    &lugre::KIND,
    &network_lugre_printed::KIND,
    &drive_terms::KIND,
    &plan::KIND,
    &feedback::KIND,
    &adaptive::KIND,
    &adaptive_feedback::KIND,
    &iterative::KIND,
    &learned::KIND,
];

/// A compensation strategy: a line of the registry.
#[derive(Clone, Copy, Debug)]
pub struct StrategyKind {
    /// Its name in results: words in lower case, `_` between them. On the command line
    /// it is written with `-`.
    pub name: &'static str,
    /// What the terminal and messages call it.
    pub label: &'static str,
    /// Above its columns in tables.
    pub heading: &'static str,
    /// One line for people.
    pub summary: &'static str,
    /// The table that shows it.
    pub table: ReportTable,
    /// What must have been found before it can be made.
    pub needs: &'static [Need],
    /// How it is made.
    pub build: Build,
}

/// How a strategy is made of what was found before.
#[derive(Clone, Copy, Debug)]
pub enum Build {
    /// One compensator after the other, each move alike.
    Each(fn(&Predictors) -> Result<Box<dyn Compensator + Send>, PipelineError>),
    /// A strategy that knows each motion ahead, or learns from move to move.
    Carrying(fn(&Predictors) -> Result<Box<dyn Strategy>, PipelineError>),
}

/// A strategy at work on one axis, from move to move.
pub trait Strategy {
    /// The compensator of the coming move.
    ///
    /// # Errors
    /// [`PipelineError`] if there is none for this axis or motion.
    fn compensator(
        &mut self,
        next: &NextMove,
    ) -> Result<Box<dyn Compensator + Send>, PipelineError>;

    /// Says how the axis is predicted to be warm along the coming moves, until it is said again: a strategy that
    /// plans subtracts the growth from the reference and plans with the friction of that temperature. None: as
    /// its model is.
    fn warmed(&mut self, _heat: Option<Arc<HeatAhead>>) {}

    /// Learns from what a controller logged in the move that is over; what it knows now.
    ///
    /// # Errors
    /// [`PipelineError`] if the record cannot be learned from.
    fn learn(&mut self, _record: &[Sample]) -> Result<LearnedValues, PipelineError> {
        Ok(LearnedValues::default())
    }
}

/// A move that is to come.
#[derive(Clone)]
pub struct NextMove {
    /// Its motion.
    pub motion: SharedMotion,
    /// Where the axis stands as the move before has left it; none if it was settled anew.
    pub continued: Option<Continued>,
    /// What was learned from repetitions of this very move, where something was.
    pub learned: Option<Arc<LearnedMove>>,
}

/// How a move goes on from the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Continued {
    /// What the compensator added last.
    pub own: Correction,
    /// How the axis stood when it was settled: where a position loop that is closed at the
    /// motor was homed.
    pub homed: HomedAt,
}

/// A motion that several may hold.
pub type SharedMotion = Arc<dyn Motion + Send + Sync>;

/// What a strategy has learned, by name: relative errors of the axis file's parameters,
/// and what else it tells, in the unit that the name ends in.
pub type LearnedValues = BTreeMap<String, f64>;

/// Each move alike.
struct EachAlike {
    predictors: Predictors,
    build: fn(&Predictors) -> Result<Box<dyn Compensator + Send>, PipelineError>,
}

impl Strategy for EachAlike {
    fn compensator(&mut self, _: &NextMove) -> Result<Box<dyn Compensator + Send>, PipelineError> {
        (self.build)(&self.predictors)
    }
}

/// The table of a report that shows a strategy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReportTable {
    /// Corrections alone.
    WithoutFrictionFeedforward,
    /// Corrections on top of friction feed-forward.
    WithFrictionFeedforward,
    /// All others.
    More,
}

impl StrategyKind {
    /// The strategy, which has not learned anything.
    ///
    /// # Errors
    /// [`PipelineError::Missing`] if the predictors lack what it needs, and whatever
    /// its own making gives.
    pub fn strategy(&self, predictors: &Predictors) -> Result<Box<dyn Strategy>, PipelineError> {
        predictors.require(self.needs, &format!("the strategy \"{}\"", self.name))?;
        match self.build {
            Build::Carrying(build) => build(predictors),
            Build::Each(build) => {
                build(predictors)?;
                Ok(Box::new(EachAlike {
                    predictors: predictors.clone(),
                    build,
                }))
            }
        }
    }

    /// The compensator of one run along `motion`, from rest.
    ///
    /// # Errors
    /// As [`StrategyKind::strategy`] and [`Strategy::compensator`].
    pub fn compensator(
        &self,
        predictors: &Predictors,
        motion: SharedMotion,
    ) -> Result<Box<dyn Compensator + Send>, PipelineError> {
        self.strategy(predictors)?.compensator(&NextMove {
            motion,
            continued: None,
            learned: None,
        })
    }
}

/// Plan and feedback adapted between moves, with a learner of one's own for what no parameter
/// holds.
///
/// # Errors
/// As [`StrategyKind::strategy`].
pub fn adapted(
    predictors: &Predictors,
    learner: Option<AnyLearner>,
) -> Result<Box<dyn Strategy>, PipelineError> {
    let options = plan_based::PlanOptions {
        feedback: true,
        adaptation: true,
        ..plan_based::PlanOptions::default()
    };
    let strategy = plan_based::PlanStrategy::new(predictors, options)?;
    Ok(Box::new(strategy.with_learner(learner)))
}

/// The strategy of that name among `strategies`.
pub fn named<'a>(strategies: &[&'a StrategyKind], name: &str) -> Option<&'a StrategyKind> {
    strategies.iter().copied().find(|kind| kind.name == name)
}

/// The strategies of a table among `strategies`, in their order.
pub fn of_table<'a>(strategies: &[&'a StrategyKind], table: ReportTable) -> Vec<&'a StrategyKind> {
    let strategies = strategies.iter().copied();
    strategies.filter(|kind| kind.table == table).collect()
}
