//! Values of a part's parameters, by the names of their keys.

use std::collections::BTreeMap;

use super::PartError;

/// Values under the names of their keys (without units): numbers in SI units,
/// whole numbers, words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(BTreeMap<&'static str, Value>);

#[derive(Clone, Debug, PartialEq)]
enum Value {
    /// In SI units, and the unit it was given in.
    Number(f64, &'static str),
    Count(u32),
    Word(&'static str),
}

impl Values {
    /// Sets a number, in SI units.
    pub fn set(&mut self, key: &'static str, number: f64) {
        let unit = match self.0.get(key) {
            Some(Value::Number(_, unit)) => unit,
            _ => "",
        };
        self.0.insert(key, Value::Number(number, unit));
    }

    /// Sets a number (in SI units) that was given in `unit`.
    pub(crate) fn set_in(&mut self, key: &'static str, number: f64, unit: &'static str) {
        self.0.insert(key, Value::Number(number, unit));
    }

    /// Sets a whole number.
    pub fn set_count(&mut self, key: &'static str, count: u32) {
        self.0.insert(key, Value::Count(count));
    }

    /// Sets a word.
    pub fn set_word(&mut self, key: &'static str, word: &'static str) {
        self.0.insert(key, Value::Word(word));
    }

    /// Multiplies a number, if there is one.
    pub fn scale(&mut self, key: &'static str, by: f64) {
        if let Some(Value::Number(number, _)) = self.0.get_mut(key) {
            *number *= by;
        }
    }

    /// Adds to a number; one that is not there was 0.
    pub fn shift(&mut self, key: &'static str, by: f64) {
        self.set(key, self.or(key, 0.0) + by);
    }

    /// A number that must be there, in SI units.
    ///
    /// # Errors
    /// [`PartError`] if it is not.
    pub fn number(&self, key: &'static str) -> Result<f64, PartError> {
        self.optional(key).ok_or_else(|| missing(key, "a number"))
    }

    /// A number that may be left out.
    pub fn optional(&self, key: &str) -> Option<f64> {
        match self.0.get(key) {
            Some(Value::Number(number, _)) => Some(*number),
            _ => None,
        }
    }

    /// A number that is `default` where it is left out.
    pub fn or(&self, key: &str, default: f64) -> f64 {
        self.optional(key).unwrap_or(default)
    }

    /// A whole number that must be there.
    ///
    /// # Errors
    /// [`PartError`] if it is not.
    pub fn count(&self, key: &'static str) -> Result<u32, PartError> {
        self.optional_count(key)
            .ok_or_else(|| missing(key, "a whole number"))
    }

    /// A whole number that may be left out.
    pub fn optional_count(&self, key: &str) -> Option<u32> {
        match self.0.get(key) {
            Some(Value::Count(count)) => Some(*count),
            _ => None,
        }
    }

    /// Whether there is a value of any sort.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.0.contains_key(key)
    }

    /// A word, where it was given.
    pub fn word(&self, key: &str) -> Option<&'static str> {
        match self.0.get(key) {
            Some(Value::Word(word)) => Some(word),
            _ => None,
        }
    }

    /// The unit in which a number was given in the file; empty if it was not.
    pub fn unit(&self, key: &str) -> &'static str {
        match self.0.get(key) {
            Some(Value::Number(_, unit)) => unit,
            _ => "",
        }
    }
}

fn missing(key: &'static str, what: &str) -> PartError {
    PartError::of(key, "is missing", what)
}
