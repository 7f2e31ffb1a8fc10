//! What every stage is told: axis, machine, folder, seed.

use std::fmt;
use std::fs::File;
use std::path::{Path, PathBuf};

use axis_pipeline::ErrorUnit;
use axis_sim::{Axis, AxisFileError, control_differences, toml_message};
use campaign::Inputs;
use clap::Args;
use miette::{
    Diagnostic, IntoDiagnostic, LabeledSpan, Report, Result, SourceCode, WrapErr, miette,
};
use serde::de::DeserializeOwned;

use crate::exit::{busy, wrong_use};
use crate::output::ready;
use crate::set_key::{SetKey, refused, with_keys};
use crate::{program, shell};

/// The axis file that commands take where none is given: the paper's, in the project's folder.
pub const DEFAULT_AXIS: &str = "data/axes/liu2025.toml";

/// Options of every stage.
#[derive(Args, Clone)]
pub struct Common {
    /// Axis file
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    pub axis: PathBuf,
    /// Set a key of the axis file to another value for this run, such as
    /// mechanism.table_mass_kg=415
    /// (may be repeated); the file of --machine keeps its own
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<SetKey>,
    /// Axis file of the simulated machine that stands for the real one [default: the one
    /// that the axis file names, or the axis itself]
    #[arg(long, value_name = "FILE")]
    pub machine: Option<PathBuf>,
    /// Folder for results [default: runs/, then the name of the axis]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Seed of everything random: the same seed gives the same bits
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Threads, 0 for all cores; results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// A small version of every stage, for trying out: fewer samples, a
    /// smaller network, fewer epochs and seeds; figures are rougher
    #[arg(long)]
    pub quick: bool,
}

/// The options, with the axis files read.
#[derive(Clone)]
pub struct Context {
    /// The model.
    pub axis: Axis,
    /// Its file.
    pub axis_file: PathBuf,
    /// The text of that, with the keys of `--set`.
    pub axis_text: String,
    /// What stands for the measured machine.
    pub machine: Axis,
    /// Whether the machine is another file than the axis.
    pub has_machine: bool,
    /// Folder for results.
    pub out: PathBuf,
    /// Seed of everything random.
    pub seed: u64,
    /// Threads, 0 for all cores.
    pub threads: usize,
    /// Whether every stage is made small.
    pub quick: bool,
    /// The options that results depend on, as a command that is to find these results needs
    /// them.
    pub options: Vec<String>,
}

impl Common {
    /// The options that results depend on, where they are not those that are taken anyway.
    fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        let mut give = |option: &str, value: String| words.extend([option.to_owned(), value]);
        let shown = |path: &Path| path.display().to_string();
        if self.axis != Path::new(DEFAULT_AXIS) {
            give("--axis", shown(&self.axis));
        }
        for key in &self.set {
            give("--set", key.to_string());
        }
        if let Some(file) = &self.machine {
            give("--machine", shown(file));
        }
        if let Some(folder) = &self.out {
            give("--out", shown(folder));
        }
        if self.seed != 1 {
            give("--seed", self.seed.to_string());
        }
        if self.quick {
            words.push("--quick".to_owned());
        }
        words
    }

    /// Reads the axis files and sets the number of threads.
    pub fn open(&self) -> Result<Context> {
        let axis = axis_with(&self.axis, &self.set)?;
        let machine_file = self.machine.clone().or_else(|| {
            let experiment = axis.experiment.as_ref();
            experiment.map(|experiment| experiment.machine.clone())
        });
        let machine = match &machine_file {
            Some(file) => read_axis(file)?,
            None => axis.clone(),
        };
        // A second call finds the pool built already, with the same number.
        let _ = rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .build_global();
        Ok(Context {
            out: self
                .out
                .clone()
                .unwrap_or_else(|| Path::new("runs").join(&axis.name)),
            has_machine: machine_file.is_some(),
            axis,
            axis_text: with_keys(&read_text(&self.axis)?, &self.set)?,
            axis_file: self.axis.clone(),
            machine,
            seed: self.seed,
            threads: self.threads,
            quick: self.quick,
            options: self.words(),
        })
    }
}

/// The right to write results to a run's folder: one process has it at a time, until it
/// drops this or ends, however it ends.
#[must_use]
pub struct Claim {
    _lock: File,
}

impl Context {
    /// Makes the run's folder and claims it for this process.
    pub fn claim(&self) -> Result<Claim> {
        ready(&self.out)?;
        let path = self.out.join("run.lock");
        let failed = || format!("cannot lock {}", path.display());
        let lock = campaign::try_lock(&path)
            .into_diagnostic()
            .wrap_err_with(failed)?;
        let lock = lock.ok_or_else(|| {
            busy(format!(
                "another run is at work in {}; wait for its end, or give another folder with --out",
                self.out.display()
            ))
        })?;
        Ok(Claim { _lock: lock })
    }

    /// Keys of the controller that the machine's file has otherwise than the axis file, in words.
    pub fn other_control(&self) -> Vec<String> {
        other_control(&self.axis, &self.machine)
    }

    /// Unit of the axis' errors.
    pub fn unit(&self) -> ErrorUnit {
        ErrorUnit::of(&self.axis)
    }

    /// The line of a shell that runs another command with these options.
    pub fn line(&self, command: &str) -> String {
        let words = [&[command.to_owned()][..], &self.options].concat();
        // The program's name may be two words, as of `cargo xtask`.
        format!("{} {}", program::name(), shell::line(&words))
    }

    /// Everything of these options that results depend on, and the program.
    pub fn inputs(&self) -> Inputs {
        program::inputs()
            .with("axis", &self.axis.fingerprint)
            .with("machine", &self.machine.fingerprint)
            .with("seed", self.seed)
    }
}

/// Reads an axis file.
///
/// # Errors
/// Wrong use, where the default is meant and is not there; what is wrong with the file.
pub fn read_axis(file: &Path) -> Result<Axis> {
    if file == Path::new(DEFAULT_AXIS) && !file.exists() {
        let program = program::name();
        return Err(wrong_use(format!(
            "--axis is missing, and its default, {DEFAULT_AXIS}, is not in this folder; \
             name a file with --axis FILE, or write one to begin with: `{program} new NAME --kind KIND`"
        )));
    }
    Axis::read(file).map_err(|error| match &error {
        AxisFileError::Field { field, what, .. }
            if field == "mechanism" && what == "is missing" =>
        {
            let program = program::name();
            let help =
                format!("`{program} new NAME --kind KIND` writes a whole axis file to begin with");
            Report::new(Helped { error, help })
        }
        _ => error.into(),
    })
}

/// Writes a warning for each of [`other_control`].
pub fn warn_of_control(f: &mut fmt::Formatter<'_>, differences: &[String]) -> fmt::Result {
    let mut all = differences.iter();
    all.try_for_each(|difference| writeln!(f, "  warning: {difference}"))
}

/// The axis of a file, with the keys that `--set` gives another value.
///
/// # Errors
/// As [`read_axis`]; wrong use, if the file is valid and the keys make no axis of it.
pub fn axis_with(file: &Path, set: &[SetKey]) -> Result<Axis> {
    let axis = read_axis(file)?;
    if set.is_empty() {
        return Ok(axis);
    }
    let own = read_text(file)?;
    let content = with_keys(&own, set)?;
    Axis::read_changed(file, &content).map_err(|error| match error {
        // The file by itself is valid, so a line of it is not to blame.
        AxisFileError::Field {
            field, what, valid, ..
        } => refused(set, &own, &field, &what, &valid),
        _ => error.into(),
    })
}

/// Keys of the controller that `machine` has otherwise than `axis`, each a sentence without its end.
pub fn other_control(axis: &Axis, machine: &Axis) -> Vec<String> {
    let all = control_differences(axis, machine);
    all.iter().map(ToString::to_string).collect()
}

/// The error of an axis file, with what helps.
#[derive(Debug)]
struct Helped {
    error: AxisFileError,
    help: String,
}

impl fmt::Display for Helped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl std::error::Error for Helped {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.error.source()
    }
}

impl Diagnostic for Helped {
    fn help(&self) -> Option<Box<dyn fmt::Display + '_>> {
        Some(Box::new(&self.help))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.error.source_code()
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.error.labels()
    }
}

/// A text in TOML as what it describes.
pub fn from_toml<T: DeserializeOwned>(text: &str) -> Result<T> {
    toml::from_str(text).map_err(|error| miette!("{}", toml_message(text, &error)))
}

/// Reads a text file, as [`axis_log::read_text`] does, naming it where that fails.
pub fn read_text(path: &Path) -> Result<String> {
    axis_log::read_text(path, None)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))
}
