//! What the first screen of a report needs beside the numbers: costs, confidence, remedies.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::cost::Cost;
use super::recalibrated::Recalibrated;
use super::remedy::DriveFunction;
use crate::controller::OwnController;

/// How far a verdict can be relied on.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// A hint.
    #[default]
    Low,
    /// To be confirmed.
    Medium,
    /// Nothing in the logs speaks against it.
    High,
}

impl Level {
    /// In a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
        }
    }

    pub(super) fn lowered(self, steps: usize) -> Self {
        let all = [Self::Low, Self::Medium, Self::High];
        all[(self as usize).saturating_sub(steps)]
    }
}

/// What the confidence in a verdict rests on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Confidence {
    /// In what was named, or in that nothing is missing: high for a gap that is explained or
    /// is none, medium where a residual is left, low where nothing explains it; a step lower for
    /// each of the three that follow, and where a residual above the floor is taken for noise.
    pub level: Level,
    /// Known parameters that were moved to the edge of their tolerance.
    pub at_edge: Vec<Recalibrated>,
    /// Effect and size whose 95 % interval is wider than half of its value.
    pub wide: Vec<[String; 2]>,
    /// Named effects that have others which these logs cannot tell from them.
    pub ambiguous: Vec<String>,
}

/// What the first screen says beside the numbers of a discovery.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Assessment {
    /// What all that was named costs together on check motion.
    pub cost: Cost,
    /// What each effect costs alone, by name, where there are several.
    pub each: Vec<(String, Cost)>,
    /// How sure all of it is.
    pub confidence: Confidence,
    /// What compensates each named effect.
    pub remedies: Vec<RemedyFound>,
    /// Where a replay leaves a residual: another controller than the file's, which gives the logged
    /// commands better.
    #[serde(default)]
    pub controller: Option<OwnController>,
}

/// What compensates an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RemedyFound {
    /// The effect.
    pub effect: String,
    /// The function of the drive.
    pub function: DriveFunction,
    /// What is entered there.
    pub parameter: String,
}
