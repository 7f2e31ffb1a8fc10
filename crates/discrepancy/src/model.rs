//! The simulated side: a machine with known parameters and effects, replayed.

use axis_log::Log;
use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, Need, OnsetForm, Scales};
use axis_sim::part::Role;
use axis_sim::{
    Axis, Balance, ChannelPart, ClosedLoop, LogChannel, Probe, Replay, ReplayError, Trace,
    position_in, reference_in,
};
use rayon::prelude::*;

use crate::answer::Answer;
use crate::spectrum::{Amplitudes, Layout};

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
    /// What the fast simulation is short of beside the slow one, by channel.
    pub defect: Vec<Vec<f64>>,
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

/// A point in the space of models.
#[derive(Clone, Debug)]
pub struct State {
    /// Shares by which the known parameters are off.
    pub shares: Vec<f64>,
    /// Effects.
    pub effects: Vec<ActiveEffect>,
}

/// The channel that counts from wherever the encoder was.
const ANGLE: &str = "motor_angle_rad";

impl State {
    /// The machine as its file says.
    pub fn initial(machine: &Axis) -> Self {
        Self {
            shares: vec![0.0; machine.known().len()],
            effects: Vec::new(),
        }
    }

    /// Takes an effect out, and with it the forms of it; their places, each as it was
    /// when its turn came.
    pub(crate) fn remove(&mut self, index: usize) -> Vec<usize> {
        let taken = self.effects.remove(index);
        let mut places = vec![index];
        while let Some(place) = self.effects.iter().position(|a| is_form_of(a, &taken)) {
            self.effects.remove(place);
            places.push(place);
        }
        places
    }
}

/// Whether one active effect is a form of another.
pub(crate) fn is_form_of(active: &ActiveEffect, other: &ActiveEffect) -> bool {
    let base = OnsetForm::of(active).and_then(|form| form.base());
    base.is_some_and(|base| base.effect.name == other.effect.name)
}

impl LogSet {
    /// Takes logs with their names and sampling periods, for this machine. One without a
    /// control is compared by torque balance.
    ///
    /// # Errors
    /// [`ReplayError::Log`] where a channel that must be there is missing.
    pub fn new(logs: Vec<(String, Log, f64)>, machine: &Axis) -> Result<Self, ReplayError> {
        let mut set = Self::prepared(logs, machine)?;
        set.correct_defects(machine, &State::initial(machine))?;
        Ok(set)
    }

    /// As [`LogSet::new`], defects taken for 0.
    pub(crate) fn prepared(
        logs: Vec<(String, Log, f64)>,
        machine: &Axis,
    ) -> Result<Self, ReplayError> {
        if !machine.has_control() {
            return Self::balanced(&logs, machine);
        }
        let compared = |c: &LogChannel| matches!(c.part, ChannelPart::Sensed | ChannelPart::Made);
        let simulated = axis_sim::channels(machine).into_iter().filter(compared);
        let everywhere = |name: &&str| logs.iter().all(|(_, log, _)| log.has(name));
        let channels: Vec<&'static str> = simulated
            .map(|channel| channel.name(machine))
            .filter(everywhere)
            .collect();
        let prepare = |(name, log, period): (String, Log, f64)| {
            let channel = |name: &&str| Ok(relative(name, log.channel(name)?));
            Ok(Prepared {
                taken_up: taken_up(&log, machine),
                answer: Answer::Replay(Replay::new(&log, period)?),
                defect: vec![vec![0.0; log.len()]; channels.len()],
                measured: channels
                    .iter()
                    .map(channel)
                    .collect::<Result<_, ReplayError>>()?,
                name,
                period,
                log,
            })
        };
        let logs: Vec<Prepared> = logs
            .into_iter()
            .map(prepare)
            .collect::<Result<_, ReplayError>>()?;
        let sizes: Vec<(usize, f64)> = logs.iter().map(|l| (l.log.len(), l.period)).collect();
        let all = 0..channels.len();
        let is_position = |&at: &usize| channels[at].starts_with("position_");
        let made_of_position = machine.control.speed_gain().is_none() && channels.len() > 1;
        let fitted: Vec<usize> = match made_of_position {
            true => all.filter(|at| !is_position(at)).collect(),
            false => all.collect(),
        };
        let begins = match machine.has(Role::Backlash) {
            true => logs.iter().map(first_move).collect(),
            false => vec![0.0; logs.len()],
        };
        let inexact: Vec<f64> = fitted
            .iter()
            .map(|&c| inexactness(machine, &logs, &channels, c))
            .collect();
        Ok(Self {
            layout: Layout::new(fitted.len(), &sizes)
                .beginning(begins)
                .inexact(&inexact),
            logs,
            channels,
            fitted,
        })
    }

    /// Logs that are answered by torque balance: of the one channel that shows it.
    fn balanced(logs: &[(String, Log, f64)], machine: &Axis) -> Result<Self, ReplayError> {
        let only: Vec<(&Log, f64)> = logs.iter().map(|(_, log, h)| (log, *h)).collect();
        let balances = Balance::of_logs(&only, machine)?;
        let channels: Vec<&'static str> = balances.iter().map(Balance::channel).take(1).collect();
        let prepare = |((name, ..), balance): (&(String, Log, f64), Balance)| {
            let log = balance.compared().clone();
            let channel = |name: &&str| Ok(log.channel(name)?.to_vec());
            Ok(Prepared {
                name: name.clone(),
                period: balance.compared_period(),
                measured: channels
                    .iter()
                    .map(channel)
                    .collect::<Result<_, ReplayError>>()?,
                taken_up: 0.0,
                defect: vec![vec![0.0; log.len()]; channels.len()],
                log,
                answer: Answer::Balance(Box::new(balance)),
            })
        };
        let prepared = logs.iter().zip(balances).map(prepare);
        let logs: Vec<Prepared> = prepared.collect::<Result<_, ReplayError>>()?;
        let sizes: Vec<(usize, f64)> = logs.iter().map(|l| (l.log.len(), l.period)).collect();
        let fitted: Vec<usize> = (0..channels.len()).collect();
        Ok(Self {
            layout: Layout::new(fitted.len(), &sizes),
            logs,
            channels,
            fitted,
        })
    }

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

    /// Whether its logs are answered by torque balance.
    pub fn is_balanced(&self) -> bool {
        !self.balances().is_empty()
    }

    /// Further logs of the same motions: where a reference is the same to the
    /// bit, so is what the fast simulation is short of on it.
    ///
    /// # Errors
    /// As [`LogSet::new`].
    pub fn again(&self, logs: Vec<Log>, machine: &Axis) -> Result<Self, ReplayError> {
        let named =
            |(log, as_before): (Log, &Prepared)| (as_before.name.clone(), log, as_before.period);
        let same = logs.len() == self.logs.len()
            && logs.iter().zip(&self.logs).all(|(log, before)| {
                let reference = |log: &Log| reference_in(log).map(<[f64]>::to_vec).ok();
                reference(log) == reference(&before.log)
            });
        let logs = logs.into_iter().zip(&self.logs).map(named).collect();
        if !same {
            return Self::new(logs, machine);
        }
        let mut set = Self::prepared(logs, machine)?;
        if set.channels == self.channels {
            for (log, before) in set.logs.iter_mut().zip(&self.logs) {
                log.defect.clone_from(&before.defect);
            }
        } else {
            set.correct_defects(machine, &State::initial(machine))?;
        }
        Ok(set)
    }

    /// Simulates each log once in the mechanism's exact way, where that is another than
    /// the fast one, and keeps the difference: a screw's fixed mesh is too stiff between
    /// its nodes by nanometres, and these would be found as an effect.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run at this state.
    pub fn correct_defects(&mut self, machine: &Axis, state: &State) -> Result<(), ReplayError> {
        let known = machine.with_known(&state.shares);
        let Some(step) = known.mechanism.exact_step().filter(|_| !self.is_balanced()) else {
            return Ok(());
        };
        let mut slow = known.clone();
        slow.effects.extend_from_slice(&state.effects);
        let slow = ClosedLoop::exact(&slow, step)?.without_noise();
        let defects: Vec<Vec<Vec<f64>>> = self
            .logs
            .par_iter()
            .map(|log| {
                let fast = log.answer.run(&known, &state.effects, None)?;
                let exact = match log.answer.replay() {
                    Some(replay) => replay.follow(&slow, |_| ())?,
                    None => fast.clone(),
                };
                let channel = |c: usize| {
                    let pairs = self
                        .simulated(&exact, c)
                        .into_iter()
                        .zip(self.simulated(&fast, c));
                    pairs.map(|(a, b)| a - b).collect()
                };
                Ok((0..self.channels.len()).map(channel).collect())
            })
            .collect::<Result<_, ReplayError>>()?;
        for (log, defect) in self.logs.iter_mut().zip(defects) {
            log.defect = defect;
        }
        Ok(())
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

    /// Measured minus simulated, per log and channel; 0 where nothing was measured, so that
    /// what was put there has no weight.
    pub fn rest(&self, traces: &[Trace]) -> Vec<Vec<Vec<f64>>> {
        let channel = |log: &Prepared, trace: &Trace, c: usize| {
            let simulated = self.simulated(trace, c);
            let pairs = log.measured[c].iter().zip(simulated);
            let mut rest: Vec<f64> = pairs.map(|(m, s)| m - s).collect();
            rest.iter_mut()
                .zip(&log.defect[c])
                .for_each(|(r, d)| *r -= d);
            for instants in log.log.missing(self.channels[c]) {
                rest[instants.clone()].fill(0.0);
            }
            rest
        };
        let one = |(log, trace): (&Prepared, &Trace)| {
            (0..self.channels.len())
                .map(|c| channel(log, trace, c))
                .collect()
        };
        self.logs.iter().zip(traces).map(one).collect()
    }

    /// By how much a simulation may be off in a channel, RMS.
    pub(crate) fn inexactness(&self, machine: &Axis, channel: usize) -> f64 {
        inexactness(machine, &self.logs, &self.channels, channel)
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

    /// Whether a channel has no zero of its own.
    pub(crate) fn counts_from_its_mean(&self, channel: usize) -> bool {
        self.channels[channel] == ANGLE
    }

    /// Which of the fitted channels have no zero of their own.
    fn free(&self) -> Vec<bool> {
        let fitted = self.fitted.iter();
        fitted.map(|&c| self.counts_from_its_mean(c)).collect()
    }

    /// Of these effects: a gap that is larger than what is taken up before a log counts,
    /// and that log.
    pub(crate) fn slack_left(&self, effects: &[ActiveEffect]) -> Option<(f64, &Prepared)> {
        let gaps = effects.iter().filter(|a| is_gap(a.effect));
        let gap: f64 = gaps.map(|a| a.values[0]).sum();
        let least = |a: &&Prepared, b: &&Prepared| a.taken_up.total_cmp(&b.taken_up);
        let least = self.logs.iter().min_by(least)?;
        (gap > least.taken_up).then_some((gap, least))
    }

    fn simulated(&self, trace: &Trace, channel: usize) -> Vec<f64> {
        let name = self.channels[channel];
        relative(name, trace.channel(name).unwrap_or_default())
    }
}

/// Share of what a channel shows of the dynamics by which two simulations of one machine
/// differ, with other mesh and integrator: measured 1e-5 to 2e-4 between this one and a
/// second program (`tests/independent`).
const INEXACT: f64 = 3e-4;

/// By how much a simulation may be off in a channel, RMS: a share of the tracking error
/// where it shows a way, and of its departures from its mean elsewhere.
fn inexactness(machine: &Axis, logs: &[Prepared], channels: &[&str], channel: usize) -> f64 {
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

/// Whether an effect is a gap between motor and load.
fn is_gap(effect: &Effect) -> bool {
    effect.needs.contains(&Need::Role(Role::Backlash))
}

/// Largest gap that is taken up before a log counts, m: the largest that an axis file may
/// have; of a motion that never goes so far, half of its farthest.
fn taken_up(log: &Log, machine: &Axis) -> f64 {
    let scales = Scales::of(machine);
    let gaps = EFFECTS.iter().filter(|effect| is_gap(effect));
    let largest = gaps.map(|e| e.parameters[0].bounds(&scales)[1]);
    let largest = largest.fold(0.0, f64::max);
    let reference = reference_in(log).unwrap_or_default();
    let moved = |x: &f64| (x - reference[0]).abs();
    largest.min(0.5 * reference.iter().map(moved).fold(0.0, f64::max))
}

/// When the reference has first moved so far that slack is taken up, s: before
/// that nobody knows where a screw lies in its gap, and noise shakes it about.
fn first_move(log: &Prepared) -> f64 {
    let reference = reference_in(&log.log).unwrap_or_default();
    let moved = |x: &f64| (x - reference[0]).abs() >= log.taken_up;
    let first = reference.iter().position(moved).unwrap_or(0);
    first as f64 * log.period
}

/// Angles count from their mean, whatever the encoder's zero; the first sample
/// would carry its noise into all others.
fn relative(name: &str, samples: &[f64]) -> Vec<f64> {
    if name != ANGLE {
        return samples.to_vec();
    }
    let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
    samples.iter().map(|v| v - mean).collect()
}
