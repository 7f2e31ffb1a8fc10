//! A result in one sentence.

use axis_sim::effects::Effect;

use super::form::FormFound;
use super::types::{EffectFound, RefusedEffects, Verdict};
use super::unknown::Unknown;
use crate::name::gap::Gap;

/// A verdict in words, with what was named, what is left, and where.
pub(super) fn sentence(
    verdict: Verdict,
    effects: &[EffectFound],
    check: &Gap,
    unknown: Option<&Unknown>,
    refused: Option<&RefusedEffects>,
    own_form: Option<&FormFound>,
    next: Option<&str>,
) -> String {
    let name = |e: &EffectFound| match others(e) {
        others if others.is_empty() => e.name.clone(),
        others => format!(
            "{} (or {}: these logs cannot tell)",
            e.name,
            others.join(", or ")
        ),
    };
    let names: Vec<String> = effects.iter().map(name).collect();
    let decides = decides(effects, next);
    let forms = effects
        .iter()
        .filter_map(|e| e.form.as_ref())
        .chain(own_form);
    let forms: String = forms.map(FormFound::sentence).collect();
    let refused = refused.map_or(String::new(), RefusedEffects::sentence);
    let it = if names.len() == 1 { "it" } else { "them" };
    let names = names.join("; ");
    let gone = check.gone();
    let place = unknown.map_or(String::new(), |u| {
        let formula = u
            .formula
            .as_ref()
            .map_or(String::new(), |f| format!(": {f}"));
        format!(
            " It acts in the {} and depends on {}{formula}.",
            u.channel, u.depends_on
        )
    });
    match verdict {
        Verdict::OtherForm => format!(
            "No effect is missing, but the axis\u{2019} own friction has another form than the model\u{2019}s. With it, {gone}.{forms}"
        ),
        Verdict::NothingMissing => format!(
            "Nothing is missing: the model and the logs agree to the noise, with known parameters inside their tolerance.{forms}"
        ),
        Verdict::Explained if check.stands_out() => {
            format!("The model lacks {names}. With {it}, {gone}.{forms}{decides}")
        }
        Verdict::Explained => format!("The model lacks {names}. {gone}.{forms}{decides}"),
        Verdict::PartlyExplained if !check.stands_out() => format!(
            "Partly explained, by {names}. {gone}. A residual remains that is not named.{place} What is named may stand for something that is not in the library.{refused}{forms}{decides}"
        ),
        Verdict::PartlyExplained => format!(
            "Partly explained: with {names}, {gone}, and a residual remains that is not named.{place} What is named may stand for something that is not in the library.{refused}{forms}{decides}"
        ),
        Verdict::Unknown => format!(
            "Unknown: the model and the logs disagree, and no effect of the library explains it.{place}{refused}{forms}"
        ),
    }
}

/// What these logs cannot tell from an effect.
fn others(effect: &EffectFound) -> Vec<String> {
    let parameters = effect.or_at_edge.iter().map(|p| p.at_its_edge());
    let effects = effect.indistinguishable_from.iter().cloned();
    effects.chain(parameters).collect()
}

/// What would decide between look-alikes: the `next` experiment, the value of a parameter, or motion in which
/// what they depend on differs. Nothing where there are none.
pub(super) fn decides(effects: &[EffectFound], next: Option<&str>) -> String {
    let parameters = effects.iter().flat_map(|e| &e.or_at_edge);
    let mut parameters: Vec<&str> = parameters.map(|p| p.name.as_str()).collect();
    parameters.sort_unstable();
    parameters.dedup();
    let alike = effects
        .iter()
        .find(|e| !e.indistinguishable_from.is_empty());
    let on = |name: &str| Effect::named(name).map_or("", |effect| effect.depends_on);
    let motion = alike.map(|e| {
        if let Some(next) = next {
            return format!("the next experiment ({next})");
        }
        let others = e.indistinguishable_from.iter();
        let others = others.filter(|name| on(name) != on(&e.name));
        let names: Vec<&String> = std::iter::once(&e.name).chain(others).collect();
        match names.as_slice() {
            [own] => format!("more motion over what both depend on ({})", on(own)),
            names => {
                let each = names.iter().map(|name| format!("{name} on {}", on(name)));
                let each: Vec<String> = each.collect();
                format!(
                    "motion that tells apart what they depend on ({})",
                    each.join(", ")
                )
            }
        }
    });
    let value = (!parameters.is_empty()).then(|| {
        format!(
            "a measured value of {} in the axis file",
            parameters.join(", ")
        )
    });
    let all: Vec<String> = motion.into_iter().chain(value).collect();
    match all.is_empty() {
        true => String::new(),
        false => format!(" What would decide: {}.", all.join("; ")),
    }
}
