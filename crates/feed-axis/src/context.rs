//! What every stage is told: axis, machine, folder, seed.

use std::fs::File;
use std::path::{Path, PathBuf};

use axis_pipeline::ErrorUnit;
use axis_sim::Axis;
use campaign::Inputs;
use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr};

use crate::exit::{busy, wrong_use};
use crate::output::ready;
use crate::set_key::{SetKey, with_keys};

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
}

impl Common {
    /// Reads the axis files and sets the number of threads.
    pub fn open(&self) -> Result<Context> {
        let mut axis = read_axis(&self.axis)?;
        if !self.set.is_empty() {
            let content = with_keys(&read_text(&self.axis)?, &self.set)?;
            axis = Axis::read_changed(&self.axis, &content)?;
        }
        let machine_file = self.machine.clone().or_else(|| {
            let experiment = axis.experiment.as_ref();
            experiment.map(|experiment| experiment.machine.clone())
        });
        let machine = match &machine_file {
            Some(file) => Axis::read(file)?,
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
            machine,
            seed: self.seed,
            threads: self.threads,
            quick: self.quick,
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

    /// Unit of the axis' errors.
    pub fn unit(&self) -> ErrorUnit {
        ErrorUnit::of(&self.axis)
    }

    /// Everything of these options that results depend on, and the program.
    pub fn inputs(&self) -> Inputs {
        crate::program::inputs()
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
        let program = crate::program::name();
        return Err(wrong_use(format!(
            "no axis file is given, and {DEFAULT_AXIS}, which is taken then, is not in this folder; \
             give one with --axis FILE, or write one to begin with: `{program} new NAME --kind KIND`"
        )));
    }
    Ok(Axis::read(file)?)
}

/// Reads a text file, naming it where that fails.
pub fn read_text(path: &Path) -> Result<String> {
    std::fs::read_to_string(path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))
}
