//! By how much two simulations of one machine may differ.

use axis_sim::{Axis, position_shown, reference_in};

use super::set::{ANGLE, LogSet, Prepared, Rest};

/// Share of what a channel shows of the dynamics by which two simulations of one machine
/// may differ, with other mesh and integrator. Between this one and a second program it is
/// 1e-8 to 5e-6 with the same laws (`two_simulations_of_one_machine…` in `tests`); a
/// machine's small laws are less alike than that.
const INEXACT: f64 = 3e-4;

/// Share of what a channel shows, of a position of the tracking error, up to which a residual in which nothing is named is no
/// lack of the model: no drive measures its current, and no motor makes torque of it, more linearly than to about as much. Laws
/// hidden in seed 14 of `docs/laws/run` leave 3.3e-3 and more, clean machines of another friction than the model's 1e-3.
pub(crate) const IMMATERIAL: f64 = 2e-3;

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

    /// RMS up to which a residual of a channel is immaterial. Of an effort all counts, also what is constant.
    pub(crate) fn immaterial(&self, machine: &Axis, channel: usize) -> f64 {
        let one = |log: &Prepared| match is_of_way(machine, self.channels[channel]) {
            true => dynamics(machine, log, &self.channels, channel),
            false => log.measured[channel].clone(),
        };
        IMMATERIAL * rms(self.logs.iter().flat_map(one))
    }

    /// Whether residuals of these RMS, one a channel, are immaterial in all channels.
    pub(crate) fn is_immaterial(&self, machine: &Axis, sizes: &[f64]) -> bool {
        let mut channels = sizes.iter().enumerate();
        channels.all(|(c, size)| *size <= self.immaterial(machine, c))
    }
}

/// By how much a simulation may be off in a channel, RMS.
pub(super) fn inexactness(
    machine: &Axis,
    logs: &[Prepared],
    channels: &[&str],
    channel: usize,
) -> f64 {
    let all = logs.iter();
    INEXACT * rms(all.flat_map(|log| dynamics(machine, log, channels, channel)))
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (squares, samples) = values.fold((0.0, 0usize), |(sum, n), v| (sum + v * v, n + 1));
    (squares / samples.max(1) as f64).sqrt()
}

fn is_of_way(machine: &Axis, channel: &str) -> bool {
    [machine.position_channel(), ANGLE].contains(&channel)
}

/// What a channel shows of the dynamics: of one that shows a way, the tracking error; of
/// others, their departures from their mean.
fn dynamics(machine: &Axis, log: &Prepared, channels: &[&str], channel: usize) -> Vec<f64> {
    let name = channels[channel];
    let way = || {
        let position = position_shown(&log.log, machine).ok()?;
        Some((reference_in(&log.log).ok()?, position))
    };
    if let Some((reference, position)) = way().filter(|_| is_of_way(machine, name)) {
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
