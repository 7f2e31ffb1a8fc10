use std::string::String;
use std::vec::Vec;

use serde::{Deserialize, Serialize};

use super::frame::Format;
use super::{ArtifactError, NetworkV1, decode, encode};
use crate::error::{all_finite, same_length};
use crate::train::{
    Best, Checkpoint, EarlyStopping, EpochReport, Initialisation, Normalisation, TrainingSettings,
};
use crate::{Error, Network};

const CHECKPOINT: Format = Format {
    kind: *b"CHKP",
    schema: 1,
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

/// The bytes of a checkpoint.
///
/// # Errors
/// As [`super::network_to_bytes`].
pub fn checkpoint_to_bytes(
    checkpoint: &Checkpoint,
    provenance: &str,
) -> Result<Vec<u8>, ArtifactError> {
    let best = checkpoint.best.as_ref();
    let stored = CheckpointV1 {
        settings: SettingsV1::from(&checkpoint.settings),
        current: NetworkV1::from(&checkpoint.current),
        damping: checkpoint.damping,
        best: best.map(|b| (b.weights.clone(), b.loss, b.age as u64)),
        history: checkpoint.history.iter().map(EpochV1::from).collect(),
        fingerprint: checkpoint.fingerprint,
    };
    encode(CHECKPOINT, stored, provenance)
}

/// A checkpoint and its provenance from bytes.
///
/// # Errors
/// As [`super::network_from_bytes`].
pub fn checkpoint_from_bytes(bytes: &[u8]) -> Result<(Checkpoint, String), ArtifactError> {
    let (stored, provenance) = decode::<CheckpointV1>(CHECKPOINT, bytes)?;
    Ok((Checkpoint::try_from(stored)?, provenance))
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
            seed: s.seed,
            threads: size(s.threads),
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
        }
    }
}

/// Counts beyond this machine's words saturate.
fn size(n: u64) -> usize {
    usize::try_from(n).unwrap_or(usize::MAX)
}
