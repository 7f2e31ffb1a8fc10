//! The model against the machine, and the predictors against the machine's
//! tracking error: Tables 13 and 14.

use axis_sim::effects::Scales;
use axis_sim::mechanism::SolutionMethod;
use axis_sim::{Axis, ClosedLoop, SetupError};
use compensator::{Compensator, Correction, NoCompensation, Sample};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use trajectories::Motion;

use crate::measured::Position;
use crate::strategies::{BothPredictors, Need, Predictors};
use crate::tracking::{PlannedTrajectory, Profile, Run, follow, plan_all, profile, run_of, track};
use crate::vibration::{Vibration, vibration};
use crate::{ErrorUnit, Figures, PipelineError};

/// One trajectory without compensation.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ValidatedTrajectory {
    /// Number in the axis file, from 1.
    pub id: usize,
    /// Duration of the motion, s.
    pub motion_time_s: f64,
    /// Reference.
    pub profile: Profile,
    /// Tracking error of the model.
    pub model: Run,
    /// Tracking error of what stands for the machine.
    pub machine: Run,
    /// The machine's error as the network predicts it, one cycle ahead.
    pub network: Run,
    /// The machine's error as the transfer function predicts it from the reference.
    pub transfer_function: Run,
    /// What the network misses of the machine's error.
    pub network_deviation: Figures,
    /// What the transfer function misses of it.
    pub transfer_function_deviation: Figures,
}

/// Natural frequencies at one table position.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ModesAt {
    /// Position of the load.
    #[serde(flatten)]
    pub position: Position<f64>,
    /// Frequencies of the first elastic modes, Hz.
    pub frequencies_hz: Vec<f64>,
}

/// How far the numerical choices move the figures, µm or µrad.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct NumericalChecks {
    /// Largest change of a maximum or mean when the internal step is halved.
    pub half_step: Figures,
    /// Largest change of them from the mechanism's fast method to its exact one; none if
    /// it has only one.
    pub exact_method: Option<Figures>,
}

/// Everything that validation shows.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Validation {
    /// Unit of all maxima and means.
    pub unit: ErrorUnit,
    /// Each trajectory.
    pub trajectories: Vec<ValidatedTrajectory>,
    /// Constant-speed runs of the model.
    pub vibration_model: Vec<Vibration>,
    /// Constant-speed runs of what stands for the machine.
    pub vibration_machine: Vec<Vibration>,
    /// Modes of the model along the stroke.
    pub modes: Vec<ModesAt>,
    /// Numerical checks on the model.
    pub checks: NumericalChecks,
}

/// Speeds of the constant-speed runs on the reference machine ([`Scales::REFERENCE`]), mm/s.
const VIBRATION_SPEEDS: [f64; 10] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 20.0];

/// Speeds of the constant-speed runs, mm/s (mrad/s), in proportion to the stroke.
pub fn vibration_speeds(axis: &Axis) -> [f64; 10] {
    let length = Scales::of(axis).motion / Scales::REFERENCE.motion;
    VIBRATION_SPEEDS.map(|speed| speed * length)
}

/// Step of the exact method, s.
const EXACT_STEP: f64 = 1e-5;

/// Elastic modes shown.
const MODES: usize = 4;

/// Runs the validation. `each` is called once a run of the closed loop;
/// [`runs`] tells how often.
///
/// # Errors
/// [`PipelineError::Missing`] without a network or transfer functions,
/// [`PipelineError::Run`] if a run diverges.
pub fn validate(
    model: &Axis,
    machine: &Axis,
    predictors: &Predictors,
    each: impl Fn() + Sync,
) -> Result<Validation, PipelineError> {
    let needs = [Need::Network, Need::TransferFunctions];
    predictors.require(&needs, "the validation")?;
    let loops = [ClosedLoop::new(model)?, ClosedLoop::new(machine)?];
    let planned = plan_all(model)?;
    let trajectory = |planned: &PlannedTrajectory| {
        let result = one(&loops, planned, predictors);
        each();
        result
    };
    let trajectories: Result<Vec<_>, PipelineError> = planned.par_iter().map(trajectory).collect();
    let trajectories = trajectories?;
    let checks = checks(model, &planned, &trajectories, &each)?;
    Ok(Validation {
        unit: ErrorUnit::of(model),
        vibration_model: vibration(model, &vibration_speeds(model))?,
        vibration_machine: vibration(machine, &vibration_speeds(model))?,
        modes: modes(model)?,
        trajectories,
        checks,
    })
}

/// How often [`validate`] calls back.
pub fn runs(model: &Axis) -> usize {
    let ways = if model.mechanism.exact_step().is_some() {
        3
    } else {
        2
    };
    ways * model.trajectories.len()
}

fn one(
    [model, machine]: &[ClosedLoop; 2],
    planned: &PlannedTrajectory,
    predictors: &Predictors,
) -> Result<ValidatedTrajectory, PipelineError> {
    let (mut watch, unit) = (Watch::new(predictors)?, ErrorUnit::of(machine.axis()));
    let mut errors = Vec::new();
    follow(machine, planned, &mut watch, |cycle| {
        errors.push(cycle.error())
    })?;
    let deviation = |predicted: &[f64]| {
        let missed: Vec<f64> = errors.iter().zip(predicted).map(|(e, p)| e - p).collect();
        Figures::of_si(&missed)
    };
    // What was predicted at k is for k + 1; the last one has no counterpart.
    watch.network.truncate(errors.len());
    watch.transfer_function.truncate(errors.len());
    Ok(ValidatedTrajectory {
        id: planned.id,
        motion_time_s: planned.motion.duration(),
        profile: profile(planned, model.axis()),
        model: track(model, planned, &mut NoCompensation)?,
        machine: run_of(&errors, unit)?,
        network: run_of(&watch.network, unit)?,
        transfer_function: run_of(&watch.transfer_function, unit)?,
        network_deviation: deviation(&watch.network)?,
        transfer_function_deviation: deviation(&watch.transfer_function)?,
    })
}

/// Asks both predictors in every cycle and corrects nothing.
struct Watch {
    predictors: BothPredictors,
    /// Predicted errors from the first cycle on, which nothing predicts: zero.
    network: Vec<f64>,
    transfer_function: Vec<f64>,
}

impl Watch {
    fn new(predictors: &Predictors) -> Result<Self, PipelineError> {
        Ok(Self {
            predictors: predictors.both()?,
            network: vec![0.0],
            transfer_function: vec![0.0],
        })
    }
}

impl Compensator for Watch {
    fn reset(&mut self) {
        self.predictors.network.reset();
        self.predictors.transfer_function.reset();
        self.network.truncate(1);
        self.transfer_function.truncate(1);
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        let both = &mut self.predictors;
        self.network.push(both.network.correct(sample).position);
        self.transfer_function
            .push(both.transfer_function.correct(sample).position);
        Correction::default()
    }
}

fn modes(axis: &Axis) -> Result<Vec<ModesAt>, PipelineError> {
    const POSITIONS: usize = 60;
    let stroke = &axis.stroke;
    let at = |i: usize| {
        let part = i as f64 / POSITIONS as f64;
        let position = stroke.minimum + part * (stroke.maximum - stroke.minimum);
        let modes = axis.mechanism.modes(position).map_err(SetupError::from)?;
        let hertz = |w: &f64| w / std::f64::consts::TAU;
        Ok(ModesAt {
            position: Position::new(ErrorUnit::of(axis), position),
            frequencies_hz: modes.iter().take(MODES).map(hertz).collect(),
        })
    };
    (0..=POSITIONS).map(at).collect()
}

fn checks(
    model: &Axis,
    planned: &[PlannedTrajectory],
    reference: &[ValidatedTrajectory],
    each: &(impl Fn() + Sync),
) -> Result<NumericalChecks, PipelineError> {
    let mut halved = model.clone();
    halved.simulation.step = 0.5 * model.simulation.step.min(model.period);
    // The other method than the file's.
    let other = match (model.mechanism.exact_step(), model.simulation.method) {
        (None, _) => None,
        (Some(_), SolutionMethod::Fast) => Some(ClosedLoop::exact(model, EXACT_STEP)?),
        (Some(_), SolutionMethod::Exact) => {
            let mut fast = model.clone();
            fast.simulation.method = SolutionMethod::Fast;
            Some(ClosedLoop::new(&fast)?)
        }
    };
    let change = |closed_loop: &ClosedLoop| -> Result<Figures, PipelineError> {
        let pairs: Result<Vec<Figures>, PipelineError> = planned
            .par_iter()
            .zip(reference)
            .map(|(planned, reference)| {
                let run = track(closed_loop, planned, &mut NoCompensation)?;
                each();
                let (a, b) = (run.figures, reference.model.figures);
                Ok(Figures {
                    max: (a.max - b.max).abs(),
                    mean: (a.mean - b.mean).abs(),
                })
            })
            .collect();
        Ok(pairs?
            .into_iter()
            .fold(Figures::default(), |most, f| Figures {
                max: most.max.max(f.max),
                mean: most.mean.max(f.mean),
            }))
    };
    Ok(NumericalChecks {
        half_step: change(&ClosedLoop::new(&halved)?)?,
        exact_method: other.as_ref().map(change).transpose()?,
    })
}
