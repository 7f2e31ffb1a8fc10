use std::vec::Vec;

use super::report::{EpochReport, History, Hyperparameters};
use super::settings::TrainingSettings;
use crate::{Network, Scaling, Shape};

/// Everything from which a training goes on bit for bit, the data apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    /// The settings. `threads` may be changed freely and `epochs` raised
    /// before resuming; any other change makes it a different training.
    pub settings: TrainingSettings,
    /// The network at the last epoch.
    pub(crate) current: Network,
    /// Damping for the next epoch.
    pub(crate) damping: f64,
    /// Under Bayesian regularisation what is estimated.
    pub(crate) hyperparameters: Option<Hyperparameters>,
    /// Weights and loss at the best validation loss.
    pub(crate) best: Option<Best>,
    /// Reports of the epochs done.
    pub(crate) history: History,
    /// [`super::Dataset::fingerprint`] of the data.
    pub(crate) fingerprint: u64,
}

/// The state with the lowest validation loss so far.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Best {
    pub weights: Vec<f64>,
    pub loss: f64,
    /// Epochs since.
    pub age: usize,
}

impl Checkpoint {
    /// Number of epochs done.
    #[must_use]
    pub fn epochs_done(&self) -> usize {
        self.history.len()
    }

    /// Reports of the epochs done.
    #[must_use]
    pub fn history(&self) -> &[EpochReport] {
        &self.history
    }

    /// Layer sizes of the network in training.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        self.current.shape()
    }

    /// Scaling of the network in training.
    #[must_use]
    pub fn scaling(&self) -> &Scaling {
        self.current.scaling()
    }
}
