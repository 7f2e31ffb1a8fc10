//! The axis file: TOML to a checked [`Axis`].

#[cfg(test)]
mod doc_table;
mod error;
mod extras;
mod fields;
mod keys;
mod layout;
mod loop_keys;
mod read;
mod registry;
mod schema;
mod slips;
mod syntax;

use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;

use toml::de::DeTable;

use crate::axis::Axis;
use crate::part::Key;
pub use error::AxisFileError;
use error::Source;
use fields::{Fields, Record};
pub use layout::TABLES_WITHOUT_PARTS;
pub use registry::Registry;
pub use syntax::toml_message;

/// Size beyond which a file is no axis file, bytes.
const MOST_BYTES: u64 = 1 << 20;

/// The text of the file, or why it cannot be had.
fn content(path: &Path) -> Result<String, AxisFileError> {
    axis_log::read_text(path, Some(MOST_BYTES)).map_err(|reason| AxisFileError::read(path, reason))
}

impl Registry {
    /// All keys that an axis file may have whose parts are of the kinds that `content`
    /// names, table by table, with their units and limits; of `[sensors]`, `[[load]]` and
    /// `[[effects]]` the key that names the kind alone. `name` stands for the text in messages.
    ///
    /// # Errors
    /// As [`Axis::read`], of what tells the kinds.
    pub fn keys(&self, name: &str, content: &str) -> Result<Vec<Key>, AxisFileError> {
        let source = Source::of(name, content);
        let table = DeTable::parse(content).map_err(|e| AxisFileError::syntax(&source, &e))?;
        read::keys_of(Fields::root(&source, &table, Record::default()), self)
    }
}

impl Axis {
    /// Reads an axis file.
    ///
    /// # Errors
    /// [`AxisFileError`] names file, line and field, and what would be valid.
    pub fn read(path: &Path) -> Result<Self, AxisFileError> {
        Self::read_with(path, &Registry::default())
    }

    /// As [`Axis::read`], of a file that may name other kinds of parts and effects.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn read_with(path: &Path, registry: &Registry) -> Result<Self, AxisFileError> {
        Self::stands_for(path, &content(path)?, registry)
    }

    /// As [`Axis::read`], of a text that stands for the file at `path`, such as the file's own
    /// with changes: messages name the file, and files that it names lie beside it.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn read_changed(path: &Path, content: &str) -> Result<Self, AxisFileError> {
        Self::stands_for(path, content, &Registry::default())
    }

    fn stands_for(path: &Path, content: &str, registry: &Registry) -> Result<Self, AxisFileError> {
        let mut axis = Self::parse_with(&path.display().to_string(), content, registry)?;
        axis.lies_in(path.parent());
        Ok(axis)
    }

    /// Reads the text of an axis file; `name` stands for it in messages.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn parse(name: &str, content: &str) -> Result<Self, AxisFileError> {
        Self::parse_with(name, content, &Registry::default())
    }

    /// As [`Axis::parse`], of a text that may name other kinds of parts and effects.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn parse_with(
        name: &str,
        content: &str,
        registry: &Registry,
    ) -> Result<Self, AxisFileError> {
        let source = Source::of(name, content);
        let table = DeTable::parse(content).map_err(|e| AxisFileError::syntax(&source, &e))?;
        let record: Record = Rc::new(RefCell::new(Vec::new()));
        let mut axis = read::axis(Fields::root(&source, &table, record.clone()), registry)?;
        let mut lines = record.take();
        lines.sort();
        lines.dedup();
        let hash = blake3::hash(lines.join("\n").as_bytes());
        axis.fingerprint = hash.to_hex().to_string();
        Ok(axis)
    }

    /// Files that an axis file names lie relative to its folder.
    fn lies_in(&mut self, folder: Option<&Path>) {
        if let (Some(experiment), Some(folder)) = (&mut self.experiment, folder) {
            experiment.machine = folder.join(&experiment.machine);
            experiment.paper_tables = experiment.paper_tables.take().map(|p| folder.join(p));
        }
    }
}
