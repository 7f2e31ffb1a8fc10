//! `export c`: a strategy as one C99 file with its header.

use std::fmt;
use std::path::Path;

use clap::{Args, ValueEnum};
use controller_export::c;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use super::controller;
use super::guard::Guard;
use crate::output::print;

/// Options of `export c`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    controller: controller::Options,
    /// The numbers of the C code
    #[arg(long, value_enum, default_value_t, value_name = "PRECISION")]
    precision: Precision,
}

/// The floating-point type of the C code.
#[derive(Clone, Copy, Default, ValueEnum)]
enum Precision {
    /// `float`, for controllers without double precision in hardware; corrections are
    /// coarser, the network's most (docs/controller-export.md)
    F32,
    /// `double`
    #[default]
    F64,
}

/// What was written.
#[derive(Serialize)]
struct Exported<'a> {
    axis: &'a str,
    axis_fingerprint: &'a str,
    strategy: &'a str,
    number: &'static str,
    period_s: f64,
    /// Of a plan: cycles by which set points must come ahead.
    look_ahead_cycles: Option<usize>,
    state_bytes: usize,
    constant_bytes: usize,
    greatest_array_bytes: usize,
    guard: Guard,
    #[serde(skip)]
    guard_words: String,
    /// Hash of all that went in.
    inputs: &'a str,
    files: [&'a str; 2],
    out: &'a Path,
}

impl fmt::Display for Exported<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} of {} in C99, {}: {} bytes of state, {} of constants, a greatest array of {} on the stack",
            self.strategy,
            self.axis,
            self.number,
            self.state_bytes,
            self.constant_bytes,
            self.greatest_array_bytes
        )?;
        if let Some(cycles) = self.look_ahead_cycles {
            writeln!(f, "  set points must come {cycles} control cycles ahead")?;
        }
        writeln!(f, "  {}", self.guard_words)?;
        let [header, source] = self.files;
        write!(f, "written to {}: {header}, {source}", self.out.display())
    }
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let made = options.controller.controller()?;
    let precision = match options.precision {
        Precision::F32 => c::Precision::F32,
        Precision::F64 => c::Precision::F64,
    };
    let controller = &made.controller;
    let code = c::export(controller, precision, None).into_diagnostic()?;
    options.controller.write(&[&code.source, &code.header])?;
    print(
        "export-c",
        &Exported {
            axis: &controller.axis,
            axis_fingerprint: &controller.fingerprint,
            strategy: &controller.strategy,
            number: precision.name(),
            period_s: controller.period,
            look_ahead_cycles: code.look_ahead,
            state_bytes: code.memory.state,
            constant_bytes: code.memory.constants,
            greatest_array_bytes: code.memory.greatest_array,
            guard: made.guard(),
            guard_words: made.words(),
            inputs: &code.hash,
            files: [&code.header.name, &code.source.name],
            out: &options.controller.out,
        },
    )
}
