//! The smooth rise and fall of an oscillation's amplitude.

/// Greatest |w'|, |w''|, |w'''| and |w''''| of [`rise`] over 0 ≤ x ≤ 1.
pub(crate) const RISE_DERIVATIVE_BOUNDS: [f64; 4] = [1.875, 5.773_502_691_896_258, 60.0, 360.0];

/// `w(x) = x³ (10 − 15 x + 6 x²)` and its first three derivatives, for 0 ≤ x ≤ 1.
///
/// The lowest polynomial that goes from 0 to 1 with w' = w'' = 0 at both ends, so that whatever
/// it multiplies starts and stops with continuous position, velocity and acceleration.
#[inline]
pub(crate) fn rise(x: f64) -> [f64; 4] {
    let rest = 1.0 - x;
    [
        // Rounding must not carry the amplitude past its full value.
        (x * x * x * (10.0 - x * (15.0 - 6.0 * x))).clamp(0.0, 1.0),
        30.0 * x * x * rest * rest,
        60.0 * x * rest * (1.0 - 2.0 * x),
        60.0 - 360.0 * x * rest,
    ]
}

/// Amplitude factor over time: rises over `ramp`, holds 1, falls over `ramp` to `duration`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Envelope {
    /// Whole length, s, at least twice the ramp.
    pub duration: f64,
    /// Length of the rise and of the fall, s, greater than zero.
    pub ramp: f64,
}

impl Envelope {
    /// The factor and its first three time derivatives at `t` in `[0, duration]`.
    #[inline]
    pub fn at(&self, t: f64) -> [f64; 4] {
        let left = self.duration - t;
        if left <= self.ramp {
            let [w, w1, w2, w3] = self.in_time(rise(left / self.ramp));
            [w, -w1, w2, -w3]
        } else if t < self.ramp {
            self.in_time(rise(t / self.ramp))
        } else {
            [1.0, 0.0, 0.0, 0.0]
        }
    }

    /// Derivatives with respect to x turned into derivatives with respect to time.
    #[inline]
    pub fn in_time(&self, [w, w1, w2, w3]: [f64; 4]) -> [f64; 4] {
        let r = 1.0 / self.ramp;
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
        assert_eq!(rise(0.0)[..3], [0.0, 0.0, 0.0]);
        assert_eq!(rise(1.0)[..3], [1.0, 0.0, 0.0]);
    }
}
