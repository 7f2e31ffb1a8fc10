//! The figures of a whole pipeline in one small structure.

use serde::{Deserialize, Serialize};

use crate::Figures;

/// What `summary.json` holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the axis.
    pub axis: String,
    /// Hash of the axis' parameters.
    pub axis_fingerprint: String,
    /// What stands for the machine. Simulated, never measured.
    pub machine: String,
    /// Version of the program.
    pub version: String,
    /// Seed of everything random.
    pub seed: u64,
    /// Whether this is the small version of every stage.
    pub quick: bool,
    /// Each trajectory.
    pub trajectories: Vec<TrajectorySummary>,
    /// The network.
    pub network: NetworkSummary,
}

/// Figures of one trajectory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrajectorySummary {
    /// Number in the axis file, from 1.
    pub id: usize,
    /// Duration of the motion, s.
    pub motion_time_s: f64,
    /// Tracking errors.
    pub errors_um: ErrorsUm,
}

/// Maximum and mean absolute tracking errors, µm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorsUm {
    /// The model, without compensation.
    pub model: Figures,
    /// What stands for the machine, without compensation.
    pub machine: Figures,
    /// The machine's error as predicted.
    pub predicted: Predicted,
    /// The machine with compensation.
    pub compensated: Compensated,
}

/// The machine's error as predicted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Predicted {
    /// By the network, one cycle ahead.
    pub network: Figures,
    /// By the transfer function, from the reference alone.
    pub transfer_function: Figures,
}

/// The machine with compensation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Compensated {
    /// Network alone.
    pub network: Figures,
    /// Network and LuGre feed-forward with the identified parameters.
    pub network_lugre: Figures,
    /// Transfer function alone.
    pub transfer_function: Figures,
    /// Transfer function and LuGre feed-forward with the identified parameters.
    pub transfer_function_lugre: Figures,
    /// LuGre feed-forward alone.
    pub lugre: Figures,
    /// Network and LuGre feed-forward with the axis file's own parameters.
    pub network_lugre_printed: Figures,
}

/// The network and the linear map that it is measured against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NetworkSummary {
    /// Neurons of each hidden layer.
    pub hidden: Vec<usize>,
    /// Epochs trained.
    pub epochs: usize,
    /// Samples trained on.
    pub train_samples: usize,
    /// Unseen samples that the errors are from.
    pub test_samples: usize,
    /// Largest absolute error of the predicted position, µm.
    pub max_abs_error_um: f64,
    /// Mean absolute error, µm.
    pub mean_abs_error_um: f64,
    /// Largest absolute error of the best linear map of as many evenly spread
    /// samples, µm.
    pub linear_max_abs_error_um: f64,
    /// Its mean absolute error, µm.
    pub linear_mean_abs_error_um: f64,
    /// Time spent in training, s.
    pub train_seconds: f64,
}
