//! What the columns of any table seem to be, by their names and the units in them.
//!
//! Words of English and German, as drives, laboratories and their users write them. A guess:
//! it is proposed and never applied.

use super::{Found, ProposedColumn};
use crate::table::Head;
use crate::unit::stem_of;
use crate::unit_table::known;

/// A quantity: words that name it, the unit that it is taken in where none is said, and by
/// dimension of the unit the channel, of what is, what should be, and of the motor.
struct Quantity {
    words: &'static [&'static str],
    usual: &'static str,
    channels: &'static [(&'static str, [&'static str; 3])],
}

/// The first of which a word is in the name counts.
const QUANTITIES: &[Quantity] = &[
    Quantity {
        words: &["time", "timestamp", "t", "zeit"],
        usual: "s",
        channels: &[("time", ["t_s", "", ""])],
    },
    Quantity {
        words: &["torque", "trq", "tau", "moment", "drehmoment"],
        usual: "N·m",
        channels: &[("torque", ["torque_n_m", "torque_ref_n_m", "torque_n_m"])],
    },
    Quantity {
        words: &["force", "kraft"],
        usual: "N",
        channels: &[("force", ["force_n", "force_ref_n", "force_n"])],
    },
    Quantity {
        words: &["current", "iq", "strom", "amps"],
        usual: "A",
        channels: &[("current", ["iq_a", "iq_ref_a", "iq_a"])],
    },
    Quantity {
        words: &[
            "velocity",
            "vel",
            "velo",
            "speed",
            "v",
            "qd",
            "dq",
            "omega",
            "geschwindigkeit",
            "drehzahl",
        ],
        usual: "mm/s",
        channels: &[
            (
                "speed",
                ["velocity_m_s", "velocity_ref_m_s", "velocity_m_s"],
            ),
            (
                "angular speed",
                ["velocity_rad_s", "velocity_ref_rad_s", "motor_speed_rad_s"],
            ),
        ],
    },
    Quantity {
        words: &[
            "position", "pos", "x", "q", "angle", "theta", "phi", "lage", "weg", "winkel",
        ],
        usual: "mm",
        channels: &[
            ("length", ["position_m", "position_ref_m", "position_m"]),
            (
                "angle",
                ["position_rad", "position_ref_rad", "motor_angle_rad"],
            ),
        ],
    },
];

/// What should be, not what is. Longer words also count as parts of one.
const DEMANDED: &[&str] = &[
    "ref",
    "reference",
    "cmd",
    "command",
    "commanded",
    "set",
    "setpoint",
    "sp",
    "des",
    "desired",
    "dem",
    "demand",
    "target",
    "goal",
    "soll",
    "sollwert",
];
const OF_MOTOR: &[&str] = &["motor", "mot"];
/// Words of columns that are none of the quantities, whatever else is in the name.
const OTHER: &[&str] = &[
    "error",
    "err",
    "deviation",
    "dev",
    "diff",
    "lag",
    "following",
    "schleppfehler",
    "limit",
    "max",
    "min",
    "id",
    "feedforward",
    "ff",
    "override",
    "temp",
    "temperature",
];

/// What each column seems to be.
pub(super) fn proposed(heads: &[&Head]) -> Vec<Found> {
    heads.iter().filter_map(|head| one(head)).collect()
}

/// The channels that show the same as this one, where its unit is of another dimension; its own
/// where it is of that.
pub(super) fn channel_of(channel: &str, dimension: &str) -> Option<&'static str> {
    QUANTITIES.iter().find_map(|quantity| {
        let mut own = quantity.channels.iter();
        let role = own.find_map(|(_, names)| names.iter().position(|name| *name == channel))?;
        let mut of = quantity.channels.iter();
        let (_, names) = of.find(|(of, _)| *of == dimension)?;
        Some(names[role])
    })
}

/// Whether a name is that of a channel already.
pub(super) fn is_channel(name: &str) -> bool {
    let all = QUANTITIES.iter().flat_map(|quantity| quantity.channels);
    all.flat_map(|(_, names)| names).any(|own| *own == name)
}

fn one(head: &Head) -> Option<Found> {
    if is_channel(&head.name) {
        return None;
    }
    let parts = parts(&head.name);
    let said = head.unit.as_deref().or(parts.unit);
    let words = words(parts.stem);
    let has = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
    // German joins words: Sollposition, Istdrehmoment.
    let names = |list: &[&str]| {
        let ends = |word: &String| list.iter().any(|l| l.len() > 3 && word.ends_with(l));
        has(list) || words.iter().any(ends)
    };
    // A unit that is said and not known is not one of these.
    let said = match said {
        Some(unit) => Some(known(unit)?),
        None => None,
    };
    if has(OTHER) {
        return None;
    }
    let mut candidates = QUANTITIES.iter().filter(|quantity| names(quantity.words));
    let (quantity, channels, unit) = candidates.find_map(|quantity| {
        let (unit, dimension) = said.or_else(|| known(quantity.usual))?;
        let mut channels = quantity.channels.iter();
        let (_, channels) = channels.find(|(of, _)| *of == dimension)?;
        Some((quantity, channels, unit))
    })?;
    let demanded = |word: &String| {
        DEMANDED
            .iter()
            .any(|known| word == known || known.len() > 3 && word.contains(known))
    };
    let channel = match (words.iter().any(demanded), has(OF_MOTOR)) {
        (true, _) => channels[1],
        (false, true) => channels[2],
        (false, false) => channels[0],
    };
    let is_time = quantity.usual == "s";
    (!channel.is_empty()).then(|| Found {
        axis: match (is_time, parts.axis) {
            (true, _) => String::new(),
            (false, Some(axis)) => axis.to_owned(),
            (false, None) => axis_of(&words, quantity.words),
        },
        column: ProposedColumn {
            source: head.name.clone(),
            channel,
            unit,
        },
        is_said: said.is_some(),
    })
}

/// Letters of axes (ISO 841).
const AXES: [&str; 9] = ["x", "y", "z", "a", "b", "c", "u", "v", "w"];

/// What of a name tells the axis: its numbers, and a letter of an axis beside a longer word for
/// the quantity.
fn axis_of(words: &[String], of_quantity: &[&str]) -> String {
    let named = |word: &&String| word.len() > 1 && of_quantity.contains(&word.as_str());
    let long = words.iter().any(|word| named(&word));
    let tells = |word: &&String| {
        let is_letter = long && AXES.contains(&word.as_str());
        is_letter || word.bytes().all(|b| b.is_ascii_digit())
    };
    let told: Vec<&str> = words.iter().filter(tells).map(String::as_str).collect();
    told.concat().to_uppercase()
}

/// What a name is made of.
struct Parts<'a> {
    stem: &'a str,
    unit: Option<&'a str>,
    /// What stands in brackets and is no unit, as `[u1, 2]` behind the signals of a control.
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

/// `Axis 1.ActPos` is `axis`, `1`, `act`, `pos`.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for c in name.chars() {
        let begins = c.is_uppercase() && before.is_lowercase()
            || c.is_ascii_digit() != before.is_ascii_digit();
        if begins || !c.is_alphanumeric() {
            words.push(String::new());
        }
        if c.is_alphanumeric() {
            words
                .last_mut()
                .unwrap_or(&mut String::new())
                .extend(c.to_lowercase());
        }
        before = c;
    }
    words.retain(|word| !word.is_empty());
    words
}
