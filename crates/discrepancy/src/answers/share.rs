//! What is held at the start of a log.
//!
//! Where the drive's command is not shown, one unknown a log, s in −1 ≤ s ≤ 1, beside the
//! parameters of the machine: nothing but the first move tells it, and it tells nothing of any
//! other motion. All of that range is possible, and equally likely. Where the command is shown,
//! its mean over the standstill has an error where its noise is slow, and the first move tells that.

use axis_sim::{Axis, ReplayError, Stored};

use super::stored::{EffortShown, effort_shown, held_effort};
use super::{Answer, LogSet, Prepared, State};

/// Shares that are tried first.
const TRIED: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];

/// Halvings of the step beside the best of them: to 1/64 of what the bristles can hold.
const HALVINGS: usize = 5;

/// Fall of minus twice the log-likelihood ([`misfit`]) below which a log is taken to begin, and its loops to tick, as before:
/// more than one number brings by chance.
pub(super) const BY_CHANCE: f64 = 25.0;

/// Steps by which a held effort is moved to see where the log is more likely, and the way downhill
/// where three points do not show a minimum, as shares of the command's noise.
const STEP: f64 = 0.1;
const STRIDE: f64 = 0.25;

/// Strides are halved to this where a held effort was moved and three points show nothing better.
const SHORTEST_STRIDE: f64 = 0.02;

/// Parabolas at most.
const PARABOLAS: usize = 8;

/// Fall of minus twice the log-likelihood below which it stays: one number by chance.
const MOVED: f64 = 10.0;

/// What the drive holds at the start of a log, while it is sought: by how much it is moved, as a share of the command's noise.
struct Sought {
    at: f64,
    /// Minus twice the log-likelihood there.
    misfit: f64,
    /// Way downhill where three points do not show a minimum.
    stride: f64,
}

impl Sought {
    fn at_what_is_shown(misfit: f64) -> Self {
        Self {
            at: 0.0,
            misfit,
            stride: STRIDE,
        }
    }

    /// Distance of the points beside it that are tried.
    fn step(&self) -> f64 {
        STEP * self.stride / STRIDE
    }

    /// Where the misfits a step below and above lead.
    fn led_to(&self, [low, high]: [f64; 2]) -> f64 {
        let (slope, bend) = (high - low, high + low - 2.0 * self.misfit);
        match bend > 0.0 {
            true => self.at - 0.5 * self.step() * slope / bend,
            false => self.at - self.stride * slope.signum(),
        }
    }

    /// Takes the likeliest of places and their misfits, if it is better than by chance; whether it is worth going on.
    fn take(&mut self, tried: [(f64, f64); 3]) -> bool {
        let likelier = |best: (f64, f64), one: (f64, f64)| if one.1 < best.1 { one } else { best };
        let (at, misfit) = tried.into_iter().fold(tried[0], likelier);
        if self.misfit - misfit > MOVED {
            // Beyond the three points the parabola knows nothing.
            let is_far = (at - self.at).abs() >= self.step();
            (self.at, self.misfit) = (at, misfit);
            return is_far;
        }
        // Near a sharp minimum it is no parabola: nearer points show it.
        self.stride *= 0.5;
        self.at != 0.0 && self.stride > SHORTEST_STRIDE
    }
}

impl LogSet {
    /// Finds what belongs to the logs and changes with the model: what they have stored where
    /// they do not show it, and defects.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine does not run at this state.
    pub(crate) fn follow(&mut self, machine: &Axis, state: &State) -> Result<(), ReplayError> {
        self.find_ticks(machine, state)?;
        self.find_stored(machine, state)?;
        self.find_beginning(machine, state)?;
        self.find_effort(machine, state)?;
        self.correct_defects(machine, state)
    }

    /// Finds what the bristles hold at the start of each log that does not show it, beside
    /// this state.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine does not run.
    pub fn find_stored(&mut self, machine: &Axis, state: &State) -> Result<(), ReplayError> {
        if self.shares().iter().all(Option::is_none) {
            return Ok(());
        }
        let misfits = |shares: Vec<f64>| -> Result<Vec<[f64; 2]>, ReplayError> {
            let set = self.with_shares(&shares);
            let rest = set.rest(&set.simulate(machine, state)?);
            let pairs = rest.iter().zip(shares);
            Ok(pairs.map(|(log, share)| [misfit(log), share]).collect())
        };
        let logs = self.logs.len();
        let free = misfits(vec![0.0; logs])?;
        let mut best = free.clone();
        let take = |best: &mut Vec<[f64; 2]>, shares: Vec<f64>| {
            for (best, tried) in best.iter_mut().zip(misfits(shares)?) {
                if tried[0] < best[0] {
                    *best = tried;
                }
            }
            Ok::<(), ReplayError>(())
        };
        for share in TRIED {
            take(&mut best, vec![share; logs])?;
        }
        let mut step = 0.25;
        for _ in 0..HALVINGS {
            for by in [step, -step] {
                let beside = best.iter().map(|[_, s]| (s + by).clamp(-1.0, 1.0));
                let beside = beside.collect();
                take(&mut best, beside)?;
            }
            step *= 0.5;
        }
        let kept = best.iter().zip(&free);
        let kept: Vec<f64> = kept
            .map(|(best, free)| {
                if free[0] - best[0] > BY_CHANCE {
                    best[1]
                } else {
                    0.0
                }
            })
            .collect();
        tracing::debug!(?kept, "held by bristles at the start");
        *self = self.with_shares(&kept);
        Ok(())
    }

    /// Finds of each log of which the first samples are too noisy to tell, whether the effects of
    /// this state were held before it began, or came up with it. A load that changes with time has
    /// moved on when a mean would tell.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine does not run.
    fn find_beginning(&mut self, machine: &Axis, state: &State) -> Result<(), ReplayError> {
        if state.effects.is_empty() || self.logs.iter().all(|log| log.doubtful.is_none()) {
            return Ok(());
        }
        let misfits = |set: &Self| -> Result<Vec<f64>, ReplayError> {
            let rest = set.rest(&set.simulate(machine, state)?);
            Ok(rest.iter().map(|log| misfit(log)).collect())
        };
        let other = self.begun_otherwise();
        let pairs = misfits(self)?.into_iter().zip(misfits(&other)?);
        let better: Vec<bool> = pairs.map(|(a, b)| a - b > BY_CHANCE).collect();
        tracing::debug!(?better, "another beginning");
        let logs = self.logs.iter_mut().zip(other.logs).zip(better);
        for ((log, other), _) in logs.filter(|(_, better)| *better) {
            *log = other;
        }
        Ok(())
    }

    /// With nothing stored where something was held, and the other way round.
    fn begun_otherwise(&self) -> Self {
        let mut set = self.clone();
        for log in &mut set.logs {
            let Answer::Replay(replay) = &log.answer else {
                continue;
            };
            let other = match (replay.stored(), log.doubtful) {
                (Stored::Effort(_), Some(_)) => Stored::Nothing,
                (Stored::Nothing, Some(effort)) => Stored::Effort(effort),
                _ => continue,
            };
            log.answer = Answer::Replay(Box::new(replay.as_ref().clone().storing(other)));
        }
        set
    }

    /// Moves what the drive holds at the start of each log, where that is the mean of a noisy or
    /// coarse command, to where the log is most likely beside this state: by parabolas through
    /// three points, from where the last one led, by no more than its mean may be off from what is shown.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine does not run.
    fn find_effort(&mut self, machine: &Axis, state: &State) -> Result<(), ReplayError> {
        let shown = self.efforts_shown(machine);
        let of = |value: fn(&EffortShown) -> f64| -> Vec<f64> {
            let each = shown.iter().map(|s| s.as_ref().map_or(0.0, value));
            each.collect()
        };
        let (noise, reach) = (of(|s| s.noise), of(|s| s.reach / s.noise));
        if noise.iter().all(|n| *n <= 0.0) {
            return Ok(());
        }
        // Reached so far, of what is shown: shares of the noise, as all moves here.
        let reached = |(log, noise): (&Prepared, &f64)| {
            let moved = effort_moved(log)?;
            (*noise > 0.0).then_some(moved / noise)
        };
        let reached = self.logs.iter().zip(&noise).map(reached);
        let reached: Vec<f64> = reached.map(Option::unwrap_or_default).collect();
        let misfits = |moves: &[f64]| -> Result<Vec<f64>, ReplayError> {
            let moves: Vec<f64> = moves.iter().zip(&noise).map(|(by, n)| by * n).collect();
            let set = self.with_efforts_moved(&moves);
            let rest = set.rest(&set.simulate(machine, state)?);
            Ok(rest.iter().map(|log| misfit(log)).collect())
        };
        let within = |i: usize, to: f64| {
            let most = reach[i].max(0.0);
            (reached[i] + to).clamp(-most, most) - reached[i]
        };
        let begun = misfits(&vec![0.0; noise.len()])?;
        let mut sought: Vec<Sought> = begun.into_iter().map(Sought::at_what_is_shown).collect();
        for _ in 0..PARABOLAS {
            let all = |to: &dyn Fn(usize, &Sought) -> f64| -> Vec<f64> {
                let each = sought.iter().enumerate();
                each.map(|(i, s)| within(i, to(i, s))).collect()
            };
            let [below, above] = [-1.0, 1.0].map(|sign| all(&|_, s| s.at + sign * s.step()));
            let [low, high] = [misfits(&below)?, misfits(&above)?];
            let next = all(&|i, s| s.led_to([low[i], high[i]]));
            let there = misfits(&next)?;
            let mut goes_on = false;
            for (i, sought) in sought.iter_mut().enumerate() {
                let tried = [(next[i], there[i]), (below[i], low[i]), (above[i], high[i])];
                goes_on |= sought.take(tried);
            }
            if !goes_on {
                break;
            }
        }
        let kept = sought.iter().zip(&noise).map(|(s, noise)| s.at * noise);
        let kept: Vec<f64> = kept.collect();
        tracing::debug!(?kept, ?noise, "effort at the start, moved by");
        *self = self.with_efforts_moved(&kept);
        Ok(())
    }

    /// How well each log shows the command with which its drive holds the axis at its start;
    /// `None` if that is not held, or not shown.
    fn efforts_shown(&self, machine: &Axis) -> Vec<Option<EffortShown>> {
        let of = |log: &Prepared| {
            held_effort(log.answer.replay()?)?;
            effort_shown(&log.log, log.period, machine)
        };
        self.logs.iter().map(of).collect()
    }

    /// Least and most by which what the drive holds at the start of each log may be moved, in the
    /// actuator's unit: none if its command is not coarse. `None` if no log's is.
    pub(crate) fn coarse_efforts(&self, machine: &Axis) -> Option<Vec<[f64; 2]>> {
        let room = |(log, shown): (&Prepared, Option<EffortShown>)| {
            let most = shown.filter(|s| s.is_coarse)?.reach;
            let moved = effort_moved(log)?;
            Some([-most - moved, most - moved])
        };
        let rooms = self.logs.iter().zip(self.efforts_shown(machine)).map(room);
        let rooms: Vec<Option<[f64; 2]>> = rooms.collect();
        let is_coarse = rooms.iter().any(Option::is_some);
        is_coarse.then(|| rooms.into_iter().map(Option::unwrap_or_default).collect())
    }

    /// Whether the drive holds another command at the start of a log than in `before`, by more than
    /// a tenth of its noise or step.
    pub(crate) fn begins_elsewhere(&self, before: &Self, machine: &Axis) -> bool {
        let shown = self.efforts_shown(machine).into_iter();
        let pairs = self.logs.iter().zip(&before.logs).zip(shown);
        let mut moved = pairs.map(|((now, before), shown)| {
            let effort = |log: &Prepared| held_effort(log.answer.replay()?);
            let by = (effort(now)? - effort(before)?).abs();
            Some(by > STEP * shown?.noise)
        });
        moved.any(|is_moved| is_moved == Some(true))
    }

    /// The same logs, the drive holding so much more at their starts.
    pub(crate) fn with_efforts_moved(&self, moves: &[f64]) -> Self {
        let mut set = self.clone();
        for (log, by) in set.logs.iter_mut().zip(moves) {
            if let Answer::Replay(replay) = &log.answer
                && let Stored::Effort(effort) = replay.stored()
            {
                log.answer = Answer::Replay(Box::new(
                    replay.as_ref().clone().storing(Stored::Effort(effort + by)),
                ));
            }
        }
        set
    }

    /// What the bristles hold at the start of each log, where that is an unknown.
    fn shares(&self) -> Vec<Option<f64>> {
        let of = |answer: &Answer| match answer.replay()?.stored() {
            Stored::Share(share) => Some(share),
            _ => None,
        };
        self.logs.iter().map(|log| of(&log.answer)).collect()
    }

    fn with_shares(&self, shares: &[f64]) -> Self {
        let mut set = self.clone();
        for (log, &share) in set.logs.iter_mut().zip(shares) {
            if let Answer::Replay(replay) = &log.answer
                && let Stored::Share(_) = replay.stored()
            {
                log.answer = Answer::Replay(Box::new(
                    replay.as_ref().clone().storing(Stored::Share(share)),
                ));
            }
        }
        set
    }
}

/// By how much what the drive holds at the start of a log is more than the log shows, in the actuator's
/// unit; `None` if that is not held, or not shown.
fn effort_moved(log: &Prepared) -> Option<f64> {
    Some(held_effort(log.answer.replay()?)? - log.shown_effort?)
}

/// Minus twice the log-likelihood of channels with white residuals of unknown variance, but for
/// a constant.
pub(super) fn misfit(log: &[Vec<f64>]) -> f64 {
    let channel = |rest: &Vec<f64>| {
        let n = rest.len().max(1) as f64;
        let square = rest.iter().map(|r| r * r).sum::<f64>() / n;
        n * square.max(f64::MIN_POSITIVE).ln()
    };
    log.iter().map(channel).sum()
}

#[cfg(test)]
mod tests {
    use axis_log::{Channel, Log};
    use axis_sim::effects::{ActiveEffect, Effect};
    use axis_sim::{Axis, ClosedLoop, Recorder};
    use compensator::NoCompensation;
    use trajectories::{Limits, Program, Step};

    use super::{LogSet, State, effort_moved};

    /// The paper's axis under a load that its file does not have: whatever is held at the start makes
    /// up for a part of it, and is looked for beside each state that a search comes to.
    #[test]
    fn what_is_held_at_the_start_stays_near_what_the_log_shows() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
        let machine = Axis::read(file.as_ref()).unwrap();
        let mut loaded = machine.clone();
        loaded.effects.push(ActiveEffect {
            effect: Effect::named("constant-load").unwrap(),
            values: vec![-14.4],
        });
        let from = machine.stroke.start;
        let rest = Step::Dwell { duration: 0.3 };
        let limits = Limits::new(0.05, 0.5, 10.0).unwrap();
        let to = |to: f64| Step::Move { to, limits };
        let steps = vec![rest, to(from + 0.01), rest, to(from), rest];
        let program = Program::new(from, steps).unwrap();
        let mut recorder = Recorder::new(&loaded);
        ClosedLoop::new(&loaded)
            .unwrap()
            .run(&program, &mut NoCompensation, |c| recorder.push(c))
            .completed()
            .unwrap();
        // Loads come up with the first samples.
        let channel =
            |c: &Channel| Channel::new(c.name.clone(), c.samples[1000..].to_vec()).unwrap();
        let log = recorder.log().unwrap();
        let log = Log::new(log.channels().iter().map(channel).collect()).unwrap();
        let logs = vec![("log".to_owned(), log, machine.period)];
        let mut set = LogSet::new(logs, &machine).unwrap();
        let mut moved = Vec::new();
        for _ in 0..4 {
            set.find_effort(&machine, &State::initial(&machine))
                .unwrap();
            let reach = set.efforts_shown(&machine)[0].unwrap().reach;
            moved.push(effort_moved(&set.logs[0]).unwrap() / reach);
        }
        println!("{moved:?}");
        assert!(moved[0].abs() > 0.5, "{moved:?}");
        let most = 1.0 + 1e-9;
        assert!(moved.iter().all(|by| by.abs() <= most), "{moved:?}");
    }
}
