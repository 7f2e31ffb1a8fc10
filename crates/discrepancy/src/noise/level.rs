//! How noisy the sensors are that logs were taken with.

use axis_sim::{Axis, ClosedLoop, ReplayError, Trace};

use super::sources::{Powers, variances};
use super::{LogNoise, Rest, SensorNoise, noise_series};
use crate::answers::LogSet;
use crate::answers::effort::COMMANDS;
use crate::spectrum::Layout;

/// Whether the logs of an axis show the noise of its sensors: not where the loop has no
/// memory and reads a position alone, of which command and position are one measurement, nor
/// in a torque balance.
pub fn shows_noise(axis: &Axis, set: &LogSet) -> bool {
    !axis.control.starts_in_motion() && !set.is_balanced()
}

/// Noise of the logs of an axis (its effects included), as their rest shows it beside
/// simulations without any.
///
/// The upper half of the bins lies above what the position loop answers to. There the
/// position and the angle show their own noise, the command that of the speed through the
/// speed controller, the d voltage that of the current through the current controller: by
/// how much is first guessed from the proportional gains. Then each sensor's noise is run
/// through the loop by itself, and what each of them and the logger make of the rest is
/// found from all channels and bands together ([`variances`]): no channel's noise is taken
/// from another alone.
pub fn noise_at(axis: &Axis, set: &LogSet, rest: &Rest, quiet: &[Trace]) -> LogNoise {
    let guess = Levels::of(set, rest).noise(axis);
    let sensors = Sensor::ALL.map(|sensor| sensor.alone(guess));
    let answers: Vec<Rest> = sensors
        .iter()
        .map(|noise| simulated(axis, set, quiet, *noise).unwrap_or_default())
        .collect();
    let bands = Bands::of(set);
    let none = || vec![vec![0.0; bands.values.len()]; set.channels.len()];
    let of_answer = |rest: &Rest| match rest.is_empty() {
        true => none(),
        false => bands.powers(set, rest),
    };
    let of_logger = |c: usize| {
        let mut own = none();
        own[c].fill(1.0);
        own
    };
    let sources: Vec<Powers> = (answers.iter().map(of_answer))
        .chain((0..set.channels.len()).map(of_logger))
        .collect();
    // A command is made of what the sensors show, and tells them from the logger. Without one
    // nobody knows, and neither comes first.
    let has_command = set.channels.iter().any(|c| COMMANDS.contains(c));
    let last = match has_command {
        true => sensors.len(),
        false => sources.len(),
    };
    let observed = bands.powers(set, rest);
    let found = variances(&observed, &sources, &bands.values, bands.upper, last);
    let (of_sensors, of_logger) = found.split_at(sensors.len());
    let loop_noise = Sensor::ALL.iter().zip(of_sensors);
    let logger = set.channels.iter().zip(of_logger);
    let noise = LogNoise {
        sensors: loop_noise.fold(guess, |noise, (sensor, p)| sensor.times(noise, p.sqrt())),
        logger: logger.map(|(&name, p)| (name, p.sqrt())).collect(),
    };
    tracing::debug!(?noise, "noise of the logs");
    noise
}

/// A sensor of the loop.
#[derive(Clone, Copy, PartialEq)]
enum Sensor {
    Position,
    Angle,
    Speed,
    Current,
}

impl Sensor {
    const ALL: [Self; 4] = [Self::Position, Self::Angle, Self::Speed, Self::Current];

    /// That of its noise.
    fn of(self, noise: &mut SensorNoise) -> &mut f64 {
        match self {
            Self::Position => &mut noise.position,
            Self::Angle => &mut noise.angle,
            Self::Speed => &mut noise.speed,
            Self::Current => &mut noise.current,
        }
    }

    /// This sensor's noise, and no other's.
    fn alone(self, mut all: SensorNoise) -> SensorNoise {
        let mut own = SensorNoise {
            position: 0.0,
            angle: 0.0,
            speed: 0.0,
            current: 0.0,
        };
        *self.of(&mut own) = *self.of(&mut all);
        own
    }

    /// With this sensor's noise so many times as large.
    fn times(self, mut noise: SensorNoise, by: f64) -> SensorNoise {
        *self.of(&mut noise) *= by;
        noise
    }
}

/// What sensors with this noise do to the logs.
fn simulated(
    axis: &Axis,
    set: &LogSet,
    quiet: &[Trace],
    sensors: SensorNoise,
) -> Result<Rest, ReplayError> {
    let silent = [
        sensors.position,
        sensors.angle,
        sensors.speed,
        sensors.current,
    ];
    if silent.iter().all(|noise| *noise == 0.0) {
        return Ok(Rest::new());
    }
    let closed_loop = ClosedLoop::new(axis)?.without_noise();
    noise_series(&closed_loop, set, quiet, &LogNoise::of_sensors(sensors), 0)
}

/// Bands of the logs, for one channel at a time.
struct Bands {
    layout: Layout,
    values: Vec<f64>,
    /// The first in the upper half of the frequencies.
    upper: usize,
}

impl Bands {
    fn of(set: &LogSet) -> Self {
        let sizes: Vec<(usize, f64)> = set.logs.iter().map(|l| (l.log.len(), l.period)).collect();
        let layout = Layout::new(1, &sizes);
        let edges: Vec<[f64; 2]> = layout.bands().map(|(edges, _)| edges).collect();
        let half = 0.5 * edges.last().map_or(0.0, |e| e[1]);
        // The last band in any case.
        let upper = edges.iter().position(|e| e[0] >= half);
        Self {
            values: layout.values().to_vec(),
            upper: upper.unwrap_or(edges.len().saturating_sub(1)),
            layout,
        }
    }

    /// Mean power of a rest in each channel and band.
    fn powers(&self, set: &LogSet, rest: &Rest) -> Powers {
        let channel = |c: usize| {
            let amplitudes = rest.iter().enumerate().map(|(l, log)| {
                self.layout
                    .transform(l, &log[c..=c], &[set.counts_from_its_mean(c)])
            });
            let matrices = self.layout.spectral_matrices(&amplitudes.collect());
            matrices.iter().map(|s| s[(0, 0)].re).collect()
        };
        (0..set.channels.len()).map(channel).collect()
    }
}

/// RMS of white noise with the level of the upper half of the bins, of the channels that
/// show a sensor each.
struct Levels {
    position: f64,
    angle: f64,
    command: f64,
    voltage: f64,
    /// Measured, not commanded.
    current: f64,
}

impl Levels {
    fn of(set: &LogSet, rest: &Rest) -> Self {
        let level = |names: &[&str]| {
            let channel = set.channels.iter().position(|c| names.contains(c));
            channel.map_or(0.0, |c| upper_level(set, rest, c))
        };
        Self {
            position: level(&["position_m", "position_rad"]),
            angle: level(&["motor_angle_rad"]),
            command: level(&COMMANDS),
            voltage: level(&["ud_v"]),
            current: level(&["iq_a"]),
        }
    }

    /// By the proportional gains alone. Where neither command nor voltage is logged, the
    /// current stands for both.
    fn noise(&self, axis: &Axis) -> SensorNoise {
        let either = |first: f64, other: f64| if first > 0.0 { first } else { other };
        let per = |level: f64, gain: Option<f64>| match gain {
            Some(gain) if gain > 0.0 => level / gain,
            _ => 0.0,
        };
        SensorNoise {
            position: self.position,
            angle: self.angle,
            // A speed that is derived from an angle has that angle's noise.
            speed: match axis.derives_speed() {
                true => 0.0,
                false => per(
                    either(self.command, self.current),
                    axis.control.speed_gain(),
                ),
            },
            current: match axis.actuator.current_gain() {
                gain if self.voltage > 0.0 => per(self.voltage, gain),
                _ => self.current,
            },
        }
    }
}

/// RMS of white noise with the level of the upper half of a channel's bins.
pub fn upper_level(set: &LogSet, rest: &Rest, channel: usize) -> f64 {
    let sizes: Vec<(usize, f64)> = set.logs.iter().map(|l| (l.log.len(), l.period)).collect();
    let layout = Layout::new(1, &sizes);
    let (mut sum, mut n) = (0.0, 0usize);
    for (log, series) in rest.iter().enumerate() {
        let bins = layout.transform(log, &series[channel..=channel], &[false]);
        for value in &bins[bins.len() / 2..] {
            sum += value.norm_sqr();
            n += 1;
        }
    }
    (sum / n.max(1) as f64).sqrt()
}
