//! A result in one sentence.

use super::form::FormFound;
use super::types::{EffectFound, RefusedEffects, Verdict};
use super::unknown::Unknown;
use crate::name::gap::Gap;

/// Names of effects, with the order of each that is named more than once: only what repeats with a turn is,
/// with another order each time.
pub(super) fn names(effects: &[EffectFound]) -> Vec<String> {
    let own_name = |e: &EffectFound| {
        let is_again = effects.iter().filter(|o| o.name == e.name).count() > 1;
        let order = e.parameters.iter().find(|p| is_again && p.name == "order");
        order.map_or(e.name.clone(), |order| {
            format!("{} of order {:.0}", e.name, order.value)
        })
    };
    effects.iter().map(own_name).collect()
}

/// A verdict in words, with what was named, the residual, and where.
pub(super) fn sentence(
    verdict: Verdict,
    effects: &[EffectFound],
    check: &Gap,
    unknown: Option<&Unknown>,
    refused: Option<&RefusedEffects>,
    own_form: Option<&FormFound>,
) -> String {
    let name = |(e, own): (&EffectFound, String)| match e.indistinguishable_from.as_slice() {
        [] => own,
        others => format!("{own} (or {}: these logs cannot tell)", others.join(", ")),
    };
    let names: Vec<String> = effects.iter().zip(names(effects)).map(name).collect();
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
        Verdict::NothingMissing if !check.is_at_floor() => format!(
            "Nothing is missing: what remains is taken for noise or is immaterial, as the notes say, with known parameters inside their tolerance.{forms}"
        ),
        Verdict::NothingMissing => format!(
            "Nothing is missing: the model and the logs agree to the noise, with known parameters inside their tolerance.{forms}"
        ),
        Verdict::Explained if check.stands_out() => {
            format!("The model lacks {names}. With {it}, {gone}.{forms}")
        }
        Verdict::Explained => format!("The model lacks {names}. {gone}.{forms}"),
        Verdict::PartlyExplained if !check.stands_out() => format!(
            "Partly explained, by {names}. {gone}. A residual remains that has no name.{place} The named effects may stand for something that is not in the library.{refused}{forms}"
        ),
        Verdict::PartlyExplained => format!(
            "Partly explained: with {names}, {gone}, and a residual remains that has no name.{place} The named effects may stand for something that is not in the library.{refused}{forms}"
        ),
        Verdict::Unknown => format!(
            "Unknown: the model and the logs disagree, and no effect of the library explains it.{place}{refused}{forms}"
        ),
    }
}
