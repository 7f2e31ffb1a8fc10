//! How noisy the sensors are that logs were taken with.

use axis_sim::{Axis, ClosedLoop, Replay, ReplayError, Trace};
use rayon::prelude::*;

use crate::hidden::Noise;
use crate::model::LogSet;
use crate::noise::Rest;
use crate::spectrum::Layout;

/// Whether the logs of an axis show the noise of its sensors: not where the loop has no
/// memory and reads a position alone, of which command and position are one measurement, nor
/// in a torque balance.
pub fn shows_noise(axis: &Axis, set: &LogSet) -> bool {
    !axis.control.starts_in_motion() && !set.is_balanced()
}

/// Noise of the sensors of an axis (its effects included), as the rest of its logs shows it
/// beside simulations without any.
///
/// The upper half of the bins lies above what the position loop answers to. There the
/// position and the angle show their own noise, the command that of the speed through the
/// speed controller, the d voltage that of the current through the current controller. By
/// how much is first taken from the proportional gains, and then seen in a simulation with
/// noise like that: a current controller of 800 Hz answers to half of what is there.
pub fn noise_at(axis: &Axis, set: &LogSet, rest: &Rest, quiet: &[Trace]) -> Noise {
    let seen = Levels::of(set, rest);
    let guess = seen.noise(axis);
    match simulated(axis, set, quiet, guess) {
        Ok(rest) => guess.times(seen.over(&Levels::of(set, &rest))),
        Err(_) => guess,
    }
}

/// What sensors with this noise do to the logs.
fn simulated(
    axis: &Axis,
    set: &LogSet,
    quiet: &[Trace],
    noise: Noise,
) -> Result<Rest, ReplayError> {
    let closed_loop = ClosedLoop::new(axis)?.without_noise();
    let one = |(seed, (replay, quiet)): (usize, (&Replay, &Trace))| {
        let noisy = replay.follow(&closed_loop, noise.sensors(seed as u64))?;
        let channel = |name: &&str| -> Vec<f64> {
            let pair = noisy.channel(name).zip(quiet.channel(name));
            let (a, b) = pair.unwrap_or_default();
            a.iter().zip(b).map(|(a, b)| a - b).collect()
        };
        Ok(set.channels.iter().map(channel).collect())
    };
    let logs: Vec<(&Replay, &Trace)> = set.replays().into_iter().zip(quiet).collect();
    logs.into_par_iter().enumerate().map(one).collect()
}

/// RMS of white noise with the level of the upper half of the bins, of the channels that
/// show a sensor each.
struct Levels {
    position: f64,
    angle: f64,
    command: f64,
    voltage: f64,
}

/// Commands of actuators, of which an axis has one.
const COMMANDS: [&str; 4] = [
    "iq_ref_a",
    "torque_ref_n_m",
    "force_ref_n",
    "drive_command_v",
];

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
        }
    }

    /// By the proportional gains alone.
    fn noise(&self, axis: &Axis) -> Noise {
        let per = |level: f64, gain: Option<f64>| match gain {
            Some(gain) if gain > 0.0 => level / gain,
            _ => 0.0,
        };
        Noise {
            position: self.position,
            angle: self.angle,
            // A speed that is derived from an angle has that angle's noise.
            speed: match axis.derives_speed() {
                true => 0.0,
                false => per(self.command, axis.control.speed_gain()),
            },
            current: per(self.voltage, axis.actuator.current_gain()),
        }
    }

    /// How much larger these are than others, sensor by sensor. What is within a fifth may be
    /// the scatter of either, and counts as the same.
    fn over(&self, other: &Self) -> Noise {
        let ratio = |own: f64, other: f64| match own / other {
            ratio if ratio.is_finite() && !(0.8..=1.25).contains(&ratio) => ratio,
            _ => 1.0,
        };
        Noise {
            position: ratio(self.position, other.position),
            angle: ratio(self.angle, other.angle),
            speed: ratio(self.command, other.command),
            current: ratio(self.voltage, other.voltage),
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
