//! The kinds of a file's parts, each named in a section of its own.

use super::error::AxisFileError;
use super::fields::{Fields, SCHEMA};
use super::loop_keys::loop_keys;
use super::registry::Registry;
use crate::actuator::Actuator;
use crate::control::{Control, absent};
use crate::friction::Friction;
use crate::load::Load;
use crate::mechanism::{Freedom, Mechanism};
use crate::part::{Key, PartKind, named, text};

/// The four parts that every axis has once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    Mechanism,
    Actuator,
    Control,
    Friction,
}

impl Section {
    pub const ALL: [Self; 4] = [
        Self::Mechanism,
        Self::Actuator,
        Self::Control,
        Self::Friction,
    ];

    /// The table of the part.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mechanism => "mechanism",
            Self::Actuator => "actuator",
            Self::Control => "control",
            Self::Friction => "friction",
        }
    }
}

/// The kinds of a file's parts.
pub(super) struct Layout {
    pub mechanism: &'static PartKind<dyn Mechanism>,
    pub actuator: &'static PartKind<dyn Actuator>,
    pub control: &'static PartKind<dyn Control>,
    pub friction: &'static PartKind<Friction>,
    /// Of each `[[load]]`.
    pub loads: Vec<&'static PartKind<dyn Load>>,
}

impl Layout {
    /// What a file has, by its sections.
    pub fn of(root: &Fields<'_>, registry: &Registry) -> Result<Self, AxisFileError> {
        if root.has("schema") {
            root.count("schema")?;
        }
        // A mistyped section is named before it is missed.
        root.check(&section_keys())?;
        let loads = root.unchecked("load", vec![kinds_key(&registry.loads)])?;
        let loads = loads.iter().map(|load| kind_of(load, &registry.loads));
        Ok(Self {
            mechanism: kind_in(root, Section::Mechanism, &registry.mechanisms)?,
            actuator: kind_in(root, Section::Actuator, &registry.actuators)?,
            control: match root.has("control") {
                true => kind_in(root, Section::Control, &registry.controls)?,
                false => &absent::KIND,
            },
            friction: kind_in(root, Section::Friction, &registry.frictions)?,
            loads: loads.collect::<Result<_, _>>()?,
        })
    }

    /// The keys of a part.
    pub fn keys(&self, section: Section) -> &'static [Key] {
        match section {
            Section::Mechanism => self.mechanism.keys,
            Section::Actuator => self.actuator.keys,
            Section::Control => self.control.keys,
            Section::Friction => self.friction.keys,
        }
    }

    /// The sections, `[control]` with `own` keys besides.
    pub fn tables(&self, own: &[Key]) -> impl Iterator<Item = Key> {
        Section::ALL.into_iter().map(|section| {
            let mut keys = vec![kind()];
            if section == Section::Control {
                keys.extend_from_slice(own);
            }
            keys.extend_from_slice(self.keys(section));
            let table = Key::of_table(section.name(), keys);
            // Without control a log is answered by a balance of torques.
            match section {
                Section::Control => table.optional(),
                _ => table,
            }
        })
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

/// The tables and keys of the file itself.
fn section_keys() -> Vec<Key> {
    let parts = Section::ALL.into_iter().map(Section::name);
    let lists = ["trajectory", "load", "effects"].map(|name| Key::of_tables(name, Vec::new()));
    let all = parts
        .chain(TABLES_WITHOUT_PARTS.iter().copied())
        .map(|name| Key::of_table(name, Vec::new()));
    all.chain(lists)
        .chain(["name", "description"].map(text))
        .chain([SCHEMA])
        .collect()
}

/// `kind`, which has been read when the rest of its table is.
fn kind() -> Key {
    text("kind")
}

/// The kind that a section names.
fn kind_in<P: ?Sized>(
    root: &Fields<'_>,
    section: Section,
    kinds: &[&'static PartKind<P>],
) -> Result<&'static PartKind<P>, AxisFileError> {
    let table = root.peek(section.name(), vec![kinds_key(kinds)])?;
    let own = match section {
        Section::Control => [Freedom::Linear, Freedom::Rotary].map(loop_keys).concat(),
        _ => Vec::new(),
    };
    named_kind(&table, kinds, own)
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
