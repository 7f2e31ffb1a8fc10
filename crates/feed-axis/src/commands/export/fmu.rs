//! `export fmu`: the axis as a unit that other simulators take up.

use std::fmt;
use std::path::{Path, PathBuf};

use axis_fmu::{FmiVersion, Unit, UnitCorrection, UnitKind, VariableKind};
use axis_pipeline::strategies::StrategyKind;
use axis_sim::SixDigits;
use clap::{Args, ValueEnum};
use controller_export::EXPORTED;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Serialize;

use super::controller::Results;
use crate::context::{read_axis, read_text};
use crate::output::{print, write_whole};
use crate::strategy_name::strategy_name_of;

/// Options of `export fmu`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    results: Results,
    /// The unit's file
    #[arg(long, value_name = "FILE.fmu")]
    out: PathBuf,
    /// Version of FMI: most programs import 2.0, fewer 3.0
    #[arg(long, value_name = "VERSION", default_value = "3")]
    fmi: Fmi,
    /// The machine alone, without control and current loops: motor torque, force or current in,
    /// motion out
    #[arg(long)]
    plant: bool,
    /// Strategy that corrects inside the unit. A network needs `train` first, transfer functions and
    /// identified friction need `identify`; plan and feedback need the axis file alone
    #[arg(long, value_name = "NAME", value_parser = strategy_name_of(EXPORTED), conflicts_with = "plant")]
    strategy: Option<&'static StrategyKind>,
    /// Library of units, of the same version [default: the one beside this program]
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,
}

/// Versions, as they are asked for.
#[derive(Clone, Copy, ValueEnum)]
enum Fmi {
    /// FMI 2.0
    #[value(name = "2", alias = "2.0")]
    Two,
    /// FMI 3.0
    #[value(name = "3", alias = "3.0")]
    Three,
}

/// What was written.
#[derive(Serialize)]
struct Exported<'a> {
    axis: &'a str,
    axis_fingerprint: &'a str,
    fmi_version: &'static str,
    interface: &'static str,
    kind: &'static str,
    strategy: Option<&'a str>,
    /// Control periods by which references are followed late.
    look_ahead_cycles: usize,
    platform: String,
    step_s: f64,
    inputs: usize,
    outputs: usize,
    parameters: usize,
    bytes: usize,
    out: &'a Path,
}

impl fmt::Display for Exported<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "FMI {} co-simulation unit of {} ({}) for {}: {} inputs, {} outputs, {} parameters, \
             control period {} s",
            self.fmi_version,
            self.axis,
            self.kind,
            self.platform,
            self.inputs,
            self.outputs,
            self.parameters,
            SixDigits(self.step_s),
        )?;
        if let Some(strategy) = self.strategy {
            let cycles = self.look_ahead_cycles;
            write!(
                f,
                "\ncorrected by {strategy}; references are followed {cycles} control periods late"
            )?;
        }
        write!(f, "\nwritten to {}", self.out.display())
    }
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    // A file that is no axis is shown with the line at fault.
    let file = &options.results.axis;
    read_axis(file)?;
    let text = read_text(file)?;
    let name = file.display().to_string();
    let version = match options.fmi {
        Fmi::Two => FmiVersion::V2,
        Fmi::Three => FmiVersion::V3,
    };
    let (platform, _) = axis_fmu::platform(version).into_diagnostic()?;
    // First, so that what is wrong with the axis is told before what is missing beside it.
    let failed = || format!("no unit of {name}");
    let unit = unit(options, &name, &text).wrap_err_with(failed)?;
    let file = library(options)?;
    let library = std::fs::read(&file).into_diagnostic();
    let library = library.wrap_err_with(|| format!("cannot read {}", file.display()))?;
    let package = axis_fmu::package(&unit, &library, version);
    let bytes = package
        .into_diagnostic()
        .wrap_err_with(|| format!("no unit of {name} with {}", file.display()))?;
    write_whole(&options.out, &bytes)?;
    let count = |is: fn(&VariableKind) -> bool| {
        let all = unit.variables().iter();
        all.filter(|variable| is(&variable.kind)).count()
    };
    print(
        "export-fmu",
        &Exported {
            axis: &unit.axis().name,
            axis_fingerprint: &unit.axis().fingerprint,
            fmi_version: version.number(),
            interface: "co-simulation",
            kind: unit.kind().words(),
            strategy: options.strategy.map(|strategy| strategy.name),
            look_ahead_cycles: unit.look_ahead(),
            platform,
            step_s: unit.axis().period,
            inputs: count(|kind| matches!(kind, VariableKind::Input(_))),
            outputs: count(|kind| matches!(kind, VariableKind::Output(_))),
            parameters: count(|kind| matches!(kind, VariableKind::Parameter { .. })),
            bytes: bytes.len(),
            out: &options.out,
        },
    )
}

/// The unit that is asked for.
fn unit(options: &Options, name: &str, text: &str) -> Result<Unit> {
    if let Some(strategy) = options.strategy {
        let predictors = options.results.predictors(strategy)?;
        let correction = UnitCorrection::of(&predictors, strategy.name).into_diagnostic()?;
        return Unit::compensated(name, text, correction.text()).into_diagnostic();
    }
    let kind = match options.plant {
        true => UnitKind::Plant,
        false => UnitKind::ClosedLoop,
    };
    Unit::of(kind, name, text).into_diagnostic()
}

/// The library: as given, or beside this program.
fn library(options: &Options) -> Result<PathBuf> {
    if let Some(file) = &options.library {
        return Ok(file.clone());
    }
    let name = axis_fmu::library_file().into_diagnostic()?;
    let program = std::env::current_exe().into_diagnostic()?;
    let file = program.with_file_name(name);
    match file.is_file() {
        true => Ok(file),
        false => Err(miette!(
            "there is no library of units at {}: make it with `cargo build --release -p \
             feed-axis-fmu` from the sources of this version, and put it there or give it with \
             --library target/release/{}",
            file.display(),
            file.file_name().unwrap_or_default().to_string_lossy()
        )),
    }
}
