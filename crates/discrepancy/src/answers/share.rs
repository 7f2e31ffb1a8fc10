//! What is held at the start of a log.
//!
//! Where the drive's command is not shown, one unknown a log, s in −1 ≤ s ≤ 1, beside the
//! parameters of the machine: nothing but the first move tells it, and it tells nothing of any
//! other motion. All of that range is possible, and equally likely. Where the command is shown,
//! its mean over the rest has an error where its noise is slow, and the first move tells that.

use axis_sim::{Axis, ReplayError, Stored};

use super::stored::noise_of_effort;
use super::{Answer, LogSet, State};

/// Shares that are tried first.
const TRIED: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];

/// Halvings of the step beside the best of them: to 1/64 of what the bristles can hold.
const HALVINGS: usize = 5;

/// Fall of minus twice the log-likelihood below which nothing is said to be stored.
const BY_CHANCE: f64 = 25.0;

/// Step by which a held effort is first moved, and most by which it is moved at once, as
/// shares of the command's noise.
const STEP: f64 = 0.1;
const REACH: f64 = 0.5;

/// Fall of minus twice the log-likelihood below which it stays: one number by chance.
const MOVED: f64 = 10.0;

impl LogSet {
    /// Finds what belongs to the logs and changes with the model: what they have stored where
    /// they do not show it, and defects.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run at this state.
    pub(crate) fn follow(&mut self, machine: &Axis, state: &State) -> Result<(), ReplayError> {
        self.find_stored(machine, state)?;
        self.find_beginning(machine, state)?;
        self.find_effort(machine, state)?;
        self.correct_defects(machine, state)
    }

    /// Finds what the bristles hold at the start of each log that does not show it, beside
    /// this state.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run.
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
    /// [`ReplayError`] where the machine does not run.
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
            log.answer = Answer::Replay(replay.clone().storing(other));
        }
        set
    }

    /// Moves what the drive holds at the start of each log, where that is the mean of a noisy
    /// command, to where the log is most likely beside this state: by a parabola through three
    /// points, by no more than [`REACH`].
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run.
    fn find_effort(&mut self, machine: &Axis, state: &State) -> Result<(), ReplayError> {
        let noise = self
            .logs
            .iter()
            .map(|log| match log.answer.replay()?.stored() {
                Stored::Effort(_) => noise_of_effort(&log.log, log.period, machine),
                _ => None,
            });
        let noise: Vec<Option<f64>> = noise.collect();
        if noise.iter().all(|n| n.is_none_or(|n| n <= 0.0)) {
            return Ok(());
        }
        let misfits = |moves: &[f64]| -> Result<Vec<f64>, ReplayError> {
            let set = self.with_efforts_moved(moves);
            let rest = set.rest(&set.simulate(machine, state)?);
            Ok(rest.iter().map(|log| misfit(log)).collect())
        };
        let steps: Vec<f64> = noise.iter().map(|n| STEP * n.unwrap_or(0.0)).collect();
        let times = |by: f64| steps.iter().map(|step| by * step).collect::<Vec<f64>>();
        let [below, here, above] = [-1.0, 0.0, 1.0].map(times).map(|m| misfits(&m));
        let (below, here, above) = (below?, here?, above?);
        let vertex = |i: usize| {
            let (slope, bend) = (above[i] - below[i], above[i] + below[i] - 2.0 * here[i]);
            let most = REACH / STEP;
            let by = match bend > 0.0 {
                true => -0.5 * slope / bend,
                false => -slope.signum(),
            };
            by.clamp(-most, most) * steps[i]
        };
        let moves: Vec<f64> = (0..steps.len()).map(vertex).collect();
        let there = misfits(&moves)?;
        let gains = here.iter().zip(&there).map(|(a, b)| a - b > MOVED);
        let kept = gains
            .zip(moves)
            .map(|(better, by)| if better { by } else { 0.0 });
        let kept: Vec<f64> = kept.collect();
        tracing::debug!(?kept, ?noise, "effort at the start, moved by");
        *self = self.with_efforts_moved(&kept);
        Ok(())
    }

    fn with_efforts_moved(&self, moves: &[f64]) -> Self {
        let mut set = self.clone();
        for (log, by) in set.logs.iter_mut().zip(moves) {
            if let Answer::Replay(replay) = &log.answer
                && let Stored::Effort(effort) = replay.stored()
            {
                log.answer = Answer::Replay(replay.clone().storing(Stored::Effort(effort + by)));
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
                log.answer = Answer::Replay(replay.clone().storing(Stored::Share(share)));
            }
        }
        set
    }
}

/// Minus twice the log-likelihood of channels with white rests of unknown variance, but for
/// a constant.
fn misfit(log: &[Vec<f64>]) -> f64 {
    let channel = |rest: &Vec<f64>| {
        let n = rest.len().max(1) as f64;
        let square = rest.iter().map(|r| r * r).sum::<f64>() / n;
        n * square.max(f64::MIN_POSITIVE).ln()
    };
    log.iter().map(channel).sum()
}
