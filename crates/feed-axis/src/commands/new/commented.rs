//! An axis file with a comment behind every key: what is valid, from the kinds' own keys.

use axis_sim::control::units_of_gain;
use axis_sim::part::{Key, PartKind};
use axis_sim::{Axis, Registry, SixDigits};
use miette::{IntoDiagnostic, Result};
use toml_edit::{DocumentMut, Item, Table, Value};

/// Widest text before a comment, characters.
const WIDEST: usize = 44;

/// The example under another name, with a comment behind every key; what it leaves out is
/// there commented out.
pub fn file(example: &str, name: &str, made_by: &str) -> Result<String> {
    let registry = Registry::default();
    let keys = registry.keys("example", example)?;
    let mut document: DocumentMut = example.parse().into_diagnostic()?;
    document.insert("name", Item::Value(Value::from(name)));
    let mut file = File {
        registry,
        axis: Axis::parse("example", example)?,
        text: head(made_by),
    };
    let own = document.iter().filter(|(_, item)| item.is_value());
    let own: Vec<_> = own.collect();
    file.lines(&own, &keys, "");
    for (table, item) in document.iter() {
        let key = keys.iter().find(|key| key.name() == table);
        file.item(table, item, key.map_or(&[], Key::keys));
    }
    let is_absent = |key: &&Key| !key.keys().is_empty() && !document.contains_key(key.name());
    for key in keys.iter().filter(is_absent) {
        file.absent(key, "");
    }
    Ok(file.text)
}

fn head(made_by: &str) -> String {
    format!(
        "# Made by `{made_by}`.\n\
         # The last part of a key is its unit; the comment behind it says what is valid. The values are\n\
         # those of an example: replace them by the machine's. What is commented out may be left out.\n"
    )
}

/// The file so far.
struct File {
    registry: Registry,
    axis: Axis,
    text: String,
}

/// Names, summaries and keys of the kinds that a table may name.
type Kinds = Vec<(&'static str, &'static str, &'static [Key])>;

impl File {
    /// A table, or several of one name.
    fn item(&mut self, path: &str, item: &Item, keys: &[Key]) {
        if let Some(tables) = item.as_array_of_tables() {
            for (i, table) in tables.iter().enumerate() {
                // Those that name no kind are all alike.
                let is_new = i == 0 || table.contains_key("kind");
                self.table(&format!("[[{path}]]"), path, table, is_new.then_some(keys));
            }
        }
        let Some(table) = item.as_table() else {
            return;
        };
        let is_parent = table.iter().all(|(_, item)| item.is_table());
        if !is_parent {
            return self.table(&format!("[{path}]"), path, table, Some(keys));
        }
        for (name, item) in table.iter() {
            let inner = keys.iter().find(|key| key.name() == name);
            self.item(
                &format!("{path}.{name}"),
                item,
                inner.map_or(&[], Key::keys),
            );
        }
        let is_absent = |key: &&Key| !key.keys().is_empty() && !table.contains_key(key.name());
        for key in keys.iter().filter(is_absent) {
            self.absent(key, &format!("{path}."));
        }
    }

    /// A table; without `keys` nothing is said of what is valid.
    fn table(&mut self, head: &str, path: &str, table: &Table, keys: Option<&[Key]>) {
        let kind = table.get("kind").and_then(Item::as_str).unwrap_or("");
        let kinds = self.kinds(path);
        let kind = kinds.iter().find(|(name, ..)| *name == kind);
        self.text.push('\n');
        if let Some((_, summary, _)) = kind {
            self.text += &format!("# {summary}\n");
        }
        self.text += &format!("{head}\n");
        let mut all = keys.unwrap_or_default().to_vec();
        if let (Some(keys), Some((_, _, of_kind))) = (keys, kind) {
            let is_new = |key: &&Key| !keys.iter().any(|k| k.name() == key.name());
            all.extend(of_kind.iter().filter(is_new).cloned());
        }
        let entries: Vec<_> = table.iter().collect();
        self.lines(&entries, &all, path);
    }

    /// Entries, each with what is valid, and the keys that were left out.
    fn lines(&mut self, entries: &[(&str, &Item)], keys: &[Key], path: &str) {
        let mut lines = Vec::new();
        for (spelling, item) in entries {
            let Some(value) = item.as_value() else {
                continue;
            };
            let mut value = value.clone();
            value.decor_mut().clear();
            let key = keys.iter().find(|key| unit(key, spelling).is_some());
            let comment = match (key, *spelling) {
                (Some(_), "kind") => self.kind_words(path),
                (Some(key), _) => words(key, spelling, &self.units(key, path)),
                (None, _) => String::new(),
            };
            lines.push((format!("{spelling} = {value}"), comment));
        }
        let given = |key: &Key| entries.iter().any(|(name, _)| unit(key, name).is_some());
        let left_out = keys
            .iter()
            .filter(|key| key.keys().is_empty() && !given(key));
        lines.extend(left_out.map(|key| commented_out(key, &self.units(key, path))));
        self.write(&lines);
    }

    /// A table that the example does not have.
    fn absent(&mut self, key: &Key, path: &str) {
        let path = format!("{path}{}", key.name());
        let inner: Vec<&Key> = key.keys().iter().collect();
        let (tables, values): (Vec<&Key>, Vec<&Key>) =
            inner.into_iter().partition(|key| !key.keys().is_empty());
        if !values.is_empty() {
            self.text += &format!("\n# {}\n", key.shown(&path));
        }
        let line = |key: &&Key| match key.name() {
            "kind" => ("# kind =".to_owned(), self.kind_words(&path)),
            _ => commented_out(key, &self.units(key, &path)),
        };
        let lines: Vec<_> = values.iter().map(line).collect();
        self.write(&lines);
        for table in tables {
            self.absent(table, &format!("{path}."));
        }
    }

    /// Lines with their comments below each other.
    fn write(&mut self, lines: &[(String, String)]) {
        let widths = lines.iter().map(|(left, _)| left.chars().count());
        let width = widths.filter(|width| *width <= WIDEST).max().unwrap_or(0);
        for (left, comment) in lines {
            let line = match comment.is_empty() {
                true => left.clone(),
                false => format!("{left:<width$}  # {comment}"),
            };
            self.text += &(line + "\n");
        }
    }

    /// The units that a key may be given in: of a controller's gain those that go with what
    /// the example's actuator takes.
    fn units(&self, key: &Key, path: &str) -> Vec<(&'static str, f64)> {
        let (control, axis) = (&self.axis.control, &self.axis);
        let is_gain =
            path == "control" && control.kind().keys.iter().any(|k| k.name() == key.name());
        match is_gain {
            true => units_of_gain(&**control, key, axis.actuator.effort(), &*axis.mechanism),
            false => key.units().to_vec(),
        }
    }

    /// The kinds that a table may name.
    fn kinds(&self, path: &str) -> Kinds {
        fn of<P: ?Sized>(kinds: &[&'static PartKind<P>]) -> Kinds {
            let one = |kind: &&'static PartKind<P>| (kind.name, kind.summary, kind.keys);
            kinds.iter().map(one).collect()
        }
        let registry = &self.registry;
        match path {
            "mechanism" => of(&registry.mechanisms),
            "actuator" => of(&registry.actuators),
            "control" => of(&registry.controls),
            "friction" => of(&registry.frictions),
            "load" => of(&registry.loads),
            "sensors.load" | "sensors.motor" => of(&registry.sensors),
            _ => Vec::new(),
        }
    }

    /// The words that a `kind` may be.
    fn kind_words(&self, path: &str) -> String {
        let kinds = self.kinds(path);
        let names: Vec<String> = kinds
            .iter()
            .map(|(name, ..)| format!("\"{name}\""))
            .collect();
        names.join(" or ")
    }
}

/// The unit of a key under a spelling, with its factor to SI; none if it is another key's.
fn unit(key: &Key, spelling: &str) -> Option<Option<(&'static str, f64)>> {
    let place = key.spellings().iter().position(|own| own == spelling)?;
    Some(key.units().get(place).copied())
}

/// What is valid under a key, in the unit in which it is spelt.
fn words(key: &Key, spelling: &str, units: &[(&'static str, f64)]) -> String {
    let own = unit(key, spelling).flatten();
    let mut text = key.valid(own);
    let others = units.iter().map(|(unit, _)| *unit);
    let others: Vec<&str> = others.filter(|u| own.is_none_or(|o| o.0 != *u)).collect();
    if !others.is_empty() {
        text += &format!(", or {}", others.join(", "));
    }
    text + &key.left_out(own.map_or(1.0, |(_, factor)| factor))
}

/// A key that is left out, in its usual unit.
fn commented_out(key: &Key, units: &[(&'static str, f64)]) -> (String, String) {
    let (spelling, factor) = match units.first() {
        Some((unit, factor)) => (format!("{}_{unit}", key.name()), *factor),
        None => (key.name().to_owned(), 1.0),
    };
    let left = match key.default() {
        Some(default) => format!("# {spelling} = {}", SixDigits(default / factor)),
        None => format!("# {spelling} ="),
    };
    let comment = words(key, &spelling, units);
    (left, comment)
}
