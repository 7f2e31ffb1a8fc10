//! Walks a TOML table field by field, so that every refusal can point at its
//! line and say what would be valid.

use std::borrow::Cow;
use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{AxisFileError, Source};
use super::slips::{list, unknown_key, unknown_word};
use crate::part::{Key, Kind, PartError, Values, count};

/// Canonical record of what was read: `path = value in SI`, for the fingerprint.
pub(super) type Record = Rc<RefCell<Vec<String>>>;

type Value<'a> = &'a Spanned<DeValue<'a>>;

/// The unit of a number that has none.
const PLAIN: &[(&str, f64)] = &[("", 1.0)];

/// One TOML table being read.
pub(super) struct Fields<'a> {
    source: &'a Source,
    path: String,
    span: Range<usize>,
    table: &'a DeTable<'a>,
    keys: Cow<'static, [Key]>,
    record: Record,
}

/// The version of a file's layout: 1 had no sections for parts.
pub(super) const SCHEMA: Key = count("schema", 2, 2);

const FIRST: &[Key] = &[SCHEMA];

impl<'a> Fields<'a> {
    /// The file itself, of which only the version can be read as yet.
    pub(super) fn root(
        source: &'a Source,
        table: &'a Spanned<DeTable<'a>>,
        record: Record,
    ) -> Self {
        Self {
            source,
            path: String::new(),
            span: table.span(),
            table: table.get_ref(),
            keys: Cow::Borrowed(FIRST),
            record,
        }
    }

    /// The table, read with these keys; one that has others is refused: an
    /// unknown key is often a slip of one that would else be missing.
    pub(super) fn with_keys(
        self,
        keys: impl Into<Cow<'static, [Key]>>,
    ) -> Result<Self, AxisFileError> {
        let keys = keys.into();
        self.check(&keys)?;
        Ok(Self { keys, ..self })
    }

    /// Refuses a table with other keys than these.
    pub(super) fn check(&self, keys: &[Key]) -> Result<(), AxisFileError> {
        let known: Vec<String> = keys.iter().flat_map(Key::spellings).collect();
        let unknown = self
            .table
            .keys()
            .filter(|key| !known.iter().any(|k| k == key.get_ref().as_ref()))
            .min_by_key(|key| key.span().start);
        let Some(key) = unknown else {
            return Ok(());
        };
        let place = if self.path.is_empty() {
            "this file"
        } else {
            "this table"
        };
        let what = unknown_key(key.get_ref(), place, keys);
        Err(self.refuse(key.span(), key.get_ref(), what, list(keys)))
    }

    fn inside(&self, path: String, value: Value<'a>, table: &'a DeTable<'a>) -> Self {
        Self {
            source: self.source,
            path,
            span: value.span(),
            table,
            keys: Cow::Borrowed(&[]),
            record: self.record.clone(),
        }
    }

    fn name_of(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }

    /// What the table of keys says about `name`.
    fn key(&self, name: &str) -> Result<&Key, AxisFileError> {
        self.keys
            .iter()
            .find(|key| key.name == name)
            .ok_or_else(|| {
                let what = "is not among the keys that are read here".to_owned();
                self.refuse(self.span.clone(), name, what, list(&self.keys))
            })
    }

    fn refuse(&self, span: Range<usize>, key: &str, what: String, valid: String) -> AxisFileError {
        AxisFileError::field(self.source, span, self.name_of(key), what, valid)
    }

    /// Notes a value for the fingerprint.
    pub(super) fn keep(&self, key: &str, value: impl std::fmt::Debug) {
        let line = format!("{} = {value:?}", self.name_of(key));
        self.record.borrow_mut().push(line);
    }

    /// An error about this whole table, for checks that take several fields.
    pub(super) fn refuse_table(&self, what: String, valid: &str) -> AxisFileError {
        let path = self.path.clone();
        AxisFileError::field(self.source, self.span.clone(), path, what, valid.to_owned())
    }

    /// An error about the value of `key`, for checks that take more than the value.
    pub(super) fn refuse_value(&self, key: &str, what: String, valid: String) -> AxisFileError {
        let span = self.table.get(key).map_or(self.span.clone(), Spanned::span);
        self.refuse(span, key, what, valid)
    }

    /// Whether the table has a key of that name.
    pub(super) fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// A sub-table that must be there.
    pub(super) fn table(&self, name: &str) -> Result<Fields<'a>, AxisFileError> {
        self.optional_table(name)?
            .ok_or_else(|| self.missing(name, format!("a table [{}]", self.name_of(name))))
    }

    /// A sub-table that may be left out.
    pub(super) fn optional_table(&self, name: &str) -> Result<Option<Fields<'a>>, AxisFileError> {
        let keys = match &self.key(name)?.kind {
            Kind::Table(keys) => keys.clone(),
            _ => Cow::Borrowed(&[][..]),
        };
        let Some(value) = self.table.get(name) else {
            return Ok(None);
        };
        match value.get_ref() {
            DeValue::Table(table) => {
                let inside = self.inside(self.name_of(name), value, table);
                inside.with_keys(keys).map(Some)
            }
            _ => Err(self.wrong_type(value, name, "a table".to_owned())),
        }
    }

    /// A sub-table that must be there, read with keys of which it has some; no other is
    /// refused yet.
    pub(super) fn peek(&self, name: &str, keys: Vec<Key>) -> Result<Fields<'a>, AxisFileError> {
        let value = self.table.get(name);
        let value =
            value.ok_or_else(|| self.missing(name, format!("a table [{}]", self.name_of(name))))?;
        match value.get_ref() {
            DeValue::Table(table) => Ok(Fields {
                keys: Cow::Owned(keys),
                ..self.inside(self.name_of(name), value, table)
            }),
            _ => Err(self.wrong_type(value, name, "a table".to_owned())),
        }
    }

    /// The table, read with the key that names its kind; no other is refused yet.
    pub(super) fn with_kind(&self, kind: Key) -> Fields<'a> {
        Fields {
            source: self.source,
            path: self.path.clone(),
            span: self.span.clone(),
            table: self.table,
            keys: Cow::Owned(vec![kind]),
            record: self.record.clone(),
        }
    }

    /// The values of a part's keys in this table, added to `values`.
    pub(super) fn part(&self, keys: &[Key], values: &mut Values) -> Result<(), AxisFileError> {
        for key in keys {
            let name = key.name;
            match &key.kind {
                Kind::Count(..) if key.optional && !self.has(name) => {}
                Kind::Count(..) => values.set_count(name, self.count(name)?),
                Kind::Word(_) if key.optional && !self.has(name) => {}
                Kind::Word(_) => values.set_word(name, self.word(name)?),
                _ => {
                    let given = if key.optional {
                        self.optional_number_in(name)?
                    } else {
                        Some(self.number_in(name)?)
                    };
                    match (given, key.default) {
                        (Some((number, unit)), _) => values.set_in(name, number, unit),
                        (None, Some(default)) => {
                            values.set(name, default);
                            if key.counted {
                                self.keep(name, default);
                            }
                        }
                        (None, None) => {}
                    }
                }
            }
        }
        Ok(())
    }

    /// What a part refuses, at the key at fault.
    pub(super) fn refuse_part(&self, error: &PartError) -> AxisFileError {
        let Some(name) = error.key else {
            return self.refuse_table(error.what.clone(), &error.valid);
        };
        let key = self.keys.iter().find(|key| key.name == name);
        let spellings = key.map_or_else(|| vec![name.to_owned()], Key::spellings);
        let given = spellings.iter().find(|spelling| self.has(spelling));
        match given.or(spellings.first()) {
            Some(spelling) => self.refuse_value(spelling, error.what.clone(), error.valid.clone()),
            None => self.refuse_table(error.what.clone(), &error.valid),
        }
    }

    /// The tables of `[[name]]`, none if there is no such key.
    pub(super) fn tables(&self, name: &str) -> Result<Vec<Fields<'a>>, AxisFileError> {
        let keys = match &self.key(name)?.kind {
            Kind::Tables(keys) => keys.clone(),
            _ => Cow::Borrowed(&[][..]),
        };
        let checked = |fields: Fields<'a>| fields.with_keys(keys.clone());
        let tables = self.unchecked(name, keys.clone())?;
        tables.into_iter().map(checked).collect()
    }

    /// As [`Fields::tables`], with keys of which a table has some; no other is refused yet.
    pub(super) fn unchecked(
        &self,
        name: &str,
        keys: impl Into<Cow<'static, [Key]>>,
    ) -> Result<Vec<Fields<'a>>, AxisFileError> {
        let keys = keys.into();
        let Some(value) = self.table.get(name) else {
            return Ok(Vec::new());
        };
        let DeValue::Array(items) = value.get_ref() else {
            return Err(self.wrong_type(value, name, format!("tables [[{name}]]")));
        };
        let table = |(i, item): (usize, Value<'a>)| match item.get_ref() {
            DeValue::Table(table) => {
                let path = format!("{}[{}]", self.name_of(name), i + 1);
                let keys = keys.clone();
                Ok(Fields {
                    keys,
                    ..self.inside(path, item, table)
                })
            }
            _ => Err(self.wrong_type(item, name, "a table".to_owned())),
        };
        items.iter().enumerate().map(table).collect()
    }

    /// A number in SI units: of a quantity, whose key is `name_unit`, or plain.
    pub(super) fn number(&self, name: &str) -> Result<f64, AxisFileError> {
        Ok(self.number_in(name)?.0)
    }

    /// As [`Fields::number`], with the unit it was given in.
    fn number_in(&self, name: &str) -> Result<(f64, &'static str), AxisFileError> {
        match self.optional_number_in(name)? {
            Some(number) => Ok(number),
            None => {
                let key = self.key(name)?;
                let spellings = key.spellings();
                let valid = match spellings.as_slice() {
                    [_, _, ..] => format!("one of {}: {}", spellings.join(", "), key.valid(None)),
                    _ => key.valid(None),
                };
                Err(self.missing(spellings.first().map_or(name, |s| s), valid))
            }
        }
    }

    /// As [`Fields::number`], of one that may be left out.
    pub(super) fn optional_number(&self, name: &str) -> Result<Option<f64>, AxisFileError> {
        Ok(self.optional_number_in(name)?.map(|(number, _)| number))
    }

    fn optional_number_in(&self, name: &str) -> Result<Option<(f64, &'static str)>, AxisFileError> {
        let key = self.key(name)?;
        let (units, limits) = match &key.kind {
            Kind::Quantity(dimension, limits) => (dimension.units, limits),
            Kind::Number(_, limits) => (PLAIN, limits),
            _ => return Err(self.wrong_kind(name)),
        };
        let given: Vec<(String, (&'static str, f64))> = key
            .spellings()
            .into_iter()
            .zip(units.iter().copied())
            .filter(|(spelling, _)| self.has(spelling))
            .collect();
        match given.as_slice() {
            [] => Ok(None),
            [(spelling, unit)] => {
                let valid = key.valid(Some(*unit));
                let number = self.plain(spelling, &valid)? * unit.1;
                if !limits.takes(number) {
                    let what = format!("is {}", self.typed(spelling));
                    return Err(self.refuse_value(spelling, what, valid));
                }
                self.keep(name, number);
                Ok(Some((number, unit.0)))
            }
            [_, (second, _), ..] => {
                let what = "states the same quantity a second time".to_owned();
                let valid = format!("one of {}", key.spellings().join(", "));
                Err(self.refuse_value(second, what, valid))
            }
        }
    }

    /// A whole number.
    pub(super) fn count(&self, name: &str) -> Result<u32, AxisFileError> {
        let key = self.key(name)?;
        let Kind::Count(least, most) = key.kind else {
            return Err(self.wrong_kind(name));
        };
        let Some(value) = self.table.get(name) else {
            return Err(self.missing(name, key.valid(None)));
        };
        let number = match value.get_ref() {
            DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix()).ok(),
            _ => None,
        };
        match number.and_then(|n| u32::try_from(n).ok()) {
            Some(n) if (least..=most).contains(&n) => {
                self.keep(name, n);
                Ok(n)
            }
            _ => {
                let what = format!("is {}", self.typed(name));
                Err(self.refuse(value.span(), name, what, key.valid(None)))
            }
        }
    }

    /// A text that must be there.
    pub(super) fn text(&self, name: &str) -> Result<&'a str, AxisFileError> {
        let valid = self.key(name)?.valid(None);
        self.optional_text(name)?
            .ok_or_else(|| self.missing(name, valid))
    }

    /// A text that may be left out. Texts do not count for the fingerprint.
    pub(super) fn optional_text(&self, name: &str) -> Result<Option<&'a str>, AxisFileError> {
        let valid = self.key(name)?.valid(None);
        let Some(value) = self.table.get(name) else {
            return Ok(None);
        };
        match value.get_ref() {
            DeValue::String(text) => Ok(Some(text.as_ref())),
            _ => Err(self.wrong_type(value, name, valid)),
        }
    }

    /// One of a few words.
    pub(super) fn word(&self, name: &str) -> Result<&'static str, AxisFileError> {
        let text = self.text(name)?;
        let key = self.key(name)?;
        let Kind::Word(words) = &key.kind else {
            return Err(self.wrong_kind(name));
        };
        let Some(word) = words.iter().find(|word| **word == text) else {
            let what = format!("is \"{text}\"{}", unknown_word(text, words));
            return Err(self.refuse_value(name, what, key.valid(None)));
        };
        self.keep(name, word);
        Ok(word)
    }

    fn plain(&self, key: &str, valid: &str) -> Result<f64, AxisFileError> {
        let Some(value) = self.table.get(key) else {
            return Err(self.missing(key, valid.to_owned()));
        };
        let number = match value.get_ref() {
            DeValue::Integer(i) if i.radix() == 10 => i.as_str().parse::<f64>().ok(),
            DeValue::Float(f) => f.as_str().parse::<f64>().ok(),
            _ => None,
        };
        number.ok_or_else(|| self.wrong_type(value, key, valid.to_owned()))
    }

    /// The value of `key` as it stands in the file.
    fn typed(&self, key: &str) -> &str {
        let span = self.table.get(key).map(Spanned::span);
        span.map_or("", |span| self.source.text(span))
    }

    fn missing(&self, key: &str, valid: String) -> AxisFileError {
        let span = self.span.start..self.span.start;
        self.refuse(span, key, "is missing".to_owned(), valid)
    }

    fn wrong_kind(&self, name: &str) -> AxisFileError {
        let what = "is read as what it is not".to_owned();
        self.refuse(self.span.clone(), name, what, list(&self.keys))
    }

    fn wrong_type(&self, value: Value<'_>, key: &str, valid: String) -> AxisFileError {
        let kind = match value.get_ref() {
            DeValue::String(_) => "a text",
            DeValue::Integer(_) => "a whole number",
            DeValue::Float(_) => "a number",
            DeValue::Boolean(_) => "true or false",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "a list",
            DeValue::Table(_) => "a table",
        };
        self.refuse(value.span(), key, format!("is {kind}"), valid)
    }
}
