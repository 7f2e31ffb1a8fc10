//! What the name of a column, and the unit beside it, say of its numbers.

use super::vocabulary::{RMS, SHARES, Words};
use crate::table::Head;
use crate::unit::stem_of;
use crate::unit_table::known;

/// What a name says.
pub(super) struct Stated<'a> {
    /// The name without its unit.
    pub stem: &'a str,
    /// What stands in brackets and is no unit, as `[u1, 2]` behind the signals of a control.
    pub axis: Option<&'a str>,
    pub unit: StatedUnit,
}

/// A unit and its dimension.
pub(super) type Unit = (&'static str, &'static str);

/// What a name says of the unit.
#[derive(Clone, Copy)]
pub(super) enum StatedUnit {
    /// Nothing.
    None,
    Known(Unit),
    /// The RMS value of a sine in this unit, if one is said.
    Rms(Option<Unit>),
    /// A share of a rated value; one is that many per cent of it.
    Share(f64),
    /// Another than those that are known.
    Other,
}

/// What is said of this column.
pub(super) fn stated(head: &Head) -> Stated<'_> {
    let (name, tailed) = match without_rms(head.name.trim()) {
        Some(name) => (name, true),
        None => (head.name.as_str(), false),
    };
    let mut parts = parts(name);
    if parts.unit.is_none()
        && let Some((stem, unit)) = name.rsplit_once(['_', ' '])
        && unit_of_rms(unit).is_some()
    {
        (parts.stem, parts.unit) = (stem, Some(unit));
    }
    let text = head.unit.as_deref().or(parts.unit);
    let is_rms = || tailed || Words::of(parts.stem).has(RMS);
    let unit = match text.map(|text| (text, known(text))) {
        Some((_, Some(unit))) if is_rms() => StatedUnit::Rms(Some(unit)),
        Some((_, Some(unit))) => StatedUnit::Known(unit),
        Some((text, None)) => match (unit_of_rms(text), share(text)) {
            (Some(unit), _) => StatedUnit::Rms(Some(unit)),
            (_, Some(size)) => StatedUnit::Share(size),
            _ => StatedUnit::Other,
        },
        None => match share(&head.name) {
            Some(size) => StatedUnit::Share(size),
            None if is_rms() => StatedUnit::Rms(None),
            None => StatedUnit::None,
        },
    };
    Stated {
        stem: parts.stem,
        axis: parts.axis,
        unit,
    }
}

/// Whether a column has the RMS values of a sine.
pub(crate) fn is_rms(head: &Head) -> bool {
    matches!(stated(head).unit, StatedUnit::Rms(_))
}

/// A name without the word for RMS at its end, in brackets or not: `iq_rms`, `Strom A (eff)`.
fn without_rms(name: &str) -> Option<&str> {
    let bare = name.trim_end_matches([')', ']']);
    let (stem, last) = bare.rsplit_once(|c: char| !c.is_alphanumeric())?;
    let is_it = RMS.contains(&last.to_lowercase().as_str());
    // `[A_rms]` is one unit, `(rms)` a word.
    let before = &bare[..bare.len() - last.len()];
    let is_whole = bare.len() == name.len() || before.ends_with(['(', '[']);
    (is_it && is_whole).then(|| stem.trim_end_matches(['_', ' ', '-', '(', '[']))
}

/// The unit of `Arms`, `A_eff`, `mA RMS`.
fn unit_of_rms(text: &str) -> Option<Unit> {
    let text = text.trim_end_matches([')', ']']);
    RMS.iter().find_map(|tail| {
        let at = text.len().checked_sub(tail.len())?;
        let is_it = text.get(at..)?.eq_ignore_ascii_case(tail);
        let unit = text[..at].trim_end_matches(['_', ' ', '-', '.', '(', '[']);
        known(unit).filter(|_| is_it)
    })
}

/// How many per cent of a rated value one is, if a text says that it is a share of it: one, or the
/// step before the sign, as in `0.1 %`.
fn share(text: &str) -> Option<f64> {
    let text = text.to_lowercase();
    let words = Words::of(&text);
    let is_there = |sign: &str| match sign.chars().all(char::is_alphabetic) {
        true => words.has(&[sign]),
        false => text.contains(sign),
    };
    let (sign, size) = SHARES.iter().find(|(sign, _)| is_there(sign))?;
    let before = &text[..text.find(sign)?];
    let before = before.trim_end_matches([' ', '_', '[', '(']);
    let digits = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',');
    let number = &before[before.trim_end_matches(digits).len()..];
    // Whole numbers are those of axes.
    let step = number.replace(',', ".").parse().ok();
    Some(
        size * step
            .filter(|step| 0.0 < *step && *step < 1.0)
            .unwrap_or(1.0),
    )
}

/// What a name is made of.
struct Parts<'a> {
    stem: &'a str,
    unit: Option<&'a str>,
    axis: Option<&'a str>,
}

/// The unit that a column's name states plainly: in brackets, behind a stroke, or at its end.
pub(crate) fn stated_unit(name: &str) -> Option<&str> {
    // An input is no inch.
    parts(name).unit.filter(|unit| *unit != "in")
}

/// A name without its unit, and the unit: in brackets, behind a stroke, or as its end.
fn parts(name: &str) -> Parts<'_> {
    let name = name.trim();
    let of = |stem, unit| Parts {
        stem,
        unit,
        axis: None,
    };
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((stem, inside)) = name.strip_suffix(close).and_then(|n| n.rsplit_once(open)) {
            let inside = inside.trim();
            let counts =
                inside.contains([',', ';']) && inside.contains(|c: char| c.is_ascii_digit());
            let axis = counts.then_some(inside);
            let unit = (!counts && !inside.is_empty()).then_some(inside);
            return Parts { stem, unit, axis };
        }
    }
    for mark in [" / ", " in "] {
        if let Some((stem, unit)) = name.rsplit_once(mark) {
            return of(stem, Some(unit.trim()));
        }
    }
    if let Some((stem, unit)) = stem_of(name) {
        return of(stem, Some(unit));
    }
    match name.rsplit_once(['_', ' ']) {
        Some((stem, unit)) if known(unit).is_some() => of(stem, Some(unit)),
        _ => of(name, None),
    }
}
