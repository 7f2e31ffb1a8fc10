//! The smooth rise and fall of an oscillation's amplitude.

use axis_scalar::Scalar;

/// Greatest |w'|, |w''|, |w'''| and |w''''| of [`rise`] over 0 ≤ x ≤ 1.
pub(crate) const RISE_DERIVATIVE_BOUNDS: [f64; 4] = [1.875, 5.773_502_691_896_258, 60.0, 360.0];

/// `w(x) = x³ (10 − 15 x + 6 x²)` and its first three derivatives, for 0 ≤ x ≤ 1.
///
/// The lowest polynomial that goes from 0 to 1 with w' = w'' = 0 at both ends, so that whatever
/// it multiplies starts and stops with continuous position, velocity and acceleration.
#[inline]
pub(crate) fn rise<T: Scalar>(x: T) -> [T; 4] {
    let rest = T::ONE - x;
    // Rounding must not carry the amplitude past its full value.
    let factor = x * x * x * (T::of(10.0) - x * (T::of(15.0) - T::of(6.0) * x));
    [
        clamp(factor, T::ZERO, T::ONE),
        T::of(30.0) * x * x * rest * rest,
        T::of(60.0) * x * rest * (T::ONE - T::TWO * x),
        T::of(60.0) - T::of(360.0) * x * rest,
    ]
}

/// `x` between `low` and `high`; NaN stays.
#[inline]
fn clamp<T: Scalar>(x: T, low: T, high: T) -> T {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}

/// Amplitude factor over time: rises over `ramp`, holds 1, falls over `ramp` to `duration`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Envelope<T> {
    /// Whole length, s, at least twice the ramp.
    pub duration: T,
    /// Length of the rise and of the fall, s, greater than zero.
    pub ramp: T,
}

impl<T: Scalar> Envelope<T> {
    /// The factor and its first three time derivatives at `t` in `[0, duration]`.
    #[inline]
    pub fn at(&self, t: T) -> [T; 4] {
        let left = self.duration - t;
        if left <= self.ramp {
            let [w, w1, w2, w3] = self.in_time(rise(left / self.ramp));
            [w, -w1, w2, -w3]
        } else if t < self.ramp {
            self.in_time(rise(t / self.ramp))
        } else {
            [T::ONE, T::ZERO, T::ZERO, T::ZERO]
        }
    }

    /// Derivatives with respect to x turned into derivatives with respect to time.
    #[inline]
    pub fn in_time(&self, [w, w1, w2, w3]: [T; 4]) -> [T; 4] {
        let r = T::ONE / self.ramp;
        [w, w1 * r, w2 * r * r, w3 * r * r * r]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn derivative_bounds_are_the_suprema() {
        let mut seen = [0.0f64; 3];
        for i in 0..=100_000 {
            let w = rise(f64::from(i) * 1e-5);
            for (s, d) in seen.iter_mut().zip(&w[1..]) {
                *s = s.max(d.abs());
            }
        }
        for (s, bound) in seen.iter().zip(RISE_DERIVATIVE_BOUNDS) {
            // 1e-12: rounding only. 1e-9: the grid of 1e-5 misses a smooth peak by its square.
            assert!(*s <= bound * (1.0 + 1e-12));
            assert_relative_eq!(*s, bound, max_relative = 1e-9);
        }
    }

    #[test]
    fn ends_are_smooth() {
        assert_eq!(rise(0.0_f64)[..3], [0.0, 0.0, 0.0]);
        assert_eq!(rise(1.0_f64)[..3], [1.0, 0.0, 0.0]);
    }
}
