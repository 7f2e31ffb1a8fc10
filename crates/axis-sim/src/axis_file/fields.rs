//! Walks a TOML table field by field, so that every refusal can point at its
//! line and say what would be valid.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{AxisFileError, Source};
use super::units::{Dimension, Valid};

/// Canonical record of what was read: `path = value in SI`, for the fingerprint.
pub(super) type Record = Rc<RefCell<Vec<String>>>;

/// One TOML table being read.
pub(super) struct Fields<'a> {
    source: &'a Source,
    path: String,
    span: Range<usize>,
    table: &'a DeTable<'a>,
    seen: RefCell<Vec<String>>,
    valid_keys: RefCell<Vec<String>>,
    record: Record,
}

impl<'a> Fields<'a> {
    pub(super) fn root(
        source: &'a Source,
        table: &'a Spanned<DeTable<'a>>,
        record: Record,
    ) -> Self {
        Self::at(source, String::new(), table.span(), table.get_ref(), record)
    }

    fn at(
        source: &'a Source,
        path: String,
        span: Range<usize>,
        table: &'a DeTable<'a>,
        record: Record,
    ) -> Self {
        Self {
            source,
            path,
            span,
            table,
            seen: RefCell::default(),
            valid_keys: RefCell::default(),
            record,
        }
    }

    fn name_of(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }

    fn get(&self, key: &str) -> Option<&'a Spanned<DeValue<'a>>> {
        let value = self.table.get(key)?;
        self.seen.borrow_mut().push(key.to_owned());
        Some(value)
    }

    fn refuse(&self, span: Range<usize>, key: &str, what: String, valid: String) -> AxisFileError {
        AxisFileError::field(self.source, span, self.name_of(key), what, valid)
    }

    fn keep(&self, key: &str, value: impl std::fmt::Debug) {
        let line = format!("{} = {value:?}", self.name_of(key));
        self.record.borrow_mut().push(line);
    }

    /// An error about this whole table, for checks that take several fields.
    pub(super) fn refuse_table(&self, what: String, valid: &str) -> AxisFileError {
        let path = self.path.clone();
        AxisFileError::field(self.source, self.span.clone(), path, what, valid.to_owned())
    }

    /// A sub-table that must be there.
    pub(super) fn table(&self, key: &str) -> Result<Fields<'a>, AxisFileError> {
        self.valid_keys.borrow_mut().push(format!("[{key}]"));
        self.optional_table(key)?.ok_or_else(|| {
            let what = "is missing".to_owned();
            let valid = format!("a table [{}]", self.name_of(key));
            self.refuse(self.span.start..self.span.start, key, what, valid)
        })
    }

    /// A sub-table that may be left out.
    pub(super) fn optional_table(&self, key: &str) -> Result<Option<Fields<'a>>, AxisFileError> {
        self.valid_keys.borrow_mut().push(format!("[{key}]"));
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        match value.get_ref() {
            DeValue::Table(table) => Ok(Some(Self::at(
                self.source,
                self.name_of(key),
                value.span(),
                table,
                self.record.clone(),
            ))),
            other => Err(self.wrong_type(value, key, other, "a table")),
        }
    }

    /// The tables of `[[key]]`, none if there is no such key.
    pub(super) fn tables(&self, key: &str) -> Result<Vec<Fields<'a>>, AxisFileError> {
        self.valid_keys.borrow_mut().push(format!("[[{key}]]"));
        let Some(value) = self.get(key) else {
            return Ok(Vec::new());
        };
        let DeValue::Array(items) = value.get_ref() else {
            return Err(self.wrong_type(value, key, value.get_ref(), "an array of tables"));
        };
        let table = |(i, item): (usize, &'a Spanned<DeValue<'a>>)| match item.get_ref() {
            DeValue::Table(table) => Ok(Self::at(
                self.source,
                format!("{}[{}]", self.name_of(key), i + 1),
                item.span(),
                table,
                self.record.clone(),
            )),
            other => Err(self.wrong_type(item, key, other, "a table")),
        };
        items.iter().enumerate().map(table).collect()
    }

    /// A quantity: the key is `name_unit`, the result is SI.
    pub(super) fn quantity(
        &self,
        name: &str,
        dimension: &Dimension,
        valid: Valid,
    ) -> Result<f64, AxisFileError> {
        let keys: Vec<String> = dimension.keys(name).collect();
        self.valid_keys.borrow_mut().push(keys.join(" | "));
        let given: Vec<(&String, f64)> = keys
            .iter()
            .zip(dimension.factors())
            .filter(|(key, _)| self.table.contains_key(key.as_str()))
            .collect();
        match given.as_slice() {
            [] => Err(self.no_such_unit(name, dimension, &keys)),
            [(key, factor)] => {
                let number = self.plain(key, valid)? * factor;
                // The factor may carry it beyond what f64 holds, or to zero.
                if !valid.accepts(number) {
                    let span = self
                        .table
                        .get(key.as_str())
                        .map_or(self.span.clone(), Spanned::span);
                    let what = format!("is {number} in SI units");
                    return Err(self.refuse(span, key, what, valid.text().to_owned()));
                }
                self.keep(name, number);
                Ok(number)
            }
            [_, (second, _), ..] => {
                let value = self.table.get(second.as_str());
                let span = value.map_or(self.span.clone(), Spanned::span);
                let what = "gives the same quantity a second time".to_owned();
                Err(self.refuse(span, second, what, format!("one of {}", keys.join(", "))))
            }
        }
    }

    /// A number without a unit.
    pub(super) fn number(&self, key: &str, valid: Valid) -> Result<f64, AxisFileError> {
        self.valid_keys.borrow_mut().push(key.to_owned());
        if !self.table.contains_key(key) {
            return Err(self.missing(key, "a number"));
        }
        let number = self.plain(key, valid)?;
        self.keep(key, number);
        Ok(number)
    }

    /// A quantity that may be left out.
    pub(super) fn optional_quantity(
        &self,
        name: &str,
        dimension: &Dimension,
        valid: Valid,
    ) -> Result<Option<f64>, AxisFileError> {
        let mut keys = dimension.keys(name);
        if keys.any(|key| self.table.contains_key(key.as_str())) {
            return self.quantity(name, dimension, valid).map(Some);
        }
        self.valid_keys.borrow_mut().extend(dimension.keys(name));
        Ok(None)
    }

    /// A number that is `default` where it is left out.
    pub(super) fn optional_number(&self, key: &str, default: f64) -> Result<f64, AxisFileError> {
        if self.table.contains_key(key) {
            return self.number(key, Valid::Finite);
        }
        self.valid_keys.borrow_mut().push(key.to_owned());
        Ok(default)
    }

    /// A whole number between `least` and `most`.
    pub(super) fn count(&self, key: &str, least: u32, most: u32) -> Result<u32, AxisFileError> {
        self.valid_keys.borrow_mut().push(key.to_owned());
        let valid = format!("a whole number from {least} to {most}");
        let Some(value) = self.get(key) else {
            return Err(self.missing(key, &valid));
        };
        let number = match value.get_ref() {
            DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix()).ok(),
            _ => None,
        };
        match number.and_then(|n| u32::try_from(n).ok()) {
            Some(n) if (least..=most).contains(&n) => {
                self.keep(key, n);
                Ok(n)
            }
            _ => {
                let what = format!("is {}", self.source.text(value.span()));
                Err(self.refuse(value.span(), key, what, valid))
            }
        }
    }

    /// A text that must be there.
    pub(super) fn text(&self, key: &str) -> Result<&'a str, AxisFileError> {
        self.optional_text(key)?
            .ok_or_else(|| self.missing(key, "a text in quotes"))
    }

    /// A text that may be left out. Texts do not count for the fingerprint.
    pub(super) fn optional_text(&self, key: &str) -> Result<Option<&'a str>, AxisFileError> {
        self.valid_keys.borrow_mut().push(key.to_owned());
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        match value.get_ref() {
            DeValue::String(text) => Ok(Some(text.as_ref())),
            other => Err(self.wrong_type(value, key, other, "a text in quotes")),
        }
    }

    /// One of a few words.
    pub(super) fn word<T: Copy>(&self, key: &str, words: &[(&str, T)]) -> Result<T, AxisFileError> {
        let text = self.text(key)?;
        let found = words.iter().find(|(word, _)| *word == text);
        let Some((word, meaning)) = found else {
            let span = self.table.get(key).map_or(self.span.clone(), Spanned::span);
            let known: Vec<String> = words.iter().map(|(w, _)| format!("\"{w}\"")).collect();
            let what = format!("is \"{text}\"");
            return Err(self.refuse(span, key, what, known.join(" or ")));
        };
        self.keep(key, word);
        Ok(*meaning)
    }

    /// Refuses keys that nothing asked for.
    pub(super) fn finish(self) -> Result<(), AxisFileError> {
        let seen = self.seen.borrow();
        let unknown = self
            .table
            .iter()
            .find(|(key, _)| !seen.iter().any(|s| s == key.get_ref().as_ref()));
        match unknown {
            None => Ok(()),
            Some((key, _)) => {
                let mut valid = self.valid_keys.borrow().clone();
                valid.sort();
                valid.dedup();
                let what = "is not a key of this table".to_owned();
                let valid = format!("one of: {}", valid.join(", "));
                Err(self.refuse(key.span(), key.get_ref(), what, valid))
            }
        }
    }

    fn plain(&self, key: &str, valid: Valid) -> Result<f64, AxisFileError> {
        let Some(value) = self.get(key) else {
            return Err(self.missing(key, valid.text()));
        };
        let number = match value.get_ref() {
            DeValue::Integer(i) if i.radix() == 10 => i.as_str().parse::<f64>().ok(),
            DeValue::Float(f) => f.as_str().parse::<f64>().ok(),
            _ => None,
        };
        match number {
            Some(number) if valid.accepts(number) => Ok(number),
            Some(_) => {
                let what = format!("is {}", self.source.text(value.span()));
                Err(self.refuse(value.span(), key, what, valid.text().to_owned()))
            }
            None => Err(self.wrong_type(value, key, value.get_ref(), valid.text())),
        }
    }

    fn missing(&self, key: &str, valid: &str) -> AxisFileError {
        let span = self.span.start..self.span.start;
        self.refuse(span, key, "is missing".to_owned(), valid.to_owned())
    }

    fn no_such_unit(&self, name: &str, dimension: &Dimension, keys: &[String]) -> AxisFileError {
        let prefix = format!("{name}_");
        let near = self.table.iter().find(|(key, _)| {
            let key = key.get_ref().as_ref();
            let elsewhere = self.seen.borrow().iter().any(|s| s == key);
            !elsewhere && key.starts_with(&prefix)
        });
        let valid = format!("one of {}", keys.join(", "));
        match near {
            Some((key, _)) => {
                let unit = &key.get_ref()[prefix.len()..];
                let what = format!(
                    "has the unit suffix `{unit}`, which is no {}",
                    dimension.name
                );
                self.refuse(key.span(), key.get_ref(), what, valid)
            }
            None => {
                let span = self.span.start..self.span.start;
                self.refuse(span, name, "is missing".to_owned(), valid)
            }
        }
    }

    fn wrong_type(
        &self,
        value: &Spanned<DeValue<'_>>,
        key: &str,
        is: &DeValue<'_>,
        valid: &str,
    ) -> AxisFileError {
        let kind = match is {
            DeValue::String(_) => "a text",
            DeValue::Integer(_) => "a whole number",
            DeValue::Float(_) => "a number",
            DeValue::Boolean(_) => "true or false",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "a list",
            DeValue::Table(_) => "a table",
        };
        self.refuse(value.span(), key, format!("is {kind}"), valid.to_owned())
    }
}
