//! The axis file: TOML to a checked [`Axis`].

mod ball_screw;
#[cfg(test)]
mod doc_table;
mod error;
mod extras;
mod fields;
mod key;
mod keys;
mod rigid;
mod slips;
mod units;

use std::cell::RefCell;
use std::io::Read;
use std::path::Path;
use std::rc::Rc;

use toml::de::DeTable;

use crate::axis::Axis;
use crate::effects::Machine;
use ball_screw::axis;
pub use error::AxisFileError;
use error::Source;
use fields::{Fields, Record};
use keys::{BALL_SCREW, KINDS, RIGID_MASS};

/// Size beyond which a file is no axis file, bytes.
const MOST_BYTES: u64 = 1 << 20;

/// The text of the file, or why it cannot be had.
fn content(path: &Path) -> Result<String, AxisFileError> {
    let read = || {
        let mut content = String::new();
        let file = std::fs::File::open(path)?;
        file.take(MOST_BYTES + 1).read_to_string(&mut content)?;
        if content.len() as u64 > MOST_BYTES {
            return Err(std::io::Error::other("it is larger than 1 MiB"));
        }
        Ok(content)
    };
    read().map_err(|reason| AxisFileError::Read {
        path: path.to_owned(),
        reason,
    })
}

impl Axis {
    /// Reads an axis file.
    ///
    /// # Errors
    /// [`AxisFileError`] names file, line and field, and what would be valid.
    pub fn read(path: &Path) -> Result<Self, AxisFileError> {
        let mut axis = Self::parse(&path.display().to_string(), &content(path)?)?;
        axis.lies_in(path.parent());
        Ok(axis)
    }

    /// Files that an axis file names lie relative to its folder.
    fn lies_in(&mut self, folder: Option<&Path>) {
        if let (Some(experiment), Some(folder)) = (&mut self.experiment, folder) {
            experiment.machine = folder.join(&experiment.machine);
            experiment.paper_tables = experiment.paper_tables.take().map(|p| folder.join(p));
        }
    }

    /// Reads the text of an axis file; `name` stands for it in messages.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn parse(name: &str, content: &str) -> Result<Self, AxisFileError> {
        let (mut axis, fingerprint) = parse(name, content, |root| {
            if is_rigid(&root)? {
                let what = "is \"rigid-mass\": this command needs a ball screw".to_owned();
                let valid = format!("\"{}\", or no kind", KINDS[0]);
                return Err(root.refuse_value("kind", what, valid));
            }
            axis(&root.with_keys(BALL_SCREW)?)
        })?;
        axis.fingerprint = fingerprint;
        Ok(axis)
    }
}

impl Machine {
    /// Reads the file of either kind of machine: `kind = "rigid-mass"`, or
    /// `kind = "ball-screw"`, which is what a file without a kind is.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn read(path: &Path) -> Result<Self, AxisFileError> {
        let mut machine = Self::parse(&path.display().to_string(), &content(path)?)?;
        if let Self::BallScrew(axis) = &mut machine {
            axis.lies_in(path.parent());
        }
        Ok(machine)
    }

    /// Reads the text of an axis file; `name` stands for it in messages.
    ///
    /// # Errors
    /// As [`Axis::read`].
    pub fn parse(name: &str, content: &str) -> Result<Self, AxisFileError> {
        let (mut machine, fingerprint) = parse(name, content, |root| {
            if is_rigid(&root)? {
                let rigid = rigid::rigid(&root.with_keys(RIGID_MASS)?)?;
                return Ok(Self::Rigid(Box::new(rigid)));
            }
            Ok(Self::BallScrew(Box::new(axis(
                &root.with_keys(BALL_SCREW)?,
            )?)))
        })?;
        match &mut machine {
            Self::BallScrew(axis) => axis.fingerprint = fingerprint,
            Self::Rigid(axis) => axis.fingerprint = fingerprint,
        }
        Ok(machine)
    }
}

/// Whether the file is of a rigid mass.
fn is_rigid(root: &Fields<'_>) -> Result<bool, AxisFileError> {
    Ok(root.has("kind") && root.word("kind")? == KINDS[1])
}

/// What `read` makes of the file, and the hash of its values.
fn parse<T>(
    name: &str,
    content: &str,
    read: impl FnOnce(Fields<'_>) -> Result<T, AxisFileError>,
) -> Result<(T, String), AxisFileError> {
    let source = Source {
        name: name.to_owned(),
        content: content.to_owned(),
    };
    let table = DeTable::parse(content).map_err(|e| AxisFileError::syntax(&source, &e))?;
    let record: Record = Rc::new(RefCell::new(Vec::new()));
    let read = read(Fields::root(&source, &table, record.clone()))?;
    let mut lines = record.take();
    lines.sort();
    let hash = blake3::hash(lines.join("\n").as_bytes());
    Ok((read, hash.to_hex().to_string()))
}
