//! Hidden layers of a network from simulated machines, for one that is refined on logs.

use std::f64::consts::TAU;

use axis_sim::{Axis, EffectForces};
use cfnn::train::{Dataset, Initialisation, Trainer, TrainingSettings};
use cfnn::{Scaling, Shape};
use compensator::{NETWORK_INPUTS, NetworkBasis, Unexplained};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::drawn::drawn_effects;
use crate::PipelineError;

/// How hidden layers are found.
#[derive(Clone, Debug, PartialEq)]
pub struct NetworkSettings {
    /// Neurons of each hidden layer.
    pub hidden: Vec<usize>,
    /// Simulated machines on which the hidden layers are trained together.
    pub trained: usize,
    /// Simulated machines whose output layers make the prior.
    pub spread: usize,
    /// States of the axis at which they are simulated.
    pub states: usize,
    /// Epochs of Levenberg–Marquardt.
    pub epochs: usize,
    /// Greatest speed of the load, m/s or rad/s.
    pub speed: f64,
    /// Seed of machines, states and starting weights.
    pub seed: u64,
}

impl Default for NetworkSettings {
    fn default() -> Self {
        Self {
            hidden: vec![40, 10],
            trained: 12,
            spread: 400,
            states: 3000,
            epochs: 20,
            speed: 0.3,
            seed: 1,
        }
    }
}

/// Share of states in which the bristles are on their way from one side to the other.
const ON_THE_WAY: f64 = 0.1;

/// A network that knows machines like `axis` with effects as [`drawn_effects`] draws them
/// over `room`: hidden layers trained on some at once, the prior of its output layer from
/// many. Torque and force of each machine are its effects' own laws, at states that are drawn.
///
/// # Errors
/// [`PipelineError::Network`] and [`PipelineError::Compensator`] for settings that are not
/// valid.
pub fn trained_basis(
    axis: &Axis,
    room: [f64; 2],
    settings: &NetworkSettings,
) -> Result<NetworkBasis, PipelineError> {
    let mut random = ChaCha8Rng::seed_from_u64(settings.seed);
    let travel = axis.travel_per_radian();
    let states = drawn_states(travel, room, settings, &mut random);
    let count = settings.spread.max(settings.trained);
    let machines = (0..count).map(|_| {
        let effects = drawn_effects(axis, room, &mut random);
        Ok(along(&axis.effect_forces(&effects)?, &states))
    });
    let machines: Vec<Vec<[f64; 2]>> = machines.collect::<Result<_, PipelineError>>()?;
    let law = axis.friction.law.parameters();
    let unit = 0.1 * travel * law.coulomb / axis.friction.lever(travel);

    let outputs = 2 * settings.trained;
    let mut inputs = Vec::with_capacity(NETWORK_INPUTS * states.len());
    let mut targets = Vec::with_capacity(outputs * states.len());
    for (k, state) in states.iter().enumerate() {
        let (sin, cos) = state.motor_angle.sin_cos();
        inputs.extend([state.position, sin, cos, state.motor_speed, state.direction]);
        let trained = machines[..settings.trained].iter();
        targets.extend(trained.flat_map(|m| [m[k][0], travel * m[k][1]]));
    }
    let data = Dataset::new(NETWORK_INPUTS, outputs, inputs, targets)?;
    let fastest = settings.speed / travel;
    let ranges = [
        (room[0], room[1]),
        (-1.0, 1.0),
        (-1.0, 1.0),
        (-fastest, fastest),
        (-1.0, 1.0),
    ];
    let scaling = Scaling::from_ranges(&ranges, &vec![(-unit, unit); outputs])?;
    let shape = Shape {
        inputs: NETWORK_INPUTS,
        hidden: settings.hidden.clone(),
        outputs,
    };
    let training = TrainingSettings {
        epochs: settings.epochs,
        initialisation: Initialisation::DataAdapted { axis_aligned: 0.5 },
        resolve_output: true,
        min_gradient: 0.0,
        seed: settings.seed,
        ..TrainingSettings::default()
    };
    let mut trainer = Trainer::new(shape, scaling, &data, training)?;
    trainer.run(|report| {
        tracing::debug!(epoch = report.epoch, loss = report.loss, "residual network")
    });
    Ok(NetworkBasis::new(
        &trainer.network(),
        travel,
        unit,
        &states,
        &machines,
    )?)
}

/// States over room, turn, speed and direction.
fn drawn_states(
    travel: f64,
    room: [f64; 2],
    settings: &NetworkSettings,
    random: &mut ChaCha8Rng,
) -> Vec<Unexplained> {
    let fastest = settings.speed / travel;
    let mut state = || {
        let motor_speed = random.random_range(-fastest..fastest);
        let direction = match random.random_range(0.0..1.0) < ON_THE_WAY {
            true => random.random_range(-1.0..1.0),
            false => motor_speed.signum(),
        };
        Unexplained {
            position: random.random_range(room[0]..room[1]),
            motor_angle: random.random_range(0.0..TAU),
            motor_speed,
            direction,
            torque: 0.0,
        }
    };
    (0..settings.states).map(|_| state()).collect()
}

fn along(forces: &EffectForces, states: &[Unexplained]) -> Vec<[f64; 2]> {
    let at = |u: &Unexplained| forces.at(u.motor_angle, u.motor_speed, u.position, u.direction);
    states.iter().map(at).collect()
}
