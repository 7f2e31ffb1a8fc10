//! By how much two simulations of one machine may differ.

use axis_sim::{Axis, position_shown, reference_in};

use super::set::{ANGLE, LogSet, Prepared, Rest};

/// Share of what a channel shows of the dynamics by which two simulations of one machine
/// may differ, with other mesh and integrator. Between this one and a second program it is
/// 1e-8 to 5e-6 with the same laws (`two_simulations_of_one_machine…` in `tests`); a
/// machine's small laws are less alike than that.
const INEXACT: f64 = 3e-4;

impl LogSet {
    /// What its channels show of the dynamics, per log and channel.
    pub(crate) fn dynamics(&self, machine: &Axis) -> Rest {
        let all = 0..self.channels.len();
        let one = |log: &Prepared| {
            all.clone()
                .map(|c| dynamics(machine, log, &self.channels, c))
                .collect()
        };
        self.logs.iter().map(one).collect()
    }

    /// By how much a simulation may be off in a channel, RMS.
    pub(crate) fn inexactness(&self, machine: &Axis, channel: usize) -> f64 {
        inexactness(machine, &self.logs, &self.channels, channel)
    }
}

/// By how much a simulation may be off in a channel, RMS.
pub(super) fn inexactness(
    machine: &Axis,
    logs: &[Prepared],
    channels: &[&str],
    channel: usize,
) -> f64 {
    let all = logs
        .iter()
        .flat_map(|log| dynamics(machine, log, channels, channel));
    let (squares, samples) = all.fold((0.0, 0usize), |(sum, n), v| (sum + v * v, n + 1));
    INEXACT * (squares / samples.max(1) as f64).sqrt()
}

/// What a channel shows of the dynamics: of one that shows a way, the tracking error; of
/// others, their departures from their mean.
fn dynamics(machine: &Axis, log: &Prepared, channels: &[&str], channel: usize) -> Vec<f64> {
    let name = channels[channel];
    let of_way = [machine.position_channel(), ANGLE].contains(&name);
    let way = || {
        let position = position_shown(&log.log, machine).ok()?;
        Some((reference_in(&log.log).ok()?, position))
    };
    if let Some((reference, position)) = way().filter(|_| of_way) {
        let lever = if name == ANGLE {
            machine.travel_per_radian()
        } else {
            1.0
        };
        let pairs = reference.iter().zip(&*position);
        return pairs.map(|(r, p)| (r - p) / lever).collect();
    }
    let samples = &log.measured[channel];
    let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
    samples.iter().map(|v| v - mean).collect()
}
