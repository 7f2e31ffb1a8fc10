//! A command that comes late.

use std::collections::VecDeque;

/// Most control periods by which a command may come late.
pub(crate) const MOST_DELAY: f64 = 1e5;

/// The last few commands, and the one that is a delay old.
#[derive(Clone, Debug)]
pub(super) struct DelayLine {
    /// In control cycles, whole and part.
    cycles: f64,
    past: VecDeque<f64>,
}

impl DelayLine {
    /// A delay of `cycles` control periods, at most [`MOST_DELAY`]; before the first
    /// command there was none.
    pub fn new(cycles: f64) -> Self {
        let cycles = cycles.clamp(0.0, MOST_DELAY);
        let length = match cycles {
            0.0 => 0,
            _ => cycles.ceil() as usize + 2,
        };
        Self {
            cycles,
            past: VecDeque::from(vec![0.0; length]),
        }
    }

    /// As if `effort` had been commanded for ever.
    pub fn settle(&mut self, effort: f64) {
        self.past.iter_mut().for_each(|past| *past = effort);
    }

    /// Takes the newest value and gives the late one, linear between cycles.
    pub fn push(&mut self, newest: f64) -> f64 {
        if self.past.is_empty() {
            return newest;
        }
        self.past.pop_back();
        self.past.push_front(newest);
        let whole = self.cycles.floor();
        let part = self.cycles - whole;
        let at = |i: usize| self.past.get(i).copied().unwrap_or(newest);
        let after = whole as usize;
        (1.0 - part) * at(after) + part * at(after + 1)
    }
}
