//! A case of the second matrix, and the factors that it is drawn from.

use axis_log::{Log, LogError};
use serde::{Deserialize, Serialize};

use crate::hidden::{Exercise, Form, Law, Rough};
use crate::matrix::{CaseKind, HiddenEffect};

/// Layout of what is kept of a case.
pub const VERSION: u32 = 2;

/// By how much known parameters may be off, as the search is told: a factor of the design.
pub const TOLERANCES: [f64; 3] = [0.01, 0.05, 0.2];

/// Sizes of what is hidden, as multiples of the fall of D that naming takes.
pub const VISIBLE: [f64; 2] = [1.0, 30.0];

/// What of a log the search is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Channels {
    /// All that the drive has.
    All,
    /// Reference, position of the load, and current or command.
    Tracking,
    /// Position of the load and current or command: a torque balance.
    Balance,
}

impl Channels {
    /// All of them, a factor of the design.
    pub const ALL: [Self; 3] = [Self::All, Self::Tracking, Self::Balance];

    /// In tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Tracking => "reference, position, current",
            Self::Balance => "position, current",
        }
    }

    /// The log as the search is given it.
    ///
    /// # Errors
    /// [`LogError`] never of a log that has a position and an effort.
    pub(super) fn of(self, log: &Log) -> Result<Log, LogError> {
        let effort = EFFORTS.into_iter().find(|name| log.has(name));
        let kept = |name: &str| match self {
            Self::All => true,
            _ if name == "t_s" || Some(name) == effort => true,
            Self::Tracking if name.starts_with("position_ref_") => true,
            _ => ["position_m", "position_rad"].contains(&name),
        };
        let channels = log.channels().iter().filter(|c| kept(&c.name));
        let mut shown = Log::new(channels.cloned().collect())?;
        for channel in log.channels().iter().filter(|c| kept(&c.name)) {
            shown.mark_missing(&channel.name, log.missing(&channel.name).iter().cloned())?;
        }
        Ok(shown)
    }
}

/// Channels that show what the drive gives; the first that a log has is its current.
const EFFORTS: [&str; 4] = ["iq_a", "torque_ref_n_m", "force_ref_n", "drive_command_v"];

/// What cases of one plot have in common: they share what the library does on the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseSetting {
    /// Name of the machine's axis.
    pub machine: String,
    /// Motion.
    pub exercise: Exercise,
    /// Where it starts, m or rad.
    pub start: f64,
    /// Share by which known parameters may be off; the search is told it.
    pub tolerance: f64,
    /// Channels of the logs.
    pub channels: Channels,
}

/// One machine with something hidden in it, or nothing: all that its logs are made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// [`VERSION`] of its layout.
    pub version: u32,
    /// Name, unique in a design.
    pub id: String,
    /// Plot that it stands in.
    pub plot: usize,
    /// What it shares with the others there.
    pub setting: CaseSetting,
    /// What kind of question it asks.
    pub kind: CaseKind,
    /// What is hidden, before its sizes are scaled.
    pub hidden: Vec<HiddenEffect>,
    /// Where something outside of the library is hidden, the law.
    pub law: Option<Law>,
    /// How a law of the truth differs from the model's.
    pub form: Form,
    /// Numbers from 0 to 1 that the form is made of.
    pub form_at: [f64; 3],
    /// Noise.
    pub noise: Rough,
    /// Share of sliding by which the bristles are deflected at the start.
    pub wound: f64,
    /// Effects that the search may not name.
    pub rejected: Vec<String>,
    /// Of noise and known parameters.
    pub seed: u64,
    /// Sizes, one a hidden effect: expected fall of D alone over what naming takes.
    pub visible: Vec<f64>,
}
