//! Two strategies at once.

use crate::{Compensator, Correction, Sample};

/// The sum of two strategies' corrections; nest it for more.
#[derive(Clone, Copy, Debug)]
pub struct Combined<A, B> {
    first: A,
    second: B,
}

impl<A: Compensator, B: Compensator> Combined<A, B> {
    /// Adds the corrections of both.
    pub fn new(first: A, second: B) -> Self {
        Self { first, second }
    }
}

impl<A: Compensator, B: Compensator> Compensator for Combined<A, B> {
    fn reset(&mut self) {
        self.first.reset();
        self.second.reset();
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        let (a, b) = (self.first.correct(sample), self.second.correct(sample));
        Correction {
            position: a.position + b.position,
            iq: a.iq + b.iq,
        }
    }
}
