//! Training and testing the one-cycle predictor: Section 4.3.

use std::time::Instant;

use axis_sim::SampleRanges;
use cfnn::train::{
    Checkpoint, Dataset, EpochReport, Initialisation, Normalisation, Trainer, TrainingSettings,
};
use cfnn::{Network, Predictor, Scaling, Shape};

use crate::linear_map::{LinearMap, input_row};
use crate::sampling::SampleSet;
use crate::{Figures, PipelineError};

/// Initial damping u of the paper's trainings.
pub const INITIAL_DAMPING: f64 = 0.97;

/// Which network, and how it is trained.
#[derive(Clone, Debug, PartialEq)]
pub struct NetworkPlan {
    /// Neurons of each hidden layer.
    pub hidden: Vec<usize>,
    /// Epochs of Levenberg–Marquardt.
    pub epochs: usize,
    /// Initial damping, the paper's u.
    pub initial_damping: f64,
    /// Seed of the starting weights.
    pub seed: u64,
    /// Threads, 0 for all cores; the bits do not depend on it.
    pub threads: usize,
}

/// A trained predictor: inputs S, Ṡ, S̈ (m, m/s, m/s²) and I_qr (A), output
/// S(k+1) − S(k) (m).
#[derive(Clone, Debug)]
pub struct Trained {
    /// The network.
    pub network: Network,
    /// The best linear map of the same training samples.
    pub linear: LinearMap,
    /// One report an epoch; the loss is the mean square over
    /// [`Trained::residual_scale`] squared.
    pub history: Vec<EpochReport>,
    /// Half the width of what the linear map leaves on the training samples,
    /// m: the unit of the loss.
    pub residual_scale: f64,
    /// Time spent in training, s.
    pub seconds: f64,
}

/// Trains the predictor.
///
/// One cycle is almost pure kinematics: the best linear map leaves parts in
/// 10⁷. So the network learns what that map leaves, scaled by itself, and the
/// map is then folded into its direct links from inputs to output: the result
/// is one plain cascade-forward network, and f64 stays out of the way.
///
/// Goes on from `resume` where there is a checkpoint of the same training;
/// `each` sees every epoch's report, and the trainer to take a checkpoint of.
///
/// # Errors
/// [`PipelineError`] for too few samples, settings that are not valid, or a
/// checkpoint of other samples.
pub fn train(
    ranges: &SampleRanges,
    samples: &SampleSet,
    plan: &NetworkPlan,
    resume: Option<Checkpoint>,
    mut each: impl FnMut(&EpochReport, &Trainer),
) -> Result<Trained, PipelineError> {
    let started = Instant::now();
    let linear = LinearMap::fit(samples)?;
    let residuals = linear.residuals(samples);
    let residual_scale = residuals.iter().fold(0.0_f64, |most, r| most.max(r.abs()));

    let shape = Shape {
        inputs: 4,
        hidden: plan.hidden.clone(),
        outputs: 1,
    };
    let data = Dataset::new(4, 1, rows(samples), residuals)?;
    let own = [(-residual_scale, residual_scale)];
    let scaling = Scaling::from_ranges(&input_ranges(ranges), &own)?;
    let settings = TrainingSettings {
        epochs: plan.epochs,
        initial_damping: plan.initial_damping,
        min_gradient: 0.0,
        normalisation: Normalisation::Sum,
        initialisation: Initialisation::DataAdapted { axis_aligned: 0.5 },
        // The output layer is linear: solve it exactly in every trial step.
        resolve_output: true,
        seed: plan.seed,
        threads: plan.threads,
        ..TrainingSettings::default()
    };
    let mut trainer = match resume {
        Some(checkpoint) => Trainer::resume(&data, checkpoint)?,
        None => Trainer::new(shape, scaling, &data, settings)?,
    };
    while trainer.outcome().is_none() && trainer.history().len() < plan.epochs {
        let report = trainer.epoch();
        each(&report, &trainer);
    }
    Ok(Trained {
        network: fold(&trainer.network(), &linear, samples)?,
        linear,
        history: trainer.history().to_vec(),
        residual_scale,
        seconds: started.elapsed().as_secs_f64(),
    })
}

/// Absolute errors of the predicted position, µm or µrad.
///
/// # Errors
/// [`PipelineError`] for a network of another shape or an empty set.
pub fn test(network: &Network, samples: &SampleSet) -> Result<Figures, PipelineError> {
    Figures::of_si(&residuals(network, samples)?)
}

/// What the network leaves of each increment, m.
///
/// # Errors
/// [`PipelineError::Network`] for a network of another shape.
pub fn residuals(network: &Network, samples: &SampleSet) -> Result<Vec<f64>, PipelineError> {
    let mut predictor = Predictor::<4, 1>::new(network.clone())?;
    let pairs = samples.inputs.iter().zip(&samples.increments);
    Ok(pairs
        .map(|(input, y)| y - predictor.predict(&input_row(input))[0])
        .collect())
}

/// Adds a linear map to a network whose output is what that map leaves.
///
/// The output layer is linear and sees bias and inputs directly, so the sum
/// is again a network of the same shape, exactly.
fn fold(
    residual: &Network,
    linear: &LinearMap,
    samples: &SampleSet,
) -> Result<Network, PipelineError> {
    residual.architecture().require_tansig()?;
    let scaling = residual.scaling();
    let (least, most) =
        (samples.increments.iter()).fold((f64::MAX, f64::MIN), |(l, m), y| (l.min(*y), m.max(*y)));
    let inputs: Vec<(f64, f64)> = (scaling.input().iter())
        .map(|range| (range.minimum(), range.maximum()))
        .collect();
    let folded = Scaling::from_ranges(&inputs, &[(least, most)])?;
    let unit = folded.output()[0].half_width();
    let middle = folded.output()[0].from_unit(0.0);

    let mut weights = residual.weights().to_vec();
    let layers = residual.shape().layers();
    let output = &mut weights[layers[layers.len() - 1].first_parameter..];
    let own = scaling.output()[0];
    for weight in output.iter_mut() {
        *weight *= own.half_width() / unit;
    }
    let mut offset = linear.offset - middle + own.from_unit(0.0);
    for (i, range) in scaling.input().iter().enumerate() {
        offset += linear.slopes[i] * range.from_unit(0.0);
        output[1 + i] += linear.slopes[i] * range.half_width() / unit;
    }
    output[0] += offset / unit;
    Ok(Network::new(residual.shape().clone(), folded, weights)?)
}

pub(crate) fn rows(samples: &SampleSet) -> Vec<f64> {
    samples.inputs.iter().flat_map(input_row).collect()
}

/// The scaling covers the whole sample ranges, so that it does not depend on
/// the draw.
pub(crate) fn input_ranges(ranges: &SampleRanges) -> [(f64, f64); 4] {
    [
        ranges.position,
        ranges.speed,
        ranges.acceleration,
        ranges.effort,
    ]
    .map(|range| (range.least, range.most))
}
