//! `export onnx`: the trained network for other programs.

use std::fmt;
use std::path::{Path, PathBuf};

use axis_pipeline::strategies::Need;
use clap::Args;
use controller_export::onnx;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use super::controller;
use crate::commands::validate;
use crate::out_file::{Force, spare};
use crate::output::{print, write_whole};

/// Options of `export onnx`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    results: controller::Results,
    /// The network's file
    #[arg(long, value_name = "FILE.onnx")]
    out: PathBuf,
    #[command(flatten)]
    force: Force,
}

/// What was written.
#[derive(Serialize)]
struct Exported<'a> {
    axis: &'a str,
    axis_fingerprint: &'a str,
    opset: i64,
    bytes: usize,
    out: &'a Path,
}

impl fmt::Display for Exported<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "one-cycle network of {} as ONNX, opset {}, numbers in f64 and SI units\n\
             written to {}",
            self.axis,
            self.opset,
            self.out.display()
        )
    }
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    spare(&options.out, options.force.force)?;
    let context = options.results.open()?;
    let predictors = validate::predictors(&context, &[Need::Network])?;
    let bytes = onnx::one_cycle(&predictors).into_diagnostic()?;
    write_whole(&options.out, &bytes)?;
    print(
        "export-onnx",
        &Exported {
            axis: &context.axis.name,
            axis_fingerprint: &context.axis.fingerprint,
            opset: onnx::OPSET,
            bytes: bytes.len(),
            out: &options.out,
        },
    )
}
