//! Exit codes: what a script learns of a command without reading its words.

use std::fmt;
use std::io::ErrorKind;
use std::process::ExitCode;

use miette::{Diagnostic, Report, miette};

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done. A verdict is a result, not an error: `discover` ends so whatever it names.
    Done = 0,
    /// Failed: a file, a log or a machine did not allow the work.
    Failed = 1,
    /// Wrong use: options that do not exist, or do not go together, or a value out of range.
    Usage = 2,
    /// Another run is at work in the folder: the same command may do later.
    Busy = 3,
}

impl Exit {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Done, Self::Failed, Self::Usage, Self::Busy];

    /// The number.
    pub fn code(self) -> u8 {
        self as u8
    }

    /// What it means, for people.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Done => "done, whatever the result or verdict says",
            Self::Failed => "failed: an input was refused, or the work could not be done",
            Self::Usage => {
                "wrong use: an option that does not exist, does not go with another, or has a \
                 value out of range"
            }
            Self::Busy => "another run is at work in the folder: try again later",
        }
    }

    /// How a command ended that failed with this error.
    pub fn of(error: &Report) -> Self {
        match error.downcast_ref::<Refused>() {
            Some(refused) => refused.exit,
            None => Self::Failed,
        }
    }

    /// The lines of the help.
    pub fn help() -> String {
        let lines = Self::ALL.map(|exit| format!("  {}  {}", exit.code(), exit.meaning()));
        format!("Exit codes:\n{}", lines.join("\n"))
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit.code())
    }
}

/// An error that has an exit code of its own.
#[derive(Debug)]
struct Refused {
    exit: Exit,
    what: String,
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)
    }
}

impl std::error::Error for Refused {}

impl Diagnostic for Refused {}

/// The error of an option that cannot be used so; it says which, and what would be valid.
pub fn wrong_use(what: impl Into<String>) -> Report {
    refused(Exit::Usage, what)
}

/// The error of a folder in which another run is at work.
pub fn busy(what: impl Into<String>) -> Report {
    refused(Exit::Busy, what)
}

/// The error of standard output that did not take a text.
pub(crate) fn not_out(e: &std::io::Error) -> Report {
    match e.kind() {
        ErrorKind::BrokenPipe => Report::new(Unread),
        _ => miette!("cannot write to standard output: {e}"),
    }
}

/// Whether a command ended because nobody reads its standard output any more, as where `head` has
/// what it wants: that needs no words.
pub(crate) fn is_unread(error: &Report) -> bool {
    error.downcast_ref::<Unread>().is_some()
}

/// Standard output that was closed at its other end.
#[derive(Debug)]
struct Unread;

impl fmt::Display for Unread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("standard output is read no more")
    }
}

impl std::error::Error for Unread {}

impl Diagnostic for Unread {}

fn refused(exit: Exit, what: impl Into<String>) -> Report {
    let what = what.into();
    Report::new(Refused { exit, what })
}

#[cfg(test)]
mod tests {
    use miette::WrapErr;

    use super::*;

    #[test]
    fn a_code_is_found_below_what_was_said_later() {
        let wrapped = Err::<(), _>(busy("at work")).wrap_err("cannot begin");
        assert_eq!(Exit::of(&wrapped.unwrap_err()), Exit::Busy);
        assert_eq!(Exit::of(&miette!("no file")), Exit::Failed);
    }

    #[test]
    fn the_book_has_every_code() {
        let page = include_str!("../../../docs/command.md");
        for exit in Exit::ALL {
            let row = format!("| {} | {} |", exit.code(), exit.meaning());
            assert!(page.contains(&row), "docs/command.md must have: {row}");
        }
    }
}
