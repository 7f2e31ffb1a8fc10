//! A feed along a path within the limits of each axis.

mod band;
mod base;
mod constant;
mod limits;
mod rate;
mod stretch;

use trajectories::{Motion, SCurve};

use crate::contour::cells;
use crate::error::ToolpathError;
use crate::{JunctionKind, Path};

pub use limits::FeedLimits;
pub use stretch::FeedPoint;
use stretch::Stretch;

/// Positions of all axes and their derivatives by time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxesPoint<const D: usize> {
    /// Position, m.
    pub position: [f64; D],
    /// Velocity, m/s.
    pub velocity: [f64; D],
    /// Acceleration, m/s².
    pub acceleration: [f64; D],
    /// Jerk, m/s³.
    pub jerk: [f64; D],
}

/// A motion along a path from standstill to standstill, in short time within the limits of each
/// axis.
///
/// It stops at corners, and where the curvature jumps unless a step of acceleration is allowed.
/// Between two stops:
///
/// - Along one line or one arc it is one S-curve in s, whose limits keep those of the axes; on a
///   line that is the least time.
/// - Elsewhere s(t) = S(τ(t)) with splines S and q = (dτ/dt)², and q of least time is found by an
///   interior-point method, again with S from the last result twice. The limits hold on the
///   splines themselves: peaks between the places at which they are held are looked for, and the
///   whole is slowed by what remains.
#[derive(Clone, Debug, PartialEq)]
pub struct FeedProfile<const D: usize> {
    path: Path<D>,
    parts: Vec<Part>,
    /// Time at which each part begins, and that of the end, s.
    starts: Vec<f64>,
}

#[derive(Clone, Debug, PartialEq)]
enum Part {
    Constant(Box<SCurve<f64>>),
    Optimised(Box<Stretch>),
}

impl Part {
    fn duration(&self) -> f64 {
        match self {
            Self::Constant(curve) => curve.duration(),
            Self::Optimised(stretch) => stretch.duration(),
        }
    }

    fn at(&self, t: f64) -> FeedPoint {
        match self {
            Self::Constant(curve) => {
                let p = curve.at(t);
                FeedPoint {
                    s: p.position,
                    feed: p.velocity,
                    acceleration: p.acceleration,
                    jerk: p.jerk,
                }
            }
            Self::Optimised(stretch) => stretch.at(t),
        }
    }
}

impl<const D: usize> FeedProfile<D> {
    /// Plans the motion along `path` within `limits`.
    ///
    /// # Errors
    /// [`ToolpathError::Invalid`] for a limit that is not from 1e-9 to 1e9,
    /// [`ToolpathError::Feed`] or [`ToolpathError::Motion`] if they are too far apart in
    /// magnitude.
    pub fn plan(path: &Path<D>, limits: &FeedLimits<D>) -> Result<Self, ToolpathError> {
        limits.check()?;
        let stops = stops(path, limits);
        let cells = cells(path);
        let mut profile = Self {
            path: path.clone(),
            parts: Vec::new(),
            starts: vec![0.0],
        };
        for pair in stops.windows(2) {
            let range = (pair[0], pair[1]);
            let part = match constant::plan(path, limits, range)? {
                Some(curve) => Part::Constant(Box::new(curve)),
                None => Part::Optimised(Box::new(stretch::plan(path, &cells, limits, range)?)),
            };
            let start = profile.starts[profile.starts.len() - 1];
            profile.starts.push(start + part.duration());
            profile.parts.push(part);
        }
        Ok(profile)
    }

    /// The path.
    pub fn path(&self) -> &Path<D> {
        &self.path
    }

    /// Duration, s.
    pub fn duration(&self) -> f64 {
        self.starts[self.parts.len()]
    }

    /// Times at which it stands still, s: 0, stops, the duration.
    pub fn stops(&self) -> &[f64] {
        &self.starts
    }

    /// Arc length, feed, and its derivatives at time `t` (s); before 0 and after the end, at rest.
    pub fn at(&self, t: f64) -> FeedPoint {
        self.locate(t).1
    }

    /// The axes at time `t` (s).
    pub fn axes(&self, t: f64) -> AxesPoint<D> {
        let FeedPoint {
            s,
            feed,
            acceleration,
            jerk,
        } = self.at(t);
        let p = self.path.at(s);
        let of = |f: &dyn Fn(f64, f64, f64) -> f64| {
            std::array::from_fn(|i| f(p.tangent[i], p.curvature[i], p.third[i]))
        };
        AxesPoint {
            position: p.position,
            velocity: of(&|x1, _, _| x1 * feed),
            acceleration: of(&|x1, x2, _| x2 * feed * feed + x1 * acceleration),
            jerk: of(&|x1, x2, x3| {
                x3 * feed * feed * feed + 3.0 * x2 * feed * acceleration + x1 * jerk
            }),
        }
    }

    fn locate(&self, t: f64) -> (usize, FeedPoint) {
        let last = self.parts.len() - 1;
        // False for a NaN too.
        let holds = t > 0.0;
        if !holds {
            return (0, FeedPoint::default());
        }
        if t >= self.duration() {
            return (
                last,
                FeedPoint {
                    s: self.path.length(),
                    ..FeedPoint::default()
                },
            );
        }
        let part = self
            .starts
            .partition_point(|&start| start <= t)
            .clamp(1, last + 1)
            - 1;
        (part, self.parts[part].at(t - self.starts[part]))
    }
}

/// Arc lengths at which the feed is zero: begin, corners, jumps of curvature without an allowed
/// step, end.
fn stops<const D: usize>(path: &Path<D>, limits: &FeedLimits<D>) -> Vec<f64> {
    let stopping = path
        .junctions()
        .iter()
        .filter(|junction| match junction.kind {
            JunctionKind::Corner => true,
            JunctionKind::Curvature => (0..D).any(|i| {
                let step = junction.after.curvature[i] - junction.before.curvature[i];
                step != 0.0 && limits.acceleration_step[i] == 0.0
            }),
            JunctionKind::Third => false,
        });
    let mut stops = vec![0.0];
    stops.extend(stopping.map(|junction| junction.s));
    stops.push(path.length());
    stops
}
