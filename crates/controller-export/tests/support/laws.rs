//! The strategies in Rust, in both precisions.

use axis_pipeline::strategies::{Predictors, STRATEGIES, named};
use axis_scalar::Scalar;
use axis_sim::Axis;
use cfnn::{FixedNetwork, Network, Scaling, Shape};
use compensator::{
    Combined, Compensator, Correction, Feedback, GuardLimits, NetworkCompensation, NoCompensation,
    Planner, Reference, Sample, Standstill, Target, TransferFunctionModel,
};
use controller_export::{ExportedLaw, NetworkLaw, PlanLaw, Position};
use lugre::Exponential;

use super::Outcome;
use super::samples::Random;

/// Hidden layers of the paper's network, and its activations.
pub const HIDDEN: [usize; 3] = [34, 19, 8];
pub const ACTIVATIONS: usize = 5 + 34 + 19 + 8;
/// Hidden layers of the network that `--quick` trains, and its activations.
pub const QUICK_HIDDEN: [usize; 3] = [14, 8, 4];
pub const QUICK_ACTIVATIONS: usize = 5 + 14 + 8 + 4;

/// What the guard keeps to.
pub const LIMITS: GuardLimits = GuardLimits {
    position: 5e-4,
    effort: 60.0,
    surprise: 1e5,
    patience: 20,
    fade: 1000,
};

/// A network of the paper's shape: kinematics and a small rest of random weights.
pub fn network(axis: &Axis) -> Outcome<Network> {
    let shape = Shape {
        inputs: 4,
        hidden: HIDDEN.to_vec(),
        outputs: 1,
    };
    let ranges = [(0.0, 1.5), (-0.333, 0.333), (-5.0, 5.0), (-15.0, 15.0)];
    let most = 0.333 * axis.period;
    let scaling = Scaling::from_ranges(&ranges, &[(-most, most)])?;
    let mut random = Random(7);
    let mut weights: Vec<f64> = (0..shape.parameters())
        .map(|_| 0.3 * random.next())
        .collect();
    let output = shape.layers()[HIDDEN.len()].first_parameter;
    for weight in &mut weights[output..] {
        *weight *= 1e-3;
    }
    weights[output + 2] = 1.0;
    Ok(Network::new(shape, scaling, weights)?)
}

/// Everything that the strategies are made of.
pub fn predictors(axis: &Axis) -> Outcome<Predictors> {
    let model = |direct| {
        let poles = [0.98, 0.98, 0.95, 0.9, -0.3];
        let coefficients = [3e-6, -2e-6, 1e-6, 4e-7, -1e-7];
        TransferFunctionModel::new(axis.period, direct, &poles, &coefficients)
    };
    let models = [model(2e-6)?, model(-1e-6)?];
    Ok(Predictors::new(
        axis,
        network(axis)?,
        models,
        axis.friction.law,
    ))
}

/// What is compared: a strategy that knows what its guard let through.
pub trait Runs<T: Scalar> {
    /// The next sample is the first of a motion from rest.
    fn reset(&mut self);
    /// The correction of a cycle.
    fn correct(&mut self, sample: &Sample<T>) -> Correction<T>;
    /// What a guard watches.
    fn surprise(&self) -> T;
    /// Whether there is anything to ask for yet.
    fn is_planned(&self) -> bool {
        true
    }
    /// After a correction that was no number: whether the state is none either, and begins anew.
    fn begins_anew(&mut self, asked: &Correction<T>) -> bool {
        let anew = !(asked.position.is_finite() && asked.command.is_finite());
        if anew {
            self.reset();
        }
        anew
    }
    /// What went to the drive.
    fn passed(&mut self, _: &Correction<T>) {}
}

impl<T: Scalar> Runs<T> for Box<dyn Compensator<T> + '_> {
    fn reset(&mut self) {
        (**self).reset();
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        (**self).correct(sample)
    }

    fn surprise(&self) -> T {
        (**self).surprise()
    }
}

/// A plan as a controller runs it: the next reference of a sample is the newest set point, and
/// the motion is held back by the look-ahead.
pub struct Streaming<T: Exponential> {
    planner: Planner<T>,
    feedback: Option<Feedback<T>>,
    started: bool,
    planned: bool,
    sound: bool,
    /// The last set point that was a number.
    last: Reference<T>,
    own: T,
}

impl<T: Exponential> Streaming<T> {
    pub fn new(law: &PlanLaw<T>) -> Self {
        Self {
            planner: (*law.planner).clone(),
            feedback: law.feedback.as_deref().cloned(),
            started: false,
            planned: false,
            sound: true,
            last: Reference::default(),
            own: T::ZERO,
        }
    }
}

impl<T: Exponential> Runs<T> for Streaming<T> {
    fn reset(&mut self) {
        (self.started, self.planned) = (false, false);
        if let Some(feedback) = &mut self.feedback {
            feedback.reset();
        }
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        let mut newest = sample.next_reference;
        let numbers = [newest.position, newest.velocity, newest.acceleration];
        let known = numbers.iter().all(|x| x.is_finite());
        (self.planned, self.sound) = (false, true);
        let none = Correction {
            position: T::ZERO,
            command: T::of(f64::NAN),
        };
        if !self.started {
            if !(known && sample.last_command.is_finite()) {
                return none;
            }
            let standstill = Standstill {
                effort: sample.last_command,
                own: self.own,
                motor_angle: sample.motor_angle,
                homed: None,
                held: None,
            };
            self.planner.begin(newest.position, &standstill);
            self.started = true;
        } else if !known {
            newest = self.last;
        }
        self.last = newest;
        let Some(planned) = self.planner.push(Target::of(newest)) else {
            return if known { Correction::default() } else { none };
        };
        self.planned = true;
        let now = Sample {
            reference: planned.reference,
            ..*sample
        };
        let asked = planned.correction;
        self.sound = asked.position.is_finite() && asked.command.is_finite();
        let mut asked = match &mut self.feedback {
            Some(feedback) if self.sound => feedback.correct(&now, &planned),
            _ => asked,
        };
        if !known {
            asked.command = none.command;
        }
        asked
    }

    fn is_planned(&self) -> bool {
        self.planned
    }

    fn begins_anew(&mut self, _: &Correction<T>) -> bool {
        if !self.sound {
            self.reset();
        }
        !self.sound
    }

    fn surprise(&self) -> T {
        let feedback = self.feedback.as_ref();
        feedback.map_or(T::ZERO, |f| f.deviations().surprise)
    }

    fn passed(&mut self, correction: &Correction<T>) {
        self.own = correction.command;
    }
}

/// The strategy as the simulator runs it.
pub fn double(
    predictors: &Predictors,
    name: &str,
    law: &ExportedLaw,
) -> Outcome<Box<dyn Runs<f64>>> {
    if let Some(plan) = &law.plan {
        return Ok(Box::new(Streaming::new(plan)));
    }
    let kind = named(STRATEGIES, name).ok_or("no such strategy")?;
    let motion = predictors.axis.plan(&predictors.axis.trajectories[0])?;
    let made: Box<dyn Compensator> = kind.compensator(predictors, std::sync::Arc::new(motion))?;
    Ok(Box::new(made))
}

/// The same in single precision, of the numbers that are exported.
pub fn single(law: &ExportedLaw<f32>) -> Outcome<Box<dyn Runs<f32> + '_>> {
    if let Some(plan) = &law.plan {
        return Ok(Box::new(Streaming::new(plan)));
    }
    let first: Box<dyn Compensator<f32> + '_> = match &law.position {
        Position::Nothing => Box::new(NoCompensation),
        Position::Transfer(filter) => Box::new(**filter),
        Position::Network(n) if n.hidden == QUICK_HIDDEN => fixed::<QUICK_ACTIVATIONS>(n)?,
        Position::Network(n) => fixed::<ACTIVATIONS>(n)?,
    };
    let all: Box<dyn Compensator<f32> + '_> = match law.friction {
        Some(friction) => Box::new(Combined::new(first, friction)),
        None => first,
    };
    Ok(Box::new(all))
}

/// The network with so many activations.
fn fixed<const A: usize>(law: &NetworkLaw<f32>) -> Outcome<Box<dyn Compensator<f32> + '_>> {
    let network =
        FixedNetwork::<f32, 4, 1, A>::new(&law.hidden, &law.packed, law.input, [law.output])?;
    Ok(Box::new(NetworkCompensation::new(network, law.estimator)))
}

/// Inputs of a network over its ranges, row by row, and its outputs.
pub fn network_cases(
    axis: &Axis,
    network: &Network,
    count: usize,
) -> Outcome<(Vec<f64>, Vec<f64>)> {
    let mut random = Random(11);
    let (mut inputs, mut outputs) = (Vec::new(), Vec::new());
    let mut scratch = network.scratch();
    let middle = 0.5 * (axis.stroke.minimum + axis.stroke.maximum);
    for _ in 0..count {
        let row = [
            middle + 0.5 * random.next(),
            0.3 * random.next(),
            4.0 * random.next(),
            15.0 * random.next(),
        ];
        outputs.push(network.predict_one(&row, &mut scratch)?);
        inputs.extend(row);
    }
    Ok((inputs, outputs))
}
