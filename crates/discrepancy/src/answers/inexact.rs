//! By how much two simulations of one machine may differ.

use axis_sim::{Axis, position_in, reference_in};

use super::set::{ANGLE, LogSet, Prepared};

/// Share of what a channel shows of the dynamics by which two simulations of one machine
/// differ, with other mesh and integrator: measured 1e-5 to 2e-4 between this one and a
/// second program (`tests/independent`).
const INEXACT: f64 = 3e-4;

impl LogSet {
    /// By how much a simulation may be off in a channel, RMS.
    pub(crate) fn inexactness(&self, machine: &Axis, channel: usize) -> f64 {
        inexactness(machine, &self.logs, &self.channels, channel)
    }
}

/// By how much a simulation may be off in a channel, RMS: a share of the tracking error
/// where it shows a way, and of its departures from its mean elsewhere.
pub(super) fn inexactness(
    machine: &Axis,
    logs: &[Prepared],
    channels: &[&str],
    channel: usize,
) -> f64 {
    let name = channels[channel];
    let of_way = [machine.position_channel(), ANGLE].contains(&name);
    let dynamics = |log: &Prepared| -> Vec<f64> {
        let way = || Some((reference_in(&log.log).ok()?, position_in(&log.log).ok()?));
        match way().filter(|_| of_way) {
            Some((reference, position)) => {
                reference.iter().zip(position).map(|(r, p)| r - p).collect()
            }
            None => {
                let samples = &log.measured[channel];
                let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
                samples.iter().map(|v| v - mean).collect()
            }
        }
    };
    let all: Vec<f64> = logs.iter().flat_map(dynamics).collect();
    let squares: f64 = all.iter().map(|v| v * v).sum();
    let lever = if name == ANGLE {
        machine.travel_per_radian()
    } else {
        1.0
    };
    INEXACT * (squares / all.len().max(1) as f64).sqrt() / lever
}
