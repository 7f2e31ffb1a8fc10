//! A simulated run at a log's instants.

use crate::Cycle;

/// What is kept of a cycle.
type Read = fn(&Cycle) -> f64;

/// Channels at a log's instants, taken while the run goes by: linear between cycles, the
/// last cycle where the log goes on. A whole run at every cycle would be ten times as large.
pub(super) struct Sampled {
    reads: Vec<Read>,
    /// Of each channel at each instant, or at the cycle before the next instant.
    columns: Vec<Vec<f64>>,
    before: Vec<f64>,
    instants: Instants,
    cycle: usize,
    cycles: usize,
}

/// When a log was sampled.
pub(super) struct Instants {
    /// Of a control cycle and of the log, s.
    periods: [f64; 2],
    /// By how much its clock is late, s.
    late: f64,
    count: usize,
    next: usize,
    /// Where the next one lies; `None` after the last.
    place: Option<Place>,
}

/// Where an instant lies: at a cycle, or so far behind one.
#[derive(Clone, Copy)]
enum Place {
    At(usize),
    Behind(usize, f64),
}

impl Instants {
    /// So many, every `periods[1]` seconds, beside cycles every `periods[0]`, on a clock that
    /// is `late`.
    pub(super) fn new(periods: [f64; 2], late: f64, count: usize) -> Self {
        let mut instants = Self {
            periods,
            late,
            count,
            next: 0,
            place: None,
        };
        instants.place = instants.find();
        instants
    }

    /// Goes on to the next instant.
    fn pass(&mut self) {
        self.next += 1;
        self.place = self.find();
    }

    fn find(&self) -> Option<Place> {
        if self.next >= self.count {
            return None;
        }
        let [period, every] = self.periods;
        let along = ((self.next as f64 * every - self.late) / period).max(0.0);
        let near = along.round();
        Some(match (along - near).abs() < 1e-6 {
            true => Place::At(near as usize),
            false => Place::Behind(along as usize, along - along.floor()),
        })
    }
}

impl Sampled {
    /// Of these channels, at these instants of a run of so many cycles.
    pub(super) fn new(reads: Vec<Read>, instants: Instants, cycles: usize) -> Self {
        Self {
            columns: vec![Vec::with_capacity(instants.count); reads.len()],
            before: vec![0.0; reads.len()],
            instants,
            reads,
            cycle: 0,
            cycles,
        }
    }

    /// The next cycle.
    pub(super) fn take(&mut self, c: &Cycle) {
        while let Some(place) = self.instants.place {
            match place {
                Place::At(k) if k == self.cycle => {
                    for (column, read) in self.columns.iter_mut().zip(&self.reads) {
                        column.push(read(c));
                    }
                }
                Place::Behind(k, part) if k + 1 == self.cycle => {
                    let pairs = self.reads.iter().zip(&self.before);
                    for (column, (read, before)) in self.columns.iter_mut().zip(pairs) {
                        column.push((1.0 - part) * before + part * read(c));
                    }
                }
                Place::Behind(k, _) if k == self.cycle => {
                    self.keep(c);
                    break;
                }
                _ => break,
            }
            self.instants.pass();
        }
        self.cycle += 1;
        if self.cycle == self.cycles {
            for (column, read) in self.columns.iter_mut().zip(&self.reads) {
                column.resize(self.instants.count, read(c));
            }
        }
    }

    fn keep(&mut self, c: &Cycle) {
        for (before, read) in self.before.iter_mut().zip(&self.reads) {
            *before = read(c);
        }
    }

    /// The samples of each channel, after the last cycle.
    pub(super) fn columns(self) -> Vec<Vec<f64>> {
        self.columns
    }
}

#[cfg(test)]
mod tests {
    use super::{Instants, Sampled};
    use crate::Cycle;

    /// A run of so many cycles every `period`, in which position and speed go as t and t².
    fn run(period: f64, every: f64, late: f64, count: usize, cycles: usize) -> Vec<Vec<f64>> {
        let instants = Instants::new([period, every], late, count);
        let mut sampled = Sampled::new(vec![|c| c.position, |c| c.load_speed], instants, cycles);
        for k in 0..cycles {
            let t = k as f64 * period;
            sampled.take(&Cycle {
                position: t,
                load_speed: t * t,
                ..Cycle::default()
            });
        }
        sampled.columns()
    }

    #[test]
    fn at_cycles_it_has_their_values() {
        for every in [1e-4, 1e-3] {
            let columns = run(1e-4, every, 0.0, 20, 200);
            for (k, [place, speed]) in rows(&columns) {
                let t = k as f64 * every;
                assert!((place - t).abs() < 1e-15);
                assert!((speed - t * t).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn between_cycles_it_is_linear_whatever_is_faster() {
        for every in [0.3e-4, 0.7e-4, 2.5e-4] {
            let columns = run(1e-4, every, 0.0, 60, 200);
            for (k, [place, speed]) in rows(&columns) {
                let t = k as f64 * every;
                let low = (t / 1e-4 + 1e-9).floor() * 1e-4;
                let chord = low * low + (t - low) * (2.0 * low + 1e-4);
                assert!((place - t).abs() < 1e-15, "{every} {k}");
                assert!((speed - chord).abs() < 1e-15, "{every} {k}");
            }
        }
    }

    #[test]
    fn a_late_clock_shows_what_was_and_a_longer_log_the_end() {
        let columns = run(1e-4, 1e-3, 2.5e-4, 8, 51);
        assert_eq!(columns[0].len(), 8);
        for (k, [place, _]) in rows(&columns) {
            let late = (k as f64 * 1e-3 - 2.5e-4).clamp(0.0, 50.0 * 1e-4);
            assert!((place - late).abs() < 1e-15, "{k}");
        }
    }

    /// Each instant with what both channels have there.
    fn rows(columns: &[Vec<f64>]) -> impl Iterator<Item = (usize, [f64; 2])> {
        let pairs = columns[0].iter().zip(&columns[1]);
        pairs.map(|(a, b)| [*a, *b]).enumerate()
    }
}
