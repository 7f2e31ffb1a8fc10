//! What heats an axis: losses of a motion that repeats itself, by place of the nut.

use crate::error::ThermalError;

/// A stretch of a motion, short beside the time in which a speed changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct DutySample {
    /// How long it lasts, s.
    pub duration: f64,
    /// Place of the nut, m; of no account without a screw.
    pub position: f64,
    /// Speed of the screw, rad/s.
    pub screw_speed: f64,
    /// Power of the dry friction at the reference temperature, W.
    pub dry_power: f64,
    /// Power of the viscous friction there, W.
    pub viscous_power: f64,
    /// Torque of the motor, N·m (N): what inertia and loads ask for, what dry friction does, and
    /// what viscous friction does, at the reference temperature.
    pub torque: [f64; 3],
}

/// Mean losses of a motion, by place of the nut. Begins empty as
/// [`ThermalModel::duty`](crate::ThermalModel::duty); [`Duty::push`] adds to it.
///
/// Bounded: as many numbers as the screw has segments, however long the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Duty {
    length: f64,
    nut: f64,
    duration: f64,
    time: Vec<f64>,
    travel: Vec<f64>,
    dry: Vec<f64>,
    viscous: Vec<f64>,
    turning: f64,
    torque: [[f64; 3]; 3],
}

impl Duty {
    /// An empty one of a screw of that length in so many segments, and the length of its nut, m.
    pub(crate) fn new(length: f64, nut: f64, segments: usize) -> Self {
        let zeros = || vec![0.0; segments];
        Self {
            length,
            nut: nut.max(length / segments as f64),
            duration: 0.0,
            time: zeros(),
            travel: zeros(),
            dry: zeros(),
            viscous: zeros(),
            turning: 0.0,
            torque: [[0.0; 3]; 3],
        }
    }

    /// Adds a stretch. What the nut has of length beyond the ends of the screw counts at the
    /// segment at that end.
    pub fn push(&mut self, sample: &DutySample) {
        let t = sample.duration;
        if t <= 0.0 {
            return;
        }
        self.duration += t;
        let speed = sample.screw_speed.abs();
        self.turning += t * speed.powf(2.0 / 3.0);
        for (row, a) in self.torque.iter_mut().zip(sample.torque) {
            for (sum, b) in row.iter_mut().zip(sample.torque) {
                *sum += t * a * b;
            }
        }
        let (first, last) = self.under(sample.position);
        for i in first..=last {
            let share = t * self.share(sample.position, i);
            self.time[i] += share;
            self.travel[i] += share * speed;
            self.dry[i] += share * sample.dry_power;
            self.viscous[i] += share * sample.viscous_power;
        }
    }

    fn cell(&self) -> f64 {
        self.length / self.time.len() as f64
    }

    fn index(&self, place: f64) -> usize {
        let most = self.time.len() - 1;
        ((place / self.cell()).max(0.0) as usize).min(most)
    }

    /// First and last segment under the nut at `position`.
    fn under(&self, position: f64) -> (usize, usize) {
        let half = 0.5 * self.nut;
        (self.index(position - half), self.index(position + half))
    }

    /// Share of the nut over segment `i`.
    fn share(&self, position: f64, i: usize) -> f64 {
        let most = self.time.len() - 1;
        let cell = self.cell();
        let from = match i {
            0 => f64::NEG_INFINITY,
            i => i as f64 * cell,
        };
        let to = match i == most {
            true => f64::INFINITY,
            false => (i + 1) as f64 * cell,
        };
        let half = 0.5 * self.nut;
        let over = (position + half).min(to) - (position - half).max(from);
        over.max(0.0) / self.nut
    }

    /// How long the motion lasts, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Mean power of dry and of viscous friction at the reference temperature, W.
    pub fn friction_power(&self) -> [f64; 2] {
        let mean = |of: &[f64]| of.iter().sum::<f64>() / self.duration;
        [mean(&self.dry), mean(&self.viscous)]
    }

    /// The same motion with dry and viscous friction that are so many times those at the reference temperature.
    #[must_use]
    pub fn with_friction(&self, levels: [f64; 2]) -> Self {
        let [dry, viscous] = levels;
        let times = |of: &[f64], level: f64| of.iter().map(|power| level * power).collect();
        let weights = [1.0, dry, viscous];
        let mut torque = self.torque;
        for (row, a) in torque.iter_mut().zip(weights) {
            for (product, b) in row.iter_mut().zip(weights) {
                *product *= a * b;
            }
        }
        Self {
            dry: times(&self.dry, dry),
            viscous: times(&self.viscous, viscous),
            torque,
            ..self.clone()
        }
    }

    /// Mean speed of the screw, whatever its direction, rad/s.
    pub fn mean_speed(&self) -> f64 {
        self.travel.iter().sum::<f64>() / self.duration
    }

    /// Mean square of the motor's torque, where dry and viscous friction are the known ones times
    /// `factors`, (N·m)².
    pub fn torque_squared(&self, factors: [f64; 2]) -> f64 {
        let weights = [1.0, factors[0], factors[1]];
        let mut sum = 0.0;
        for (row, a) in self.torque.iter().zip(weights) {
            for (product, b) in row.iter().zip(weights) {
                sum += a * b * product;
            }
        }
        sum / self.duration
    }

    /// Share of the time in which the nut is over each segment.
    pub fn time_shares(&self) -> Vec<f64> {
        self.time.iter().map(|t| t / self.duration).collect()
    }

    /// Shares of the travel there; of the time, if the axis stands still throughout.
    pub(crate) fn travel_shares(&self) -> Vec<f64> {
        let all: f64 = self.travel.iter().sum();
        match all > 0.0 {
            true => self.travel.iter().map(|way| way / all).collect(),
            false => self.time_shares(),
        }
    }

    /// Mean power of dry and viscous friction over each segment, W.
    pub(crate) fn by_segment(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let mean = |sum: &f64| sum / self.duration;
        let both = self.dry.iter().zip(&self.viscous);
        both.map(move |(dry, viscous)| [mean(dry), mean(viscous)])
    }

    /// Mean of |ω|^⅔, (rad/s)^⅔.
    pub(crate) fn turning(&self) -> f64 {
        self.turning / self.duration
    }

    pub(crate) fn places(&self) -> usize {
        self.time.len()
    }

    pub(crate) fn validate(&self) -> Result<(), ThermalError> {
        match self.duration > 0.0 {
            true => Ok(()),
            false => Err(ThermalError::NoDuration),
        }
    }
}
