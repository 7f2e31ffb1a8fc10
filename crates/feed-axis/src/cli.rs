//! What every program of these commands does before and after a command.

use std::io::Write;
use std::process::ExitCode;

use clap::{Args, ColorChoice, Parser};
use miette::Result;

use crate::diagnostic::Compiler;
use crate::exit::{Exit, is_unread};
use crate::output;
use crate::program;
use crate::terminal::{Format, Terminal, color_in};

/// Options of every command.
#[derive(Args, Clone)]
#[command(next_help_heading = "Output")]
pub struct Global {
    /// What standard output carries: text for people, or one JSON document
    #[arg(
        long,
        value_enum,
        default_value_t,
        global = true,
        value_name = "FORMAT"
    )]
    format: Format,
    /// Colour of help and messages; auto: on a terminal, if NO_COLOR is not set
    #[arg(long, default_value_t, global = true, value_name = "WHEN")]
    color: ColorChoice,
    /// Nothing but results and errors: no progress, no notes, no warnings
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Report on standard error what a search or a training tries; results are the same
    #[arg(long, short, global = true)]
    verbose: bool,
}

/// Reads the command line; ends the program where it asks for help, or is no valid one.
pub fn parse<P: Parser>(name: &'static str) -> P {
    program::set(name, P::command);
    let matches = program::command()
        .color(color_in(std::env::args_os().skip(1)))
        .get_matches();
    P::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())
}

/// Makes ready for a command: how it speaks, the looks of errors, the journal.
pub fn start(options: &Global) {
    let terminal = Terminal {
        format: options.format,
        color: options.color,
        quiet: options.quiet,
    };
    terminal.set();
    let colour = terminal.is_coloured();
    // Fails only where a handler was set before.
    let _ = miette::set_hook(Box::new(move |_| Box::new(Compiler { colour })));
    let level = match (options.quiet, options.verbose) {
        (true, _) => tracing::Level::ERROR,
        (false, true) => tracing::Level::DEBUG,
        (false, false) => tracing::Level::WARN,
    };
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_ansi(colour)
        .with_max_level(level)
        .init();
}

/// Writes what a command found, tells its error, and makes the exit code of it.
pub fn finish(result: Result<()>) -> ExitCode {
    // What was found before an error is kept.
    let written = output::finish();
    match result.and(written) {
        Ok(()) => Exit::Done.into(),
        Err(error) => {
            if !is_unread(&error) {
                // Where standard error is closed, the exit code still tells.
                let _ = writeln!(std::io::stderr(), "{error:?}");
            }
            Exit::of(&error).into()
        }
    }
}
