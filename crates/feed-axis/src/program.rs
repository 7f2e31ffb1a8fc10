//! Which program this is, for results that depend on its code.

use std::sync::OnceLock;

use campaign::Inputs;

/// What the user types to run this program.
static NAME: OnceLock<&'static str> = OnceLock::new();

/// Says what the user types to run this program; the first call counts.
pub fn set_name(name: &'static str) {
    let _ = NAME.set(name);
}

/// What the user types to run this program, for messages that name a command.
pub fn name() -> &'static str {
    NAME.get().copied().unwrap_or("feed-axis")
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
