//! Logs, made ready to be compared with simulations of them.

use axis_log::Log;
use axis_sim::part::Role;
use axis_sim::{
    Axis, Balance, ChannelPart, ClosedLoop, LogChannel, Replay, ReplayError, reference_in,
};

use super::inexact::inexactness;
use super::set::{LogSet, Prepared, relative};
use super::slack::{first_move, taken_up};
use super::stored::{held_effort, storing};
use super::{Answer, State};
use crate::spectrum::Layout;

impl LogSet {
    /// Takes logs with their names and sampling periods, for this machine. One without a
    /// control is compared by torque balance.
    ///
    /// # Errors
    /// [`ReplayError::Log`] if a channel that must be there is missing.
    pub fn new(logs: Vec<(String, Log, f64)>, machine: &Axis) -> Result<Self, ReplayError> {
        let mut set = Self::prepared(logs, machine)?;
        set.find_ticks(machine, &State::initial(machine))?;
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
        let as_filed = ClosedLoop::new(machine)?;
        let prepare = |(name, log, period): (String, Log, f64)| {
            let channel = |name: &&str| Ok(relative(name, log.channel(name)?));
            let (replay, doubtful) = {
                let replay = Replay::of_axis(&log, period, machine)?;
                storing(replay, &log, period, &as_filed)
            };
            Ok(Prepared {
                taken_up: taken_up(&log, machine),
                doubtful,
                shown_effort: held_effort(&replay),
                answer: Answer::Replay(Box::new(replay)),
                defect: vec![vec![0.0; log.len()]; channels.len()],
                sensed: vec![vec![0.0; log.len()]; channels.len()],
                hum: vec![Vec::new(); channels.len()],
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

    /// Logs that are answered by torque balance: of the channels that all of them compare.
    fn balanced(logs: &[(String, Log, f64)], machine: &Axis) -> Result<Self, ReplayError> {
        let only: Vec<(&Log, f64)> = logs.iter().map(|(_, log, h)| (log, *h)).collect();
        let balances = Balance::of_logs(&only, machine)?;
        let mut channels = balances.first().map_or(Vec::new(), Balance::channels);
        channels.retain(|name| balances.iter().all(|b| b.channels().contains(name)));
        let prepare = |((name, ..), balance): (&(String, Log, f64), Balance)| {
            let log = balance.compared().clone();
            let channel = |name: &&str| Ok(relative(name, log.channel(name)?));
            Ok(Prepared {
                name: name.clone(),
                period: balance.compared_period(),
                measured: channels
                    .iter()
                    .map(channel)
                    .collect::<Result<_, ReplayError>>()?,
                taken_up: 0.0,
                doubtful: None,
                shown_effort: None,
                defect: vec![vec![0.0; log.len()]; channels.len()],
                sensed: vec![vec![0.0; log.len()]; channels.len()],
                hum: vec![Vec::new(); channels.len()],
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

    /// Further logs of the same motions: where a reference is the same to the
    /// bit, so is what the fast simulation is short of on it.
    ///
    /// # Errors
    /// As [`LogSet::new`].
    pub fn again(&self, logs: Vec<Log>, machine: &Axis) -> Result<Self, ReplayError> {
        let named = |(log, as_before): (Log, &Prepared)| {
            let period = match &as_before.answer {
                Answer::Balance(balance) => balance.period(),
                Answer::Replay(_) => as_before.period,
            };
            (as_before.name.clone(), log, period)
        };
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
            set = set.ticked(|l| self.logs[l].answer.replay().map(Replay::ticks));
            for (log, before) in set.logs.iter_mut().zip(&self.logs) {
                log.defect.clone_from(&before.defect);
                log.sensed.clone_from(&before.sensed);
            }
        } else {
            set.correct_defects(machine, &State::initial(machine))?;
        }
        Ok(set)
    }
}
