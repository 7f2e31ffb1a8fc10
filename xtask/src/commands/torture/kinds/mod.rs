//! The kinds of input: how one is made, and what is done with it.

mod artifact;
mod axis;
mod log;
mod program;
mod samples;
mod stage;
mod table;

use std::path::Path;

use miette::{IntoDiagnostic, Report, Result};

use super::message;
use super::random::Source;
pub use axis::small_screw;

/// One input.
pub struct Input {
    /// Path of its file below the desk.
    pub file: String,
    /// What is written there.
    pub bytes: Vec<u8>,
    /// Whether no result may come of it: a hash covers every bit of it.
    pub damaged: bool,
}

/// What became of an input.
#[derive(Debug)]
pub enum Verdict {
    /// It was read, and what could be done with it was.
    Accepted,
    /// It was refused, in words that say what, where and what would be valid.
    Refused,
    /// What must not be.
    Fault(String),
}

/// A kind of input, with what it needs.
pub trait Kind {
    /// Its name in tables.
    fn name(&self) -> &'static str;
    /// How many inputs of every sixteen or so are of this kind.
    fn share(&self) -> usize;
    /// An input.
    fn input(&self, random: &mut Source) -> Input;
    /// What the commands do with it, which lies in the folder `desk`.
    fn judge(&self, input: &Input, desk: &Path) -> Verdict;
    /// Puts back what the input stood in the place of.
    fn restore(&self, _: &Input, desk: &Path) -> Result<()> {
        let _ = desk;
        Ok(())
    }
}

/// All kinds. What they need is made in the folder `desk`.
pub fn all(desk: &Path) -> Result<Vec<Box<dyn Kind>>> {
    std::fs::create_dir_all(desk).into_diagnostic()?;
    let mut kinds: Vec<Box<dyn Kind>> = Vec::new();
    kinds.extend(axis::kinds());
    kinds.extend(program::kinds());
    kinds.extend(log::kinds());
    kinds.extend(artifact::kinds()?);
    kinds.push(samples::kind(desk)?);
    kinds.push(stage::kind(desk)?);
    kinds.push(table::kind()?);
    Ok(kinds)
}

/// The kind of each of so many inputs in a row, over and over.
pub fn schedule(kinds: &[Box<dyn Kind>]) -> Vec<usize> {
    let most = kinds.iter().map(|kind| kind.share()).max().unwrap_or(0);
    let turns = (0..most).flat_map(|turn| (0..kinds.len()).map(move |kind| (turn, kind)));
    turns
        .filter(|&(turn, kind)| turn < kinds[kind].share())
        .map(|(_, kind)| kind)
        .collect()
}

/// A refusal, which must name the input's file, and a place in it where `place` says so.
fn refused(error: impl Into<Report>, input: &Input, place: bool) -> Verdict {
    match message::judge(&error.into(), &input.file, place) {
        Ok(()) => Verdict::Refused,
        Err(wrong) => Verdict::Fault(wrong),
    }
}

fn fault(what: impl Into<String>) -> Verdict {
    Verdict::Fault(what.into())
}
