//! `export fmu`: the axis as a unit that other simulators take up.

use std::fmt;
use std::path::{Path, PathBuf};

use axis_fmu::{FmiVersion, Unit, UnitCorrection, UnitKind, UnitLibrary, VariableKind};
use axis_pipeline::strategies::StrategyKind;
use axis_sim::SixDigits;
use clap::{Args, ValueEnum};
use controller_export::EXPORTED;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Serialize;

use super::controller::Results;
use crate::context::{read_axis, read_text};
use crate::out_file::{Force, spare};
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
    #[command(flatten)]
    force: Force,
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
    /// Library of units, of the same version; once for each platform that the unit is for, which
    /// the file's header says [default: the one beside this program]
    #[arg(long = "library", value_name = "FILE")]
    libraries: Vec<PathBuf>,
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
    platforms: Vec<String>,
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
            self.platforms.join(", "),
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
    spare(&options.out, options.force.force)?;
    // A file that is no axis is shown with the line at fault.
    let file = &options.results.axis;
    read_axis(file)?;
    let text = read_text(file)?;
    let name = file.display().to_string();
    let version = match options.fmi {
        Fmi::Two => FmiVersion::V2,
        Fmi::Three => FmiVersion::V3,
    };
    // First, so that what is wrong with the axis is told before what is missing beside it.
    let failed = || format!("no unit of {name}");
    let unit = unit(options, &name, &text).wrap_err_with(failed)?;
    let files = libraries(options)?;
    let contents = files.iter().map(|file| {
        let read = std::fs::read(file).into_diagnostic();
        read.wrap_err_with(|| format!("cannot read {}", file.display()))
    });
    let contents: Vec<Vec<u8>> = contents.collect::<Result<_>>()?;
    let known = files.iter().zip(&contents).map(|(file, bytes)| {
        let library = UnitLibrary::of(bytes);
        let library = library.and_then(|library| Ok((library, library.platform(version)?)));
        let with = || format!("no unit of {name} with {}", file.display());
        library.into_diagnostic().wrap_err_with(with)
    });
    let (libraries, platforms): (Vec<_>, Vec<_>) =
        known.collect::<Result<Vec<_>>>()?.into_iter().unzip();
    let bytes = axis_fmu::package(&unit, &libraries, version);
    let bytes = bytes.into_diagnostic().wrap_err_with(failed)?;
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
            platforms,
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

/// The libraries: as given, or the one beside this program.
fn libraries(options: &Options) -> Result<Vec<PathBuf>> {
    if !options.libraries.is_empty() {
        return Ok(options.libraries.clone());
    }
    let name = axis_fmu::library_file().into_diagnostic()?;
    let program = std::env::current_exe().into_diagnostic()?;
    let file = program.with_file_name(name);
    match file.is_file() {
        true => Ok(vec![file]),
        false => Err(miette!(
            "there is no library of units at {}: make it with `cargo build --release -p \
             feed-axis-fmu` from the sources of this version, and put it there or give it with \
             --library target/release/{}",
            file.display(),
            file.file_name().unwrap_or_default().to_string_lossy()
        )),
    }
}
