//! `train`: the one-cycle network.

use std::path::Path;

use axis_pipeline::measured::Rms;
use axis_pipeline::training::{INITIAL_DAMPING, NetworkPlan, Trained, test, train};
use axis_pipeline::{ErrorUnit, Figures, LinearMap};
use cfnn::Network;
use cfnn::artifact::{
    checkpoint_from_bytes, checkpoint_to_bytes, network_from_bytes, network_to_bytes,
};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};

use super::sample;
use crate::context::{Common, Context};
use crate::output::{Worded, print, write_whole};
use crate::program;
use crate::progress::bar;
use crate::store::Stage;

const NETWORK: &str = "network.cfnn";
const TRAINING: &str = "training.json";
const CHECKPOINT: &str = "checkpoint.cfnn";
/// Epochs from one checkpoint to the next.
const CHECKPOINT_EVERY: usize = 25;

/// What a training showed.
#[derive(Serialize, Deserialize)]
pub struct Training {
    /// Neurons of each hidden layer.
    pub hidden: Vec<usize>,
    /// Epochs of the training.
    pub epochs: usize,
    /// Damping that the training began with (Levenberg-Marquardt).
    pub initial_damping: f64,
    /// Samples it was trained on.
    pub train_samples: usize,
    /// Samples it has not seen.
    pub test_samples: usize,
    /// Unit of the errors.
    pub unit: ErrorUnit,
    /// Errors on the unseen samples.
    pub network: Figures,
    /// Errors there of the best linear map of as many evenly spread samples.
    pub linear: Figures,
    /// Errors of the network on its own training samples.
    pub seen: Figures,
    /// Root mean square over the training samples after each epoch.
    #[serde(flatten)]
    pub rms: Rms<Vec<f64>>,
    /// Time of the training, s.
    pub seconds: f64,
}

/// Runs the command.
pub fn command(common: &Common) -> Result<()> {
    let context = common.open()?;
    let _claim = context.claim()?;
    run(&context)
}

/// The stage, for this context.
pub fn stage(context: &Context) -> Stage<'_> {
    let settings = format!(
        "{:?}",
        NetworkPlan {
            threads: 0,
            ..plan(context)
        }
    );
    let (files, after) = (&[NETWORK, TRAINING], [&sample::stage(context)]);
    Stage::new(context, "train", files, &settings, &after).with_scratch(&[CHECKPOINT])
}

/// Runs the stage; goes on from a checkpoint where one is left.
pub fn run(context: &Context) -> Result<()> {
    let stage = stage(context);
    let [seen, even, unseen] = sample::load(context)?;
    stage.begin()?;
    let plan = plan(context);
    let progress = bar("train", plan.epochs as u64);
    let checkpoint_path = stage.path(CHECKPOINT);
    let checkpoint = std::fs::read(&checkpoint_path)
        .ok()
        .and_then(|bytes| checkpoint_from_bytes(&bytes).ok())
        .filter(|(_, made_for)| made_for == stage.key())
        .map(|(checkpoint, _)| checkpoint);

    let mut unsaved = false;
    let trained = train(
        &axis_pipeline::sampling::ranges(&context.axis).into_diagnostic()?,
        &seen,
        &plan,
        checkpoint,
        |report, trainer| {
            progress.set_position(report.epoch as u64);
            if report.epoch % CHECKPOINT_EVERY == 0 && !unsaved {
                let saved = checkpoint_to_bytes(&trainer.checkpoint(), stage.key())
                    .into_diagnostic()
                    .and_then(|bytes| write_whole(&checkpoint_path, &bytes));
                // Only a help for a killed training: the training itself goes on.
                if let Err(e) = saved {
                    tracing::warn!("no more checkpoints: {e:#}");
                    unsaved = true;
                }
            }
        },
    )
    .into_diagnostic()?;
    progress.finish_and_clear();

    let training = Training {
        hidden: plan.hidden.clone(),
        epochs: trained.history.len(),
        initial_damping: plan.initial_damping,
        train_samples: seen.inputs.len(),
        test_samples: unseen.inputs.len(),
        unit: context.unit(),
        network: test(&trained.network, &unseen).into_diagnostic()?,
        linear: LinearMap::fit(&even)
            .and_then(|map| map.errors(&unseen))
            .into_diagnostic()?,
        seen: test(&trained.network, &seen).into_diagnostic()?,
        rms: Rms::new(context.unit(), rms(&trained)),
        seconds: trained.seconds,
    };
    let provenance = &context.axis.fingerprint;
    let bytes = network_to_bytes(&trained.network, provenance).into_diagnostic()?;
    write_whole(&stage.path(NETWORK), &bytes)?;
    stage.write_json(TRAINING, &training)?;
    stage.finish()?;
    let text = format!(
        "train: {} epochs in {:.1} s; unseen samples max {:.2e} {unit}, mean {:.2e} {unit} (linear map {:.2e}, {:.2e})",
        training.epochs,
        training.seconds,
        training.network.max,
        training.network.mean,
        training.linear.max,
        training.linear.mean,
        unit = training.unit
    );
    let value = training;
    print("train", &Worded { text, value })
}

/// The network of a finished stage.
pub fn load_network(context: &Context) -> Result<Network> {
    let stage = stage(context);
    let path = stage.path(NETWORK);
    let (network, made_from) = network(&stage.read(NETWORK)?, &path)?;
    if made_from == context.axis.fingerprint {
        return Ok(network);
    }
    Err(miette!(
        "{} was made from another axis file",
        path.display()
    ))
}

/// The network in the bytes of the file `path`, and what it was made from.
pub fn network(bytes: &[u8], path: &Path) -> Result<(Network, String)> {
    let refused = || {
        format!(
            "{} is not a network that this version reads; run `{} train` again",
            path.display(),
            program::name()
        )
    };
    let read = network_from_bytes(bytes).into_diagnostic();
    read.wrap_err_with(refused)
}

/// What a finished stage showed.
pub fn load_training(context: &Context) -> Result<Training> {
    stage(context).read_json(TRAINING)
}

fn rms(trained: &Trained) -> Vec<f64> {
    let unit = 1e6 * trained.residual_scale;
    let reports = trained.history.iter();
    reports.map(|report| unit * report.loss.sqrt()).collect()
}

fn plan(context: &Context) -> NetworkPlan {
    let (hidden, epochs) = if context.quick {
        (vec![14, 8, 4], 150)
    } else {
        (vec![34, 19, 8], 500)
    };
    NetworkPlan {
        hidden,
        epochs,
        initial_damping: INITIAL_DAMPING,
        seed: context.seed,
        threads: context.threads,
    }
}
