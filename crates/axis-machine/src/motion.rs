//! One axis' part of a motion along a path.

use std::sync::Arc;

use toolpath::FeedProfile;
use trajectories::{Motion, Setpoint};

/// What one axis has to do along a path: it begins where that axis' motions begin, and goes on as the path's coordinate
/// does.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisMotion<const D: usize> {
    profile: Arc<FeedProfile<D>>,
    axis: usize,
    /// Position of the axis where the path's coordinate is 0, m.
    zero: f64,
}

impl<const D: usize> AxisMotion<D> {
    /// Of axis `axis` (from 0; of a greater number the last), which stands at `start` (m) where the path begins.
    pub fn new(profile: Arc<FeedProfile<D>>, axis: usize, start: f64) -> Self {
        let axis = axis.min(D.saturating_sub(1));
        let begin = profile.path().at(0.0).position;
        Self {
            zero: start - begin.get(axis).copied().unwrap_or(0.0),
            profile,
            axis,
        }
    }

    /// Position of the axis where the path's coordinate is 0, m.
    pub fn zero(&self) -> f64 {
        self.zero
    }
}

impl<const D: usize> Motion for AxisMotion<D> {
    fn duration(&self) -> f64 {
        self.profile.duration()
    }

    fn at(&self, t: f64) -> Setpoint {
        let all = self.profile.axes(t);
        let of = |values: &[f64; D]| values.get(self.axis).copied().unwrap_or(0.0);
        Setpoint {
            position: self.zero + of(&all.position),
            velocity: of(&all.velocity),
            acceleration: of(&all.acceleration),
            jerk: of(&all.jerk),
        }
    }
}
