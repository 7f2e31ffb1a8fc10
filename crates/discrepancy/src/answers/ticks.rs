//! In which cycle of the control a log begins.
//!
//! A position loop that is slower than the control runs in one of several cycles, and no log says in which: a log of
//! one sample in its period may be taken anywhere in that. Half a period of 1 ms at a wrong instant is a gain, a
//! feed-forward and a delay that are not there.

use axis_sim::{Axis, ReplayError};

use super::share::{BY_CHANCE, misfit};
use super::{Answer, LogSet, Prepared, State};

impl LogSet {
    /// Finds of each log, beside this state, how long before its first sample all loops of the control ran: of all cycles
    /// the one with which the log is most likely.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine does not run.
    pub(crate) fn find_ticks(&mut self, machine: &Axis, state: &State) -> Result<(), ReplayError> {
        let ticks = machine.control.ticks(machine.period);
        if ticks < 2 || self.is_balanced() {
            return Ok(());
        }
        let misfits = |set: &Self| -> Result<Vec<f64>, ReplayError> {
            let rest = set.rest(&set.simulate(machine, state)?);
            Ok(rest.iter().map(|log| misfit(log)).collect())
        };
        let as_now = misfits(self)?;
        let mut best: Vec<(f64, u32)> = as_now.iter().map(|now| (now - BY_CHANCE, 0)).collect();
        let mut found: Vec<Option<u32>> = vec![None; best.len()];
        for cycles in 0..ticks {
            let set = self.ticked(|_| Some(cycles));
            for (l, tried) in misfits(&set)?.into_iter().enumerate() {
                if tried < best[l].0 {
                    best[l] = (tried, cycles);
                    found[l] = Some(cycles);
                }
            }
        }
        tracing::debug!(?found, "cycles before the first sample");
        *self = self.ticked(|l| found[l]);
        Ok(())
    }

    /// The same logs, all loops of the control having run so many cycles before the first sample of each of which that is
    /// known.
    pub(super) fn ticked(&self, cycles: impl Fn(usize) -> Option<u32>) -> Self {
        let mut set = self.clone();
        for (l, log) in set.logs.iter_mut().enumerate() {
            if let (Answer::Replay(replay), Some(cycles)) = (&log.answer, cycles(l)) {
                log.answer = Answer::Replay(Box::new(replay.as_ref().clone().ticked(cycles)));
            }
        }
        set
    }

    /// Of which logs it was found that slower loops of the control did not run with the first sample, in words.
    pub(crate) fn notes_of_ticks(&self, machine: &Axis) -> Vec<String> {
        let note = |log: &Prepared| {
            let cycles = log.answer.replay().map(axis_sim::Replay::ticks)?;
            (cycles > 0).then(|| {
                format!(
                    "{}: the control\u{2019}s slower loop ran {:.3} ms before the first sample, by what fits the log best: a log does not show it",
                    log.name,
                    1e3 * f64::from(cycles) * machine.period
                )
            })
        };
        self.logs.iter().filter_map(note).collect()
    }
}
