//! Every strategy in C with the cycles to prove it on, for compilers and targets elsewhere.
//!
//! `cargo run -p controller-export --example export_c -- FOLDER [CYCLES]` makes
//! `FOLDER/NAME-PRECISION/` with NAME.c, NAME.h, check.c and cases.bin. Compile the two C files and
//! run the program in that folder: it says how far its corrections are from Rust's.

#[path = "../tests/support/mod.rs"]
mod support;

use std::path::PathBuf;

use controller_export::EXPORTED;
use controller_export::c::Precision;
use support::{Outcome, laws, program, samples};

fn main() -> Outcome<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("usage: export_c FOLDER [CYCLES]")?);
    let cycles = arguments.next().map_or(Ok(20_000), |n| n.parse())?;
    let axis = samples::axis()?;
    let predictors = laws::predictors(&axis)?;
    for &name in EXPORTED {
        for precision in [Precision::F64, Precision::F32] {
            let folder = folder.join(format!("{name}-{}", precision.name()));
            let source = program::write(&folder, &predictors, name, precision, cycles)?;
            println!("{}: {:?}", folder.display(), source.memory);
        }
    }
    Ok(())
}
