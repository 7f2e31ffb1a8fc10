//! Machines with something hidden in them, to try the search on.
//!
//! The truth is made another way than the model: the paper's moving node on a
//! finer mesh, Newmark's rule in steps of 20 µs, known parameters off, and
//! noise in every sensor that the controller sees as well.

mod outside;

pub use outside::OUTSIDE;

use axis_log::{Channel, Log};
use axis_sim::effects::{ActiveEffect, Machine};
use axis_sim::{Axis, ClosedLoop, Measured, Recorder, ReplayError};
use compensator::NoCompensation;
use feed_dynamics::{FeedDrive, NutCoupling};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use trajectories::{Limits, Motion, Program, Step, TrajectoryError};

use crate::known::{known_parameters, with_known};

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

    /// The same, `by` times as large.
    pub fn scaled(self, by: f64) -> Self {
        Self {
            position: by * self.position,
            angle: by * self.angle,
            speed: by * self.speed,
            current: by * self.current,
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
    /// Shares by which its known parameters are off, in the order of
    /// [`known_parameters`].
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
        let machine = Machine::BallScrew(Box::new(machine.clone()));
        let off = |_| share * (2.0 * random.random::<f64>() - 1.0);
        self.shares = known_parameters(&machine).iter().map(off).collect();
        self
    }

    /// The log of a motion, one sample every `every` control cycles.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine cannot be set up or does not hold.
    pub fn log(&self, axis: &Axis, motion: &impl Motion, every: usize) -> Result<Log, ReplayError> {
        let machine = Machine::BallScrew(Box::new(axis.clone()));
        let Machine::BallScrew(mut truth) = with_known(&machine, &self.shares) else {
            return Ok(Recorder::default().log()?);
        };
        let mut parameters = truth.drive.parameters().clone();
        parameters.elements = parameters.elements * 13 / 10;
        truth.drive = FeedDrive::new(parameters)?;
        truth.coupling = NutCoupling::MovingNode;
        truth.simulation.step = 2e-5;
        truth.effects.extend_from_slice(&self.effects);

        let sense = self.noise.sensors(self.seed);
        let mut recorder = Recorder::default();
        ClosedLoop::implicit(&truth)?
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
            .filter(|a| a.effect.name == "clock-offset");
        clock.map(|a| a.values[0]).sum()
    }
}

/// The log with the table's channel late by a time.
fn shifted(log: &Log, late: f64) -> Result<Log, ReplayError> {
    let time = log.time();
    let period = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let position = log.channel("position_m")?;
    let last = (position.len() - 1) as f64;
    let at = |k: usize| {
        let along = (k as f64 - late / period).clamp(0.0, last);
        let i = (along as usize).min(position.len() - 2);
        position[i] + (along - i as f64) * (position[i + 1] - position[i])
    };
    let channel = |c: &Channel| {
        let samples = if c.name == "position_m" {
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
    let (length, share) = if check { (0.17, 0.8) } else { (0.2, 1.0) };
    let to = |position: f64, speed: f64| -> Result<Step, TrajectoryError> {
        Ok(Step::Move {
            to: position,
            limits: Limits::new(share * speed, share * 0.225 * (speed / 0.1), 1.2)?,
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
        let chirp = trajectories::Chirp {
            amplitude: if check { 2.5e-5 } else { 3e-5 },
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
