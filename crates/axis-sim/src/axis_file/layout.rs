//! Which table of a file holds the keys of which part.
//!
//! A file has a section for each part, which names the part's kind. Files of the first
//! schema have none: their `kind` stands for the kinds of all parts, and the keys stand in
//! tables of their own.

use super::error::AxisFileError;
use super::fields::Fields;
use super::first_keys::{SHORT_KINDS, loop_keys};
use super::registry::Registry;
use crate::actuator::Actuator;
use crate::control::{Control, absent};
use crate::friction::Friction;
use crate::load::Load;
use crate::mechanism::{Freedom, Mechanism};
use crate::part::{Key, PartKind, count, named, text};

/// The four parts that every axis has once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    Mechanism,
    Actuator,
    Control,
    Friction,
}

/// Some keys of a part, or all, and the table that they stand in.
type Place = (&'static str, Section, &'static [&'static str]);

/// All keys of a part.
const ALL: &[&str] = &[];

/// A file with a section for each part.
const SECTIONS: &[Place] = &[
    ("mechanism", Section::Mechanism, ALL),
    ("actuator", Section::Actuator, ALL),
    ("control", Section::Control, ALL),
    ("friction", Section::Friction, ALL),
];

/// `kind = "ball-screw"`, or none, in the first schema.
const BALL_SCREW: &[Place] = &[
    (
        "screw",
        Section::Mechanism,
        &[
            "length",
            "diameter",
            "lead",
            "elements",
            "youngs_modulus",
            "poisson_ratio",
            "density",
        ],
    ),
    (
        "drive",
        Section::Mechanism,
        &[
            "motor_inertia",
            "torque_sensor_inertia",
            "motor_coupling",
            "screw_coupling",
            "nut_stiffness",
            "table_mass",
            "stiffness_damping",
            "bearing_stiffness",
            "mounting",
            "backlash",
        ],
    ),
    ("friction", Section::Friction, ALL),
    (
        "motor",
        Section::Actuator,
        &[
            "pole_pairs",
            "torque_constant",
            "resistance",
            "inductance_d",
            "inductance_q",
        ],
    ),
    (
        "inverter",
        Section::Actuator,
        &["dc_link", "dead_time_voltage"],
    ),
    (
        "control",
        Section::Actuator,
        &[
            "current_d_proportional",
            "current_d_integral",
            "current_q_proportional",
            "current_q_integral",
            "current_limit",
            "command_delay",
            "current_delay_periods",
        ],
    ),
    ("control", Section::Control, ALL),
];

/// `kind = "rigid-mass"` in the first schema.
const RIGID_MASS: &[Place] = &[
    ("body", Section::Mechanism, ALL),
    ("body", Section::Actuator, &["force_gain"]),
    ("body", Section::Friction, ALL),
    ("control", Section::Control, ALL),
    ("control", Section::Actuator, &["command_limit"]),
];

/// The kinds of a file's parts, and where their keys stand.
pub(super) struct Layout {
    pub mechanism: &'static PartKind<dyn Mechanism>,
    pub actuator: &'static PartKind<dyn Actuator>,
    pub control: &'static PartKind<dyn Control>,
    pub friction: &'static PartKind<Friction>,
    /// Of each `[[load]]`.
    pub loads: Vec<&'static PartKind<dyn Load>>,
    /// Whether each part has a section.
    sections: bool,
    places: &'static [Place],
}

impl Layout {
    /// A file with a section for each part.
    pub fn sections(
        mechanism: &'static PartKind<dyn Mechanism>,
        actuator: &'static PartKind<dyn Actuator>,
        control: &'static PartKind<dyn Control>,
        friction: &'static PartKind<Friction>,
    ) -> Self {
        Self {
            mechanism,
            actuator,
            control,
            friction,
            loads: Vec::new(),
            sections: true,
            places: SECTIONS,
        }
    }

    /// A file of the first schema, by its kind; none if the registry lacks one of its parts.
    pub fn short(
        kind: &str,
        registry: &Registry,
        loads: Vec<&'static PartKind<dyn Load>>,
    ) -> Option<Self> {
        let (kinds, places) = match kind == SHORT_KINDS[1] {
            true => (["rigid-mass", "force-gain", "p-p", "coulomb"], RIGID_MASS),
            false => (
                ["ball-screw", "pmsm-foc", "p-pi", "lugre-at-motor"],
                BALL_SCREW,
            ),
        };
        let [mechanism, actuator, control, friction] = kinds;
        Some(Self {
            mechanism: named(&registry.mechanisms, mechanism)?,
            actuator: named(&registry.actuators, actuator)?,
            control: named(&registry.controls, control)?,
            friction: named(&registry.frictions, friction)?,
            loads,
            sections: false,
            places,
        })
    }

    /// Whether each part has a section, which names its kind.
    pub fn has_sections(&self) -> bool {
        self.sections
    }

    /// What a file has, by its sections or its kind.
    pub fn of(root: &Fields<'_>, registry: &Registry) -> Result<Self, AxisFileError> {
        let loads = root.unchecked("load", vec![kinds_key(&registry.loads)])?;
        let loads = loads.iter().map(|load| kind_of(load, &registry.loads));
        let loads: Vec<_> = loads.collect::<Result<_, _>>()?;
        let has = |places: &[Place]| {
            let mut own = places.iter().map(|(table, ..)| *table);
            own.any(|table| table != "control" && table != "friction" && root.has(table))
        };
        // A file that has neither is asked for sections, which any axis can have.
        let short = root.has("kind") || has(BALL_SCREW) || has(RIGID_MASS);
        if !has(SECTIONS) && short {
            let rigid = root.has("kind") && root.word("kind")? == SHORT_KINDS[1];
            let found = Self::short(SHORT_KINDS[usize::from(rigid)], registry, loads);
            return found.ok_or_else(|| {
                let what = "has kinds that are not registered".to_owned();
                root.refuse_table(what, "a file with a section for each part")
            });
        }
        // A mistyped section is named before it is missed.
        root.check(&section_keys())?;
        Ok(Self {
            mechanism: kind_in(root, "mechanism", &registry.mechanisms)?,
            actuator: kind_in(root, "actuator", &registry.actuators)?,
            control: match root.has("control") {
                true => kind_in(root, "control", &registry.controls)?,
                false => &absent::KIND,
            },
            friction: kind_in(root, "friction", &registry.frictions)?,
            loads,
            sections: true,
            places: SECTIONS,
        })
    }

    fn part_keys(&self, section: Section) -> &'static [Key] {
        match section {
            Section::Mechanism => self.mechanism.keys,
            Section::Actuator => self.actuator.keys,
            Section::Control => self.control.keys,
            Section::Friction => self.friction.keys,
        }
    }

    /// Keys of a part that stand in a table: its name, and the keys.
    fn keys_of(&self, place: &Place) -> impl Iterator<Item = Key> {
        let (_, section, names) = *place;
        let wanted = move |key: &&Key| names.is_empty() || names.contains(&key.name);
        self.part_keys(section).iter().filter(wanted).cloned()
    }

    /// The tables of the parts: name, and keys beside `own` ones of that table.
    pub fn tables(&self, own: &[(&'static str, Vec<Key>)]) -> Vec<Key> {
        let mut names: Vec<&'static str> = Vec::new();
        for (table, ..) in self.places {
            if !names.contains(table) {
                names.push(table);
            }
        }
        let table = |name: &'static str| {
            let places = self.places.iter().filter(|(table, ..)| *table == name);
            let parts = places.flat_map(|place| self.keys_of(place));
            let own = own.iter().filter(|(table, _)| *table == name);
            let own = own.flat_map(|(_, keys)| keys.iter().cloned());
            let mut keys: Vec<Key> = own.chain(parts).collect();
            if self.has_sections() {
                keys.insert(0, kind());
            }
            // Without control a log is answered by a balance of torques; a table of the first
            // schema may be left out with its keys.
            let may_miss = match self.has_sections() {
                true => name == "control",
                false => keys.iter().all(Key::is_optional),
            };
            match may_miss {
                true => Key::of_table(name, keys).optional(),
                false => Key::of_table(name, keys),
            }
        };
        names.into_iter().map(table).collect()
    }

    /// The tables and keys of one part.
    pub fn places(&self, section: Section) -> Vec<(&'static str, Vec<Key>)> {
        let own = self.places.iter().filter(|(_, of, _)| *of == section);
        own.map(|place| (place.0, self.keys_of(place).collect()))
            .collect()
    }
}

/// Tables of an axis file that hold no part of the machine, or none whose numbers a run may
/// change.
pub const TABLES_WITHOUT_PARTS: &[&str] = &[
    "stroke",
    "samples",
    "simulation",
    "sensors",
    "experiment",
    "tolerances",
    "log",
    "balance",
    "thermal",
    "rating",
];

/// What a file with a section for each part may have.
fn section_keys() -> Vec<Key> {
    let parts = SECTIONS.iter().map(|(table, ..)| *table);
    let lists = ["trajectory", "load", "effects"].map(|name| Key::of_tables(name, Vec::new()));
    let all = parts
        .chain(TABLES_WITHOUT_PARTS.iter().copied())
        .map(|name| Key::of_table(name, Vec::new()));
    all.chain(lists)
        .chain(["name", "description"].map(text))
        .chain([count("schema", 1, 2)])
        .collect()
}

/// `kind`, which has been read when the rest of its table is.
fn kind() -> Key {
    text("kind")
}

/// The kind that the section `table` names.
pub(super) fn kind_in<P: ?Sized>(
    root: &Fields<'_>,
    table: &'static str,
    kinds: &[&'static PartKind<P>],
) -> Result<&'static PartKind<P>, AxisFileError> {
    let section = root.peek(table, vec![kinds_key(kinds)])?;
    let own = match table {
        "control" => [Freedom::Linear, Freedom::Rotary].map(loop_keys).concat(),
        _ => Vec::new(),
    };
    named_kind(&section, kinds, own)
}

/// The kind that a table names.
pub(super) fn kind_of<P: ?Sized>(
    section: &Fields<'_>,
    kinds: &[&'static PartKind<P>],
) -> Result<&'static PartKind<P>, AxisFileError> {
    named_kind(section, kinds, Vec::new())
}

/// As [`kind_of`], of a table that has `own` keys besides its kind's.
fn named_kind<P: ?Sized>(
    section: &Fields<'_>,
    kinds: &[&'static PartKind<P>],
    own: Vec<Key>,
) -> Result<&'static PartKind<P>, AxisFileError> {
    if !section.has("kind") {
        // It may stand there misspelt, beside the keys of any kind.
        let all = kinds.iter().flat_map(|kind| kind.keys.iter().cloned());
        let all = all.chain([kinds_key(kinds)]).chain(own);
        section.check(&all.collect::<Vec<Key>>())?;
    }
    let name = section.word("kind")?;
    named(kinds, name).ok_or_else(|| {
        let valid = kinds.iter().map(|kind| kind.name).collect::<Vec<_>>();
        section.refuse_value("kind", format!("is \"{name}\""), valid.join(", "))
    })
}

/// `kind`, one of the names of `kinds`.
pub(super) fn kinds_key<P: ?Sized>(kinds: &[&'static PartKind<P>]) -> Key {
    Key::of_words("kind", kinds.iter().map(|kind| kind.name).collect())
}
