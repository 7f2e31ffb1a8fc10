//! Log to MAT version 5.

use std::io::{self, Write};

use super::columns::Columns;
use super::mat_bytes::{column, header, texts};
use super::{LAYOUT, LogSink, in_a_line, invalid};
use crate::log::Log;

/// The structs of units and of notes, and the number of the layout.
const UNITS: &str = "units";
const NOTES: &str = "notes";
const VERSION: &str = "axis_log_version";
/// Most characters of a variable's name.
const NAME: usize = 63;

/// A MAT file: held in memory to the end, as each variable begins with its length.
pub(super) struct MatSink<W> {
    writer: W,
    columns: Columns,
    notes: Vec<(String, String)>,
}

impl<W: Write> MatSink<W> {
    pub(super) fn new(writer: W) -> Self {
        let columns = Columns::default();
        Self {
            writer,
            columns,
            notes: Vec::new(),
        }
    }
}

impl<W: Write> LogSink for MatSink<W> {
    type End = W;

    fn write(&mut self, block: &Log) -> io::Result<()> {
        if self.columns.push(block)? {
            let names = self.columns.all.iter();
            names.map(|(name, ..)| name).try_for_each(|n| check(n))?;
        }
        Ok(())
    }

    fn note(&mut self, name: &str, text: &str) -> io::Result<()> {
        self.notes.push((name.to_owned(), in_a_line(text)));
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<W> {
        self.columns.check()?;
        let to = &mut self.writer;
        to.write_all(&header())?;
        for (name, _, samples) in &self.columns.all {
            to.write_all(&column(name, samples)?)?;
        }
        let all = self.columns.all.iter();
        let units: Vec<(&str, &str)> = all.map(|(n, u, _)| (n.as_str(), u.as_str())).collect();
        to.write_all(&texts(UNITS, &units))?;
        if !self.notes.is_empty() {
            let notes = self.notes.iter();
            let notes: Vec<(&str, &str)> = notes.map(|(n, t)| (n.as_str(), t.as_str())).collect();
            to.write_all(&texts(NOTES, &notes))?;
        }
        to.write_all(&column(VERSION, &[f64::from(LAYOUT)])?)?;
        to.flush()?;
        Ok(self.writer)
    }
}

fn check(name: &str) -> io::Result<()> {
    let all = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let fits = name.len() <= NAME
        && name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(all)
        && name != VERSION;
    match fits {
        true => Ok(()),
        false => Err(invalid(format!(
            "channel \"{name}\" cannot be a variable of a MAT file: letters, digits and _ are \
             valid, a letter first, {NAME} characters at most"
        ))),
    }
}
