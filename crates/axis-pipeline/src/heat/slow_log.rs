//! A log of hours: its duties, and the growth that was read meanwhile.
//!
//! | channel | |
//! |---|---|
//! | `t_s` | time |
//! | `duty_1` | number of the duty since the row before, from 1; 0 at standstill |
//! | or `position_ref_m` | the reference, five times a second or oftener; `velocity_ref_m_s` if it is there |
//! | or both of them | sampled every 5 s or oftener: each row is one of the states that the motion passes through |
//! | `air_degc` | temperature of the air; if it is not there the one that is stated |
//! | `place_m`, `growth_m` | where growth was probed, and what was found; `probed_1` is 1 in rows in which it was |
//! | or `position_m`, `motor_angle_rad` | the scale and the motor's encoder |
//! | `nut_degc`, `front_bearing_degc`, … | temperatures of bodies that have a sensor (winding, housing, rear_bearing, table, bed, scale) |
//! | `friction_w` | mean power of the friction since the row before; 0 in rows without it |
//! | or `torque_n_m`, or `iq_a` | torque or q current of the motor, beside a reference |
//!
//! Lengths may be in m, mm or µm (`growth_um`), speeds in m/s, mm/s or m/min, angles in rad, ° or turns.

use axis_log::Log;
use axis_sim::Axis;
use axis_sim::thermal::LossModel;
use axis_thermal::{
    Duty, DutySample, GrowthLog, GrowthOf, GrowthStretch, GrowthZero, HeatNode, ThermalModel,
};
use trajectories::Setpoint;

use super::HeatError;
use super::channels::{CURRENT, LENGTH, NUMBER, POWER, SPEED, TEMPERATURE, TORQUE, channel};
use super::readings::{self, Reading};
use crate::strategies::SharedMotion;

/// Longest sampling interval of a reference without its speed, s: beyond it speeds are not known.
const LONGEST_INTERVAL: f64 = 0.21;

/// Longest sampling interval of a reference with its speed, s: of a stretch of 5 min it shows 60 states, and the mean
/// of a loss over them is off by some 5 % of what the loss scatters by.
const LONGEST_SAMPLED: f64 = 5.5;

/// Fewest positions in which a sampled reference must be seen: of a motion whose period is a multiple of the interval
/// the same few states come again and again.
const FEWEST_POSITIONS: usize = 20;

/// How a log is read.
#[derive(Clone)]
pub struct SlowLogOptions<'a> {
    /// The duties that `duty_1` counts from 1; each repeats itself.
    pub duties: &'a [SharedMotion],
    /// Temperature of the air if the log has none, °C.
    pub air: f64,
    /// Longest stretch of a reference, s; growth by encoder and scale is read at the end of each.
    pub window: f64,
    /// What a probe reads.
    pub probe: GrowthOf,
    /// What readings of a probe count from. Those of encoder and scale count from the first at each place.
    pub zero: GrowthZero,
}

impl Default for SlowLogOptions<'_> {
    /// No duties; 20 °C; 5 min; growth against the bed at the front bearing, since the begin.
    fn default() -> Self {
        Self {
            duties: &[],
            air: 20.0,
            window: 300.0,
            probe: GrowthOf::Screw,
            zero: GrowthZero::Begin,
        }
    }
}

/// What a probe reads growth against, by its name.
///
/// # Errors
/// [`HeatError::Log`] names those that there are.
pub fn probe_of(name: &str) -> Result<GrowthOf, HeatError> {
    match name {
        "bearing" => Ok(GrowthOf::Screw),
        "bed" => Ok(GrowthOf::ScrewLessBed),
        other => Err(HeatError::log(
            format!("is said to be probed against \"{other}\""),
            "\"bearing\" (the bed at the front bearing) or \"bed\" (at the same position)",
        )),
    }
}

/// What readings of a probe count from, by its name.
///
/// # Errors
/// [`HeatError::Log`] names those that there are.
pub fn zero_of(name: &str) -> Result<GrowthZero, HeatError> {
    match name {
        "begin" => Ok(GrowthZero::Begin),
        "first" => Ok(GrowthZero::FirstAtPlace),
        other => Err(HeatError::log(
            format!("is said to count from \"{other}\""),
            "\"begin\" (of the log) or \"first\" (reading at each position)",
        )),
    }
}

/// What moves the axis.
enum Source<'a> {
    Duties {
        programs: &'a [SharedMotion],
        number: Vec<f64>,
    },
    Reference {
        position: Vec<f64>,
        velocity: Vec<f64>,
        /// Whether rows are states of a motion that is not seen between them.
        sampled: bool,
        /// Rows at constant speed.
        constant: Vec<bool>,
    },
}

/// A log of hours, checked.
pub struct SlowLog<'a> {
    axis: &'a Axis,
    losses: LossModel,
    source: Source<'a>,
    /// Since the log's begin, s.
    time: Vec<f64>,
    air: Vec<f64>,
    /// Rows at which a stretch ends, and what was read there.
    ends: Vec<Reading>,
    friction: Option<Vec<f64>>,
    temperatures: Vec<(HeatNode, Vec<f64>)>,
    of: GrowthOf,
    zero: GrowthZero,
}

impl<'a> SlowLog<'a> {
    /// Reads the channels.
    ///
    /// # Errors
    /// [`HeatError`] if the axis has no screw, the log has neither duties nor a reference, or a value of it makes no
    /// sense.
    pub fn new(axis: &'a Axis, log: &Log, options: &SlowLogOptions<'a>) -> Result<Self, HeatError> {
        if axis.thermal_parameters().screw.is_none() {
            return Err(HeatError::NoScrew);
        }
        let begun = log.time()[0];
        let time: Vec<f64> = log.time().iter().map(|t| t - begun).collect();
        let air = channel(log, "air", TEMPERATURE);
        let air = air.unwrap_or_else(|| vec![options.air; time.len()]);
        let source = source(log, options)?;
        let read = match &source {
            Source::Duties { .. } => readings::of_rows(log, &time)?,
            Source::Reference {
                position,
                constant,
                velocity,
                ..
            } => {
                let reference = readings::Reference {
                    position,
                    velocity,
                    constant,
                };
                readings::of_reference(axis, log, &time, &reference, options.window)?
            }
        };
        let friction = friction(axis, log, &source);
        Ok(Self {
            axis,
            losses: LossModel::of(axis)?,
            source,
            time,
            air,
            ends: read.ends,
            friction,
            temperatures: temperatures(log),
            of: match read.by_scale {
                true => GrowthOf::ScrewLessScale,
                false => options.probe,
            },
            zero: match read.by_scale {
                true => GrowthZero::FirstAtPlace,
                false => options.zero,
            },
        })
    }

    /// What its readings show, and what they count from.
    pub fn reads(&self) -> (GrowthOf, GrowthZero) {
        (self.of, self.zero)
    }

    /// Times of its rows since the begin, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// The reference's positions, m; none if the log names duties.
    pub fn reference(&self) -> Option<&[f64]> {
        match &self.source {
            Source::Duties { .. } => None,
            Source::Reference { position, .. } => Some(position),
        }
    }

    /// The axis that it is of.
    pub(super) fn axis(&self) -> &Axis {
        self.axis
    }

    /// Temperatures of the air at each row, °C.
    pub(super) fn air(&self) -> &[f64] {
        &self.air
    }

    /// The rows at which a stretch ends.
    pub(super) fn ends(&self) -> &[Reading] {
        &self.ends
    }

    /// The log as stretches for a model.
    pub fn stretches(&self, model: &ThermalModel) -> GrowthLog {
        let mut from = 0;
        let mut stretches = Vec::new();
        for end in &self.ends {
            stretches.push(GrowthStretch {
                duty: self.duty(model, from, end.row),
                duration: self.time[end.row] - self.time[from],
                air: [self.air[from], self.air[end.row]],
                found: end.found.clone(),
                friction: self.friction_between(from, end.row),
                temperatures: self.temperatures_at(end.row),
            });
            from = end.row;
        }
        GrowthLog {
            stretches,
            of: self.of,
            zero: self.zero,
        }
    }

    /// Losses from one row to another.
    pub(super) fn duty(&self, model: &ThermalModel, from: usize, to: usize) -> Duty {
        let mut duty = model.duty();
        match &self.source {
            Source::Duties { programs, number } => {
                let number = number[to] as usize;
                match number.checked_sub(1).and_then(|i| programs.get(i)) {
                    Some(program) => self.losses.add_motion(&mut duty, self.axis, &**program),
                    None => self.standstill(&mut duty, model),
                }
            }
            Source::Reference { .. } if from == to => self.standstill(&mut duty, model),
            Source::Reference { .. } => {
                for row in from..to {
                    duty.push(&self.sample(row));
                }
            }
        }
        duty
    }

    fn standstill(&self, duty: &mut Duty, model: &ThermalModel) {
        let screw = model.parameters().screw;
        duty.push(&DutySample {
            duration: 1.0,
            position: screw.map_or(0.0, |screw| 0.5 * screw.length),
            ..DutySample::default()
        });
    }

    /// The reference from one row to the next; nothing of a log of duties.
    pub(super) fn sample(&self, row: usize) -> DutySample {
        let Source::Reference {
            position,
            velocity,
            sampled,
            ..
        } = &self.source
        else {
            return DutySample::default();
        };
        let step = self.time[row + 1] - self.time[row];
        let at = match sampled {
            // How it gets from one state to the next is not known, and inertia takes as much as it gives.
            true => Setpoint {
                position: position[row],
                velocity: velocity[row],
                ..Setpoint::default()
            },
            // What it has travelled is known better than its speed at either end.
            false => Setpoint {
                position: 0.5 * (position[row] + position[row + 1]),
                velocity: (position[row + 1] - position[row]) / step,
                acceleration: (velocity[row + 1] - velocity[row]) / step,
                ..Setpoint::default()
            },
        };
        self.losses.set_point(self.axis, step, &at)
    }

    /// Mean power of friction, W.
    fn friction_between(&self, from: usize, to: usize) -> Option<f64> {
        let read = self.friction.as_ref()?;
        let Source::Reference {
            position, sampled, ..
        } = &self.source
        else {
            return Some(read[to]).filter(|power| *power > 0.0);
        };
        if from == to {
            return None;
        }
        if *sampled {
            return self.friction_of_states(read, from, to);
        }
        // Torque of inertia and loads is the reference's, which no friction takes part in.
        let power = |row: usize| {
            let sample = self.sample(row);
            let turned = (position[row + 1] - position[row]) / self.axis.travel_per_radian();
            turned * (0.5 * (read[row] + read[row + 1]) - sample.torque[0])
        };
        let sum: f64 = (from..to).map(power).sum();
        Some(sum / (self.time[to] - self.time[from]))
    }

    /// The same by the states at constant speed, where the motor has friction and loads alone to overcome: their share of
    /// what is known of the friction in these states, times what is known of it over the whole stretch.
    fn friction_of_states(&self, read: &[f64], from: usize, to: usize) -> Option<f64> {
        let Source::Reference {
            velocity, constant, ..
        } = &self.source
        else {
            return None;
        };
        let (mut shown, mut known, mut whole, mut rows) = (0.0, 0.0, 0.0, 0);
        for row in from..to {
            let sample = self.sample(row);
            let friction = sample.dry_power + sample.viscous_power;
            whole += sample.duration * friction;
            if constant[row] {
                let turns = velocity[row] / self.axis.travel_per_radian();
                shown += turns * (read[row] - sample.torque[0]);
                known += friction;
                rows += 1;
            }
        }
        let mean = whole / (self.time[to] - self.time[from]);
        (rows >= FEWEST_STATES && known > 0.0).then(|| mean * shown / known)
    }

    /// What sensors show at a row.
    fn temperatures_at(&self, row: usize) -> Vec<(HeatNode, f64)> {
        let all = self.temperatures.iter();
        all.map(|(node, values)| (*node, values[row]))
            .filter(|(_, value)| value.is_finite())
            .collect()
    }
}

/// Fewest states at constant speed of which a power is taken.
const FEWEST_STATES: usize = 20;

/// Bodies that have a channel.
fn temperatures(log: &Log) -> Vec<(HeatNode, Vec<f64>)> {
    let name = |node: HeatNode| match node {
        HeatNode::Housing => "housing".to_owned(),
        other => other.name().replace(' ', "_"),
    };
    let one = |node: &HeatNode| Some((*node, channel(log, &name(*node), TEMPERATURE)?));
    HeatNode::ALL.iter().filter_map(one).collect()
}

fn source<'a>(log: &Log, options: &SlowLogOptions<'a>) -> Result<Source<'a>, HeatError> {
    if let Some(number) = channel(log, "duty", NUMBER) {
        let most = options.duties.len();
        let valid = |n: &f64| n.fract() == 0.0 && (0.0..=most as f64).contains(n);
        if let Some(row) = number.iter().position(|n| !valid(n)) {
            return Err(HeatError::log(
                format!("has duty {} in row {}", number[row], row + 1),
                format!(
                    "0 for standstill, or from 1 to {most}, the number of duties that are stated"
                ),
            ));
        }
        return Ok(Source::Duties {
            programs: options.duties,
            number,
        });
    }
    let Some(position) = channel(log, "position_ref", LENGTH) else {
        return Err(HeatError::log(
            "says nothing of what the axis did",
            "a channel duty_1 (number of the duty) or position_ref_m (the reference)",
        ));
    };
    let time = log.time();
    let velocity = channel(log, "velocity_ref", SPEED);
    let longest = match &velocity {
        Some(_) => LONGEST_SAMPLED,
        None => LONGEST_INTERVAL,
    };
    if let Some(row) = time.windows(2).position(|w| w[1] - w[0] > longest) {
        return Err(HeatError::log(
            format!("has no reference from {} to {} s", time[row], time[row + 1]),
            "rows at most 0.2 s apart, or 5 s with a channel velocity_ref_m_s, or a channel duty_1 in the place of position_ref_m",
        ));
    }
    let sampled = time.windows(2).any(|w| w[1] - w[0] > LONGEST_INTERVAL);
    let velocity = velocity.unwrap_or_else(|| derivative(time, &position));
    let constant = match sampled {
        true => readings::recurring(&position, &velocity),
        false => readings::constant(&velocity),
    };
    if sampled {
        let moves = position.iter().zip(&velocity).filter(|(_, v)| **v != 0.0);
        let mut seen: Vec<i64> = moves.map(|(x, _)| (1e5 * x).round() as i64).collect();
        seen.sort_unstable();
        seen.dedup();
        if (1..FEWEST_POSITIONS).contains(&seen.len()) {
            return Err(HeatError::log(
                format!(
                    "shows the moving axis in {} positions only: the motion's period is a multiple of the interval of the rows",
                    seen.len()
                ),
                "rows at another interval, or a channel duty_1 in the place of position_ref_m",
            ));
        }
    }
    Ok(Source::Reference {
        position,
        velocity,
        sampled,
        constant,
    })
}

/// Central differences.
fn derivative(time: &[f64], of: &[f64]) -> Vec<f64> {
    let last = time.len() - 1;
    let at = |i: usize| {
        let (from, to) = (i.saturating_sub(1), (i + 1).min(last));
        match to > from {
            true => (of[to] - of[from]) / (time[to] - time[from]),
            false => 0.0,
        }
    };
    (0..=last).map(at).collect()
}

/// Power of friction of each row of a log of duties, or torque of each row beside a reference.
fn friction(axis: &Axis, log: &Log, source: &Source<'_>) -> Option<Vec<f64>> {
    if let Source::Duties { .. } = source {
        return channel(log, "friction", POWER);
    }
    channel(log, "torque", TORQUE).or_else(|| {
        let current = channel(log, "iq", CURRENT)?;
        let constant = axis.torque_constant();
        Some(current.into_iter().map(|iq| constant * iq).collect())
    })
}
