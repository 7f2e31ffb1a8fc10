//! Where a machine was.

use std::ops::Range;
use std::sync::Arc;

use toolpath::{FeedProfile, Follower, Foot, PathPoint, PathSegment};

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
    /// A [`Follower`] that comes to a corner sharper than a right angle, or to a tip of a smaller radius than the error, would stay on
    /// the line it came from, as the tool goes on along the next one: there too the distance has a minimum. Therefore the places that the
    /// reference has passed (corners, and points of a NURBS every 0.25 mm or radius of curvature) are kept until the tool
    /// has passed them too; a foot from there takes over if it is as near.
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

/// Follows a position from foot to foot, also around sharp corners and tips.
struct Feet<'a, const D: usize> {
    profile: &'a FeedProfile<D>,
    follower: Follower<'a, D>,
    /// Time at which the reference stands in each corner, and its arc length, those to come last first.
    corners: Vec<(f64, f64)>,
    has_curves: bool,
    /// Where the reference was last kept, m.
    kept: f64,
    /// Places that the reference has passed and the tool has not.
    passed: Vec<(f64, PathPoint<D>)>,
}

/// Arc lengths between two places of the reference on a curve, m: its radius of curvature, within these.
const APART: (f64, f64) = (5e-6, 2.5e-4);

impl<'a, const D: usize> Feet<'a, D> {
    fn of(profile: &'a FeedProfile<D>) -> Self {
        let path = profile.path();
        let at_corner = |s: f64| path.corners().iter().any(|c| (c - s).abs() < 1e-9);
        let stops = profile.stops().iter().rev().map(|&t| (t, profile.at(t).s));
        Self {
            profile,
            follower: Follower::new(path, 0.0),
            corners: stops.filter(|&(_, s)| at_corner(s)).collect(),
            has_curves: (path.segments().iter()).any(|s| matches!(s, PathSegment::Nurbs(_))),
            kept: 0.0,
            passed: Vec::new(),
        }
    }

    fn next(&mut self, time: f64, position: &[f64; D]) -> Foot<D> {
        self.keep(time);
        let foot = self.follower.follow(*position);
        // The last that the tool has passed is the nearest behind it.
        let ahead = |at: &PathPoint<D>| -> f64 {
            (0..D)
                .map(|i| (position[i] - at.position[i]) * at.tangent[i])
                .sum()
        };
        for i in (0..self.passed.len()).rev() {
            let (s, at) = self.passed[i];
            if ahead(&at) < 0.0 {
                continue;
            }
            let mut from_there = self.follower.from(s);
            let next = from_there.follow(*position);
            // Two descents to one foot differ by rounding.
            if next.s >= s && next.length() <= foot.length() + 1e-12 {
                self.follower = from_there;
                self.passed.drain(..=i);
                return next;
            }
        }
        foot
    }

    /// Keeps where the reference is, if it has gone far enough.
    fn keep(&mut self, time: f64) {
        let path = self.profile.path();
        while let Some(&(_, s)) = self.corners.last().filter(|corner| corner.0 <= time) {
            self.corners.pop();
            self.passed.push((s, path.at(s)));
            self.kept = s;
        }
        if !self.has_curves {
            return;
        }
        let s = self.profile.at(time).s;
        if s - self.kept < APART.0 {
            return;
        }
        let at = path.at(s);
        if s - self.kept >= (1.0 / at.curvature_size()).clamp(APART.0, APART.1) {
            self.passed.push((s, at));
            self.kept = s;
        }
    }
}
