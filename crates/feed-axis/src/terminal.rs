//! How a program speaks: in which format, in colour, and how much. Said once, by the options
//! of every command.

use std::ffi::OsString;
use std::io::IsTerminal;
use std::sync::OnceLock;

use clap::{ColorChoice, ValueEnum};

/// What standard output carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Lines and tables for people
    #[default]
    Text,
    /// One JSON document, with SI units or those in the names of the fields
    Json,
}

/// How a program speaks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Terminal {
    /// What standard output carries.
    pub format: Format,
    /// Whether messages are in colour.
    pub color: ColorChoice,
    /// Whether nothing is said but results and errors.
    pub quiet: bool,
}

static TERMINAL: OnceLock<Terminal> = OnceLock::new();

impl Terminal {
    /// Says how this program speaks; the first call counts.
    pub fn set(self) {
        let _ = TERMINAL.set(self);
    }

    /// How this program speaks.
    pub fn get() -> Self {
        TERMINAL.get().copied().unwrap_or_default()
    }

    /// Whether messages on standard error are in colour: where it was asked for, or a person
    /// reads them and has not asked for none (<https://no-color.org>).
    pub fn is_coloured(self) -> bool {
        let unwanted = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        match self.color {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => std::io::stderr().is_terminal() && !unwanted,
        }
    }
}

/// What `--color` of a command line says, before it is parsed: errors of parsing keep to it
/// too. Nothing if it says nothing valid, which the parser then tells.
pub fn color_in(words: impl IntoIterator<Item = OsString>) -> ColorChoice {
    let mut choice = ColorChoice::Auto;
    let mut words = words.into_iter().peekable();
    while let Some(word) = words.next() {
        let word = word.to_string_lossy();
        let value = match word.split_once('=') {
            _ if word == "--" => break,
            Some(("--color", value)) => Some(value.to_owned()),
            None if word == "--color" => words.peek().map(|w| w.to_string_lossy().into_owned()),
            _ => None,
        };
        let given = value.and_then(|value| ColorChoice::from_str(&value, false).ok());
        choice = given.unwrap_or(choice);
    }
    choice
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_is_read_before_the_rest() {
        let of = |line: &str| color_in(line.split(' ').map(OsString::from));
        assert_eq!(of("simulate --color never"), ColorChoice::Never);
        assert_eq!(
            of("--color=always simulate --nonsense"),
            ColorChoice::Always
        );
        assert_eq!(of("--color green"), ColorChoice::Auto);
        assert_eq!(of("campaign sample -- --color never"), ColorChoice::Auto);
    }
}
