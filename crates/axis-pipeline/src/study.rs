//! The study of Tables 7 to 10: how initial damping, layers, neurons and
//! epochs change a small network's error, over several seeds.

use axis_sim::Axis;
use cfnn::train::{Dataset, Trainer, TrainingSettings};
use cfnn::{Scaling, Shape};
use serde::{Deserialize, Serialize};

use crate::sampling::ranges;
use crate::sampling::{SamplePlan, SampleSet, Sampler, SpeedDensity};
use crate::training::{input_ranges, rows, test};
use crate::{ErrorUnit, Figures, PipelineError};

/// One setting of the study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Table of the paper, 7 to 10.
    pub table: u32,
    /// What is varied, as the paper's tables name it.
    pub label: String,
    /// Initial damping u.
    pub initial_damping: f64,
    /// Neurons of each hidden layer.
    pub hidden: Vec<usize>,
    /// Epochs.
    pub epochs: usize,
}

/// The errors of one setting over all seeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyRow {
    /// The setting.
    pub setting: Setting,
    /// Unit of the errors.
    pub unit: ErrorUnit,
    /// Errors on unseen samples, one for each seed.
    pub errors: Vec<Figures>,
}

/// The twelve settings of Tables 7 to 10.
pub fn settings() -> Vec<Setting> {
    let setting = |table, label: String, initial_damping, hidden, epochs| Setting {
        table,
        label,
        initial_damping,
        hidden,
        epochs,
    };
    let mut all = Vec::new();
    for u in [0.3, 0.5, 0.7] {
        all.push(setting(7, format!("u = {u}"), u, vec![3], 100));
    }
    for layers in 1..=3 {
        all.push(setting(
            8,
            format!("N = {layers}"),
            0.3,
            vec![3; layers],
            100,
        ));
    }
    for neurons in 3..=5 {
        all.push(setting(
            9,
            format!("M = {neurons}"),
            0.3,
            vec![neurons; 3],
            100,
        ));
    }
    for epochs in [100, 150, 200] {
        all.push(setting(
            10,
            format!("epochs = {epochs}"),
            0.3,
            vec![3; 3],
            epochs,
        ));
    }
    all
}

/// Sets the unseen samples' seed apart from the seen ones'.
const UNSEEN: u64 = 0x5eed_0000_0000_0000;

/// Trains the network of a setting from a seed: on `samples` samples that are drawn from
/// it, and judges it by as many unseen ones. Answers its errors, µm or µrad.
///
/// As in the paper the network learns the position S(k+1) itself, from
/// Nguyen–Widrow starting weights.
///
/// # Errors
/// [`PipelineError`] if the samples cannot be drawn or the training is not valid.
pub fn network(
    axis: &Axis,
    setting: &Setting,
    samples: usize,
    seed: u64,
) -> Result<Figures, PipelineError> {
    let draw = |seed| -> Result<SampleSet, PipelineError> {
        let plan = SamplePlan {
            count: samples,
            seed,
            density: SpeedDensity::Uniform,
        };
        Sampler::new(axis, &plan)?.all()
    };
    let (seen, unseen) = (draw(seed)?, draw(seed ^ UNSEEN)?);
    let shape = Shape {
        inputs: 4,
        hidden: setting.hidden.clone(),
        outputs: 1,
    };
    let data = Dataset::new(4, 1, rows(&seen), positions(&seen))?;
    let ranges = ranges(axis)?;
    let positions_range = ranges.position;
    let output = [(positions_range.least, positions_range.most)];
    let scaling = Scaling::from_ranges(&input_ranges(&ranges), &output)?;
    let options = TrainingSettings {
        epochs: setting.epochs,
        initial_damping: setting.initial_damping,
        // Near the linear map gradients are small; the epochs are to be run.
        min_gradient: 0.0,
        seed,
        threads: 1,
        ..TrainingSettings::default()
    };
    let mut trainer = Trainer::new(shape, scaling, &data, options)?;
    trainer.run(|_| {});
    let unseen = SampleSet {
        increments: positions(&unseen),
        inputs: unseen.inputs,
    };
    test(&trainer.network(), &unseen)
}

/// S(k+1), m.
fn positions(samples: &SampleSet) -> Vec<f64> {
    let pairs = samples.inputs.iter().zip(&samples.increments);
    pairs.map(|(input, step)| input.position + step).collect()
}
