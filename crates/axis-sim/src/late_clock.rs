//! The load's channel on a clock of its own.

use std::collections::VecDeque;

use crate::cycle::Cycle;

/// Passes cycles on with the position that a log shows beside them, where the load's channel is
/// late against the others: linear between cycles, the first or the last one beyond the run's ends.
/// It holds as many cycles as the clock is off by.
#[derive(Clone, Debug)]
pub(crate) struct LateClock {
    /// By how much it is late, cycles.
    late: f64,
    /// Positions as measured, from that of cycle `first` on.
    positions: VecDeque<f64>,
    first: usize,
    /// Cycles whose position is not known yet, from cycle `next` on.
    waiting: VecDeque<Cycle>,
    next: usize,
}

impl LateClock {
    /// One that is late by so many cycles; early where negative.
    pub(crate) fn new(late: f64) -> Self {
        Self {
            late,
            positions: VecDeque::new(),
            first: 0,
            waiting: VecDeque::new(),
            next: 0,
        }
    }

    /// Takes the next cycle, and gives those whose position is known by now.
    pub(crate) fn push(&mut self, cycle: &Cycle, mut to: impl FnMut(Cycle)) {
        if self.late == 0.0 {
            return to(*cycle);
        }
        self.positions.push_back(cycle.measured.position);
        self.waiting.push_back(*cycle);
        let newest = (self.first + self.positions.len() - 1) as f64;
        while self.along() <= newest {
            let Some(cycle) = self.pass() else { break };
            to(cycle);
        }
    }

    /// Gives the rest, after the last cycle.
    pub(crate) fn finish(mut self, mut to: impl FnMut(Cycle)) {
        while let Some(cycle) = self.pass() {
            to(cycle);
        }
    }

    /// Where the position lies that is shown beside the next cycle.
    fn along(&self) -> f64 {
        (self.next as f64 - self.late).max(0.0)
    }

    /// The next cycle as the log shows it.
    fn pass(&mut self) -> Option<Cycle> {
        let mut cycle = self.waiting.pop_front()?;
        let along = self.along();
        let last = self.positions.len() - 1;
        let at = (along as usize).saturating_sub(self.first).min(last);
        self.positions.drain(..at);
        self.first += at;
        let part = (along - self.first as f64).clamp(0.0, 1.0);
        let after = self.positions.get(1).unwrap_or(&self.positions[0]);
        cycle.measured.position = (1.0 - part) * self.positions[0] + part * after;
        self.next += 1;
        Some(cycle)
    }
}

#[cfg(test)]
mod tests {
    use super::LateClock;
    use crate::Cycle;

    /// What is shown of a run whose position is the square of the cycle's number.
    fn shown(late: f64, cycles: usize) -> Vec<(f64, f64)> {
        let mut clock = LateClock::new(late);
        let mut shown = Vec::new();
        let mut keep = |c: Cycle| shown.push((c.time, c.measured.position));
        for k in 0..cycles {
            let mut cycle = Cycle {
                time: k as f64,
                ..Cycle::default()
            };
            cycle.measured.position = (k * k) as f64;
            clock.push(&cycle, &mut keep);
        }
        clock.finish(&mut keep);
        shown
    }

    #[test]
    fn each_cycle_is_shown_once_beside_the_position_of_another_instant() {
        for late in [0.0, 1.0, 2.5, 0.25, -0.25, -1.0, -3.75, 40.0, -40.0] {
            for cycles in [1, 2, 3, 20] {
                let shown = shown(late, cycles);
                assert_eq!(shown.len(), cycles, "{late}");
                for (k, (time, position)) in shown.iter().enumerate() {
                    assert_eq!(*time, k as f64);
                    let at = (k as f64 - late).clamp(0.0, (cycles - 1) as f64);
                    // The chord of the parabola.
                    let chord = at.floor().powi(2) + (at - at.floor()) * (2.0 * at.floor() + 1.0);
                    assert!((position - chord).abs() < 1e-9, "{late} {cycles} {k}");
                }
            }
        }
    }
}
