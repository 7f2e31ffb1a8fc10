//! Machines with something hidden in them, to try the search on.
//!
//! The truth is made another way than the model: the paper's moving node on a
//! finer mesh, Newmark's rule in steps of 20 µs, known parameters off, and
//! noise in every sensor that the controller sees as well.

mod outside;

pub use outside::OUTSIDE;

use axis_log::{Channel, Log};
use axis_sim::effects::{ActiveEffect, EffectChannel, Measure, Scales};
use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, ClosedLoop, Measured, Recorder, ReplayError, position_in};
use compensator::NoCompensation;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use trajectories::{Limits, Motion, Program, Step, TrajectoryError};

/// Standard deviations of sensor noise, white at the control rate.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    /// Table position, m.
    pub position: f64,
    /// Motor angle, rad.
    pub angle: f64,
    /// Motor speed, rad/s.
    pub speed: f64,
    /// Each current, A.
    pub current: f64,
}

impl Noise {
    /// A good linear scale, a motor encoder with sine interpolation and a
    /// current sensor of 15 A range.
    pub const GOOD: Self = Self {
        position: 1e-8,
        angle: 2e-6,
        speed: 0.01,
        current: 5e-3,
    };

    /// As good ones for an axis: on the paper's, [`Noise::GOOD`].
    pub fn good(axis: &Axis) -> Self {
        let current = axis.actuator.limit() / 15.0;
        // A resolver's noise at a motor's shaft; of a motor that is the load, that of the
        // scale's differences.
        let speed = match axis.mechanism.has_motor_encoder() {
            true => Self::GOOD.speed,
            false => Self::GOOD.speed * Self::GOOD.position / Self::GOOD.angle,
        };
        let position = match axis.freedom() {
            Freedom::Linear => Self::GOOD.position,
            Freedom::Rotary => 10.0 * Self::GOOD.position,
        };
        Self {
            position,
            speed,
            current: current * Self::GOOD.current,
            ..Self::GOOD
        }
    }

    /// The same, `by` times as large.
    pub fn scaled(self, by: f64) -> Self {
        Self {
            position: by * self.position,
            angle: by * self.angle,
            speed: by * self.speed,
            current: by * self.current,
        }
    }

    /// Each sensor's noise as many times as large as `by` says.
    pub(crate) fn times(self, by: Self) -> Self {
        Self {
            position: self.position * by.position,
            angle: self.angle * by.angle,
            speed: self.speed * by.speed,
            current: self.current * by.current,
        }
    }

    /// Sensors with this noise, for [`ClosedLoop::run_sensed`]: the same seed
    /// gives the same noise.
    pub fn sensors(self, seed: u64) -> impl FnMut(&mut Measured) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = move |deviation: f64| {
            let unit: f64 = StandardNormal.sample(&mut random);
            deviation * unit
        };
        move |seen: &mut Measured| {
            seen.position += normal(self.position);
            seen.motor_angle += normal(self.angle);
            seen.motor_speed += normal(self.speed);
            seen.current.d += normal(self.current);
            seen.current.q += normal(self.current);
        }
    }
}

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
        let off = |_| share * (2.0 * random.random::<f64>() - 1.0);
        self.shares = machine.known().into_iter().map(off).collect();
        self
    }

    /// The log of a motion, one sample every `every` control cycles.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine cannot be set up or does not hold.
    pub fn log(&self, axis: &Axis, motion: &impl Motion, every: usize) -> Result<Log, ReplayError> {
        let mut truth = axis.with_known(&self.shares);
        // On a finer mesh, where the mechanism has one.
        let _ = truth.mechanism.change(|values| {
            if let Some(elements) = values.optional_count("elements") {
                values.set_count("elements", elements * 13 / 10);
            }
        });
        truth.effects.extend_from_slice(&self.effects);

        let sense = self.noise.sensors(self.seed);
        let mut recorder = Recorder::new(&truth);
        // Shorter steps than those that a model's defects are corrected by.
        let step = 0.4 * axis.mechanism.exact_step().unwrap_or(5e-5);
        ClosedLoop::exact(&truth, step)?
            .with_seed(self.seed)
            .run_sensed(motion, &mut NoCompensation, sense, |cycle| {
                recorder.push(cycle)
            })
            .completed()?;
        let late = self.clock_offset();
        let log = recorder.log()?;
        let log = if late == 0.0 {
            log
        } else {
            shifted(&log, late)?
        };
        Ok(log.decimate(every)?)
    }

    fn clock_offset(&self) -> f64 {
        let clock = self
            .effects
            .iter()
            .filter(|a| a.effect.channel == EffectChannel::Clock);
        clock.map(|a| a.values[0]).sum()
    }
}

/// The log with the table's channel late by a time.
fn shifted(log: &Log, late: f64) -> Result<Log, ReplayError> {
    let time = log.time();
    let period = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let position = position_in(log)?;
    let last = (position.len() - 1) as f64;
    let at = |k: usize| {
        let along = (k as f64 - late / period).clamp(0.0, last);
        let i = (along as usize).min(position.len() - 2);
        position[i] + (along - i as f64) * (position[i + 1] - position[i])
    };
    let channel = |c: &Channel| {
        let samples = if ["position_m", "position_rad"].contains(&c.name.as_str()) {
            (0..position.len()).map(at).collect()
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

/// Motions that a log may be taken on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Exercise {
    /// A move and the way back.
    ThereAndBack,
    /// That, slow and fast.
    SlowAndFast,
    /// That, and a small chirp.
    WithChirp,
    /// A move, and no way back: too poor to tell many effects from one another.
    OneWay,
}

impl Exercise {
    /// Those that are rich enough for most questions.
    pub const RICH: [Self; 3] = [Self::ThereAndBack, Self::SlowAndFast, Self::WithChirp];

    /// In tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::ThereAndBack => "there-and-back",
            Self::SlowAndFast => "slow-and-fast",
            Self::WithChirp => "with-chirp",
            Self::OneWay => "one-way",
        }
    }
}

/// The exercise on this axis; `check` gives one of the same kind that differs
/// in length and speed.
///
/// # Errors
/// [`TrajectoryError`] where it does not fit the axis.
pub fn exercise(axis: &Axis, kind: Exercise, check: bool) -> Result<Program, TrajectoryError> {
    let start = axis.stroke.start;
    let (length, share) = if check { (0.85, 0.8) } else { (1.0, 1.0) };
    let scales = Scales::of(axis);
    let length = length * scales.motion;
    let of_speed = scales.ratio(Measure::Speed);
    // The same course in time as on the paper's axis, faster or slower.
    let pace = of_speed / (scales.motion / 0.2);
    // As far as the actuator has the force.
    let of_acceleration = (of_speed * pace).min(scales.ratio(Measure::Acceleration));
    let to = |position: f64, speed: f64| -> Result<Step, TrajectoryError> {
        let acceleration = share * 0.225 * (speed / 0.1) * of_acceleration;
        let jerk = 1.2 * of_acceleration * pace;
        Ok(Step::Move {
            to: position,
            limits: Limits::new(share * speed * of_speed, acceleration, jerk)?,
        })
    };
    let rest = Step::Dwell { duration: 0.2 };
    let mut steps = vec![rest, to(start + length, 0.1)?, rest];
    if kind != Exercise::OneWay {
        steps.extend([to(start, 0.1)?, rest]);
    }
    if matches!(kind, Exercise::SlowAndFast | Exercise::WithChirp) {
        steps.extend([
            to(start + 0.2 * length, 0.03)?,
            rest,
            to(start, 0.03)?,
            rest,
        ]);
        steps.extend([to(start + length, 0.25)?, rest, to(start, 0.25)?, rest]);
    }
    if kind == Exercise::WithChirp {
        let amplitude = if check { 2.5e-5 } else { 3e-5 };
        let chirp = trajectories::Chirp {
            amplitude: amplitude * scales.ratio(Measure::Acceleration),
            from_frequency: 2.0,
            to_frequency: 90.0,
            duration: 2.5,
            ramp: 0.1,
            sweep: trajectories::Sweep::default(),
        };
        steps.extend([Step::Chirp(chirp), rest]);
    }
    Program::new(start, steps)
}
