//! A network as ONNX, with inputs and what Rust makes of them as raw `f64`, least byte first.
//!
//! `cargo run -p controller-export --example export_onnx -- FOLDER` makes network.onnx, x.bin (rows of
//! four) and y.bin.

#[path = "../tests/support/mod.rs"]
mod support;

use std::path::PathBuf;

use controller_export::onnx;
use support::{Outcome, laws, samples};

fn main() -> Outcome<()> {
    let folder = std::env::args().nth(1);
    let folder = PathBuf::from(folder.ok_or("usage: export_onnx FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let axis = samples::axis()?;
    let predictors = laws::predictors(&axis)?;
    let (x, y) = laws::network_cases(&axis, &laws::network(&axis)?, 100_000)?;
    let bytes =
        |values: &[f64]| -> Vec<u8> { values.iter().flat_map(|v| v.to_le_bytes()).collect() };
    std::fs::write(folder.join("network.onnx"), onnx::one_cycle(&predictors)?)?;
    std::fs::write(folder.join("x.bin"), bytes(&x))?;
    std::fs::write(folder.join("y.bin"), bytes(&y))?;
    Ok(())
}
