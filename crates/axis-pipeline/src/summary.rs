//! The figures of a whole pipeline in one small structure.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Figures;
use crate::compensation::CompensatedRun;
use crate::measured::{Errors, LinearMaxAbsError, LinearMeanAbsError, MaxAbsError, MeanAbsError};
use crate::validation::{ValidatedTrajectory, Validation};

/// What `summary.json` holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Summary {
    /// Version of this file's layout, [`Summary::SCHEMA`]. It rises where a field goes or
    /// changes its meaning; new fields do not raise it.
    pub schema: u32,
    /// Name of the axis.
    pub axis: String,
    /// Hash of the axis' parameters.
    pub axis_fingerprint: String,
    /// What stands for the machine. Simulated, never measured.
    pub machine: String,
    /// Version of the program.
    pub version: String,
    /// Seed of everything random.
    pub seed: u64,
    /// Whether this is the small version of every stage.
    pub quick: bool,
    /// Each trajectory.
    pub trajectories: Vec<TrajectorySummary>,
    /// The network.
    pub network: NetworkSummary,
    /// Margins of the drive's loops, not compensated. Files of earlier versions have none.
    #[serde(default)]
    pub loops: LoopsSummary,
}

impl Summary {
    /// Version of the layout that this program writes.
    pub const SCHEMA: u32 = 1;
}

/// Margins of the drive's loops on model and machine, which are the same where no machine was given;
/// null where the axis has no position controller.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LoopsSummary {
    /// The model.
    pub model: Option<MarginsSummary>,
    /// What stands for the machine.
    pub machine: Option<MarginsSummary>,
}

/// Margins over all cases: start, ends and middle of the stroke, the load's mass 10 % less, as it is
/// and 40 % more, sliding and stuck. Gain, phase and delay are those of the loop cut at the command,
/// the least of all cases; null where a case is not stable, or no case has that margin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MarginsSummary {
    /// Cases.
    pub cases: usize,
    /// Cases in which the loop is not stable.
    pub unstable: usize,
    /// Maximum sensitivity, max 1/|1 + L|, of all cases, the loop cut at the command or at the
    /// position.
    pub sensitivity: Option<f64>,
    /// The same with one more cycle of delay.
    pub sensitivity_late: Option<f64>,
    /// Factor above 1 of the loop's gain at which it gets unstable.
    pub gain_up: Option<f64>,
    /// Factor below 1 at which it does.
    pub gain_down: Option<f64>,
    /// Phase margin, degrees.
    pub phase_deg: Option<f64>,
    /// Delay that the loop takes, s.
    pub delay_s: Option<f64>,
}

/// Figures of one trajectory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TrajectorySummary {
    /// Number in the axis file, from 1.
    pub id: usize,
    /// Duration of the motion, s.
    pub motion_time_s: f64,
    /// Tracking errors.
    #[serde(flatten)]
    pub errors: Errors<TrackingErrors>,
}

/// Maximum and mean absolute tracking errors, in the unit that their name ends in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TrackingErrors {
    /// The model, without compensation.
    pub model: Figures,
    /// What stands for the machine, without compensation.
    pub machine: Figures,
    /// The machine's error as predicted.
    pub predicted: Predicted,
    /// The machine with compensation.
    pub compensated: Compensated,
}

/// The machine's error as predicted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Predicted {
    /// By the network, one cycle ahead.
    pub network: Figures,
    /// By the transfer function, from the reference alone.
    pub transfer_function: Figures,
}

/// The machine with compensation, by the names of the strategies, in the order in which
/// they ran.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compensated(Vec<(String, Figures)>);

impl Compensated {
    /// Those of one trajectory.
    pub fn of_trajectory(runs: &[CompensatedRun], id: usize) -> Self {
        let runs = runs.iter().filter(|run| run.id == id);
        Self(
            runs.map(|run| (run.strategy.clone(), run.run.figures))
                .collect(),
        )
    }

    /// Under the strategy of a name, where it ran.
    pub fn under(&self, strategy: &str) -> Option<Figures> {
        let mut all = self.iter();
        all.find(|(name, _)| *name == strategy).map(|(_, f)| f)
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = (&str, Figures)> {
        self.0.iter().map(|(name, f)| (name.as_str(), *f))
    }
}

impl JsonSchema for Compensated {
    fn schema_name() -> Cow<'static, str> {
        "Compensated".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "object",
            "description": "The machine with compensation, by the names of the strategies.",
            "additionalProperties": generator.subschema_for::<Figures>(),
        })
    }
}

/// A map that keeps its order.
impl Serialize for Compensated {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.iter())
    }
}

impl<'de> Deserialize<'de> for Compensated {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries;
        impl<'de> Visitor<'de> for Entries {
            type Value = Compensated;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("figures by the names of strategies")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Compensated, A::Error> {
                let mut all = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    all.push(entry);
                }
                Ok(Compensated(all))
            }
        }
        deserializer.deserialize_map(Entries)
    }
}

/// Figures of every trajectory, from the results of validation and compensation.
pub fn trajectories(validation: &Validation, runs: &[CompensatedRun]) -> Vec<TrajectorySummary> {
    let one = |t: &ValidatedTrajectory| TrajectorySummary {
        id: t.id,
        motion_time_s: t.motion_time_s,
        errors: Errors::new(
            validation.unit,
            TrackingErrors {
                model: t.model.figures,
                machine: t.machine.figures,
                predicted: Predicted {
                    network: t.network.figures,
                    transfer_function: t.transfer_function.figures,
                },
                compensated: Compensated::of_trajectory(runs, t.id),
            },
        ),
    };
    validation.trajectories.iter().map(one).collect()
}

/// The network and the linear map that it is measured against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NetworkSummary {
    /// Neurons of each hidden layer.
    pub hidden: Vec<usize>,
    /// Epochs trained.
    pub epochs: usize,
    /// Samples trained on.
    pub train_samples: usize,
    /// Unseen samples that the errors are from.
    pub test_samples: usize,
    /// Largest absolute error of the predicted position.
    #[serde(flatten)]
    pub max_abs_error: MaxAbsError<f64>,
    /// Mean absolute error.
    #[serde(flatten)]
    pub mean_abs_error: MeanAbsError<f64>,
    /// Largest absolute error of the best linear map of as many evenly spread
    /// samples.
    #[serde(flatten)]
    pub linear_max_abs_error: LinearMaxAbsError<f64>,
    /// Its mean absolute error.
    #[serde(flatten)]
    pub linear_mean_abs_error: LinearMeanAbsError<f64>,
    /// Time spent in training, s.
    pub train_seconds: f64,
}
