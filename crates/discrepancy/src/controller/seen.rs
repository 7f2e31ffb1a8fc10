//! What a controller saw in a log, in every control cycle.

use axis_log::Log;
use axis_sim::actuator::Effort;
use axis_sim::{
    Axis, LoggedReference, Measured, SampledCurve, Trace, excitation_in, position_shown,
};
use trajectories::{Motion, Setpoint};

use super::error::ControllerError;

/// What a controller saw in a log, and what it commanded.
#[derive(Clone, Debug)]
pub struct Seen {
    /// In every control cycle.
    pub reference: Vec<Setpoint>,
    /// In every control cycle.
    pub measured: Vec<Measured>,
    /// What was added to the command, in every control cycle.
    pub added: Vec<f64>,
    /// The command at the log's instants.
    pub command: Vec<f64>,
    /// Instants of the log at which something that is needed was not measured.
    pub missing: Vec<bool>,
    /// Speed of the load at the start, m/s or rad/s.
    pub speed: f64,
    /// Sampling period of the log, s.
    pub log_period: f64,
}

/// The channel of the controller's command on this axis.
pub fn command_channel(axis: &Axis) -> &'static str {
    match axis.actuator.effort() {
        Effort::Current => "iq_ref_a",
        Effort::Torque => "torque_ref_n_m",
        Effort::Force => "force_ref_n",
        Effort::Voltage => "drive_command_v",
    }
}

const ANGLE: &str = "motor_angle_rad";

/// Samples of what a controller reads.
struct Sampled<'a> {
    log: &'a Log,
    period: f64,
    position: &'a [f64],
    command: &'a [f64],
    angle: Option<&'a [f64]>,
    speed: Option<&'a [f64]>,
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
        let position = position_shown(log, axis).map_err(missed)?;
        let mut seen = Self::sampled(
            axis,
            &Sampled {
                log,
                period: *period,
                position: &position,
                command,
                angle: log.channel(ANGLE).ok(),
                speed: log.channel("motor_speed_rad_s").ok(),
            },
        )?;
        for needed in [channel, axis.position_channel(), ANGLE] {
            for instants in log.missing(needed) {
                seen.missing[instants.clone()].fill(true);
            }
        }
        Ok(seen)
    }

    /// What a controller sees in a simulation of a log, which has no noise.
    pub fn simulated(axis: &Axis, log: &(String, Log, f64), trace: &Trace) -> Option<Self> {
        let shown = Sampled {
            log: &log.1,
            period: log.2,
            position: trace.position(),
            command: trace.channel(command_channel(axis))?,
            angle: trace.channel(ANGLE),
            speed: None,
        };
        Self::sampled(axis, &shown).ok()
    }

    fn sampled(axis: &Axis, shown: &Sampled<'_>) -> Result<Self, ControllerError> {
        let (h, travel) = (axis.period, axis.travel_per_radian());
        let reference = LoggedReference::new(shown.log, shown.period)?;
        let cycles = (reference.duration() / h + 1e-6) as usize + 1;
        let curve = |samples: &[f64]| SampledCurve::spline(samples, shown.period);
        let position = curve(shown.position);
        let angle = match shown.angle {
            Some(angle) => curve(angle),
            None => curve(&scaled(shown.position, 1.0 / travel)),
        };
        let speed = shown.speed.map(curve);
        let every = axis.control.speed_every(h) as usize;
        let measured = |k: usize| {
            let t = k as f64 * h;
            let [motor_angle, slope] = angle.at(t);
            Measured {
                position: position.at(t)[0],
                motor_angle,
                motor_speed: match &speed {
                    Some(speed) => speed.at(t)[0],
                    // As a drive derives it, from one cycle of its speed loop to the next.
                    None if axis.derives_speed() && k >= every => {
                        let taken = (k - k % every) as f64 * h;
                        let period = every as f64 * h;
                        (angle.at(taken)[0] - angle.at(taken - period)[0]) / period
                    }
                    None => slope,
                },
                ..Measured::default()
            }
        };
        let added = excitation_in(shown.log);
        let added = |k: usize| {
            let along = (k as f64 * h / shown.period).round() as usize;
            added.and_then(|added| added.get(along)).copied()
        };
        let few = shown.position.len().min(6) - 1;
        let travelled = shown.position[few] - shown.position[0];
        Ok(Self {
            reference: (0..cycles).map(|k| reference.at(k as f64 * h)).collect(),
            measured: (0..cycles).map(measured).collect(),
            added: (0..cycles).map(|k| added(k).unwrap_or(0.0)).collect(),
            command: shown.command.to_vec(),
            missing: vec![false; shown.command.len()],
            speed: travelled / (few.max(1) as f64 * shown.period),
            log_period: shown.period,
        })
    }
}

fn scaled(samples: &[f64], by: f64) -> Vec<f64> {
    samples.iter().map(|sample| by * sample).collect()
}
