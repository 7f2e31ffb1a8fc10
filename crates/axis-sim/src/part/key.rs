//! One key of the axis file: its spellings, its limits, and what is valid in words.

use std::borrow::Cow;

use super::units::Dimension;
use super::{Role, Values};
use crate::SixDigits;
use crate::value_range::ValueRange;

/// One key of a table of the axis file: made by [`quantity`], [`number`],
/// [`count`] or [`word`].
#[derive(Clone, Debug)]
pub struct Key {
    /// As in the file; a quantity's is without its unit.
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) optional: bool,
    /// What a number is where it is left out.
    pub(crate) default: Option<f64>,
    /// Whether that counts in the fingerprint where the key is left out.
    pub(crate) counted: bool,
    pub(crate) role: Option<Role>,
}

/// What stands under a key.
#[derive(Clone, Debug)]
pub(crate) enum Kind {
    /// A number with a unit, which ends the key; the limits are SI.
    Quantity(&'static Dimension, ValueRange),
    /// A number whose unit, if it has one, is always the same.
    Number(&'static str, ValueRange),
    /// A whole number.
    Count(u32, u32),
    /// A text, and what is valid.
    Text(&'static str),
    /// One of a few words.
    Word(Cow<'static, [&'static str]>),
    /// A table.
    Table(Cow<'static, [Key]>),
    /// Tables of the same kind.
    Tables(Cow<'static, [Key]>),
}

const fn key(name: &'static str, kind: Kind) -> Key {
    Key {
        name,
        kind,
        optional: false,
        default: None,
        counted: false,
        role: None,
    }
}

/// A number whose unit ends the key (`lead_mm`), from `least` to `most` in SI units.
pub const fn quantity(
    name: &'static str,
    dimension: &'static Dimension,
    least: f64,
    most: f64,
) -> Key {
    key(name, Kind::Quantity(dimension, ValueRange { least, most }))
}

/// A number without a unit, from `least` to `most`.
pub const fn number(name: &'static str, least: f64, most: f64) -> Key {
    key(name, Kind::Number("", ValueRange { least, most }))
}

/// A whole number from `least` to `most`.
pub const fn count(name: &'static str, least: u32, most: u32) -> Key {
    key(name, Kind::Count(least, most))
}

pub(crate) const fn text(name: &'static str) -> Key {
    text_of(name, "a text in quotes")
}

/// One of a few words.
pub const fn word(name: &'static str, words: &'static [&'static str]) -> Key {
    key(name, Kind::Word(Cow::Borrowed(words)))
}

/// A text of which not all are valid.
pub(crate) const fn text_of(name: &'static str, valid: &'static str) -> Key {
    key(name, Kind::Text(valid))
}

pub(crate) const fn table(name: &'static str, keys: &'static [Key]) -> Key {
    key(name, Kind::Table(Cow::Borrowed(keys)))
}

pub(crate) const fn tables(name: &'static str, keys: &'static [Key]) -> Key {
    key(name, Kind::Tables(Cow::Borrowed(keys)))
}

impl ValueRange {
    /// Whether `value` lies inside, but for the rounding of its conversion to SI.
    pub(crate) fn takes(&self, value: f64) -> bool {
        let slack = |end: f64| 1e-12 * end.abs();
        (self.least - slack(self.least)..=self.most + slack(self.most)).contains(&value)
    }

    /// In words, in a unit of `factor` SI units.
    fn text(&self, factor: f64) -> String {
        let (least, most) = (
            SixDigits(self.least / factor),
            SixDigits(self.most / factor),
        );
        format!("from {least} to {most}")
    }
}

impl Key {
    /// May be left out.
    #[must_use]
    pub const fn optional(mut self) -> Self {
        self.optional = true;
        self
    }

    /// May be left out, and is then this number.
    #[must_use]
    pub const fn or(mut self, default: f64) -> Self {
        self.optional = true;
        self.default = Some(default);
        self
    }

    /// Counts in the fingerprint where it is left out, too: of a key that did not exist when
    /// results were made with files without it, and that stands for something else than they
    /// did.
    #[must_use]
    pub const fn counted(mut self) -> Self {
        self.counted = true;
        self
    }

    /// What the parameter is in any machine, by which effects find it.
    #[must_use]
    pub const fn role(mut self, role: Role) -> Self {
        self.role = Some(role);
        self
    }

    /// Whether the parameter has that role.
    pub fn has_role(&self, role: Role) -> bool {
        self.role == Some(role)
    }

    /// Its name, without a unit.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The units that it may be given in, with their factors to SI; none of what has none.
    pub fn units(&self) -> &'static [(&'static str, f64)] {
        match &self.kind {
            Kind::Quantity(dimension, _) => dimension.units,
            _ => &[],
        }
    }

    /// The least and the greatest number that it takes, in SI units; none of what is not a number, or
    /// is a whole one.
    pub fn limits(&self) -> Option<[f64; 2]> {
        match &self.kind {
            Kind::Quantity(_, limits) | Kind::Number(_, limits) => {
                Some([limits.least, limits.most])
            }
            _ => None,
        }
    }

    /// Whether a number stands under it that need not be whole.
    pub fn is_number(&self) -> bool {
        matches!(self.kind, Kind::Quantity(..) | Kind::Number(..))
    }

    /// Gives it the least value that it takes, or its first word.
    pub(crate) fn set_least(&self, values: &mut Values) {
        match &self.kind {
            Kind::Quantity(dimension, limits) => {
                let unit = dimension.units.first().map_or("", |(unit, _)| unit);
                values.set_in(self.name, limits.least, unit);
            }
            Kind::Number(unit, limits) => values.set_in(self.name, limits.least, unit),
            Kind::Count(least, _) => values.set_count(self.name, *least),
            Kind::Word(words) => {
                if let Some(word) = words.first() {
                    values.set_word(self.name, word);
                }
            }
            Kind::Text(_) | Kind::Table(_) | Kind::Tables(_) => {}
        }
    }

    /// A table of these keys.
    pub(crate) const fn of_table(name: &'static str, keys: Vec<Key>) -> Self {
        key(name, Kind::Table(Cow::Owned(keys)))
    }

    /// Tables of these keys.
    pub(crate) const fn of_tables(name: &'static str, keys: Vec<Key>) -> Self {
        key(name, Kind::Tables(Cow::Owned(keys)))
    }

    /// A number of an effect, in SI units.
    pub(crate) const fn of_effect(
        name: &'static str,
        unit: &'static str,
        bounds: [f64; 2],
    ) -> Self {
        let [least, most] = bounds;
        key(name, Kind::Number(unit, ValueRange { least, most }))
    }

    /// A key whose value is one of `words`.
    pub(crate) const fn of_words(name: &'static str, words: Vec<&'static str>) -> Self {
        key(name, Kind::Word(Cow::Owned(words)))
    }

    /// Whether it may be left out.
    pub fn is_optional(&self) -> bool {
        self.optional
    }

    /// What a number is where it is left out, in SI units; none if it then has no value.
    pub fn default(&self) -> Option<f64> {
        self.default
    }

    /// What it means to leave it out, behind [`Key::valid`]: nothing of what must be there.
    /// `factor` is that of its unit to SI.
    pub fn left_out(&self, factor: f64) -> String {
        match (self.optional, self.default) {
            (true, Some(default)) => format!("; {} if left out", SixDigits(default / factor)),
            (true, None) => "; may be left out".to_owned(),
            (false, _) => String::new(),
        }
    }

    /// The keys of a table, or of each of several tables of one name; none of what is no table.
    pub fn keys(&self) -> &[Key] {
        match &self.kind {
            Kind::Table(keys) | Kind::Tables(keys) => keys,
            _ => &[],
        }
    }

    /// The spellings under which it may stand in a file: of a quantity one for each unit.
    pub fn spellings(&self) -> Vec<String> {
        match &self.kind {
            Kind::Quantity(dimension, _) => dimension.keys(self.name).collect(),
            _ => vec![self.name.to_owned()],
        }
    }

    /// A spelling with the brackets that a table has in a file.
    pub fn shown(&self, spelling: &str) -> String {
        match self.kind {
            Kind::Table(_) => format!("[{spelling}]"),
            Kind::Tables(_) => format!("[[{spelling}]]"),
            _ => spelling.to_owned(),
        }
    }

    /// What would be valid, in words; `unit` is that of the key as it was given, if it was,
    /// with its factor to SI.
    pub fn valid(&self, unit: Option<(&str, f64)>) -> String {
        match &self.kind {
            Kind::Quantity(dimension, limits) => {
                let usual = dimension.units.first().copied();
                let (unit, factor) = unit.or(usual).unwrap_or(("", 1.0));
                format!("a number {}, in {unit}", limits.text(factor))
            }
            Kind::Number(unit, limits) => {
                let text = format!("a number {} {unit}", limits.text(1.0));
                text.trim_end().to_owned()
            }
            Kind::Count(least, most) if least == most => least.to_string(),
            Kind::Count(least, most) => format!("a whole number from {least} to {most}"),
            Kind::Text(valid) => (*valid).to_owned(),
            Kind::Word(words) => {
                let quoted: Vec<String> = words.iter().map(|w| format!("\"{w}\"")).collect();
                quoted.join(" or ")
            }
            Kind::Table(_) => format!("a table [{}]", self.name),
            Kind::Tables(_) => format!("tables [[{}]]", self.name),
        }
    }
}
