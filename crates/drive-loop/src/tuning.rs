//! What tuning found.

use schemars::JsonSchema;
use serde::Serialize;

use crate::helps::Help;
use crate::moves::MoveFigures;
use crate::plant::Corner;
use crate::tuned_gains::{LoopFigures, TunedGains};

/// A constraint, and how near the gains are to it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Limiting {
    /// What it limits: `sensitivity at the command`, ….
    pub what: String,
    /// Its value.
    pub value: f64,
    /// Its limit.
    pub limit: f64,
    /// Where: the corner with the greatest value; none of a constraint that has no corner.
    pub corner: Option<Corner>,
    /// Frequency of the peak there, Hz.
    pub frequency_hz: Option<f64>,
    /// Number, from 1, of the natural mode within a quarter of that frequency.
    pub mode: Option<usize>,
}

/// A move before and after.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MoveCheck {
    /// Number of the trajectory, from 1.
    pub trajectory: usize,
    /// With the gains of the file.
    pub file: MoveFigures,
    /// With the tuned ones.
    pub tuned: MoveFigures,
}

/// What `tune` found.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Tuning {
    /// Of this form.
    pub schema: u32,
    /// Name of the axis.
    pub axis: String,
    /// Fingerprint of the file's axis.
    pub axis_fingerprint: String,
    /// Version of the program.
    pub version: String,
    /// Unit of the load's position: "m" or "rad".
    pub position_unit: String,
    /// Limits of the sensitivity that were kept: as asked for, or lower where the simulated axis rang.
    pub limits: [f64; 2],
    /// Gains of the file.
    pub file_gains: TunedGains,
    /// Gains that were found.
    pub tuned_gains: TunedGains,
    /// The file's loops.
    pub file: LoopFigures,
    /// The tuned loops.
    pub tuned: LoopFigures,
    /// Whether the greatest eigenvalue is below 1 in every corner, loops at their own rates.
    pub proven_stable: bool,
    /// Constraints, the nearest first; those within 2 % limit the gains.
    pub limiting: Vec<Limiting>,
    /// What would help, the most first: each by tuning again with that change.
    pub helps: Vec<Help>,
    /// The file's moves, simulated with the noise of the sensors.
    pub moves: Vec<MoveCheck>,
    /// Evaluations of the objective.
    pub evaluations: usize,
    /// What else is to be known, in words.
    pub notes: Vec<String>,
}
