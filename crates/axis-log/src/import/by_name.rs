//! What the columns of any table seem to be, by their names and the units in them.
//!
//! Words of English and German, as drives, laboratories and their users write them. A guess:
//! it is proposed and never applied.

use super::ProposedColumn;
use crate::source_unit::known;
use crate::table::Head;
use crate::unit::stem_of;

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

/// The first column of each channel.
pub(super) fn proposed(heads: &[&Head]) -> Vec<ProposedColumn> {
    let mut found: Vec<ProposedColumn> = Vec::new();
    for head in heads {
        if let Some(column) = one(head)
            && found.iter().all(|other| other.channel != column.channel)
        {
            found.push(column);
        }
    }
    found
}

/// Whether a name is that of a channel already.
pub(super) fn is_channel(name: &str) -> bool {
    let all = QUANTITIES.iter().flat_map(|quantity| quantity.channels);
    all.flat_map(|(_, names)| names).any(|own| *own == name)
}

fn one(head: &Head) -> Option<ProposedColumn> {
    if is_channel(&head.name) {
        return None;
    }
    let (stem, said) = parts(&head.name);
    let said = head.unit.as_deref().or(said);
    let words = words(stem);
    let has = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
    // A unit that is said and not known is not one of these.
    let said = match said {
        Some(unit) => Some(known(unit)?),
        None => None,
    };
    if has(OTHER) {
        return None;
    }
    let mut candidates = QUANTITIES.iter().filter(|quantity| has(quantity.words));
    let (channels, unit) = candidates.find_map(|quantity| {
        let (unit, dimension) = said.or_else(|| known(quantity.usual))?;
        let mut channels = quantity.channels.iter();
        let (_, channels) = channels.find(|(of, _)| *of == dimension)?;
        Some((channels, unit))
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
    (!channel.is_empty()).then(|| ProposedColumn {
        source: head.name.clone(),
        channel,
        unit,
    })
}

/// A name without its unit, and the unit: in brackets, behind a stroke, or as its end.
fn parts(name: &str) -> (&str, Option<&str>) {
    let name = name.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((stem, unit)) = name.strip_suffix(close).and_then(|n| n.rsplit_once(open)) {
            return (stem, Some(unit.trim()).filter(|unit| !unit.is_empty()));
        }
    }
    for mark in [" / ", " in "] {
        if let Some((stem, unit)) = name.rsplit_once(mark) {
            return (stem, Some(unit.trim()));
        }
    }
    if let Some((stem, unit)) = stem_of(name) {
        return (stem, Some(unit));
    }
    match name.rsplit_once(['_', ' ']) {
        Some((stem, unit)) if known(unit).is_some() => (stem, Some(unit)),
        _ => (name, None),
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
