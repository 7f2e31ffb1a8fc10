//! Which program this is, for results that depend on its code.

use campaign::Inputs;

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
