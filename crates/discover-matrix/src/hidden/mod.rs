//! Machines with something hidden in them, to try the search on.
//!
//! The truth is made another way than the model: the paper's moving node on a
//! finer mesh, Newmark's rule in steps of 20 µs, known parameters off, and
//! noise in every sensor that the controller sees as well.

mod exercise;
mod form;
mod law;
mod outside;
mod rough;
mod rough_kind;
mod rough_stream;
mod truth;

pub use axis_sim::NoiseLevels as Noise;
pub use exercise::{Exercise, exercise};
pub use form::Form;
pub use law::{Factor, Law, LawShape, LawVariable, Ranges};
pub(crate) use law::{LAW, LAW_NAME};
pub use outside::OUTSIDE;
pub use rough_kind::{Entry, NoiseColour, Rough};
pub use truth::Truth;

use axis_log::{Channel, Log};
use axis_sim::effects::{ActiveEffect, EffectChannel};
use axis_sim::{Axis, ClosedLoop, Measured, Recorder, ReplayError, Start};
use compensator::NoCompensation;
use discrepancy::SensorNoise;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trajectories::Motion;

/// A machine with effects hidden in it.
#[derive(Clone, Debug)]
pub struct Hidden {
    /// What is hidden.
    pub effects: Vec<ActiveEffect>,
    /// Shares by which its known parameters are off, in the order of [`Axis::known`].
    pub shares: Vec<f64>,
    /// Sensors.
    pub noise: Noise,
    /// Of the noise.
    pub seed: u64,
}

impl Hidden {
    /// Known parameters off by up to `share` of their values, evenly spread.
    pub fn with_known_off_by(mut self, machine: &Axis, share: f64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed ^ 0x6b6e_6f77);
        let off = |most| most * (2.0 * random.random::<f64>() - 1.0);
        self.shares = most_off(machine, share).into_iter().map(off).collect();
        self
    }

    /// The log of a motion, one sample every `every` control cycles.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine cannot be set up or does not hold.
    pub fn log(&self, axis: &Axis, motion: &impl Motion, every: usize) -> Result<Log, ReplayError> {
        let truth = made(axis, &self.shares, &self.effects);
        let sense = self.noise.sensors(self.seed);
        let log = recorded(axis, &truth, self.seed, 0.0, motion, sense)?;
        late(&self.effects, log)?
            .decimate(every)
            .map_err(ReplayError::from)
    }
}

/// What the search would suppose of sensors with this noise, had it been told.
pub fn supposed(noise: Noise) -> SensorNoise {
    SensorNoise {
        position: noise.position,
        angle: noise.angle,
        speed: noise.speed,
        current: noise.current,
    }
}

/// By how much each known parameter may be off: that share of its value; an angle by its own tolerance, as a share says
/// nothing of it.
pub(crate) fn most_off(machine: &Axis, share: f64) -> Vec<f64> {
    let all = machine.known_tolerances().into_iter();
    let all = all.zip(machine.known_angles());
    all.map(|(own, is_angle)| if is_angle { own } else { share })
        .collect()
}

/// The machine of the truth: known parameters off, effects put in, and a finer mesh.
fn made(axis: &Axis, shares: &[f64], effects: &[ActiveEffect]) -> Axis {
    let mut truth = axis.with_known(shares);
    // On a finer mesh, where the mechanism has one.
    let _ = truth.mechanism.change(|values| {
        if let Some(elements) = values.optional_count("elements") {
            values.set_count("elements", elements * 13 / 10);
        }
    });
    truth.effects.extend_from_slice(effects);
    truth
}

/// The log of a motion on it, from rest with its bristles deflected by the share `wound` of
/// sliding, one sample a control cycle.
fn recorded(
    axis: &Axis,
    truth: &Axis,
    seed: u64,
    wound: f64,
    motion: &impl Motion,
    sense: impl FnMut(&mut Measured),
) -> Result<Log, ReplayError> {
    let mut recorder = Recorder::new(truth);
    // Shorter steps than those that a model's defects are corrected by.
    let step = 0.4 * axis.mechanism.exact_step().unwrap_or(5e-5);
    let closed_loop = ClosedLoop::exact(truth, step)?.with_seed(seed);
    let mut state = closed_loop.start(&Start {
        friction: wound,
        ..Start::at(motion.at(0.0).position)
    })?;
    let none = &mut NoCompensation;
    closed_loop
        .run_from(&mut state, motion, none, sense, |cycle| {
            recorder.push(cycle)
        })
        .completed()?;
    Ok(recorder.log()?)
}

/// The log with its clocks off by what the effects say.
fn late(effects: &[ActiveEffect], log: Log) -> Result<Log, ReplayError> {
    let mut clocks = effects
        .iter()
        .filter(|a| a.effect.channel == EffectChannel::Clock);
    clocks.try_fold(log, |log, clock| {
        let channels = match clock.effect.name {
            "reference-delay" => &OF_REFERENCE[..],
            _ => &OF_LOAD[..],
        };
        shifted(&log, channels, clock.values[0])
    })
}

/// The load's channels.
const OF_LOAD: [&str; 2] = ["position_m", "position_rad"];

/// Channels of the reference.
const OF_REFERENCE: [&str; 6] = [
    "position_ref_m",
    "velocity_ref_m_s",
    "acceleration_ref_m_s2",
    "position_ref_rad",
    "velocity_ref_rad_s",
    "acceleration_ref_rad_s2",
];

/// The log with these channels late by a time.
fn shifted(log: &Log, channels: &[&str], late: f64) -> Result<Log, ReplayError> {
    let time = log.time();
    let period = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let last = (time.len() - 1) as f64;
    let at = |samples: &[f64], k: usize| {
        let along = (k as f64 - late / period).clamp(0.0, last);
        let i = (along as usize).min(samples.len() - 2);
        samples[i] + (along - i as f64) * (samples[i + 1] - samples[i])
    };
    let channel = |c: &Channel| {
        let samples = if channels.contains(&c.name.as_str()) {
            (0..c.samples.len()).map(|k| at(&c.samples, k)).collect()
        } else {
            c.samples.clone()
        };
        Channel {
            name: c.name.clone(),
            unit: c.unit.clone(),
            samples,
        }
    };
    Ok(Log::new(log.channels().iter().map(channel).collect())?)
}
