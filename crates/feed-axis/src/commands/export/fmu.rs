//! `export fmu`: the axis or machine as a unit that other simulators take up.

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
use crate::context::{DEFAULT_AXIS, read_axis, read_text};
use crate::exit::wrong_use;
use crate::out_file::{Force, spare};
use crate::output::{print, write_whole};
use crate::strategy_name::strategy_name_of;

/// Options of `export fmu`.
#[derive(Args)]
#[command(mut_arg("machine", |machine| machine.help(MACHINE).conflicts_with("plant")))]
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

/// What `--machine` is here.
const MACHINE: &str = "Machine file of two or three axes on one path: the unit holds all of them and the couplings between them. \
     With --strategy: axis file of the machine with which the results were made";

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
    axis_fingerprint: String,
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
    let version = match options.fmi {
        Fmi::Two => FmiVersion::V2,
        Fmi::Three => FmiVersion::V3,
    };
    // First, so that what is wrong with the axis is told before what is missing beside it.
    let (name, unit) = unit(options)?;
    let failed = || format!("no unit of {name}");
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
            axis: unit.name(),
            axis_fingerprint: unit.fingerprint(),
            fmi_version: version.number(),
            interface: "co-simulation",
            kind: unit.kind().words(),
            strategy: options.strategy.map(|strategy| strategy.name),
            look_ahead_cycles: unit.look_ahead(),
            platforms,
            step_s: unit.period(),
            inputs: count(|kind| matches!(kind, VariableKind::Input(_))),
            outputs: count(|kind| matches!(kind, VariableKind::Output(_))),
            parameters: count(VariableKind::is_of_file),
            bytes: bytes.len(),
            out: &options.out,
        },
    )
}

/// The unit that is asked for, and the name of its file.
fn unit(options: &Options) -> Result<(String, Unit)> {
    let (axis, machine) = (&options.results.axis, &options.results.machine);
    if let (Some(machine), None) = (machine, options.strategy) {
        if axis != Path::new(DEFAULT_AXIS) {
            return Err(wrong_use(format!(
                "--axis {} and --machine {}: a machine file names its axes; valid: --machine alone, or --strategy with both",
                axis.display(),
                machine.display()
            )));
        }
        let unit = Unit::machine(machine).into_diagnostic();
        let name = machine.display().to_string();
        return Ok((
            name.clone(),
            unit.wrap_err_with(|| format!("no unit of {name}"))?,
        ));
    }
    // A file that is no axis is shown with the line at fault.
    read_axis(axis)?;
    let (name, text) = (axis.display().to_string(), read_text(axis)?);
    let unit = of_axis(options, &name, &text).wrap_err_with(|| format!("no unit of {name}"))?;
    Ok((name, unit))
}

/// The same of an axis.
fn of_axis(options: &Options, name: &str, text: &str) -> Result<Unit> {
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
