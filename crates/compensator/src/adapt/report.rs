//! What an adaptation reports: each parameter with its standard error.

use std::vec::Vec;

use super::AdaptParameter;

/// One parameter as it is known after a move.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Estimated {
    /// Which.
    pub parameter: AdaptParameter,
    /// Relative error of the assumed model: value over assumed model − 1; of a constant load, its
    /// share
    /// of the assumed Coulomb force.
    pub relative: f64,
    /// Standard error of `relative`.
    pub standard_error: f64,
    /// In the model's unit: friction in its own coordinate, inertia in kg or kg·m², the
    /// greatest compliance along the stroke in rad/(N·m), a constant load in N or N·m.
    pub value: f64,
    /// Standard error of `value`.
    pub value_error: f64,
    /// Whether the estimate is held by its bound.
    pub at_bound: bool,
}

/// What a move has taught.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Learned {
    /// Moves learned by now, this one included.
    pub moves: usize,
    /// The parameters that are adapted on this axis.
    pub parameters: Vec<Estimated>,
    /// RMS of the smoothed torque that the model did not explain before, what is seen
    /// where it explains little counting less, N·m.
    pub torque_before: f64,
    /// And after.
    pub torque_after: f64,
    /// RMS of the motor's torque, N·m.
    pub torque: f64,
    /// Free travel between motor and load that the log seems to show, and its standard
    /// error, m or rad at the load; none if the load has no sensor of its own. The model
    /// has it where it is above three of them.
    pub free_travel: Option<[f64; 2]>,
}
