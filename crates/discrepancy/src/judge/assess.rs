//! How far a verdict can be relied on, and what compensates what was named.

use axis_sim::effects::{Effect, EffectParameter};

use super::assessment::{Confidence, Level, RemedyFound};
use super::recalibrated::Recalibrated;
use super::remedy::Remedy;
use super::types::{EffectFound, Verdict};

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
