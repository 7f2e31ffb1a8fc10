//! What blocks of one log have in common.

use std::io;

use super::invalid;
use crate::log::Log;

/// The channels that every block has.
#[derive(Debug, Default)]
pub(super) struct Names(Vec<String>);

impl Names {
    /// Takes those of the first block, and checks those of the others; whether it was the
    /// first.
    pub(super) fn take(&mut self, block: &Log) -> io::Result<bool> {
        let found = || block.channels().iter().map(|c| c.name.as_str());
        if self.are_empty() {
            self.0 = found().map(str::to_owned).collect();
            return Ok(true);
        }
        match found().eq(self.0.iter().map(String::as_str)) {
            true => Ok(false),
            false => Err(invalid(format!(
                "a block has the channels {}: it must have those of the first, {}",
                found().collect::<Vec<_>>().join(", "),
                self.0.join(", ")
            ))),
        }
    }

    /// Whether there was no block.
    pub(super) fn are_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Channels that are collected before they are written.
#[cfg(any(feature = "mat", feature = "parquet"))]
#[derive(Debug, Default)]
pub(super) struct Columns {
    names: Names,
    /// Name, symbol of the unit, samples.
    pub(super) all: Vec<(String, String, Vec<f64>)>,
}

#[cfg(any(feature = "mat", feature = "parquet"))]
impl Columns {
    /// Adds a block; whether it was the first.
    pub(super) fn push(&mut self, block: &Log) -> io::Result<bool> {
        let is_first = self.names.take(block)?;
        if is_first {
            let empty = block.channels().iter();
            self.all = empty
                .map(|c| (c.name.clone(), c.unit.clone(), Vec::new()))
                .collect();
        }
        for ((.., samples), channel) in self.all.iter_mut().zip(block.channels()) {
            samples.extend_from_slice(&block.with_holes(channel));
        }
        Ok(is_first)
    }

    /// Instants that are held.
    #[cfg(feature = "parquet")]
    pub(super) fn len(&self) -> usize {
        self.all.first().map_or(0, |(.., samples)| samples.len())
    }

    /// Refuses a log without a block.
    pub(super) fn check(&self) -> io::Result<()> {
        match self.names.are_empty() {
            true => Err(invalid("no instants: a log has at least one")),
            false => Ok(()),
        }
    }
}
