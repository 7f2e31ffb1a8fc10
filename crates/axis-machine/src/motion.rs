//! One axis' part of a motion along a path.

use std::sync::Arc;

use toolpath::{AxesPoint, FeedProfile};
use trajectories::{Motion, Setpoint};

use crate::coupling::Coupling;

/// Half of the time over which the accelerations of a corrected cross-talk are averaged, s.
///
/// A feed of limited jerk has jumps of jerk, so that k a(t) has jumps of speed, which no axis can follow. The mean of a over
/// [t − h, t + h], (v(t + h) − v(t − h))/2h, has none, and its derivatives are as simple. A motion that repeats at ω loses
/// (ω h)²/6 of its correction: 2 % at 10 Hz, 10⁻⁶ on a circle of 50 mm at 3 m/min.
pub(crate) const HALF_WINDOW: f64 = 5e-3;

/// What one axis has to do along a path: it begins where that axis' motions begin, and goes on as the path's coordinate
/// does; on request less what other axes will do to the tool's position along it.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisMotion<const D: usize> {
    profile: Arc<FeedProfile<D>>,
    axis: usize,
    /// Position of the axis where the path's coordinate is 0, m.
    zero: f64,
    correction: Option<Correction<D>>,
    /// By which the motion begins later than the profile, and ends, s.
    delay: f64,
}

#[derive(Clone, Debug, PartialEq)]
struct Correction<const D: usize> {
    coupling: Arc<Coupling>,
    /// Positions of all axes where the path's coordinates are 0, m.
    zeros: [f64; D],
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
            correction: None,
            delay: 0.0,
        }
    }

    /// The same motion less what `coupling` will do to the tool's position along the axis: x_ref − φ y − w(y) − k a_y.
    /// `zeros` are the positions (m) of all axes where the path's coordinates are 0.
    ///
    /// What the corrections of other axes add to that, squares of φ and k, is left out. Where the coupling has a
    /// cross-talk, the motion begins and ends 5 ms later than the profile ([`AxisMotion::delay`]).
    #[must_use]
    pub fn correcting(self, coupling: Arc<Coupling>, zeros: [f64; D]) -> Self {
        let delay = if coupling.has_crosstalk() {
            HALF_WINDOW
        } else {
            0.0
        };
        Self {
            correction: Some(Correction { coupling, zeros }),
            delay,
            ..self
        }
    }

    /// Position of the axis where the path's coordinate is 0, m.
    pub fn zero(&self) -> f64 {
        self.zero
    }

    /// By which the motion begins and ends later than the profile, s.
    pub fn delay(&self) -> f64 {
        self.delay
    }

    pub(crate) fn profile(&self) -> &Arc<FeedProfile<D>> {
        &self.profile
    }

    /// What is taken off at time `t` of the profile, and its derivatives.
    fn taken_off(&self, correction: &Correction<D>, now: &AxesPoint<D>, t: f64) -> Setpoint {
        let mut sum = Setpoint::default();
        let mut ends = None;
        for pair in correction.coupling.of(self.axis).filter(|pair| pair.by < D) {
            let (q, v) = (now.position[pair.by], now.velocity[pair.by]);
            let (a, j) = (now.acceleration[pair.by], now.jerk[pair.by]);
            sum.position += pair.squareness * q;
            sum.velocity += pair.squareness * v;
            sum.acceleration += pair.squareness * a;
            sum.jerk += pair.squareness * j;
            if let Some(table) = &pair.straightness {
                let [w, w1, w2, w3] = table.at(correction.zeros[pair.by] + q);
                sum.position += w;
                sum.velocity += w1 * v;
                sum.acceleration += w2 * v * v + w1 * a;
                sum.jerk += w3 * v * v * v + 3.0 * w2 * v * a + w1 * j;
            }
            if pair.crosstalk != 0.0 {
                let [before, after] = *ends.get_or_insert_with(|| {
                    [t - HALF_WINDOW, t + HALF_WINDOW].map(|t| self.profile.axes(t))
                });
                let per = pair.crosstalk / (2.0 * HALF_WINDOW);
                let i = pair.by;
                sum.position += per * (after.velocity[i] - before.velocity[i]);
                sum.velocity += per * (after.acceleration[i] - before.acceleration[i]);
                sum.acceleration += per * (after.jerk[i] - before.jerk[i]);
            }
        }
        sum
    }
}

impl<const D: usize> Motion for AxisMotion<D> {
    fn duration(&self) -> f64 {
        self.profile.duration() + 2.0 * self.delay
    }

    fn at(&self, t: f64) -> Setpoint {
        let t = t - self.delay;
        let all = self.profile.axes(t);
        let of = |values: &[f64; D]| values.get(self.axis).copied().unwrap_or(0.0);
        let wanted = Setpoint {
            position: self.zero + of(&all.position),
            velocity: of(&all.velocity),
            acceleration: of(&all.acceleration),
            jerk: of(&all.jerk),
        };
        let Some(correction) = &self.correction else {
            return wanted;
        };
        let off = self.taken_off(correction, &all, t);
        Setpoint {
            position: wanted.position - off.position,
            velocity: wanted.velocity - off.velocity,
            acceleration: wanted.acceleration - off.acceleration,
            jerk: wanted.jerk - off.jerk,
        }
    }
}
