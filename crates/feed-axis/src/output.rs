//! Writing to the terminal and to files so that failures are told, not thrown.
//!
//! A command makes a value of what it found and gives it to [`print()`], which writes it as
//! text or keeps it for the one JSON document that [`finish`] writes. Standard output carries
//! nothing else.

use std::fmt::{self, Display};
use std::io::{BufWriter, ErrorKind, Write};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use atomic_write_file::AtomicWriteFile;
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::{Serialize, Serializer};

use crate::exit::not_out;
use crate::terminal::{Format, Terminal};

/// Whether standard output carries a log, and results go to standard error.
static ASIDE: AtomicBool = AtomicBool::new(false);

/// Says that standard output carries a log: results go to standard error.
pub fn results_aside() {
    ASIDE.store(true, Ordering::Relaxed);
}

/// What has been found so far, for the JSON document.
static DOCUMENT: Mutex<Document> = Mutex::new(Document::new());

/// The JSON document: what one command found, or several by their names.
struct Document {
    by_name: bool,
    parts: Vec<(String, String)>,
}

impl Document {
    const fn new() -> Self {
        Self {
            by_name: false,
            parts: Vec::new(),
        }
    }

    /// The whole document; none if nothing was found.
    fn text(&self) -> Option<String> {
        if !self.by_name {
            return self.parts.first().map(|(_, json)| json.clone());
        }
        let part = |(name, json): &(String, String)| {
            format!("  \"{name}\": {}", json.replace('\n', "\n  "))
        };
        let parts: Vec<String> = self.parts.iter().map(part).collect();
        Some(format!("{{\n{}\n}}", parts.join(",\n")))
    }
}

/// Says that several commands print: the JSON document holds what they found by their names.
pub fn print_by_name() {
    lock().by_name = true;
}

/// A value whose text was made beside it.
pub struct Worded<T> {
    /// For people.
    pub text: String,
    /// The same for programs.
    pub value: T,
}

impl<T> Display for Worded<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl<T: Serialize> Serialize for Worded<T> {
    fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
        self.value.serialize(to)
    }
}

/// Prints what the command `name` found: its text, or the same as JSON at the end.
pub fn print(name: &str, found: &(impl Serialize + Display)) -> Result<()> {
    match Terminal::get().format {
        Format::Text => say(found.to_string().trim_end_matches('\n')),
        Format::Json => {
            let json = crate::json::pretty(found).into_diagnostic()?;
            let json = String::from_utf8(json).into_diagnostic()?;
            lock().parts.push((name.to_owned(), json));
            Ok(())
        }
    }
}

/// Writes the JSON document, where one was asked for.
pub fn finish() -> Result<()> {
    match lock().text() {
        Some(text) if Terminal::get().format == Format::Json => line_out(&text),
        _ => Ok(()),
    }
}

fn lock() -> std::sync::MutexGuard<'static, Document> {
    // What a thread that panicked had pushed is whole.
    DOCUMENT
        .lock()
        .unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// A line beside the results, on standard error; not with `--quiet`.
pub fn note(line: impl AsRef<str>) {
    if !Terminal::get().quiet {
        // Where nobody reads it, nothing is lost.
        let _ = writeln!(std::io::stderr(), "{}", line.as_ref());
    }
}

/// A line for people: on standard output, unless that is to carry JSON or a log. An error where nobody
/// reads it any more.
pub fn say(line: impl AsRef<str>) -> Result<()> {
    match (Terminal::get().format, ASIDE.load(Ordering::Relaxed)) {
        (Format::Text, false) => return line_out(line.as_ref()),
        (Format::Text, true) => {
            let _ = writeln!(std::io::stderr(), "{}", line.as_ref());
        }
        (Format::Json, _) => note(line),
    }
    Ok(())
}

fn line_out(line: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}")
        .and_then(|()| out.flush())
        .map_err(|e| not_out(&e))
}

/// Writes a file whole: aside first, then renamed.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    write_whole_by(path, |file| file.write_all(bytes))
}

/// As [`write_whole`], with a content that is never all in memory.
pub fn write_whole_by(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<AtomicWriteFile>) -> std::io::Result<()>,
) -> Result<()> {
    let attempt = || -> std::io::Result<()> {
        std::fs::create_dir_all(path.parent().unwrap_or(path))?;
        let mut file = BufWriter::new(AtomicWriteFile::open(path)?);
        write(&mut file)?;
        let file = file.into_inner()?;
        // Before the commit, which leaves the file aside behind where flushing fails.
        file.sync_all()?;
        file.commit()
    };
    attempt()
        .into_diagnostic()
        .wrap_err_with(|| cannot_write(path))
}

/// That a file cannot be written, and what to look at.
pub(crate) fn cannot_write(path: &Path) -> String {
    format!(
        "cannot write {}: is the folder writable, the disk full?",
        path.display()
    )
}

/// Removes what killed runs left of the files of these names: what was written aside,
/// `.<name>.<six letters or digits>`.
pub fn sweep(folder: &Path, names: &[&str]) -> Result<()> {
    let aside = |file: &str| {
        let middle = file
            .strip_prefix('.')
            .and_then(|rest| rest.rsplit_once('.'));
        middle.is_some_and(|(name, end)| {
            names.contains(&name)
                && end.len() == 6
                && end.bytes().all(|b| b.is_ascii_alphanumeric())
        })
    };
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_str().is_some_and(aside) {
            remove(&entry.path())?;
        }
    }
    Ok(())
}

/// Makes the folder where it is not there, and asks whether results can be written to
/// it: before the work that makes them, so that none is lost.
pub fn ready(folder: &Path) -> Result<()> {
    const PROBE: &str = "writable";
    std::fs::create_dir_all(folder)
        .and_then(|()| AtomicWriteFile::open(folder.join(PROBE)))
        .map(drop)
        .into_diagnostic()
        .wrap_err_with(|| {
            format!(
                "cannot write to the folder {}; give one that can be written to with --out",
                folder.display()
            )
        })?;
    sweep(folder, &[PROBE])
}

/// Removes what an earlier run left, where there is something.
pub fn remove(path: &Path) -> Result<()> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(e)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot remove {}, of an earlier run", path.display())),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_written_aside_is_swept() {
        let folder = tempfile::tempdir().unwrap();
        let kept = [
            "a.json",
            ".a.json",
            ".a.json.1234567",
            ".b.json.123456",
            ".a.json.12-456",
        ];
        for name in kept.iter().chain(&[".a.json.1aB456"]) {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        sweep(folder.path(), &["a.json", "c.json"]).unwrap();
        let mut left: Vec<String> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        let mut kept = kept.map(str::to_owned);
        kept.sort();
        assert_eq!(left, kept);
    }
}
