//! Logs that are compared together, and what a model leaves of them.

use std::ops::Range;

use axis_log::Log;
use axis_sim::{Axis, Balance, Probe, Replay, ReplayError, TRANSMISSION_ERROR, Trace};
use rayon::prelude::*;

use super::{Answer, State};
use crate::spectrum::{Amplitudes, Layout};

/// Series per log, per channel; most often measured minus simulated.
pub type Rest = Vec<Vec<Vec<f64>>>;

/// A log, ready to be compared with simulations of it.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// Its name in messages.
    pub name: String,
    /// Sampling period, s.
    pub period: f64,
    /// How a model answers it.
    pub answer: Answer,
    /// The channels compared, in the order of [`LogSet::channels`].
    pub measured: Vec<Vec<f64>>,
    /// The log itself; of a torque balance, as it is compared.
    pub log: Log,
    /// Largest gap between screw and nut that is taken up before the log counts, m.
    pub taken_up: f64,
    /// Command with which the drive may have held the axis at the log's start, in the actuator's
    /// unit, where the first samples are too noisy to tell whether it did.
    pub doubtful: Option<f64>,
    /// Command that the drive holds at its start as the log shows it, in the actuator's unit.
    pub shown_effort: Option<f64>,
    /// Exact simulation less the fast one, by channel.
    pub defect: Vec<Vec<f64>>,
    /// What steps and noise of the sensors change on average, by channel.
    pub sensed: Vec<Vec<f64>>,
    /// Hum that is taken out of it, by channel; empty if there is none.
    pub hum: Vec<Vec<f64>>,
}

impl Prepared {
    /// The highest frequency that it shows, Hz: half its rate, or where a torque balance is low-passed.
    pub(crate) fn highest_shown(&self) -> f64 {
        let half = 0.5 / self.period;
        let balance = self.answer.balance();
        balance.map_or(half, |balance| half.min(balance.quality().cutoff))
    }
}

/// Logs that are compared together.
#[derive(Clone, Debug)]
pub struct LogSet {
    /// The logs.
    pub logs: Vec<Prepared>,
    /// The channels that all of them have and that a simulation gives.
    pub channels: Vec<&'static str>,
    /// Places in `channels` of those that are fitted. Of command and position, a
    /// controller that reads no speed of the motor makes one of the other without
    /// noise of its own: they are one measurement, and the command is taken.
    pub fitted: Vec<usize>,
    /// Bins and bands.
    pub layout: Layout,
}

/// The motor's angle.
pub(crate) const ANGLE: &str = "motor_angle_rad";

/// Whether a channel counts from wherever an encoder was.
fn has_no_zero(channel: &str) -> bool {
    channel == ANGLE || TRANSMISSION_ERROR.contains(&channel)
}

impl LogSet {
    /// The torque balances of its logs; none of logs that are replayed.
    pub fn balances(&self) -> Vec<&Balance> {
        self.logs
            .iter()
            .filter_map(|l| l.answer.balance())
            .collect()
    }

    /// The replays of its logs; none of logs that are balanced.
    pub(crate) fn replays(&self) -> Vec<&Replay> {
        self.logs.iter().filter_map(|l| l.answer.replay()).collect()
    }

    /// What was decided for the torque balance of each log, in words.
    pub fn notes(&self) -> Vec<String> {
        let notes = self.logs.iter().filter_map(|log| {
            let balance = log.answer.balance()?;
            Some(balance.quality().sentence(&log.name))
        });
        notes.collect()
    }

    /// How the model answers these logs, as the file of results has it.
    pub fn answer(&self) -> &'static str {
        self.logs.first().map_or("", |log| log.answer.name())
    }

    /// The same, `controller-estimated` for a replay with gains that were estimated.
    pub fn answer_of(&self, machine: &Axis) -> &'static str {
        match machine.control_estimated && !self.replays().is_empty() {
            true => "controller-estimated",
            false => self.answer(),
        }
    }

    /// Whether its logs are answered by torque balance.
    pub fn is_balanced(&self) -> bool {
        !self.balances().is_empty()
    }

    /// Samples of each log that count: what lies before is neither fitted nor judged.
    pub(crate) fn counted(&self) -> Vec<Range<usize>> {
        let one = |(l, log): (usize, &Prepared)| {
            let samples = log.log.len();
            let first = (self.layout.begins(l) / log.period).ceil() as usize;
            first.min(samples.saturating_sub(1))..samples
        };
        self.logs.iter().enumerate().map(one).collect()
    }

    /// Simulates every log.
    ///
    /// # Errors
    /// [`ReplayError`] of the first log that does not run.
    pub fn simulate(&self, machine: &Axis, state: &State) -> Result<Vec<Trace>, ReplayError> {
        self.simulate_with(machine, state, None)
    }

    /// As [`LogSet::simulate`], with one disturbance per log.
    ///
    /// # Errors
    /// As [`LogSet::simulate`].
    pub fn simulate_with(
        &self,
        machine: &Axis,
        state: &State,
        probes: Option<&[Probe]>,
    ) -> Result<Vec<Trace>, ReplayError> {
        let machine = machine.with_known(&state.shares);
        let run = |(i, log): (usize, &Prepared)| {
            log.answer
                .run(&machine, &state.effects, probes.map(|p| &p[i]))
        };
        self.logs.par_iter().enumerate().map(run).collect()
    }

    /// Measured minus simulated, per log and channel; 0 if nothing was measured, so that
    /// what was put there has no weight.
    pub fn rest(&self, traces: &[Trace]) -> Rest {
        let pairs = self.logs.iter().zip(traces);
        pairs
            .map(|(log, trace)| self.residual(log, trace, [&log.defect, &log.sensed]))
            .collect()
    }

    /// The same of one log by channel, with these as what its simulation leaves out.
    pub(super) fn residual(
        &self,
        log: &Prepared,
        trace: &Trace,
        [defect, sensed]: [&[Vec<f64>]; 2],
    ) -> Vec<Vec<f64>> {
        let channel = |c: usize| {
            let pairs = log.measured[c].iter().zip(self.simulated(trace, c));
            let mut rest: Vec<f64> = pairs.map(|(m, s)| m - s).collect();
            for known in [&defect[c], &sensed[c], &log.hum[c]] {
                rest.iter_mut().zip(known).for_each(|(r, k)| *r -= k);
            }
            for instants in log.log.missing(self.channels[c]) {
                rest[instants.clone()].fill(0.0);
            }
            rest
        };
        (0..self.channels.len()).map(channel).collect()
    }

    /// Difference of two simulations divided by `by`, as amplitudes.
    pub fn difference(&self, a: &[Trace], b: &[Trace], by: f64) -> Amplitudes {
        let free = self.free();
        let one = |(i, (a, b)): (usize, (&Trace, &Trace))| {
            let channel = |c: usize| {
                let pairs = self.simulated(a, c).into_iter().zip(self.simulated(b, c));
                pairs.map(|(x, y)| (x - y) / by).collect()
            };
            let series: Vec<Vec<f64>> = self.fitted.iter().map(|&c| channel(c)).collect();
            self.layout.transform(i, &series, &free)
        };
        a.iter().zip(b).enumerate().map(one).collect()
    }

    /// Amplitudes of series per log and channel, of the channels that are fitted.
    pub fn amplitudes(&self, series: &[Vec<Vec<f64>>]) -> Amplitudes {
        let free = self.free();
        let one = |(i, all): (usize, &Vec<Vec<f64>>)| {
            let fitted: Vec<Vec<f64>> = self.fitted.iter().map(|&c| all[c].clone()).collect();
            self.layout.transform(i, &fitted, &free)
        };
        series.iter().enumerate().map(one).collect()
    }

    /// Simulated series per log and channel.
    pub(crate) fn simulated_all(&self, traces: &[Trace]) -> Rest {
        let one = |trace: &Trace| {
            let channels = 0..self.channels.len();
            channels.map(|c| self.simulated(trace, c)).collect()
        };
        traces.iter().map(one).collect()
    }

    /// Whether a channel has no zero of its own.
    pub(crate) fn counts_from_its_mean(&self, channel: usize) -> bool {
        has_no_zero(self.channels[channel])
    }

    /// Which of the fitted channels have no zero of their own.
    fn free(&self) -> Vec<bool> {
        let fitted = self.fitted.iter();
        fitted.map(|&c| self.counts_from_its_mean(c)).collect()
    }

    pub(super) fn simulated(&self, trace: &Trace, channel: usize) -> Vec<f64> {
        let name = self.channels[channel];
        relative(name, trace.channel(name).unwrap_or_default())
    }
}

/// What has no zero of its own counts from its mean; the first sample would carry its noise into
/// all others.
pub(super) fn relative(name: &str, samples: &[f64]) -> Vec<f64> {
    if !has_no_zero(name) {
        return samples.to_vec();
    }
    let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
    samples.iter().map(|v| v - mean).collect()
}
