//! `identify`: friction from logs of an axis or of a simulated machine, transfer function from
//! the model.

mod axis_file;
mod friction;
mod from_logs;
mod simulated;
mod words;

use std::path::PathBuf;

use axis_pipeline::measured::{TrainingRms, ValidationRms};
use axis_pipeline::transfer::{TransferPlan, identify_transfer};
use axis_sim::Axis;
use clap::Args;
use compensator::TransferFunctionModel;
use lugre::LuGre;
use miette::{IntoDiagnostic, Result, miette};
use serde::{Deserialize, Serialize};

pub use self::friction::{Found, Friction, RunPoint, SmallMotionPoint};
use self::simulated::{PRESLIDING, SPEEDS};
use self::words::Identified;
use crate::context::{Common, Context};
use crate::output::{print, remove, write_whole};
use crate::progress::bar;
use crate::store::Stage;

const FRICTION: &str = "friction.json";
pub(super) const TRANSFER: &str = "transfer_functions.json";

/// Options of the command.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Logs of the axis at constant speeds in both directions and of small motions about a
    /// standstill, in any format that `log inspect` reads; a log in several files as their paths
    /// with + between. Without any, both are simulated and kept beside the results
    #[arg(long, value_name = "LOG", num_args = 1..)]
    log: Vec<PathBuf>,
}

/// The transfer function as identified.
#[derive(Serialize, Deserialize)]
pub struct Transfer {
    /// Control period, s.
    pub period: f64,
    /// Direct feed-through, s².
    pub direct: f64,
    /// Real poles, of z.
    pub poles: Vec<f64>,
    /// Coefficient of each pole, s².
    pub coefficients: Vec<f64>,
    /// RMS of what it misses on the motions it was fitted to.
    #[serde(flatten)]
    pub training_rms: TrainingRms<f64>,
    /// RMS of what it misses on other motions.
    #[serde(flatten)]
    pub validation_rms: ValidationRms<f64>,
    /// How many candidates were tried.
    pub candidates: usize,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let context = options.common.open()?;
    let _claim = context.claim()?;
    if options.log.is_empty() {
        // Asked for without logs: what an earlier run was told is over.
        remove(&from_logs::list(&context))?;
        return run(&context);
    }
    let found = from_logs::identify(&context, &options.log)?;
    from_logs::remember(&context, &options.log)?;
    finish(&context, &found)
}

/// The stage, for this context: from the logs that it was last given, where there were any.
pub fn stage(context: &Context) -> Stage<'_> {
    let machine = &context.machine.fingerprint;
    let transfer = transfer_plan(context);
    match from_logs::remembered(context) {
        Some(logs) => {
            let settings = format!("{transfer:?} {logs}");
            let files = &[FRICTION, TRANSFER, axis_file::NAME, from_logs::LIST];
            Stage::new(context, "identify", files, &settings, &[])
        }
        None => {
            let plan = simulated::plan(context);
            let settings = format!("{plan:?} {transfer:?} {machine}");
            let files = &[FRICTION, TRANSFER, axis_file::NAME, SPEEDS, PRESLIDING];
            Stage::new(context, "identify", files, &settings, &[])
        }
    }
}

/// Runs the stage: from the logs that it was last given, or else on the simulated machine.
pub fn run(context: &Context) -> Result<()> {
    if from_logs::remembered(context).is_some() {
        let found = from_logs::again(context)?;
        return finish(context, &found);
    }
    let stage = stage(context);
    stage.begin()?;
    let found = simulated::identify(context, &stage)?;
    finish(context, &found)
}

/// Writes the friction, by itself and in the axis file, and finds the transfer functions beside it.
fn finish(context: &Context, found: &Friction) -> Result<()> {
    let stage = stage(context);
    stage.begin()?;
    stage.write_json(FRICTION, found)?;
    let axis_file = stage.path(axis_file::NAME);
    let text = axis_file::with_friction(context, &stage.path(""), found)?;
    write_whole(&axis_file, text.as_bytes())?;
    let fits = transfer(context)?;
    stage.write_json(TRANSFER, &fits)?;
    stage.finish()?;
    let identified = Identified {
        units: context.axis.friction.at.units(),
        friction: found,
        transfer_functions: &fits,
        lacks: lacks_for_transfer(&context.axis),
        axis_file,
    };
    print("identify", &identified)
}

/// What an axis file must have for a transfer function of the tracking error, and this one has not.
fn lacks_for_transfer(axis: &Axis) -> Option<&'static str> {
    if !axis.has_control() {
        Some("[control]")
    } else if axis.trajectories.is_empty() {
        Some("[[trajectory]]")
    } else {
        None
    }
}

/// The transfer functions without and with friction feed-forward; none of an axis whose file lacks
/// what they need.
fn transfer(context: &Context) -> Result<Vec<Transfer>> {
    if lacks_for_transfer(&context.axis).is_some() {
        return Ok(Vec::new());
    }
    let plan = transfer_plan(context);
    let progress = bar("transfer", 2 * (plan.training + plan.validation) as u64);
    let unit = context.unit();
    let fit = |feedforward| {
        let fit = identify_transfer(&context.axis, &plan, feedforward, || progress.inc(1))
            .into_diagnostic()?;
        Ok::<_, miette::Report>(Transfer {
            period: fit.model.period(),
            direct: fit.model.direct(),
            poles: fit.model.poles().to_vec(),
            coefficients: fit.model.coefficients().to_vec(),
            training_rms: TrainingRms::new(unit, 1e6 * fit.chosen.training_rms),
            validation_rms: ValidationRms::new(unit, 1e6 * fit.chosen.validation_rms),
            candidates: fit.trials.len(),
        })
    };
    let fits = vec![fit(false)?, fit(true)?];
    progress.finish_and_clear();
    Ok(fits)
}

/// The friction of a finished stage.
pub fn load_friction(context: &Context) -> Result<(Friction, LuGre)> {
    let friction: Friction = stage(context).read_json(FRICTION)?;
    let law = LuGre::new(friction.parameters()).into_diagnostic()?;
    Ok((friction, law))
}

/// The transfer functions of a finished stage, without and with friction feed-forward.
pub fn load_transfer(context: &Context) -> Result<([Transfer; 2], [TransferFunctionModel; 2])> {
    let fits: Vec<Transfer> = stage(context).read_json(TRANSFER)?;
    let fits: [Transfer; 2] = fits.try_into().map_err(|_| {
        let lacks = lacks_for_transfer(&context.axis).unwrap_or("[control]");
        miette!("the axis has no {lacks}, so no transfer function of its tracking error was identified; valid: strategies without one, or an axis file with {lacks}")
    })?;
    let model = |t: &Transfer| {
        TransferFunctionModel::new(t.period, t.direct, &t.poles, &t.coefficients).into_diagnostic()
    };
    let models = [model(&fits[0])?, model(&fits[1])?];
    Ok((fits, models))
}

fn transfer_plan(context: &Context) -> TransferPlan {
    let mut plan = TransferPlan {
        seed: context.seed,
        ..TransferPlan::default()
    };
    if context.quick {
        plan.training = 3;
        plan.validation = 2;
    }
    plan
}
