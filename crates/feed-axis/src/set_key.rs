//! Keys of an axis file that an option sets to other values for one run.

use std::fmt;
use std::str::FromStr;

use miette::{IntoDiagnostic, Report, Result};
use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

use crate::exit::wrong_use;

/// One key, by the tables that it is in, and its value: `mechanism.table_mass_kg=415`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetKey {
    tables: Vec<String>,
    key: String,
    value: String,
}

impl FromStr for SetKey {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let valid = "valid: KEY=VALUE, such as mechanism.table_mass_kg=415";
        let (path, value) = text.split_once('=').ok_or(format!("no `=`; {valid}"))?;
        let mut tables: Vec<String> = path.split('.').map(|part| part.trim().into()).collect();
        if tables.iter().any(String::is_empty) {
            return Err(format!("a part of the key is empty; {valid}"));
        }
        let key = tables.pop().unwrap_or_default();
        let value = value.trim().to_owned();
        Ok(Self { tables, key, value })
    }
}

impl fmt::Display for SetKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.path(), self.value)
    }
}

impl SetKey {
    /// The key with its tables.
    fn path(&self) -> String {
        let tables = self.tables.iter().map(|table| format!("{table}."));
        tables.collect::<String>() + &self.key
    }

    /// What the value is in TOML: a number, a list and so on, or else a text, for which a shell
    /// needs no quotes within quotes.
    fn value(&self) -> Value {
        self.value
            .parse()
            .unwrap_or_else(|_| Value::from(self.value.as_str()))
    }
}

impl SetKey {
    /// The table of the file that the key is in, made where it is not there; of several of one name, as
    /// `[[trajectory]]`, the one of the number that follows the name, from 1.
    fn table_of<'a>(&self, document: &'a mut DocumentMut) -> Result<&'a mut dyn TableLike> {
        let wrong = |what: String| wrong_use(format!("--set {self}: {what}"));
        let mut table: &mut dyn TableLike = document.as_table_mut();
        let mut names = self.tables.iter();
        while let Some(name) = names.next() {
            let item = table
                .entry(name)
                .or_insert_with(|| Item::Table(Table::new()));
            if let Item::ArrayOfTables(all) = item {
                let (number, count) = (names.next(), all.len());
                let index = number.and_then(|n| n.parse::<usize>().ok()?.checked_sub(1));
                let one = index.and_then(|index| all.get_mut(index));
                table = one.ok_or_else(|| {
                    wrong(format!(
                        "which [[{name}]] is meant is not said; valid: {name}.1 to {name}.{count}, a point, \
                         and one of its keys"
                    ))
                })?;
                continue;
            }
            table = item.as_table_like_mut().ok_or_else(|| {
                wrong(format!(
                    "`{name}` is no table of the axis file; valid: a table such as mechanism, actuator, \
                     control, friction or stroke, or trajectory.1, a point, and one of its keys"
                ))
            })?;
        }
        Ok(table)
    }
}

/// The text of an axis file with keys set. A key that the file leaves out is added; whether there is
/// such a key, and whether the value is valid, is for the reader of the file to say.
///
/// # Errors
/// A text that is no TOML; wrong use, where what should be a table is none.
pub fn with_keys(content: &str, keys: &[SetKey]) -> Result<String> {
    let mut document: DocumentMut = content.parse().into_diagnostic()?;
    for set in keys {
        let table = set.table_of(&mut document)?;
        match table.get_mut(&set.key).and_then(Item::as_value_mut) {
            // What stands around a value, its comment among it, stays.
            Some(value) => {
                let around = value.decor().clone();
                *value = set.value();
                *value.decor_mut() = around;
            }
            None => {
                table.insert(&set.key, Item::Value(set.value()));
            }
        }
    }
    Ok(document.to_string())
}

/// What is wrong with the keys that were set, of which the reader refuses `field`: those of them that set it, or something in it
/// or around it, else all of them, of which one needs another.
///
/// `content` is the text of the file: a table that it does not have is named, with those that it has, as the same quantity stands
/// in other tables in another layout.
pub fn refused(keys: &[SetKey], content: &str, field: &str, what: &str, valid: &str) -> Report {
    // The reader counts tables as `trajectory[2]`, the option as `trajectory.2`.
    let field_as_set = field.replace('[', ".").replace(']', "");
    let is_in = |inner: &str, outer: &str| {
        let rest = inner.strip_prefix(outer);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    let meant = |key: &&SetKey| {
        let path = key.path();
        is_in(&path, &field_as_set) || is_in(&field_as_set, &path)
    };
    let mut blamed: Vec<&SetKey> = keys.iter().filter(meant).collect();
    if blamed.is_empty() {
        blamed = keys.iter().collect();
    }
    let options: Vec<String> = blamed.iter().map(|key| format!("--set {key}")).collect();
    let options = options.join(" ");
    let tables = tables_of(content);
    let first = |key: &&SetKey| key.tables.first().cloned();
    let mut strange = blamed.iter().filter_map(first);
    let strange = strange.find(|table| !tables.contains(table));
    let strange = strange.map_or(String::new(), |table| {
        format!(
            "; the file has no table {table}, its tables are: {}",
            tables.join(", ")
        )
    });
    wrong_use(format!(
        "{options}: `{field}` {what}; valid: {valid}{strange}"
    ))
}

/// Names of the tables at the head of a text; none of what is no TOML.
fn tables_of(content: &str) -> Vec<String> {
    let document: DocumentMut = content.parse().unwrap_or_default();
    let is_table = |item: &Item| item.is_table_like() || item.is_array_of_tables();
    let tables = document.iter().filter(|(_, item)| is_table(item));
    tables.map(|(name, _)| name.to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::{SetKey, with_keys};

    const FILE: &str =
        "name = \"a\"\n[mechanism]\nmass_kg = 515 # of the table\nmounting = \"fixed-free\"\n";

    fn set(keys: &[&str]) -> String {
        let keys: Vec<SetKey> = keys.iter().map(|key| key.parse().unwrap()).collect();
        with_keys(FILE, &keys).unwrap()
    }

    #[test]
    fn a_key_has_its_new_value_and_keeps_its_comment() {
        assert_eq!(set(&["mechanism.mass_kg=415"]), FILE.replace("515", "415"));
        assert_eq!(
            set(&["mechanism.mounting=fixed-fixed", "name = b"]),
            FILE.replace("fixed-free", "fixed-fixed")
                .replace("\"a\"", "\"b\"")
        );
    }

    #[test]
    fn one_of_several_tables_is_named_by_its_number() {
        let file = "[[trajectory]]\nspeed = 1\n[[trajectory]]\nspeed = 2\n";
        let with = |key: &str| with_keys(file, &[key.parse().unwrap()]);
        assert_eq!(
            with("trajectory.2.speed=3").unwrap(),
            file.replace("= 2", "= 3")
        );
        for key in [
            "trajectory.speed=3",
            "trajectory.0.speed=3",
            "trajectory.3.speed=3",
        ] {
            let error = with(key).unwrap_err().to_string();
            assert!(error.contains("trajectory.1 to trajectory.2"), "{error}");
        }
    }

    #[test]
    fn a_key_that_is_not_there_is_added() {
        let text = set(&["mechanism.lead_mm=10", "stroke.start_mm=[1, 2]"]);
        assert!(text.contains("lead_mm = 10\n"), "{text}");
        assert!(text.contains("[stroke]\nstart_mm = [1, 2]\n"), "{text}");
    }

    #[test]
    fn what_is_no_key_is_told_with_what_would_be() {
        for wrong in ["mass", "a..b=1", "=3"] {
            let message = wrong.parse::<SetKey>().unwrap_err();
            assert!(message.contains("mechanism.table_mass_kg=415"), "{message}");
        }
        let spelt: SetKey = "stroke.start_mm = [1, 2]".parse().unwrap();
        assert_eq!(spelt.to_string(), "stroke.start_mm=[1, 2]");
        let in_a_value: SetKey = "name.first=3".parse().unwrap();
        let message = with_keys(FILE, &[in_a_value]).unwrap_err().to_string();
        assert!(message.contains("`name` is no table"), "{message}");
    }
}
