//! One key of the axis file: its spellings, its limits, and what is valid in words.

use std::borrow::Cow;

use super::units::Dimension;
use crate::SixDigits;
use crate::axis::Range;

/// One key of a table.
#[derive(Clone, Debug)]
pub(super) struct Key {
    /// As in the file; a quantity's is without its unit.
    pub(super) name: &'static str,
    pub(super) kind: Kind,
}

/// What stands under a key.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// A number with a unit, which ends the key; the limits are SI.
    Quantity(&'static Dimension, Range),
    /// A number whose unit, if it has one, is always the same.
    Number(&'static str, Range),
    /// A whole number.
    Count(u32, u32),
    /// A text.
    Text,
    /// One of a few words.
    Word(Cow<'static, [&'static str]>),
    /// A table.
    Table(&'static [Key]),
    /// Tables of the same kind.
    Tables(&'static [Key]),
}

pub(super) const fn quantity(
    name: &'static str,
    dimension: &'static Dimension,
    least: f64,
    most: f64,
) -> Key {
    let kind = Kind::Quantity(dimension, Range { least, most });
    Key { name, kind }
}

pub(super) const fn number(name: &'static str, least: f64, most: f64) -> Key {
    let kind = Kind::Number("", Range { least, most });
    Key { name, kind }
}

pub(super) const fn count(name: &'static str, least: u32, most: u32) -> Key {
    let kind = Kind::Count(least, most);
    Key { name, kind }
}

pub(super) const fn text(name: &'static str) -> Key {
    let kind = Kind::Text;
    Key { name, kind }
}

pub(super) const fn word(name: &'static str, words: &'static [&'static str]) -> Key {
    let kind = Kind::Word(Cow::Borrowed(words));
    Key { name, kind }
}

pub(super) const fn table(name: &'static str, keys: &'static [Key]) -> Key {
    let kind = Kind::Table(keys);
    Key { name, kind }
}

pub(super) const fn tables(name: &'static str, keys: &'static [Key]) -> Key {
    let kind = Kind::Tables(keys);
    Key { name, kind }
}

impl Range {
    /// Whether `value` lies inside, but for the rounding of its conversion to SI.
    pub(super) fn takes(&self, value: f64) -> bool {
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
    /// A number of an effect, in SI units.
    pub(super) const fn of_effect(
        name: &'static str,
        unit: &'static str,
        bounds: [f64; 2],
    ) -> Self {
        let [least, most] = bounds;
        let kind = Kind::Number(unit, Range { least, most });
        Self { name, kind }
    }

    /// A key whose value is one of `words`.
    pub(super) const fn of_words(name: &'static str, words: Vec<&'static str>) -> Self {
        let kind = Kind::Word(Cow::Owned(words));
        Self { name, kind }
    }

    /// The spellings under which it may stand in a file.
    pub(super) fn spellings(&self) -> Vec<String> {
        match &self.kind {
            Kind::Quantity(dimension, _) => dimension.keys(self.name).collect(),
            _ => vec![self.name.to_owned()],
        }
    }

    /// A spelling with the brackets that a table has in a file.
    pub(super) fn shown(&self, spelling: &str) -> String {
        match self.kind {
            Kind::Table(_) => format!("[{spelling}]"),
            Kind::Tables(_) => format!("[[{spelling}]]"),
            _ => spelling.to_owned(),
        }
    }

    /// What would be valid; `unit` is that of the key as it was given, if it was.
    pub(super) fn valid(&self, unit: Option<(&str, f64)>) -> String {
        match &self.kind {
            Kind::Quantity(dimension, limits) => {
                let usual = dimension.units().first().copied();
                let (unit, factor) = unit.or(usual).unwrap_or(("", 1.0));
                format!("a number {}, in {unit}", limits.text(factor))
            }
            Kind::Number(unit, limits) => {
                let text = format!("a number {} {unit}", limits.text(1.0));
                text.trim_end().to_owned()
            }
            Kind::Count(least, most) => format!("a whole number from {least} to {most}"),
            Kind::Text => "a text in quotes".to_owned(),
            Kind::Word(words) => {
                let quoted: Vec<String> = words.iter().map(|w| format!("\"{w}\"")).collect();
                quoted.join(" or ")
            }
            Kind::Table(_) => format!("a table [{}]", self.name),
            Kind::Tables(_) => format!("tables [[{}]]", self.name),
        }
    }
}
