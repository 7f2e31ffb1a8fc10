//! What the drive holds at the start of a log that shows it coarsely.
//!
//! At rest a rounded command is off by one and the same part of its step, and an axis that is
//! homed where it stands is off by what that bends, for the whole log. It is one unknown a log,
//! a state of that log and no parameter of the machine, and is fitted beside these.

use super::columns::Columns;
use super::fit::{Fit, Fitter};
use crate::answers::LogSet;
use crate::spectrum::Amplitudes;

/// Rounds at most.
const ROUNDS: usize = 4;

/// Step of a difference quotient, as a share of what a start may be moved over.
const STEP: f64 = 0.1;

/// Fall of D that is not worth another round.
const ENOUGH: f64 = 2.0;

/// The logs with the starts that bring D down, and the fit there; `None` if no command is
/// coarse, or no other start helps. With `own`, the derivatives with respect to all parameters of
/// the fit, these move as well.
pub fn with_starts(fitter: &Fitter<'_>, fit: &Fit, own: Option<&Columns>) -> Option<(LogSet, Fit)> {
    let machine = fitter.machine;
    let rooms = fitter.set.coarse_efforts(machine)?;
    let step: Vec<f64> = rooms
        .iter()
        .map(|[low, high]| STEP * (high - low))
        .collect();
    // A parameter that does nothing stays out of it.
    let held = || vec![fitter.nothing(fit); fit.state.shares.len()];
    let columns = own.cloned().unwrap_or_else(held);
    let mut moved = vec![0.0; rooms.len()];
    let mut best: Option<(LogSet, Fit)> = None;
    for _ in 0..ROUNDS {
        let (set, at) = best.as_ref().map_or((fitter.set, fit), |(s, f)| (s, f));
        let here = Fitter { machine, set };
        let beside = set.with_efforts_moved(&step);
        let traces = beside.simulate(machine, &at.state).ok()?;
        let response = set.difference(&traces, &at.traces, 1.0);
        let starts = (0..rooms.len()).map(|log| only(&response, log));
        let all: Columns = columns.iter().cloned().chain(starts).collect();
        let solved = here.solve(at, &all);
        let start = |log: usize| {
            let by = step[log] * solved.step[columns.len() + log];
            (moved[log] + by).clamp(rooms[log][0], rooms[log][1])
        };
        let to: Vec<f64> = (0..rooms.len()).map(start).collect();
        let next = fitter.set.with_efforts_moved(&to);
        let there = Fitter {
            machine,
            set: &next,
        };
        let state = match own {
            Some(_) => here.moved(&at.state, &solved.step, 1.0),
            None => at.state.clone(),
        };
        let trial = there.at(state).ok()?;
        let fall = at.deviance - trial.deviance;
        tracing::debug!(?to, fall, "coarse starts");
        if fall <= 0.0 {
            break;
        }
        moved = to;
        best = Some((next, trial));
        if fall < ENOUGH {
            break;
        }
    }
    best
}

/// What belongs to one log, and nothing of the others.
fn only(response: &Amplitudes, log: usize) -> Amplitudes {
    let all = response.iter().enumerate();
    all.map(|(l, bins)| match l == log {
        true => bins.clone(),
        false => vec![Default::default(); bins.len()],
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use axis_log::{Channel, Log};
    use axis_sim::{Axis, ClosedLoop, Recorder, Stored};
    use compensator::NoCompensation;
    use trajectories::{Limits, Program, Step};

    use super::with_starts;
    use crate::answers::{Answer, LogSet, State};
    use crate::estimate::fit::Fitter;

    const COMMAND: &str = "torque_ref_n_m";

    /// One step of the command, N·m.
    const STEP: f64 = 7e-3;

    /// A joint under gravity that moves there and back, its sensors without noise.
    fn joint() -> (Axis, Log) {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/joint.toml");
        let axis = Axis::read(file.as_ref()).unwrap();
        let from = axis.stroke.start;
        let limits = Limits::new(0.2, 1.0, 20.0).unwrap();
        let rest = Step::Dwell { duration: 0.2 };
        let to = |to: f64| Step::Move { to, limits };
        let steps = vec![rest, to(from + 0.05), rest, to(from), rest];
        let program = Program::new(from, steps).unwrap();
        let mut recorder = Recorder::new(&axis);
        ClosedLoop::new(&axis)
            .unwrap()
            .without_noise()
            .run(&program, &mut NoCompensation, |c| recorder.push(c))
            .completed()
            .unwrap();
        (axis, recorder.log().unwrap())
    }

    /// The log with its command rounded to steps, off by so much of one at the start.
    fn in_steps(log: &Log, share: f64) -> Log {
        let held = log.channel(COMMAND).unwrap()[0];
        let from = held + share * STEP;
        let shown = |torque: &f64| from + STEP * ((torque - from) / STEP).round();
        let channel = |channel: &Channel| Channel {
            samples: match channel.name == COMMAND {
                true => channel.samples.iter().map(shown).collect(),
                false => channel.samples.clone(),
            },
            ..channel.clone()
        };
        Log::new(log.channels().iter().map(channel).collect()).unwrap()
    }

    fn held(set: &LogSet) -> f64 {
        let Answer::Replay(replay) = &set.logs[0].answer else {
            panic!("a machine with a control is replayed");
        };
        match replay.stored() {
            Stored::Effort(effort) => effort,
            other => panic!("held with no command: {other:?}"),
        }
    }

    /// A joint is homed where it stands, so that a start that is off is seen in the whole log.
    #[test]
    fn what_a_coarse_command_holds_is_found_from_the_whole_log() {
        let (machine, log) = joint();
        let truth = log.channel(COMMAND).unwrap()[0];
        for share in [-0.4, 0.25] {
            let logs = vec![("log".to_owned(), in_steps(&log, share), machine.period)];
            let set = LogSet::new(logs, &machine).unwrap();
            let fitter = Fitter {
                machine: &machine,
                set: &set,
            };
            let fit = fitter.at(State::initial(&machine)).unwrap();
            let off = held(&set) - truth;
            assert!((off - share * STEP).abs() < 1e-9, "{off}");
            let (set, better) = with_starts(&fitter, &fit, None).unwrap();
            let left = held(&set) - truth;
            println!(
                "{share}: off by {off:e}, then {left:e}; D {} to {}",
                fit.deviance, better.deviance
            );
            assert!(left.abs() < 0.01 * off.abs(), "{left}");
            assert_eq!(better.state.shares, fit.state.shares);
        }
    }

    /// Of a noisy command the mean of a rest tells what is held, whatever that is.
    #[test]
    fn a_command_finer_than_its_noise_is_left_as_it_is() {
        let (machine, log) = joint();
        let truth = log.channel(COMMAND).unwrap()[0];
        let noisy = |(k, torque): (usize, &f64)| torque + 0.02 + 1e-3 * (1.7 * k as f64).sin();
        let channel = |channel: &Channel| Channel {
            samples: match channel.name == COMMAND {
                true => channel.samples.iter().enumerate().map(noisy).collect(),
                false => channel.samples.clone(),
            },
            ..channel.clone()
        };
        let log = Log::new(log.channels().iter().map(channel).collect()).unwrap();
        let logs = vec![("log".to_owned(), log, machine.period)];
        let set = LogSet::new(logs, &machine).unwrap();
        assert!((held(&set) - truth - 0.02).abs() < 1e-4);
        let fitter = Fitter {
            machine: &machine,
            set: &set,
        };
        let fit = fitter.at(State::initial(&machine)).unwrap();
        assert!(with_starts(&fitter, &fit, None).is_none());
    }
}
