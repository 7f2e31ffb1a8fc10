//! What a controller saw in a log, in every control cycle.

use axis_log::Log;
use axis_sim::{Axis, ChannelPart, LoggedReference, Measured, Trace, channels, position_in};
use trajectories::{Motion, Setpoint};

use super::error::ControllerError;

/// What a controller saw in a log, and what it commanded, in every control cycle.
#[derive(Clone, Debug)]
pub struct Seen {
    pub reference: Vec<Setpoint>,
    pub measured: Vec<Measured>,
    /// What was added to the command.
    pub added: Vec<f64>,
    /// As logged.
    pub command: Vec<f64>,
    /// Speed of the load at the start, m/s or rad/s.
    pub speed: f64,
    /// Sampling period of the log, s.
    pub log_period: f64,
    /// Cycles at which something that is needed was not measured.
    pub missing: Vec<bool>,
}

/// The channel of the controller's command on this axis.
pub fn command_channel(axis: &Axis) -> &'static str {
    const COMMANDS: [&str; 4] = [
        "iq_ref_a",
        "torque_ref_n_m",
        "force_ref_n",
        "drive_command_v",
    ];
    let made = channels(axis)
        .into_iter()
        .filter(|c| c.part == ChannelPart::Made);
    let mut names = made
        .map(|c| c.name(axis))
        .filter(|name| COMMANDS.contains(name));
    names.next().unwrap_or("drive_command_v")
}

impl Seen {
    /// From a log, with its name and sampling period (s).
    pub fn of(
        axis: &Axis,
        (name, log, period): &(String, Log, f64),
    ) -> Result<Self, ControllerError> {
        let missed = |reason| ControllerError::Log {
            file: name.clone(),
            reason,
        };
        let channel = command_channel(axis);
        let Ok(command) = log.channel(channel) else {
            return Err(ControllerError::NoCommand {
                file: name.clone(),
                channel,
            });
        };
        let position = position_in(log).map_err(missed)?;
        let angle = log.channel("motor_angle_rad").ok();
        let speed = log.channel("motor_speed_rad_s").ok();
        let mut seen = Self::sampled(axis, log, *period, [position, command], [angle, speed])?;
        for needed in [channel, axis.position_channel(), "motor_angle_rad"] {
            for instants in log.missing(needed) {
                let cycle = |i: usize| (i as f64 * period / axis.period) as usize;
                let last = seen.missing.len();
                let lost = cycle(instants.start).min(last)..(cycle(instants.end) + 1).min(last);
                seen.missing[lost].fill(true);
            }
        }
        Ok(seen)
    }

    /// What a controller sees in a simulation of a log, which has no noise.
    pub fn simulated(
        axis: &Axis,
        (_, log, period): &(String, Log, f64),
        trace: &Trace,
    ) -> Option<Self> {
        let command = trace.channel(command_channel(axis))?;
        let angle = trace.channel("motor_angle_rad");
        Self::sampled(
            axis,
            log,
            *period,
            [trace.position(), command],
            [angle, None],
        )
        .ok()
    }

    fn sampled(
        axis: &Axis,
        log: &Log,
        log_period: f64,
        [position, command]: [&[f64]; 2],
        [angle, speed]: [Option<&[f64]>; 2],
    ) -> Result<Self, ControllerError> {
        let reference = LoggedReference::new(log, log_period)?;
        let (h, travel) = (axis.period, axis.travel_per_radian());
        let cycles = (reference.duration() / h + 1e-6) as usize + 1;
        let along = |k: usize| k as f64 * h / log_period;
        let at = |samples: &[f64]| -> Vec<f64> {
            (0..cycles)
                .map(|k| interpolated(samples, along(k)))
                .collect()
        };
        let position = at(position);
        let angle = angle.map_or_else(|| position.iter().map(|x| x / travel).collect(), at);
        let speed = speed.map_or_else(|| differences(&angle, h), at);
        let added = log.channel("drive_command_added_v").ok();
        let show = |k: usize| Measured {
            position: position[k],
            motor_angle: angle[k],
            motor_speed: speed[k],
            ..Measured::default()
        };
        let few = position.len().min(6) - 1;
        Ok(Self {
            reference: (0..cycles).map(|k| reference.at(k as f64 * h)).collect(),
            measured: (0..cycles).map(show).collect(),
            added: added.map_or_else(|| vec![0.0; cycles], at),
            command: at(command),
            speed: (position[few] - position[0]) / (few.max(1) as f64 * h),
            log_period,
            missing: vec![false; cycles],
        })
    }
}

/// As a drive derives the speed: from one cycle to the next.
fn differences(angle: &[f64], period: f64) -> Vec<f64> {
    let first = angle
        .get(1)
        .zip(angle.first())
        .map_or(0.0, |(b, a)| (b - a) / period);
    let rest = angle.windows(2).map(|pair| (pair[1] - pair[0]) / period);
    std::iter::once(first)
        .chain(rest)
        .take(angle.len())
        .collect()
}

/// Linear between samples; the sample itself at its instant.
pub fn interpolated(samples: &[f64], along: f64) -> f64 {
    let Some(last) = samples.len().checked_sub(1) else {
        return 0.0;
    };
    let along = along.clamp(0.0, last as f64);
    let near = along.round();
    if (along - near).abs() < 1e-6 {
        return samples[near as usize];
    }
    let (i, part) = (along as usize, along.fract());
    (1.0 - part) * samples[i] + part * samples[(i + 1).min(last)]
}
