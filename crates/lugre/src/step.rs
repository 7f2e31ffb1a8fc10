//! One step of the bristle state: an exponential integrator.

use crate::exponential::Exponential;
use crate::law::LuGre;

impl<T: Exponential> LuGre<T> {
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
    #[inline(always)] // a call made a step 6 to 8 % slower
    pub fn step(&self, z0: T, w0: T, w1: T, h: T) -> T {
        if w0 * w1 >= T::ZERO {
            self.relax(z0, T::HALF * (w0 + w1), h)
        } else {
            self.step_across(z0, w0, w1, h)
        }
    }

    /// [`step`](Self::step) through zero speed. Rare, so kept out of the way of
    /// the inlined one.
    #[cold]
    #[inline(never)]
    fn step_across(&self, z0: T, w0: T, w1: T, h: T) -> T {
        let before = h * crossing(w0, w1);
        let z = self.relax(z0, T::HALF * w0, before);
        self.relax(z, T::HALF * w1, h - before)
    }

    /// [`step`](Self::step), and the friction torque (N·m) at its end, with
    /// the speed `w1`: `(z1, T_f)`.
    #[must_use]
    #[inline]
    pub fn step_torque(&self, z0: T, w0: T, w1: T, h: T) -> (T, T) {
        let z1 = self.step(z0, w0, w1, h);
        (z1, self.torque(z1, w1))
    }

    /// The most by which the torque of [`step_torque`](Self::step_torque) changes
    /// with `w1`, N·m·s/rad, in a step of `h` seconds from any speed and any `z0`
    /// within [`bristle_limit`](Self::bristle_limit):
    ///
    /// ```text
    /// σ2 + (2 σ0 h + 3 σ1) D Q,   D = 1 + T_S/T_C,   Q = 1 + (2/e) (T_S/T_C − 1)
    /// ```
    ///
    /// A bound, not the steepest slope: D is the greatest distance of the bristles
    /// from where they tend, in units of that, and Q what G(ω) adds, as
    /// `|ω G'(ω)| ≤ (2/e) (T_S − T_C)`. Of the damping, `|ω| dz1/dω` is what has to be
    /// bounded: bristles forget the start of a step as `e^{−a}`, and `a e^{−a} ≤ 1/e`.
    #[must_use]
    pub fn steepness(&self, h: T) -> T {
        let p = self.parameters();
        if h.is_nan() {
            return h;
        }
        if self.bristle_stiffness() == T::ZERO {
            return p.viscous;
        }
        let rise = p.stiction / p.coulomb - T::ONE;
        let distance = T::TWO + rise;
        let falling = T::ONE + T::of(0.736) * rise;
        let bristles = T::TWO * p.stiffness * h + T::of(3.0) * p.damping;
        p.viscous + bristles * distance * falling
    }

    /// [`step`](Self::step), and the friction's angular impulse
    /// `∫ T_f dt` (N·m·s) over it: `(z1, impulse)`.
    ///
    /// The impulse belongs to the same solution as `z1`: exact for a constant
    /// speed, so that momentum and work balance in steps longer than the
    /// relaxation time too, in which the torque at the end is not that of the step.
    #[must_use]
    #[inline]
    pub fn step_impulse(&self, z0: T, w0: T, w1: T, h: T) -> (T, T) {
        let (z1, area) = if w0 * w1 >= T::ZERO {
            self.relax_area(z0, T::HALF * (w0 + w1), h)
        } else {
            let before = h * crossing(w0, w1);
            let (z, first) = self.relax_area(z0, T::HALF * w0, before);
            let (z1, second) = self.relax_area(z, T::HALF * w1, h - before);
            (z1, first + second)
        };
        let p = self.parameters();
        // The integral of equation (3); σ1 dz/dt integrates to σ1 (z1 − z0).
        let damping = if self.bristle_stiffness() == T::ZERO {
            T::ZERO
        } else {
            p.damping * (z1 - z0)
        };
        let impulse =
            self.bristle_stiffness() * area + damping + p.viscous * (T::HALF * (w0 + w1) * h);
        (z1, impulse)
    }

    /// Exact solution of equation (1) over `h` at a constant speed.
    #[inline(always)]
    fn relax(&self, z0: T, speed: T, h: T) -> T {
        let (bristle, decay) = self.curve(speed.abs());
        let target = bristle.copysign(speed);
        let z1 = z0 + (target - z0) * (decay * speed.abs() * h).one_minus_exp();
        hold(z1, z0, bristle)
    }

    /// [`relax`](Self::relax) and `∫ z dt` (rad·s) of the same solution.
    #[inline(always)]
    fn relax_area(&self, z0: T, speed: T, h: T) -> (T, T) {
        let (bristle, decay) = self.curve(speed.abs());
        let target = bristle.copysign(speed);
        let a = decay * speed.abs() * h;
        let z1 = z0 + (target - z0) * a.one_minus_exp();
        let area = h * (target + (z0 - target) * a.mean_decay());
        (hold(z1, z0, bristle), area)
    }
}

/// The fraction of the step after which a speed of changing sign is zero.
#[inline]
fn crossing<T: Exponential>(w0: T, w1: T) -> T {
    w0 / (w0 - w1)
}

/// Takes back the last-bit overshoot that rounding may leave. Comparisons, not
/// `max` and `clamp`, so that NaN passes through and a diverged plant is
/// noticed.
#[inline]
fn hold<T: Exponential>(z1: T, z0: T, bristle: T) -> T {
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
