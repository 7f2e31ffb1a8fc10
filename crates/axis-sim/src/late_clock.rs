//! Channels of a log on a clock of their own.

use std::collections::VecDeque;

use trajectories::Setpoint;

use crate::cycle::Cycle;

/// What shares a clock.
pub(crate) trait Timed: Copy {
    fn of(cycle: &Cycle) -> Self;

    /// This much of the way from `self` to the next, 0 to 1.
    fn towards(self, next: Self, part: f64) -> Self;

    fn show(self, cycle: &mut Cycle);
}

/// The load's position as it is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoadPosition(f64);

impl Timed for LoadPosition {
    fn of(cycle: &Cycle) -> Self {
        Self(cycle.measured.position)
    }

    fn towards(self, next: Self, part: f64) -> Self {
        Self((1.0 - part) * self.0 + part * next.0)
    }

    fn show(self, cycle: &mut Cycle) {
        cycle.measured.position = self.0;
    }
}

impl Timed for Setpoint {
    fn of(cycle: &Cycle) -> Self {
        cycle.reference
    }

    fn towards(self, next: Self, part: f64) -> Self {
        let between = |a: f64, b: f64| (1.0 - part) * a + part * b;
        Self {
            position: between(self.position, next.position),
            velocity: between(self.velocity, next.velocity),
            acceleration: between(self.acceleration, next.acceleration),
            jerk: between(self.jerk, next.jerk),
        }
    }

    fn show(self, cycle: &mut Cycle) {
        cycle.reference = self;
    }
}

/// Passes cycles on with what a log shows beside them, where some channels are late against the
/// others: linear between cycles, the first or the last one beyond the run's ends.
/// It holds as many cycles as the clock is off by.
#[derive(Clone, Debug)]
pub(crate) struct LateClock<T> {
    /// By how much it is late, cycles.
    late: f64,
    /// Those of the channels, from that of cycle `first` on.
    values: VecDeque<T>,
    first: usize,
    /// Cycles whose value is not known yet, from cycle `next` on.
    waiting: VecDeque<Cycle>,
    next: usize,
}

impl<T: Timed> LateClock<T> {
    /// One that is late by so many cycles; early where negative.
    pub(crate) fn new(late: f64) -> Self {
        Self {
            late,
            values: VecDeque::new(),
            first: 0,
            waiting: VecDeque::new(),
            next: 0,
        }
    }

    /// Takes the next cycle, and gives those whose value is known by now.
    pub(crate) fn push(&mut self, cycle: &Cycle, mut to: impl FnMut(Cycle)) {
        if self.late == 0.0 {
            return to(*cycle);
        }
        self.values.push_back(T::of(cycle));
        self.waiting.push_back(*cycle);
        let newest = (self.first + self.values.len() - 1) as f64;
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

    /// Where the value lies that is shown beside the next cycle.
    fn along(&self) -> f64 {
        (self.next as f64 - self.late).max(0.0)
    }

    /// The next cycle as the log shows it.
    fn pass(&mut self) -> Option<Cycle> {
        let mut cycle = self.waiting.pop_front()?;
        let along = self.along();
        let last = self.values.len() - 1;
        let at = (along as usize).saturating_sub(self.first).min(last);
        self.values.drain(..at);
        self.first += at;
        let part = (along - self.first as f64).clamp(0.0, 1.0);
        let after = *self.values.get(1).unwrap_or(&self.values[0]);
        self.values[0].towards(after, part).show(&mut cycle);
        self.next += 1;
        Some(cycle)
    }
}

/// The clocks of a log: the load's channel, and the reference's, against all others.
#[derive(Clone, Debug)]
pub(crate) struct LateClocks {
    load: LateClock<LoadPosition>,
    reference: LateClock<Setpoint>,
}

/// By how many cycles the channels of each are late.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Lateness {
    pub(crate) load: f64,
    pub(crate) reference: f64,
}

impl LateClocks {
    pub(crate) fn new(late: Lateness) -> Self {
        Self {
            load: LateClock::new(late.load),
            reference: LateClock::new(late.reference),
        }
    }

    /// Takes the next cycle, and gives those that the log shows by now.
    pub(crate) fn push(&mut self, cycle: &Cycle, mut to: impl FnMut(Cycle)) {
        let reference = &mut self.reference;
        self.load.push(cycle, |c| reference.push(&c, &mut to));
    }

    /// Gives the rest, after the last cycle.
    pub(crate) fn finish(mut self, mut to: impl FnMut(Cycle)) {
        self.load.finish(|c| self.reference.push(&c, &mut to));
        self.reference.finish(to);
    }
}

#[cfg(test)]
mod tests {
    use super::{LateClock, LoadPosition};
    use crate::Cycle;

    /// What is shown of a run whose position is the square of the cycle's number.
    fn shown(late: f64, cycles: usize) -> Vec<(f64, f64)> {
        let mut clock = LateClock::<LoadPosition>::new(late);
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
