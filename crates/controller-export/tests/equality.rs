//! The C code gives what the Rust code gives.

mod support;

use controller_export::EXPORTED;
use controller_export::c::Precision;
use support::program::{compare, compilers, write};
use support::{Outcome, laws, samples};

/// Cycles of a comparison: the full number for the strategies that together have every part.
fn cycles(name: &str) -> usize {
    match name {
        "network_lugre" | "transfer_function_lugre" | "feedback" => 1_000_000,
        _ => 100_000,
    }
}

/// Every strategy in both precisions, compiled by every compiler that there is, to the bit, over
/// cycles in which it is switched, trips and begins anew.
#[test]
fn c_is_rust() -> Outcome<()> {
    let compilers = compilers();
    if compilers.is_empty() {
        println!("skipped: neither gcc nor clang");
        return Ok(());
    }
    let axis = samples::axis()?;
    let predictors = laws::predictors(&axis)?;
    for &name in EXPORTED {
        let cycles = cycles(name);
        for precision in [Precision::F64, Precision::F32] {
            let folder = tempfile::tempdir()?;
            let source = write(folder.path(), &predictors, name, precision, cycles)?;
            for compiler in &compilers {
                let c = compare(folder.path(), compiler, name, &[])?;
                println!(
                    "{name:<24}{:<7}{compiler:<6} {c:?} {:?}",
                    precision.name(),
                    source.memory
                );
                assert_eq!((c.cycles, c.statuses), (cycles, 0), "{name}: {c:?}");
                assert_eq!(c.equal, cycles, "{name}: {c:?}");
                assert_eq!(c.state, source.memory.state, "{name}: {c:?}");
            }
        }
    }
    Ok(())
}
