//! One step of the bristle state: an exponential integrator.

use crate::exponential::{mean_decay, one_minus_exp};
use crate::law::LuGre;

impl LuGre {
    /// The deflection after a step of `h` seconds (`h ≥ 0`) in which the speed
    /// goes linearly from `w0` to `w1` (rad/s), from the deflection `z0` (rad).
    ///
    /// With the speed held at its mean, equation (1) has the solution
    ///
    /// ```text
    /// z1 = z0 + (z_ss − z0) (1 − e^{−a}),   a = σ0 |ω| h / G,   z_ss = G sign ω / σ0
    /// ```
    ///
    /// which is exact for a constant speed, however stiff, and second order in
    /// `h` otherwise. Where the speed changes sign, |ω| has a kink: the step is
    /// split there, and both parts stay second order.
    ///
    /// The result lies between `z0` and `z_ss` (when split: twice), so
    /// `|z1| ≤ max(|z0|, T_S/σ0)`, exactly and in floating point.
    #[must_use]
    #[inline]
    pub fn step(&self, z0: f64, w0: f64, w1: f64, h: f64) -> f64 {
        if w0 * w1 >= 0.0 {
            self.relax(z0, 0.5 * (w0 + w1), h)
        } else {
            self.step_across(z0, w0, w1, h)
        }
    }

    /// [`step`](Self::step) through zero speed. Rare, so kept out of the way of
    /// the inlined one.
    #[cold]
    fn step_across(&self, z0: f64, w0: f64, w1: f64, h: f64) -> f64 {
        let before = h * crossing(w0, w1);
        let z = self.relax(z0, 0.5 * w0, before);
        self.relax(z, 0.5 * w1, h - before)
    }

    /// [`step`](Self::step), and the friction torque (N·m) at its end, with
    /// the speed `w1`: `(z1, T_f)`.
    #[must_use]
    #[inline]
    pub fn step_torque(&self, z0: f64, w0: f64, w1: f64, h: f64) -> (f64, f64) {
        let z1 = self.step(z0, w0, w1, h);
        (z1, self.torque(z1, w1))
    }

    /// [`step`](Self::step), and the friction's angular impulse
    /// `∫ T_f dt` (N·m·s) over it: `(z1, impulse)`.
    ///
    /// The impulse belongs to the same solution as `z1`: exact for a constant
    /// speed, so that momentum and work balance in steps longer than the
    /// relaxation time too, where the end torque stands for nothing.
    #[must_use]
    #[inline]
    pub fn step_impulse(&self, z0: f64, w0: f64, w1: f64, h: f64) -> (f64, f64) {
        let (z1, area) = if w0 * w1 >= 0.0 {
            self.relax_area(z0, 0.5 * (w0 + w1), h)
        } else {
            let before = h * crossing(w0, w1);
            let (z, first) = self.relax_area(z0, 0.5 * w0, before);
            let (z1, second) = self.relax_area(z, 0.5 * w1, h - before);
            (z1, first + second)
        };
        let p = self.parameters();
        // The integral of equation (3); σ1 dz/dt integrates to σ1 (z1 − z0).
        let damping = if self.bristle_stiffness() == 0.0 {
            0.0
        } else {
            p.damping * (z1 - z0)
        };
        let impulse = self.bristle_stiffness() * area + damping + p.viscous * (0.5 * (w0 + w1) * h);
        (z1, impulse)
    }

    /// Exact solution of equation (1) over `h` at a constant speed.
    #[inline(always)]
    fn relax(&self, z0: f64, speed: f64, h: f64) -> f64 {
        let (bristle, decay) = self.curve(speed.abs());
        let target = bristle.copysign(speed);
        let z1 = z0 + (target - z0) * one_minus_exp(decay * speed.abs() * h);
        hold(z1, z0, bristle)
    }

    /// [`relax`](Self::relax) and `∫ z dt` (rad·s) of the same solution.
    #[inline(always)]
    fn relax_area(&self, z0: f64, speed: f64, h: f64) -> (f64, f64) {
        let (bristle, decay) = self.curve(speed.abs());
        let target = bristle.copysign(speed);
        let a = decay * speed.abs() * h;
        let z1 = z0 + (target - z0) * one_minus_exp(a);
        let area = h * (target + (z0 - target) * mean_decay(a));
        (hold(z1, z0, bristle), area)
    }
}

/// The fraction of the step after which a speed of changing sign is zero.
#[inline]
fn crossing(w0: f64, w1: f64) -> f64 {
    w0 / (w0 - w1)
}

/// Takes back the last-bit overshoot that rounding may leave. Comparisons, not
/// `max` and `clamp`, so that NaN passes through and a diverged plant is
/// noticed.
#[inline]
fn hold(z1: f64, z0: f64, bristle: f64) -> f64 {
    let limit = if bristle > z0.abs() {
        bristle
    } else {
        z0.abs()
    };
    if z1.abs() > limit {
        limit.copysign(z1)
    } else {
        z1
    }
}
