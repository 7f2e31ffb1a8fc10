//! Two strategies at once.

use axis_scalar::Scalar;

use crate::{Compensator, Correction, Sample};

/// The sum of two strategies' corrections; nest it for more.
#[derive(Clone, Copy, Debug)]
pub struct Combined<A, B> {
    first: A,
    second: B,
}

impl<A, B> Combined<A, B> {
    /// Adds the corrections of both, which compute in the same scalar.
    pub fn new(first: A, second: B) -> Self {
        Self { first, second }
    }
}

impl<T, A, B> Compensator<T> for Combined<A, B>
where
    T: Scalar,
    A: Compensator<T>,
    B: Compensator<T>,
{
    fn reset(&mut self) {
        self.first.reset();
        self.second.reset();
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        let (a, b) = (self.first.correct(sample), self.second.correct(sample));
        Correction {
            position: a.position + b.position,
            command: a.command + b.command,
        }
    }

    /// The greater of both; what is no number before what is one.
    fn surprise(&self) -> T {
        let (a, b) = (self.first.surprise(), self.second.surprise());
        match b.abs() <= a.abs() || !a.is_finite() {
            true => a,
            false => b,
        }
    }
}
