//! A log of hours: duties, the growth that was read meanwhile, and what a model makes of them.

use crate::duty::Duty;
use crate::error::ThermalError;
use crate::growth::Growth;
use crate::model::ThermalModel;
use crate::run::ThermalAccuracy;
use crate::state::{HeatNode, ThermalState};
use crate::work::AxisAtWork;

/// What a reading of growth shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum GrowthOf {
    /// The screw, against the bed at the front bearing.
    #[default]
    Screw,
    /// The screw, against a gauge that is clamped to the bed at the same place: a touch probe.
    ScrewLessBed,
    /// The screw, against the scale: the scale's position less the motor's.
    ScrewLessScale,
}

impl Growth {
    /// What a reading shows of it, m.
    pub fn read(&self, of: GrowthOf) -> f64 {
        match of {
            GrowthOf::Screw => self.screw,
            GrowthOf::ScrewLessBed => self.screw - self.bed,
            GrowthOf::ScrewLessScale => self.screw - self.scale,
        }
    }
}

/// What readings of growth count from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum GrowthZero {
    /// The beginning of the log.
    #[default]
    Begin,
    /// The first reading at each place: its value there is unknown, as the pitch errors of a screw are.
    FirstAtPlace,
}

/// A stretch of a log: a duty, and what was read at its end.
#[derive(Clone, Debug)]
pub struct GrowthStretch {
    /// Losses of the reference; a standstill is a duty too.
    pub duty: Duty,
    /// How long, s.
    pub duration: f64,
    /// Temperature of the air at its begin and its end, °C.
    pub air: [f64; 2],
    /// Positions (m) and readings of growth (m) at the end of the stretch.
    pub found: Vec<[f64; 2]>,
    /// Mean power of the friction over the stretch, W: mean of torque times speed of the motor over whole
    /// repetitions of the duty. None if nothing was measured.
    pub friction: Option<f64>,
    /// Bodies whose temperature was read at the end of the stretch, and what was read, °C.
    pub temperatures: Vec<(HeatNode, f64)>,
}

/// A log that begins with all bodies at the temperature of the air.
#[derive(Clone, Debug, Default)]
pub struct GrowthLog {
    /// Its stretches, in their order.
    pub stretches: Vec<GrowthStretch>,
    /// What its readings show.
    pub of: GrowthOf,
    /// What they count from.
    pub zero: GrowthZero,
}

/// A reading of growth, and what the model says of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FollowedGrowth {
    /// Number of its stretch, from 0.
    pub stretch: usize,
    /// Time of the reading since the log's begin, s.
    pub time: f64,
    /// Position, m.
    pub place: f64,
    /// As it was read, m.
    pub found: f64,
    /// As the model has it, m.
    pub predicted: f64,
}

/// A reading of the friction's power, and what the model says of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FollowedFriction {
    /// Number of its stretch, from 0.
    pub stretch: usize,
    /// How long that is, s.
    pub duration: f64,
    /// As it was read, W.
    pub found: f64,
    /// As the model has it, W.
    pub predicted: f64,
}

/// All readings of a log beside what a model says of them.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FollowedLog {
    /// Of growth.
    pub growth: Vec<FollowedGrowth>,
    /// Of the friction's power.
    pub friction: Vec<FollowedFriction>,
    /// Of temperatures: number of the stretch, model less log, K.
    pub temperatures: Vec<(usize, f64)>,
}

impl FollowedLog {
    /// Model less log of each reading of growth, m.
    pub fn errors(&self) -> impl Iterator<Item = f64> + '_ {
        self.growth.iter().map(|read| read.predicted - read.found)
    }

    /// Readings of the friction's power; a standstill has none to compare.
    pub(crate) fn powers(&self) -> impl Iterator<Item = &FollowedFriction> {
        self.friction.iter().filter(|read| read.found > 0.0)
    }
}

impl FollowedFriction {
    /// Model less log as a share, weighted by its duration beside the usual one: in seconds a mean says little.
    pub(crate) fn deviation(&self, usual: f64) -> f64 {
        (self.duration / usual).sqrt() * (self.predicted / self.found - 1.0)
    }
}

/// The usual duration of the stretches with a power, Σ t²/Σ t, s.
pub(crate) fn usual_duration(followed: &[FollowedLog]) -> f64 {
    let times = || followed.iter().flat_map(FollowedLog::powers);
    let total: f64 = times().map(|read| read.duration).sum();
    let squares: f64 = times().map(|read| read.duration * read.duration).sum();
    squares / total
}

/// Positions nearer than this count as one, m.
const SAME_PLACE: f64 = 1e-6;

/// What the readings of a log count from, place by place.
#[derive(Clone, Debug)]
pub struct GrowthZeros {
    zero: GrowthZero,
    /// First position, reading and prediction of each place.
    first: Vec<[f64; 3]>,
}

impl GrowthZeros {
    /// Before the first reading.
    pub fn new(zero: GrowthZero) -> Self {
        let first = Vec::new();
        Self { zero, first }
    }

    /// Position, reading and prediction (m) as they are compared: less those that they count from. None for a
    /// reading that the later ones at its place count from.
    pub fn counted(&mut self, reading: [f64; 3]) -> Option<[f64; 3]> {
        let [place, found, predicted] = reading;
        if self.zero == GrowthZero::Begin {
            return Some(reading);
        }
        let known = self
            .first
            .iter()
            .find(|at| (at[0] - place).abs() < SAME_PLACE);
        let Some(zero) = known else {
            self.first.push(reading);
            return None;
        };
        Some([place, found - zero[1], predicted - zero[2]])
    }
}

impl GrowthLog {
    /// The first stretches, as a log.
    #[must_use]
    pub fn first(&self, stretches: usize) -> Self {
        let count = stretches.min(self.stretches.len());
        Self {
            stretches: self.stretches[..count].to_vec(),
            ..*self
        }
    }

    /// How many readings of growth a model is compared with: not those that others count from.
    pub fn comparisons(&self) -> usize {
        let mut zeros = GrowthZeros::new(self.zero);
        let all = self.stretches.iter().flat_map(|stretch| &stretch.found);
        all.filter_map(|&[place, found]| zeros.counted([place, found, 0.0]))
            .count()
    }

    pub(crate) fn validate(&self) -> Result<(), ThermalError> {
        for (number, stretch) in self.stretches.iter().enumerate() {
            let found = stretch.found.iter();
            let read = found.flat_map(|&[place, growth]| [("place", place), ("growth", growth)]);
            let air = stretch.air.map(|air| ("temperature of the air", air));
            let friction = stretch
                .friction
                .map(|power| ("power of the friction", power));
            let duration = [("duration", stretch.duration)];
            let bodies = stretch.temperatures.iter();
            let bodies = bodies.map(|(_, found)| ("temperature of a body", *found));
            for (channel, value) in read
                .chain(air)
                .chain(friction)
                .chain(duration)
                .chain(bodies)
            {
                if !value.is_finite() {
                    return Err(ThermalError::Log {
                        stretch: number + 1,
                        channel,
                        value,
                    });
                }
            }
        }
        Ok(())
    }
}

impl ThermalModel {
    /// Follows a log: all readings beside what this model says of them.
    ///
    /// # Errors
    /// [`ThermalError`] if the log's duties are of another screw, or a number of it is not finite.
    pub fn follow(&self, log: &GrowthLog) -> Result<FollowedLog, ThermalError> {
        log.validate()?;
        let first = log.stretches.first().map_or(0.0, |stretch| stretch.air[0]);
        let cold = self.at_rest(first);
        let mut state = cold.clone();
        let mut followed = FollowedLog::default();
        let mut zeros = GrowthZeros::new(log.zero);
        let mut at_work: Option<(&Duty, AxisAtWork)> = None;
        for (number, stretch) in log.stretches.iter().enumerate() {
            // The same duty goes on in the same network.
            let network = match at_work.take() {
                Some((duty, network)) if *duty == stretch.duty => network,
                _ => self.under(&stretch.duty)?,
            };
            match stretch.friction {
                None => advance(&network, &mut state, stretch, [0.0, 1.0])?,
                Some(found) => {
                    // Simpson's rule.
                    let before = friction_power(&network, &state);
                    advance(&network, &mut state, stretch, [0.0, 0.5])?;
                    let middle = friction_power(&network, &state);
                    advance(&network, &mut state, stretch, [0.5, 1.0])?;
                    let after = friction_power(&network, &state);
                    followed.friction.push(FollowedFriction {
                        stretch: number,
                        duration: stretch.duration,
                        found,
                        predicted: (before + 4.0 * middle + after) / 6.0,
                    });
                }
            }
            at_work = Some((&stretch.duty, network));
            let read = stretch.temperatures.iter();
            let read = read.map(|(node, found)| (number, state.of(*node) - found));
            followed.temperatures.extend(read);
            for &[place, found] in &stretch.found {
                let predicted = self.growth(&cold, &state, place).read(log.of);
                let Some([_, found, predicted]) = zeros.counted([place, found, predicted]) else {
                    continue;
                };
                followed.growth.push(FollowedGrowth {
                    stretch: number,
                    time: state.time,
                    place,
                    found,
                    predicted,
                });
            }
        }
        Ok(followed)
    }
}

fn friction_power(at_work: &AxisAtWork, state: &ThermalState) -> f64 {
    let losses = at_work.losses(state);
    losses.total() - losses.winding
}

/// A part of a stretch, from one share of it to another, in air that changes linearly.
fn advance(
    at_work: &AxisAtWork,
    state: &mut ThermalState,
    stretch: &GrowthStretch,
    [from, to]: [f64; 2],
) -> Result<(), ThermalError> {
    let (begun, whole) = (state.time, stretch.duration);
    let [first, last] = stretch.air;
    let air = |t: f64| first + (last - first) * (from + (t - begun) / whole);
    at_work.run_in(state, air, (to - from) * whole, &ThermalAccuracy::default())?;
    Ok(())
}
