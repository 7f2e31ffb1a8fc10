//! Compensation strategies: a registry.
//!
//! A [`StrategyKind`] is one file and one line of [`STRATEGIES`]. By that the command
//! line takes it (`simulate --compensation`), [`crate::compensation::compensate`] runs it,
//! and summary and tables show it. A strategy that is made elsewhere goes into a list of
//! one's own, which [`crate::compensation::compensate_with`] takes.

mod feedforward;
mod lugre;
mod network;
mod network_lugre;
mod network_lugre_printed;
mod none;
mod predictors;
mod transfer_function;
mod transfer_function_lugre;

use compensator::Compensator;

use crate::PipelineError;
pub use feedforward::Feedforward;
pub use network::KIND as NETWORK;
pub use network_lugre::KIND as NETWORK_LUGRE;
pub use none::KIND as NONE;
pub(crate) use predictors::BothPredictors;
pub use predictors::{NetworkStrategy, Predictors, TransferModels};

/// All strategies, one line each, in the order of summary and tables; without [`NONE`],
/// which is what they are compared with.
pub const STRATEGIES: &[&StrategyKind] = &[
    &network::KIND,
    &network_lugre::KIND,
    &transfer_function::KIND,
    &transfer_function_lugre::KIND,
    &lugre::KIND,
    &network_lugre_printed::KIND,
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
    pub table: Table,
    /// What must have been found before it can be made.
    pub needs: &'static [Need],
    /// Makes the compensator of one run.
    pub build: fn(&Predictors) -> Result<Box<dyn Compensator>, PipelineError>,
}

/// The table of a report that shows a strategy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// Table 16 of the paper: without friction feed-forward.
    WithoutFrictionFeedforward,
    /// Table 15 of the paper: with friction feed-forward.
    WithFrictionFeedforward,
    /// More strategies, which the paper does not have.
    More,
}

/// What is found from simulation or measurement, and a strategy may be made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// The trained one-cycle network.
    Network,
    /// The transfer functions of the tracking error.
    TransferFunctions,
    /// The friction parameters identified on the machine.
    IdentifiedFriction,
}

impl Need {
    /// All of them.
    pub const ALL: [Self; 3] = [
        Self::Network,
        Self::TransferFunctions,
        Self::IdentifiedFriction,
    ];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Network => "the trained network",
            Self::TransferFunctions => "the transfer functions of the tracking error",
            Self::IdentifiedFriction => "the identified friction parameters",
        }
    }
}

impl StrategyKind {
    /// The compensator of one run.
    ///
    /// # Errors
    /// [`PipelineError::Missing`] where the predictors lack what it needs, and whatever
    /// its own making gives.
    pub fn compensator(
        &self,
        predictors: &Predictors,
    ) -> Result<Box<dyn Compensator>, PipelineError> {
        predictors.require(self.needs, &format!("the strategy \"{}\"", self.name))?;
        (self.build)(predictors)
    }
}

/// The strategy of that name among `strategies`.
pub fn named<'a>(strategies: &[&'a StrategyKind], name: &str) -> Option<&'a StrategyKind> {
    strategies.iter().copied().find(|kind| kind.name == name)
}

/// The strategies of a table among `strategies`, in their order.
pub fn of_table<'a>(strategies: &[&'a StrategyKind], table: Table) -> Vec<&'a StrategyKind> {
    let strategies = strategies.iter().copied();
    strategies.filter(|kind| kind.table == table).collect()
}
