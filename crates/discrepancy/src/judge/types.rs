//! What `discovery.json` holds.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use trajectories::Program;

use super::assessment::Assessment;
use super::experiment::Proposal;
use super::form::FormFound;
use super::likeness::Likeness;
use super::recalibrated::Recalibrated;
use super::unknown::Unknown;
use crate::answers::LogSet;
use crate::name::gap::Gap;
use crate::name::search::{DECISIVE_EVIDENCE, Found};

/// The verdict on a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Named effects remove at least 90 % of the gap above the floor on check
    /// motion, and nothing significant is left.
    Explained,
    /// Named effects, and a significant residual without a name.
    PartlyExplained,
    /// No gap beyond noise and the tolerance of known parameters.
    NothingMissing,
    /// No effect, but the axis' own friction has another form than the model's: with it, nothing
    /// significant is left of the gap.
    OtherForm,
    /// A significant gap, and nothing in the library that explains it.
    Unknown,
}

impl Verdict {
    /// As in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Explained => "explained",
            Self::PartlyExplained => "partly-explained",
            Self::NothingMissing => "nothing-missing",
            Self::OtherForm => "other-form",
            Self::Unknown => "unknown",
        }
    }
}

/// A parameter of an effect with its 95 % interval.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ParameterFound {
    /// Name.
    pub name: String,
    /// Estimate, SI.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// 95 % interval.
    pub ci95: [f64; 2],
    /// The value before further effects were added.
    pub when_named: f64,
    /// A force or a coefficient at the table as a torque at the screw.
    pub at_screw: Option<AtScrew>,
}

/// A number at the table as it is at the screw.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct AtScrew {
    /// Estimate.
    pub value: f64,
    /// Unit.
    pub unit: String,
}

/// An effect that was named.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct EffectFound {
    /// Name, as in the axis file.
    pub name: String,
    /// One line for people.
    pub summary: String,
    /// Effects that these logs cannot tell from it.
    pub indistinguishable_from: Vec<String>,
    /// Its numbers.
    pub parameters: Vec<ParameterFound>,
    /// Where it shows first.
    pub channel: String,
    /// On what it depends.
    pub depends_on: String,
    /// Share of the check logs' gap that comes back without it.
    pub share_of_gap: f64,
    /// Fall of minus twice the log-likelihood: on the fit logs, on the check logs.
    pub evidence: [f64; 2],
    /// Its size, fitted to the logs of which the figures are, over the size that it has: lower end of the 95 % interval, ratio,
    /// upper end. `None` if it does nothing there.
    #[serde(default)]
    pub size_on_check: Option<[f64; 3]>,
    /// What else was tried in its place, with the fall that it reached.
    pub runners_up: Vec<(String, f64)>,
    /// In what its law differs from the library's; `None` if nothing shows that.
    pub form: Option<FormFound>,
}

/// An effect that was named on the way.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ReplacedEffect {
    /// Name.
    pub name: String,
    /// Its numbers when it had just been named: name, value, unit.
    pub when_named: Vec<(String, f64, String)>,
    /// The effect, or the other form of a friction, that explains as much in its place, now that the others are there.
    pub by: String,
}

/// Effects that explain something of the fitted logs, and are not given: with them check
/// motion is further off, or they take away too little of its gap or have another size there, or one law outside the
/// library explains as much as all of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RefusedEffects {
    /// Names.
    pub effects: Vec<String>,
    /// Channels that are further off; none if they are so in total only, or in none.
    pub channels: Vec<String>,
    /// Share of the gap on check motion that they take away, where that is too little.
    #[serde(default)]
    pub takes_away: Option<f64>,
    /// Size of the first of them on check motion over its size on the fitted motion, where that is another.
    #[serde(default)]
    pub size_on_check: Option<f64>,
    /// The law outside the library that is more probable than they are together, if it has a formula: a force in
    /// proportion to this, of time t, position x and speed v.
    #[serde(default)]
    pub law: Option<String>,
    /// What the law outside the library that is more probable than they are together depends on.
    #[serde(default)]
    pub law_over: Option<String>,
}

impl RefusedEffects {
    /// In a sentence that follows another.
    pub(super) fn sentence(&self) -> String {
        let (it, they, is) = match self.effects.len() > 1 {
            true => ("them", "they", "are"),
            false => ("it", "it", "is"),
        };
        let names = match self.effects.as_slice() {
            // Only how the axis' own friction acts was another.
            [] => "Another form of the friction".to_owned(),
            names => names.join(" with "),
        };
        if let Some(share) = self.takes_away {
            return format!(
                " {names} would take away {:.0} % of the gap, too little for a name, so {they} {is} not named.",
                100.0 * share.max(0.0)
            );
        }
        if let (Some(ratio), Some(first)) = (self.size_on_check, self.effects.first()) {
            return format!(
                " {first} would have {ratio:.2} times its size on check motion, so it stands for something else and is not named."
            );
        }
        if let Some(law) = &self.law {
            return format!(
                " A force in proportion to {law} explains and predicts these logs better than {names}, so {they} {is} not named."
            );
        }
        if let Some(over) = &self.law_over {
            return format!(
                " One law over {over} explains and predicts these logs better than {names}, so {they} {is} not named."
            );
        }
        let where_ = match self.channels.as_slice() {
            [] => "in total".to_owned(),
            channels => format!("in {}", channels.join(", ")),
        };
        format!(
            " {names} would explain most of the fitted logs, but with {it} the model is further off {where_} on motion not used in the fit than without, so {they} {is} not named."
        )
    }
}

/// Gap on both sets of logs.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Gaps {
    /// On the logs that were fitted.
    pub fit: Gap,
    /// On logs that were not: those of [`Discovery::figures`].
    pub check: Gap,
}

/// The logs that the figures of a discovery are of: gap on motion that was not fitted to,
/// costs, shares of the gap.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Figures")]
pub struct FigureLogs {
    /// Their names.
    pub logs: Vec<String>,
    /// Whether they took part in the choice of names, as check logs do.
    pub took_part: bool,
}

impl FigureLogs {
    pub(super) fn of(found: &Found, set: &LogSet) -> Self {
        Self {
            logs: set.logs.iter().map(|log| log.name.clone()).collect(),
            took_part: found.test.is_none(),
        }
    }

    /// In a sentence; `None` if the logs are not known, as in older files.
    pub fn sentence(&self) -> Option<String> {
        let logs = self.logs.join(", ");
        (!self.logs.is_empty()).then(|| match self.took_part {
            true => format!(
                "Figures are from {logs}, which also served to choose what is named: a third set of logs (--test) would give independent figures."
            ),
            false => format!("Figures are from {logs}, which took no part in any choice."),
        })
    }
}

/// The motion that would tell apart what these logs cannot.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct NextExperiment {
    /// What it is, in words.
    pub what: String,
    /// Effects that it separates.
    pub separates: [String; 2],
    /// Fall of −2 log L to be expected between the two; 25 and more decide.
    pub by: f64,
    /// The motion, as a program file has it (`simulate --program`).
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    pub program: Program,
}

impl NextExperiment {
    /// What a log of it is worth, as a sentence without its end. Evidence of independent logs adds up.
    #[must_use]
    pub fn said(&self) -> String {
        let expected = format!(
            "One log of it should bring an evidence of {}, and {} are needed",
            said_evidence(self.by),
            DECISIVE_EVIDENCE
        );
        let needed = (DECISIVE_EVIDENCE / self.by).ceil();
        match needed {
            _ if self.by >= DECISIVE_EVIDENCE => format!("{expected}: one log is enough"),
            // As many as nobody records.
            _ if needed <= 100.0 => format!("{expected}: record {needed} logs"),
            _ => format!("{expected}: logs of it hardly distinguish the two"),
        }
    }
}

/// Evidence, a fall of −2 log L, rounded to three digits.
#[must_use]
pub fn said_evidence(fall: f64) -> String {
    let rounded: f64 = format!("{fall:.2e}").parse().unwrap_or(fall);
    match rounded.abs() < 1e5 {
        true => rounded.to_string(),
        false => format!("{fall:.2e}"),
    }
}

/// Of files from before there was another way.
fn replayed() -> String {
    "closed-loop-replay".to_owned()
}

/// What `discovery.json` holds.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Discovery {
    /// Version of this file's layout, [`Discovery::SCHEMA`]. It rises where a field goes or
    /// changes its meaning; new fields do not raise it.
    pub schema: u32,
    /// Name of the axis.
    pub axis: String,
    /// How the model was compared with the logs: `closed-loop-replay`, `torque-balance`,
    /// `controller-estimated`, a replay with gains that were estimated from logs, or `thermal-network`, of logs of hours.
    #[serde(default = "replayed")]
    pub answer: String,
    /// Notes on the logs beside the verdict; whoever reads them adds what
    /// was done to them.
    pub notes: Vec<String>,
    /// Verdict.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    pub sentence: String,
    /// Named effects, largest share first.
    pub effects: Vec<EffectFound>,
    /// In what the law of the axis' own dry friction differs from the model's; `None`
    /// if nothing shows that.
    pub own_form: Option<FormFound>,
    /// Effects that were named on the way, until another took their place.
    pub replaced: Vec<ReplacedEffect>,
    /// What was named in the end and is not given, as it makes check motion worse.
    pub refused: Option<RefusedEffects>,
    /// Best candidates that were not added.
    pub not_added: Vec<(String, f64)>,
    /// The residual is significant, and is nothing in the library.
    pub unknown: Option<Unknown>,
    /// Gap before and after.
    pub gap: Gaps,
    /// Of which logs the figures are.
    #[serde(default)]
    pub figures: FigureLogs,
    /// Known parameters.
    pub recalibrated: Vec<Recalibrated>,
    /// What a first screen says beside: costs, confidence, remedies.
    #[serde(default)]
    pub assessment: Assessment,
    /// What these logs can show of each effect of the library.
    pub likenesses: Vec<Likeness>,
    /// What to run next, where effects look alike.
    pub next_experiment: Option<NextExperiment>,
}

impl Discovery {
    /// Version of the layout that this program writes.
    pub const SCHEMA: u32 = 1;
}

impl NextExperiment {
    /// As it is told.
    pub(super) fn new(proposal: &Proposal) -> Self {
        Self {
            what: proposal.what.to_owned(),
            separates: proposal.pair.each_ref().map(|a| a.effect.name.to_owned()),
            by: proposal.separation,
            program: proposal.program.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{NextExperiment, said_evidence};

    #[test]
    fn evidence_is_rounded_and_weighed() {
        for (fall, shown) in [
            (1_795_009.4, "1.80e6"),
            (71_834.0, "71800"),
            (26.04, "26"),
            (0.0, "0"),
            (-3.456, "-3.46"),
        ] {
            assert_eq!(said_evidence(fall), shown);
        }
        let text = r#"{"what":"w","separates":["a","b"],"by":0.0,"program":{"start_mm":0,"steps":[{"dwell":{"duration_s":1}}]}}"#;
        let next: NextExperiment = serde_json::from_str(text).unwrap();
        let said = |by: f64| NextExperiment { by, ..next.clone() }.said();
        for (by, end) in [
            (
                1_795_009.4,
                "of 1.80e6, and 25 are needed: one log is enough",
            ),
            (25.0, "one log is enough"),
            (12.0, "of 12, and 25 are needed: record 3 logs"),
            (0.0, "hardly distinguish the two"),
        ] {
            assert!(said(by).ends_with(end), "{}", said(by));
        }
    }
}
