//! What can go wrong in a stage.

use thiserror::Error;

use crate::cycle_names::CYCLE_BY_CYCLE;
use crate::need::Need;

impl PipelineError {
    /// Whether a strategy cannot be made for this axis at all: another one may be.
    pub fn is_unsuited(&self) -> bool {
        matches!(self, Self::Feedback(_) | Self::Adapt(_))
    }
}

/// Why an axis has no feedback, and what would give it one.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "no feedback can be designed for this axis; valid: a strategy without one, such as plan or adaptive{}",
    words(helps)
)]
pub struct NoFeedback {
    /// What the nearest design falls short of.
    #[source]
    pub why: Box<compensator::DesignError>,
    /// Changes of the axis, each by itself, with which one can be designed: computed, in words.
    pub helps: Vec<String>,
}

fn words(helps: &[String]) -> String {
    match helps {
        [] => String::new(),
        helps => format!("; or this axis with {}", helps.join(", or ")),
    }
}

/// Why a stage gave no result.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// The axis cannot be set up, or a step of it does not come out.
    #[error("the axis cannot be simulated: {0}")]
    Setup(#[from] axis_sim::SetupError),
    /// The axis has no ranges to draw samples from.
    #[error(
        "the axis file has no [samples], and no [[trajectory]] that would imply their ranges: give either"
    )]
    NoSampleRanges,
    /// The sample design is not valid.
    #[error("the sample design is not valid: {0}")]
    Design(#[from] lhs::LhsError),
    /// The network or its training is not valid.
    #[error("the network cannot be trained: {0}")]
    Network(#[from] cfnn::Error),
    /// A compensation strategy cannot be set up.
    #[error("the compensation cannot be set up: {0}")]
    Compensator(#[from] compensator::CompensatorError),
    /// No plan can be made of the axis.
    #[error(transparent)]
    AssumedModel(#[from] axis_sim::PlanModelError),
    /// No feedback can be designed for the axis.
    #[error(transparent)]
    Feedback(#[from] NoFeedback),
    /// The model cannot be adapted.
    #[error("the model of this axis cannot be adapted: {0}")]
    Adapt(#[from] compensator::AdaptError),
    /// A strategy, or the validation, asks for what was not found before.
    #[error("{by} needs {}, which is not among the predictors; valid: predictors that include it, or strategies that do not need it", need.name())]
    Missing {
        /// What is not there.
        need: Need,
        /// Who asks for it.
        by: String,
    },
    /// There is no strategy of that name.
    #[error("there is no strategy \"{0}\"; valid: those of the registry")]
    NoStrategy(String),
    /// A strategy that does not run cycle by cycle.
    #[error("the strategy \"{0}\" does not run cycle by cycle; valid: {names}", names = CYCLE_BY_CYCLE.join(", "))]
    NotByCycle(String),
    /// Two strategies that results could not tell apart.
    #[error("two of the strategies have the name \"{0}\"; valid: each name once")]
    SameName(&'static str),
    /// A motion has no plan.
    #[error("trajectory {index} cannot be planned: {source}")]
    Trajectory {
        /// Its number, from 1; 0 for a motion of an experiment.
        index: usize,
        /// Why.
        source: trajectories::TrajectoryError,
    },
    /// A run diverged.
    #[error("{what}: {source}")]
    Run {
        /// Which run.
        what: String,
        /// When and in which state.
        source: axis_sim::RunStopped,
    },
    /// Friction parameters cannot be found in logs.
    #[error("friction cannot be identified: {0}")]
    Identify(#[from] crate::identification::IdentifyLogsError),
    /// A simulated run makes no log.
    #[error("a simulated run makes no log: {0}")]
    Log(#[from] axis_log::LogError),
    /// Friction parameters make no law.
    #[error("the friction law is not valid: {0}")]
    Friction(#[from] lugre::LugreError),
    /// An error series has no figures.
    #[error("no error figures: {0}")]
    Metric(#[from] axis_log::metrics::MetricError),
    /// The transfer function cannot be found.
    #[error("the transfer function cannot be identified: {0}")]
    Transfer(#[from] compensator::TransferFunctionError),
    /// Too few samples for a fit.
    #[error("{found} samples that differ in every input: at least {needed} are needed")]
    TooFewSamples {
        /// How many there are.
        found: usize,
        /// How many it takes.
        needed: usize,
    },
    /// The axis' heat, or a log of it, was refused.
    #[error(transparent)]
    Heat(#[from] crate::heat::HeatError),
    /// The axis file lists no trajectories.
    #[error("the axis file lists no [[trajectory]]: give at least one")]
    NoTrajectories,
}
