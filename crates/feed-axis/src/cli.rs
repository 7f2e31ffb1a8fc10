//! What every program of these commands does before and after a command.

use std::io::Write;
use std::process::ExitCode;

use clap::Args;
use miette::Result;

use crate::diagnostic::Compiler;
use crate::program;

/// Options of every command.
#[derive(Args, Clone)]
pub struct Global {
    /// Say on stderr what a search or a training tries; results are the same
    #[arg(long, short, global = true)]
    verbose: bool,
}

/// Makes ready for a command: the program's name in messages, the looks of errors, the journal.
pub fn start(program: &'static str, options: &Global) {
    program::set_name(program);
    // Fails only where a handler was set before.
    let _ = miette::set_hook(Box::new(|_| Box::new(Compiler::for_terminal())));
    let level = if options.verbose {
        tracing::Level::DEBUG
    } else {
        tracing::Level::WARN
    };
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_max_level(level)
        .init();
}

/// Tells an error, and the exit code of a command.
pub fn finish(result: Result<()>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Where standard error is closed, the exit code still tells.
            let _ = writeln!(std::io::stderr(), "{error:?}");
            ExitCode::FAILURE
        }
    }
}
