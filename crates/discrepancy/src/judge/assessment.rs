//! What the first screen of a report needs beside the numbers: costs, confidence, remedies.

use std::f64::consts::PI;

use axis_log::never_zero;
use axis_sim::effects::{Effect, EffectParameter};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::cost::Cost;
use super::remedy::{DriveFunction, Remedy};
use super::types::{EffectFound, Recalibrated, Verdict};
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

    fn lowered(self, steps: usize) -> Self {
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

/// Share of the tolerance from which a parameter is at its edge: fits end just inside.
const EDGE: f64 = 0.99;

/// Half width of an interval over the value from which it is wide.
const WIDE: f64 = 0.25;

impl Confidence {
    pub(super) fn new(
        verdict: Verdict,
        effects: &[EffectFound],
        known: &[Recalibrated],
        taken_for_noise: bool,
    ) -> Self {
        let at_edge: Vec<Recalibrated> = known.iter().filter(|k| k.is_at_edge()).cloned().collect();
        let wide: Vec<[String; 2]> = effects.iter().flat_map(wide).collect();
        let alike = effects
            .iter()
            .filter(|e| !e.indistinguishable_from.is_empty());
        let ambiguous: Vec<String> = alike.map(|e| e.name.clone()).collect();
        let from = match verdict {
            Verdict::Explained | Verdict::NothingMissing | Verdict::OtherForm => Level::High,
            Verdict::PartlyExplained => Level::Medium,
            Verdict::Unknown => Level::Low,
        };
        let doubts = [
            at_edge.is_empty(),
            wide.is_empty(),
            ambiguous.is_empty(),
            !taken_for_noise,
        ];
        let steps = doubts.iter().filter(|none| !**none).count();
        Self {
            level: from.lowered(steps),
            at_edge,
            wide,
            ambiguous,
        }
    }
}

impl Recalibrated {
    /// Whether the fit moved it to the limit of its tolerance. An angle that may have any value has no limit.
    pub fn is_at_edge(&self) -> bool {
        let is_any = self.is_angle && self.tolerance >= EDGE * PI;
        self.tolerance > 0.0 && !is_any && self.share.abs() >= EDGE * self.tolerance
    }

    /// By how much it was moved, with its unit.
    pub fn moved(&self) -> String {
        match self.is_angle {
            true => format!("{:+.3}°", self.share.to_degrees()),
            false => format!("{:+.2} %", 100.0 * self.share),
        }
    }

    /// Its tolerance, with its unit.
    pub fn within(&self) -> String {
        match self.is_angle {
            true => format!("{}°", never_zero(self.tolerance.to_degrees(), 3)),
            false => format!("{} %", never_zero(100.0 * self.tolerance, 2)),
        }
    }
}

/// Sizes of an effect that are known badly; places and phases may be.
fn wide(effect: &EffectFound) -> Vec<[String; 2]> {
    let known = Effect::named(&effect.name);
    let is_size = |name: &str| {
        let parameters = known.map_or(&[][..], |e| e.parameters);
        parameters
            .iter()
            .filter(|p: &&EffectParameter| p.is_size())
            .any(|p| p.name == name)
    };
    let sizes = effect.parameters.iter().filter(|p| is_size(&p.name));
    let badly = sizes.filter(|p| 0.5 * (p.ci95[1] - p.ci95[0]) > WIDE * p.value.abs());
    badly
        .map(|p| [effect.name.clone(), p.name.clone()])
        .collect()
}

/// The remedies of named effects, in their order.
pub(super) fn remedies(effects: &[EffectFound]) -> Vec<RemedyFound> {
    let lines = effects.iter().filter_map(|e| Remedy::of(&e.name));
    let one = |remedy: &Remedy| RemedyFound {
        effect: remedy.effect.to_owned(),
        function: remedy.function,
        parameter: remedy.parameter.to_owned(),
    };
    lines.map(one).collect()
}
