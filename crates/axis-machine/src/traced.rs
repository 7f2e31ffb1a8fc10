//! Where a machine was.

use std::ops::Range;
use std::sync::Arc;

use toolpath::{FeedProfile, Follower, Foot, Path};

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
    ///
    /// A [`Follower`] that came to a corner sharper than a right angle would go back along the line it came from, as the tool goes on
    /// along the next one: distances to both fall. From the instant at which the reference stands in the corner, a second one looks
    /// at the path behind it, and takes over once it is as near.
    pub fn contour_error(&self) -> impl Iterator<Item = Foot<D>> {
        let mut feet = Feet::of(&self.profile);
        let positions = self.positions.iter().enumerate();
        positions.map(move |(k, p)| feet.next(self.time(k), p))
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

/// Follows a position from foot to foot, also around sharp corners.
struct Feet<'a, const D: usize> {
    follower: Follower<'a, D>,
    /// Time at which the reference stands in each corner, and its arc length, those to come last first.
    corners: Vec<(f64, f64)>,
    /// At each corner that was passed and is not taken over yet: a follower that stands there, and its arc length.
    beyond: Option<(Follower<'a, D>, f64)>,
    path: &'a Path<D>,
}

impl<'a, const D: usize> Feet<'a, D> {
    fn of(profile: &'a FeedProfile<D>) -> Self {
        let path = profile.path();
        let at_corner = |s: f64| path.corners().iter().any(|c| (c - s).abs() < 1e-9);
        let stops = profile.stops().iter().rev().map(|&t| (t, profile.at(t).s));
        Self {
            follower: Follower::new(path, 0.0),
            corners: stops.filter(|&(_, s)| at_corner(s)).collect(),
            beyond: None,
            path,
        }
    }

    fn next(&mut self, time: f64, position: &[f64; D]) -> Foot<D> {
        while let Some(&(_, s)) = self.corners.last().filter(|corner| corner.0 <= time) {
            self.corners.pop();
            self.beyond = Some((Follower::new(self.path, s), s));
        }
        let foot = self.follower.follow(*position);
        let Some((standing, corner)) = &self.beyond else {
            return foot;
        };
        // From the corner anew each time: until the tool has passed it, the way back to the line before is the nearer one.
        let mut ahead = standing.clone();
        let next = ahead.follow(*position);
        if next.s >= *corner && next.length() <= foot.length() {
            self.follower = ahead;
            self.beyond = None;
            return next;
        }
        foot
    }
}
