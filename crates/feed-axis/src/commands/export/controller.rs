//! What the exports for controllers share: the results that they are made of, the strategy,
//! the folder.

use std::path::PathBuf;

use axis_pipeline::strategies::{Predictors, StrategyKind};
use clap::Args;
use compensator::GuardLimits;
use controller_export::{EXPORTED, ExportError, ExportedController, NamedText};
use miette::{IntoDiagnostic, Result, WrapErr};

use super::guard::{self, Guarded};
use crate::commands::validate;
use crate::context::{Common, Context, DEFAULT_AXIS};
use crate::exit::wrong_use;
use crate::file_set::FileSet;
use crate::out_file::Force;
use crate::strategy_name::strategy_name_of;

/// Valid limits while those of the export are not known.
const UNTIL_KNOWN: GuardLimits = GuardLimits {
    position: 1.0,
    effort: 1.0,
    surprise: 1.0,
    patience: 0,
    fade: 0,
};

/// Where the trained network and the identified friction are.
#[derive(Args)]
#[group(id = "results-options")]
pub struct Results {
    /// Axis file
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    pub axis: PathBuf,
    /// Axis file of the machine with which the results were made [default: the one that the axis
    /// file names, or the axis itself]
    #[arg(long, value_name = "FILE")]
    pub machine: Option<PathBuf>,
    /// Folder with the results of `train` and `identify`, their --out [default: runs/,
    /// then the name of the axis]
    #[arg(long, value_name = "DIR")]
    run: Option<PathBuf>,
    /// Seed that the results were made with
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// The results were made with --quick
    #[arg(long)]
    quick: bool,
}

impl Results {
    /// Reads the axis files.
    pub fn open(&self) -> Result<Context> {
        let common = Common {
            axis: self.axis.clone(),
            set: Vec::new(),
            machine: self.machine.clone(),
            out: self.run.clone(),
            seed: self.seed,
            threads: 0,
            quick: self.quick,
        };
        common.open()
    }

    /// What the strategy is made of.
    pub fn predictors(&self, strategy: &StrategyKind) -> Result<Predictors> {
        // Before results are asked for, which would not help.
        controller_export::exportable(strategy.name).map_err(refused)?;
        validate::predictors(&self.open()?, strategy.needs)
    }
}

/// What is exported, and what its guard keeps to.
#[derive(Args)]
#[group(id = "controller-options")]
pub struct Options {
    #[command(flatten)]
    results: Results,
    /// Strategy that the controller runs. A network needs `train` first, transfer functions and
    /// identified friction need `identify`; plan and feedback need the axis file alone
    #[arg(long, value_name = "NAME", value_parser = strategy_name_of(EXPORTED))]
    strategy: &'static StrategyKind,
    /// Name of the files, and of all types and functions in them: several axes in one
    /// firmware have one each [default: that of the strategy]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    #[command(flatten)]
    limits: guard::Options,
    /// Folder for the files
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    #[command(flatten)]
    force: Force,
}

impl Options {
    /// The compensator behind its guard, and what its limits are made of.
    pub fn controller(&self) -> Result<Guarded> {
        let name = self.strategy.name;
        // Before results are asked for, which would not help.
        controller_export::exportable(name).map_err(refused)?;
        let context = self.results.open()?;
        let predictors = validate::predictors(&context, self.strategy.needs)?;
        let failed = || format!("no export of {name} for {}", self.results.axis.display());
        let made = ExportedController::of(&predictors, name, UNTIL_KNOWN).into_diagnostic();
        let mut controller = made.wrap_err_with(failed)?;
        let simulated = self.limits.simulated(&context, &predictors, self.strategy);
        let simulated = simulated.wrap_err_with(failed)?;
        if let Some(name) = &self.name {
            let named = controller.named(name);
            controller = named.map_err(|error| wrong_use(format!("--name: {error}")))?;
        }
        controller.limits = self.limits.of(simulated, &context.axis);
        Ok(Guarded {
            controller,
            is_simulated: simulated.is_some(),
        })
    }

    /// Writes texts into the folder, each whole. The first is removed before and written last,
    /// so that it never stands beside others of another export.
    pub fn write(&self, texts: &[&NamedText]) -> Result<()> {
        let last_first = || texts.iter().rev();
        let names: Vec<&str> = last_first().map(|text| &*text.name).collect();
        self.force.spare_in(&self.out, &names)?;
        let mut files = FileSet::new(&self.out, &names)?;
        last_first().try_for_each(|text| files.put(&text.name, text.text.as_bytes()))?;
        files.publish()
    }
}

/// Names as the option takes them.
fn refused(error: ExportError) -> miette::Report {
    wrong_use(format!("--strategy: {error}").replace('_', "-"))
}
