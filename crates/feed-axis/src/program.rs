//! Which program this is, for results that depend on its code.

use std::sync::OnceLock;

use campaign::Inputs;
use clap::Command;

use crate::exit::Exit;

/// The program that runs.
struct Program {
    /// What the user types to run it.
    name: &'static str,
    /// Its whole command line.
    command: fn() -> Command,
}

static PROGRAM: OnceLock<Program> = OnceLock::new();

/// Says what the user types to run this program, and what its command line is made by; the
/// first call counts.
pub fn set(name: &'static str, command: fn() -> Command) {
    let _ = PROGRAM.set(Program { name, command });
}

/// What the user types to run this program, for messages that name a command.
pub fn name() -> &'static str {
    PROGRAM.get().map_or("feed-axis", |program| program.name)
}

/// The command line of this program, with what every help says at its end.
pub fn command() -> Command {
    let command = match PROGRAM.get() {
        Some(program) => (program.command)(),
        None => Command::new(name()),
    };
    command.after_long_help(Exit::help())
}

/// BLAKE3 of the sources from which this program was built.
const SOURCES: &str = env!("PROGRAM_SOURCES");
/// Compiler, target, instruction set and optimisation.
const COMPILER: &str = env!("PROGRAM_COMPILER");

/// The program as inputs of a job. Not the hash of the program's file: two machines that
/// build the same sources with the same compiler need not make the same bytes (paths), but
/// the program means the same.
pub fn inputs() -> Inputs {
    Inputs::default()
        .with("version", env!("CARGO_PKG_VERSION"))
        .with("sources", SOURCES)
        .with("compiler", COMPILER)
}

/// The program as one key.
pub fn key() -> String {
    inputs().key()
}
