use std::string::String;
use std::vec::Vec;

use serde::{Deserialize, Serialize};

use super::frame::{self, Format};
use super::{ArchitectureV2, ArtifactError, NetworkV1, content, encode, plain, size};
use crate::error::{all_finite, same_length};
use crate::train::{
    Bayesian, Best, Checkpoint, EarlyStopping, EpochReport, Hyperparameters, Initialisation,
    Normalisation, TrainingSettings,
};
use crate::{Error, Network};

const CHECKPOINT: Format = Format {
    kind: *b"CHKP",
    schema: 2,
};

/// Schema 1 of a checkpoint. Field order is the format.
#[derive(Debug, Serialize, Deserialize)]
struct CheckpointV1 {
    settings: SettingsV1,
    current: NetworkV1,
    damping: f64,
    best: Option<(Vec<f64>, f64, u64)>,
    history: Vec<EpochV1>,
    fingerprint: u64,
}

#[derive(Debug, Serialize, Deserialize)]
struct SettingsV1 {
    epochs: u64,
    initial_damping: f64,
    damping_increase: f64,
    damping_decrease: f64,
    max_damping: f64,
    goal: f64,
    min_gradient: f64,
    validation: Option<(f64, u64)>,
    normalisation: u8,
    initialisation: (u8, f64),
    resolve_output: bool,
    seed: u64,
    threads: u64,
}

#[derive(Debug, Serialize, Deserialize)]
struct EpochV1 {
    epoch: u64,
    loss: f64,
    validation_loss: Option<f64>,
    gradient: f64,
    damping: f64,
    trials: u64,
}

/// Schema 2: what schema 1 cannot hold, and that.
#[derive(Debug, Serialize, Deserialize)]
struct CheckpointV2 {
    architecture: ArchitectureV2,
    caller_pool: bool,
    /// Tolerance, and the share below which there are new estimates.
    bayesian: Option<(f64, f64)>,
    hyperparameters: Option<HyperparametersV2>,
    /// One for each epoch.
    history: Vec<Option<HyperparametersV2>>,
    plain: CheckpointV1,
}

/// α, β, γ.
type HyperparametersV2 = (f64, f64, f64);

/// The bytes of a checkpoint.
///
/// # Errors
/// As [`super::network_to_bytes`].
pub fn checkpoint_to_bytes(
    checkpoint: &Checkpoint,
    provenance: &str,
) -> Result<Vec<u8>, ArtifactError> {
    let settings = &checkpoint.settings;
    let usual = settings.bayesian.is_none() && !settings.caller_pool;
    let estimated = checkpoint.hyperparameters.is_some()
        || (checkpoint.history.iter()).any(|report| report.hyperparameters.is_some());
    if plain(&checkpoint.current) && usual && !estimated {
        encode(
            CHECKPOINT.older(1),
            CheckpointV1::from(checkpoint),
            provenance,
        )
    } else {
        encode(CHECKPOINT, CheckpointV2::from(checkpoint), provenance)
    }
}

/// A checkpoint and its provenance from bytes.
///
/// # Errors
/// As [`super::network_from_bytes`].
pub fn checkpoint_from_bytes(bytes: &[u8]) -> Result<(Checkpoint, String), ArtifactError> {
    match frame::unwrap(CHECKPOINT, bytes)? {
        (1, payload) => content::<CheckpointV1, _>(payload),
        (_, payload) => content::<CheckpointV2, _>(payload),
    }
}

impl From<&Checkpoint> for CheckpointV1 {
    fn from(checkpoint: &Checkpoint) -> Self {
        let best = checkpoint.best.as_ref();
        Self {
            settings: SettingsV1::from(&checkpoint.settings),
            current: NetworkV1::from(&checkpoint.current),
            damping: checkpoint.damping,
            best: best.map(|b| (b.weights.clone(), b.loss, b.age as u64)),
            history: checkpoint.history.iter().map(EpochV1::from).collect(),
            fingerprint: checkpoint.fingerprint,
        }
    }
}

impl From<&Checkpoint> for CheckpointV2 {
    fn from(checkpoint: &Checkpoint) -> Self {
        let stored = |h: Hyperparameters| (h.alpha, h.beta, h.effective_parameters);
        let reports = checkpoint.history.iter();
        Self {
            architecture: checkpoint.current.architecture().into(),
            caller_pool: checkpoint.settings.caller_pool,
            bayesian: checkpoint
                .settings
                .bayesian
                .map(|b| (b.tolerance, b.estimate_below)),
            hyperparameters: checkpoint.hyperparameters.map(stored),
            history: reports.map(|r| r.hyperparameters.map(stored)).collect(),
            plain: CheckpointV1::from(checkpoint),
        }
    }
}

/// Finite and above zero (the number of parameters may be zero), as an update
/// leaves them.
fn hyperparameters(stored: Option<HyperparametersV2>) -> Result<Option<Hyperparameters>, Error> {
    let Some((alpha, beta, effective_parameters)) = stored else {
        return Ok(None);
    };
    for (name, value, least) in [
        ("alpha", alpha, f64::MIN_POSITIVE),
        ("beta", beta, f64::MIN_POSITIVE),
        ("effective_parameters", effective_parameters, 0.0),
    ] {
        if !(value >= least && value.is_finite()) {
            return Err(Error::Setting {
                name,
                value,
                valid: "finite and above 0 (the number of parameters: 0 or above)",
            });
        }
    }
    Ok(Some(Hyperparameters {
        alpha,
        beta,
        effective_parameters,
    }))
}

impl TryFrom<CheckpointV2> for Checkpoint {
    type Error = Error;

    fn try_from(stored: CheckpointV2) -> Result<Self, Error> {
        let mut whole = Self::try_from(stored.plain)?;
        whole.current = stored.architecture.applied_to(&whole.current)?;
        if let Some(best) = &whole.best {
            // Refused if a link that is not there has a weight.
            let Checkpoint { current, .. } = &whole;
            let (architecture, scaling) = (current.architecture().clone(), current.scaling());
            Network::new(architecture, scaling.clone(), best.weights.clone())?;
        }
        same_length("history", stored.history.len(), whole.history.len())?;
        for (report, estimated) in whole.history.iter_mut().zip(stored.history) {
            report.hyperparameters = hyperparameters(estimated)?;
        }
        whole.hyperparameters = hyperparameters(stored.hyperparameters)?;
        whole.settings.caller_pool = stored.caller_pool;
        whole.settings.bayesian = stored.bayesian.map(|(tolerance, estimate_below)| Bayesian {
            tolerance,
            estimate_below,
        });
        whole.settings.validate()?;
        Ok(whole)
    }
}

impl TryFrom<CheckpointV1> for Checkpoint {
    type Error = Error;

    fn try_from(stored: CheckpointV1) -> Result<Self, Error> {
        let settings = TrainingSettings::try_from(stored.settings)?;
        let current = Network::try_from(stored.current)?;
        if let Some((weights, _, _)) = &stored.best {
            same_length("best weights", weights.len(), current.weights().len())?;
            all_finite("best weights", weights)?;
        }
        if !(stored.damping > 0.0 && stored.damping.is_finite()) {
            return Err(Error::Setting {
                name: "damping",
                value: stored.damping,
                valid: "positive and finite",
            });
        }
        Ok(Self {
            settings,
            current,
            damping: stored.damping,
            hyperparameters: None,
            best: stored.best.map(|(weights, loss, age)| Best {
                weights,
                loss,
                age: size(age),
            }),
            history: stored.history.into_iter().map(Into::into).collect(),
            fingerprint: stored.fingerprint,
        })
    }
}

impl From<&TrainingSettings> for SettingsV1 {
    fn from(s: &TrainingSettings) -> Self {
        Self {
            epochs: s.epochs as u64,
            initial_damping: s.initial_damping,
            damping_increase: s.damping_increase,
            damping_decrease: s.damping_decrease,
            max_damping: s.max_damping,
            goal: s.goal,
            min_gradient: s.min_gradient,
            validation: s.validation.map(|v| (v.fraction, v.patience as u64)),
            normalisation: match s.normalisation {
                Normalisation::Sum => 0,
                Normalisation::Mean => 1,
            },
            initialisation: match s.initialisation {
                Initialisation::NguyenWidrow => (0, 0.0),
                Initialisation::LinearStart => (1, 0.0),
                Initialisation::DataAdapted { axis_aligned } => (2, axis_aligned),
            },
            resolve_output: s.resolve_output,
            seed: s.seed,
            threads: s.threads as u64,
        }
    }
}

impl TryFrom<SettingsV1> for TrainingSettings {
    type Error = Error;

    fn try_from(s: SettingsV1) -> Result<Self, Error> {
        let unknown = |name, value: u8, valid| Error::Setting {
            name,
            value: f64::from(value),
            valid,
        };
        let settings = Self {
            epochs: size(s.epochs),
            initial_damping: s.initial_damping,
            damping_increase: s.damping_increase,
            damping_decrease: s.damping_decrease,
            max_damping: s.max_damping,
            goal: s.goal,
            min_gradient: s.min_gradient,
            validation: s.validation.map(|(fraction, patience)| EarlyStopping {
                fraction,
                patience: size(patience),
            }),
            normalisation: match s.normalisation {
                0 => Normalisation::Sum,
                1 => Normalisation::Mean,
                other => return Err(unknown("normalisation", other, "0 or 1")),
            },
            initialisation: match s.initialisation {
                (0, _) => Initialisation::NguyenWidrow,
                (1, _) => Initialisation::LinearStart,
                (2, axis_aligned) => Initialisation::DataAdapted { axis_aligned },
                (other, _) => return Err(unknown("initialisation", other, "0, 1 or 2")),
            },
            resolve_output: s.resolve_output,
            bayesian: None,
            seed: s.seed,
            threads: size(s.threads),
            caller_pool: false,
        };
        settings.validate()?;
        Ok(settings)
    }
}

impl From<&EpochReport> for EpochV1 {
    fn from(r: &EpochReport) -> Self {
        Self {
            epoch: r.epoch as u64,
            loss: r.loss,
            validation_loss: r.validation_loss,
            gradient: r.gradient,
            damping: r.damping,
            trials: r.trials as u64,
        }
    }
}

impl From<EpochV1> for EpochReport {
    fn from(r: EpochV1) -> Self {
        Self {
            epoch: size(r.epoch),
            loss: r.loss,
            validation_loss: r.validation_loss,
            gradient: r.gradient,
            damping: r.damping,
            trials: size(r.trials),
            hyperparameters: None,
        }
    }
}
