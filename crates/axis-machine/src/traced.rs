//! Where a machine was.

use std::ops::Range;
use std::sync::Arc;

use toolpath::{FeedProfile, Follower, Foot};

/// Positions of a machine along a path, at even times from 0 on.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced<const D: usize> {
    profile: Arc<FeedProfile<D>>,
    period: f64,
    /// By which the motion began later than the profile, s.
    delay: f64,
    positions: Vec<[f64; D]>,
}

impl<const D: usize> Traced<D> {
    pub(crate) fn new(profile: Arc<FeedProfile<D>>, period: f64, positions: Vec<[f64; D]>) -> Self {
        Self {
            profile,
            period,
            delay: 0.0,
            positions,
        }
    }

    /// The same of a motion that began so much later (s) than the profile.
    pub(crate) fn delayed(self, delay: f64) -> Self {
        Self { delay, ..self }
    }

    /// The motion along the path that was asked for.
    pub fn profile(&self) -> &FeedProfile<D> {
        &self.profile
    }

    /// Time between two positions, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Time of the profile at position number `index` (from 0), s; below 0 before it begins.
    pub fn time(&self, index: usize) -> f64 {
        index as f64 * self.period - self.delay
    }

    /// Where the machine was, m, in the path's coordinates.
    pub fn positions(&self) -> &[[f64; D]] {
        &self.positions
    }

    /// The feet of all positions on the path, one after the other: each has the contour error.
    pub fn contour_error(&self) -> impl Iterator<Item = Foot<D>> {
        let mut follower = Follower::new(self.profile.path(), 0.0);
        self.positions.iter().map(move |p| follower.follow(*p))
    }

    /// Those of the positions while the reference is between two arc lengths (m): of the counted turn of a circle, for
    /// instance.
    pub fn contour_error_between(&self, counted: (f64, f64)) -> impl Iterator<Item = Foot<D>> {
        let range = self.range(counted);
        self.contour_error().skip(range.start).take(range.len())
    }

    /// The positions while the reference is between two arc lengths, m.
    pub fn between(&self, counted: (f64, f64)) -> &[[f64; D]] {
        &self.positions[self.range(counted)]
    }

    /// Which positions these are.
    fn range(&self, (from, to): (f64, f64)) -> Range<usize> {
        let passed = |s: f64| {
            let (mut low, mut high) = (0, self.positions.len());
            while low < high {
                let middle = low.midpoint(high);
                match self.profile.at(self.time(middle)).s < s {
                    true => low = middle + 1,
                    false => high = middle,
                }
            }
            low
        };
        let (first, last) = (passed(from), passed(to));
        first..last.max(first)
    }
}
