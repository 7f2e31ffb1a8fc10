//! The motion that a log shows, with its derivatives.

use axis_log::Log;

use super::filter::{LowPass, derivative, integral};
use super::spectrum::{Noise, Source};
use crate::axis::{Axis, LoadSensor};
use crate::balance_error::BalanceError;
use crate::freedom::Freedom;
use crate::torque_channel::names;

/// A coordinate with its derivatives, one value a sample.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// m or rad.
    pub position: Vec<f64>,
    /// Per second.
    pub speed: Vec<f64>,
    /// Per second squared.
    pub acceleration: Vec<f64>,
}

/// Whose motion a channel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Whose {
    Load,
    Motor,
}

/// A channel that shows a motion.
#[derive(Clone, Copy, Debug)]
struct MotionChannel {
    name: &'static str,
    source: Source,
    whose: Whose,
    /// Of that coordinate per unit of the channel.
    scale: f64,
    /// Whether it is called the load's: the motor's then, it was set to the load's position where the log begins.
    is_loads: bool,
}

/// Those of an axis: positions before speeds, the load's before the motor's. Without a sensor at
/// the load, its position and speed are the motor's times the travel per radian.
fn channels(axis: &Axis) -> Vec<MotionChannel> {
    let [position, speed] = match axis.freedom() {
        Freedom::Linear => ["position_m", "velocity_m_s"],
        Freedom::Rotary => ["position_rad", "velocity_rad_s"],
    };
    let (of_load, scale) = match axis.sensors.load {
        LoadSensor::Missing => (Whose::Motor, axis.travel_per_radian().recip()),
        _ => (Whose::Load, 1.0),
    };
    let all = [
        (position, Source::Position, of_load, scale, true),
        (
            "motor_angle_rad",
            Source::Position,
            Whose::Motor,
            1.0,
            false,
        ),
        (speed, Source::Speed, of_load, scale, true),
        ("motor_speed_rad_s", Source::Speed, Whose::Motor, 1.0, false),
    ];
    all.map(|(name, source, whose, scale, is_loads)| MotionChannel {
        name,
        source,
        whose,
        scale,
        is_loads,
    })
    .to_vec()
}

/// A motion as it was measured.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    pub whose: Whose,
    pub name: &'static str,
    /// Whether the channel is called the load's, whosever it is.
    pub is_loads: bool,
    source: Source,
    samples: Vec<f64>,
    pub noise: Noise,
}

impl Measured {
    /// The motions of load and motor that a log shows: one of them or both, positions
    /// rather than speeds.
    pub fn of(log: &Log, period: f64, axis: &Axis) -> Result<Vec<Self>, BalanceError> {
        let mut found: Vec<Self> = Vec::new();
        let mut there: Vec<MotionChannel> = channels(axis);
        there.retain(|channel| log.has(channel.name));
        for channel in there {
            let known = |m: &Self| m.whose == channel.whose || channel.source == Source::Speed;
            if found.iter().any(known) {
                continue;
            }
            let samples = log.channel(channel.name).unwrap_or_default();
            let samples: Vec<f64> = samples.iter().map(|x| channel.scale * x).collect();
            found.push(Self {
                whose: channel.whose,
                name: channel.name,
                is_loads: channel.is_loads,
                source: channel.source,
                noise: Noise::of(&samples, channel.source, period),
                samples,
            });
        }
        if found.is_empty() {
            let needed: Vec<&str> = channels(axis).iter().map(|c| c.name).collect();
            return Err(BalanceError::NoMotion {
                needed: needed.join(", "),
                available: names(log),
            });
        }
        Ok(found)
    }

    /// Its positions as they were sampled, or its speeds integrated from the first sample on.
    pub fn positions(&self, period: f64) -> Vec<f64> {
        match self.source {
            Source::Position => self.samples.clone(),
            Source::Speed => integral(&self.samples, period),
        }
    }

    /// Its speeds as they were sampled, or the differences of its positions.
    pub fn speeds(&self, period: f64) -> Vec<f64> {
        match self.source {
            Source::Position => {
                let steps = self.samples.windows(2).map(|w| (w[1] - w[0]) / period);
                let mut speeds: Vec<f64> = steps.collect();
                speeds.extend(speeds.last().copied());
                speeds
            }
            Source::Speed => self.samples.clone(),
        }
    }

    /// How far a mean speed over `time` seconds may be off by noise and resolution.
    pub fn speed_uncertainty(&self, period: f64, time: f64) -> f64 {
        let deviation = self.noise.deviation(period);
        match self.source {
            Source::Position => deviation * std::f64::consts::SQRT_2 / time,
            Source::Speed => deviation * (period / time).sqrt(),
        }
    }

    /// The power that noise alone has in its samples.
    pub fn noise_power(&self, period: f64) -> f64 {
        self.noise.deviation(period).powi(2)
    }

    /// Its samples, in its own unit.
    pub fn samples(&self) -> &[f64] {
        &self.samples
    }

    /// Low-passed at `cutoff` (Hz), and differentiated; the acceleration as it is expected to be without noise.
    pub fn course(&self, period: f64, cutoff: f64) -> Course {
        let course = self.smoothed(&self.samples, period, cutoff);
        Course {
            acceleration: self.noise.expected(&course.acceleration, period),
            ..course
        }
    }

    /// What of a course this channel shows.
    pub(super) fn shown<'a>(&self, course: &'a Course) -> &'a [f64] {
        match self.source {
            Source::Position => &course.position,
            Source::Speed => &course.speed,
        }
    }

    /// The course that samples like those of this channel show, low-passed at `cutoff` (Hz).
    pub(super) fn smoothed(&self, samples: &[f64], period: f64, cutoff: f64) -> Course {
        let smooth = LowPass::new(cutoff * period).apply(samples);
        let [position, speed] = match self.source {
            Source::Position => {
                let speed = derivative(&smooth, period);
                [smooth, speed]
            }
            Source::Speed => [integral(&smooth, period), smooth],
        };
        Course {
            acceleration: derivative(&speed, period),
            position,
            speed,
        }
    }
}

impl Course {
    /// Its first sample alone; `None` if it has none.
    pub fn first(&self) -> Option<Self> {
        let of = |series: &[f64]| series.first().map(|value| vec![*value]);
        Some(Self {
            position: of(&self.position)?,
            speed: of(&self.speed)?,
            acceleration: of(&self.acceleration)?,
        })
    }

    /// With so many times another motion added.
    pub fn plus(&self, times: f64, other: &Self) -> Self {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + times * b).collect();
        Self {
            position: sum(&self.position, &other.position),
            speed: sum(&self.speed, &other.speed),
            acceleration: sum(&self.acceleration, &other.acceleration),
        }
    }

    /// The same motion at the other end of a stiff transmission.
    pub fn times(&self, factor: f64) -> Self {
        let scaled = |series: &[f64]| series.iter().map(|x| factor * x).collect();
        Self {
            position: scaled(&self.position),
            speed: scaled(&self.speed),
            acceleration: scaled(&self.acceleration),
        }
    }
}
