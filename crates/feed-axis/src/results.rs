//! Results of all stages together: what the report shows.

use miette::{Result, miette};
use pipeline::compensation::{CompensatedRun, find};
use pipeline::strategies::{STRATEGIES, StrategyKind};
use pipeline::study::StudyRow;
use pipeline::summary::{self, NetworkSummary, Summary};
use pipeline::validation::Validation;

use crate::commands::identify::{Friction, Transfer};
use crate::commands::train::Training;
use crate::commands::{compensate, identify, study, train, validate};
use crate::context::Context;
use crate::{paper, program};

/// Everything that the page shows.
pub struct Results {
    pub summary: Summary,
    pub training: Training,
    pub friction: Friction,
    pub friction_law: lugre::LuGre,
    /// Without and with friction feed-forward.
    pub transfer: [Transfer; 2],
    pub validation: Validation,
    pub compensation: Vec<CompensatedRun>,
    pub study: Vec<StudyRow>,
    pub paper: Option<paper::Tables>,
}

/// Reads the results of all finished stages.
pub fn gather(context: &Context) -> Result<Results> {
    let validation = validate::load(context)?;
    let compensation = compensate::load(context)?;
    let training = train::load_training(context)?;
    let (friction, friction_law) = identify::load_friction(context)?;
    let (transfer, _) = identify::load_transfer(context)?;
    let folder = context.axis.experiment.as_ref();
    let folder = folder.and_then(|experiment| experiment.paper_tables.as_ref());
    let paper = folder.map(|folder| paper::read(folder)).transpose()?;
    Ok(Results {
        summary: summarise(context, &validation, &compensation, &training)?,
        study: study::load(context)?,
        training,
        friction,
        friction_law,
        transfer,
        validation,
        compensation,
        paper,
    })
}

fn summarise(
    context: &Context,
    validation: &Validation,
    compensation: &[CompensatedRun],
    training: &Training,
) -> Result<Summary> {
    for t in &validation.trajectories {
        let without = |kind: &&&StrategyKind| find(compensation, t.id, kind.name).is_none();
        if let Some(kind) = STRATEGIES.iter().find(without) {
            return Err(miette!(
                "trajectory {} was not compensated with \"{}\"; run `{} compensate`",
                t.id,
                kind.label,
                program::name()
            ));
        }
    }
    Ok(Summary {
        schema: Summary::SCHEMA,
        axis: context.axis.name.clone(),
        axis_fingerprint: context.axis.fingerprint.clone(),
        machine: context.machine.name.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: context.seed,
        quick: context.quick,
        trajectories: summary::trajectories(validation, compensation),
        network: NetworkSummary {
            hidden: training.hidden.clone(),
            epochs: training.epochs,
            train_samples: training.train_samples,
            test_samples: training.test_samples,
            max_abs_error_um: training.network.max,
            mean_abs_error_um: training.network.mean,
            linear_max_abs_error_um: training.linear.max,
            linear_mean_abs_error_um: training.linear.mean,
            train_seconds: training.seconds,
        },
    })
}
