//! What the columns of any table seem to be, by their names and the units in them.
//!
//! A guess: it is proposed and never applied.

use std::f64::consts::SQRT_2;

use super::stated::{Stated, StatedUnit, Unit, stated};
use super::vocabulary::{
    DEMANDED, NOT_OF_ROTOR, OF_FIELD, OF_MOTOR, OTHER, QUANTITIES, Quantity, Words,
};
use super::{Found, ProposedColumn};
use crate::table::Head;
use crate::unit::unit_of;
use crate::unit_table::{PERCENT, known};

/// What each column seems to be.
pub(super) fn proposed(heads: &[&Head]) -> Vec<Found> {
    let mut found: Vec<Found> = heads.iter().filter_map(|head| one(head)).collect();
    // The first column of a channel counts: one that need not be converted from RMS.
    found.sort_by_key(|found| found.column.factor.is_some());
    found
}

/// What one column seems to be, if that is a position or a speed: of a program whose efforts are
/// often in a unit of its own.
pub(super) fn motion(head: &Head) -> Option<Found> {
    let is_motion = |dimension| matches!(dimension, "length" | "angle" | "speed" | "angular speed");
    one(head).filter(|found| known(found.column.unit).is_some_and(|(_, of)| is_motion(of)))
}

/// What is to be said of columns whose numbers are not in a unit of their quantity.
pub(super) fn remarks(heads: &[&Head]) -> Vec<String> {
    heads.iter().filter_map(|head| remark(head)).collect()
}

/// The channels that show the same as this one, where its unit is of another dimension; its own
/// where it is of that.
pub(super) fn channel_of(channel: &str, dimension: &str) -> Option<&'static str> {
    QUANTITIES.iter().find_map(|quantity| {
        let mut own = quantity.channels.iter();
        let role = own.find_map(|(_, names)| names.iter().position(|name| *name == channel))?;
        let mut of = quantity.channels.iter();
        let (_, names) = of.find(|(of, _)| *of == dimension)?;
        Some(names[role]).filter(|name| !name.is_empty())
    })
}

/// The d current's channel, which has its own words ([`OF_FIELD`]) beside those of currents.
const FIELD_CURRENT: &str = "id_a";

/// Whether a name is that of a channel already.
fn is_channel(name: &str) -> bool {
    let all = QUANTITIES.iter().flat_map(|quantity| quantity.channels);
    let mut names = all.flat_map(|(_, names)| names);
    name == FIELD_CURRENT || names.any(|own| *own == name)
}

/// A name that is not yet that of a channel, what it says, and its words.
fn read(head: &Head) -> Option<(Stated<'_>, Words)> {
    let stated = stated(head);
    let words = Words::of(stated.stem);
    (!is_channel(&head.name)).then_some((stated, words))
}

fn one(head: &Head) -> Option<Found> {
    let (stated, words) = read(head)?;
    let (said, is_rms) = match stated.unit {
        // A unit that is said and not known is not one of these, nor is a share.
        StatedUnit::Other | StatedUnit::Share(_) => return None,
        StatedUnit::None => (None, false),
        StatedUnit::Known(unit) => (Some(unit), false),
        StatedUnit::Rms(unit) => (unit, true),
    };
    let meant = meant(&words, said)?;
    let is_current = meant.unit.1 == "current";
    if is_rms && !is_current {
        return None;
    }
    let is_time = meant.quantity.usual == "s";
    Some(Found {
        axis: match (is_time, stated.axis) {
            (true, _) => String::new(),
            (false, Some(axis)) => axis.to_owned(),
            (false, None) => axis_of(&words, meant.quantity.words),
        },
        column: ProposedColumn {
            source: head.name.clone(),
            channel: meant.channel,
            unit: meant.unit.0,
            // A channel of current is the amplitude of the phases' sine, √2 times its RMS value.
            factor: is_rms.then_some(SQRT_2),
        },
        is_said: said.is_some(),
    })
}

fn remark(head: &Head) -> Option<String> {
    let (stated, words) = read(head)?;
    let name = &head.name;
    match stated.unit {
        StatedUnit::Share(size) => {
            let Meant { channel, .. } = meant(&words, None)?;
            let symbol = unit_of(channel).filter(|_| channel != "t_s")?;
            let (step, of) = match size {
                1.0 => ("per cent".to_owned(), String::new()),
                size => (format!("steps of {size} %"), format!("{size} times ")),
            };
            let peak = match symbol {
                "A" => " (peak: √2 times an RMS value)",
                _ => "",
            };
            Some(format!(
                "{name}: in {step} of a rated value, not in {symbol}, so nothing is proposed; to map it to \"{channel}\", give unit = \"{PERCENT}\" and as factor {of}the value in {symbol} at 100 %{peak}"
            ))
        }
        StatedUnit::Rms(said) => {
            let meant = meant(&words, said)?;
            Some(match meant.unit.1 {
                "current" => format!(
                    "{name}: an RMS value, and \"{}\" is the peak, so its factor is √2; compare the signs: an RMS value may have none",
                    meant.channel
                ),
                _ => format!(
                    "{name}: an RMS value over some time, which \"{}\" is not, so nothing is proposed",
                    meant.channel
                ),
            })
        }
        _ => None,
    }
}

/// What words mean in a unit.
struct Meant {
    quantity: &'static Quantity,
    channel: &'static str,
    unit: Unit,
}

/// What these words mean, in the unit that is said or the usual one.
fn meant(words: &Words, said: Option<Unit>) -> Option<Meant> {
    let is_of_field = is_of_field(words, said);
    let is_other = |word: &str| OTHER.contains(&word) && !(word == "id" && is_of_field);
    if words.iter().any(is_other) {
        return None;
    }
    let is_demanded = words.has(DEMANDED);
    if is_of_field {
        let quantity = QUANTITIES.iter().find(|q| q.usual == "A")?;
        let unit = said.or_else(|| known(quantity.usual))?;
        let is_it = unit.1 == "current" && !is_demanded && !words.has(NOT_OF_ROTOR);
        return is_it.then_some(Meant {
            quantity,
            channel: FIELD_CURRENT,
            unit,
        });
    }
    let (quantity, channels, unit) = words.quantities().find_map(|quantity| {
        let (unit, dimension) = said.or_else(|| known(quantity.usual))?;
        let mut channels = quantity.channels.iter();
        let (_, channels) = channels.find(|(of, _)| *of == dimension)?;
        Some((quantity, channels, (unit, dimension)))
    })?;
    if unit.1 == "current" && words.has(NOT_OF_ROTOR) {
        return None;
    }
    let role = usize::from(is_demanded) + 2 * usize::from(words.has(OF_MOTOR));
    let channel = channels[role];
    (!channel.is_empty()).then_some(Meant {
        quantity,
        channel,
        unit,
    })
}

/// Whether words are those of the d current. `id` alone may number things: another word, or the
/// unit, must say that it is a current, or which of its values it is.
fn is_of_field(words: &Words, said: Option<Unit>) -> bool {
    let is_current = |quantity: &Quantity| quantity.usual == "A";
    let in_amperes = said.is_some_and(|(_, of)| of == "current");
    let says = in_amperes
        || words.quantities().any(is_current)
        || words.has(&["id"]) && (words.has(DEMANDED) || words.has(&["ist", "act", "actual"]));
    says && words.has(OF_FIELD)
}

/// Letters of axes (ISO 841).
const AXES: [&str; 9] = ["x", "y", "z", "a", "b", "c", "u", "v", "w"];

/// What of a name tells the axis: its numbers, and a letter of an axis beside a longer word for
/// the quantity.
fn axis_of(words: &Words, of_quantity: &[&str]) -> String {
    let long = words
        .iter()
        .any(|word| word.len() > 1 && of_quantity.contains(&word));
    let tells = |word: &&str| {
        let is_letter = long && AXES.contains(word);
        is_letter || word.bytes().all(|b| b.is_ascii_digit())
    };
    let told: Vec<&str> = words.iter().filter(tells).collect();
    told.concat().to_uppercase()
}
