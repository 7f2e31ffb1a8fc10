//! What motions need of their scalar beyond arithmetic.

use axis_scalar::Scalar;

/// A scalar that motions can be planned and sampled in: `f64` or `f32`.
pub trait Real: Scalar {
    /// Most cycles of one sine or chirp. Above, the phase has lost a millionth of a cycle to
    /// rounding, in `f32` a thousandth.
    const MAX_CYCLES: Self;

    /// [`MAX_CYCLES`](Self::MAX_CYCLES) for the error of an oscillation with more.
    const VALID_CYCLES: &'static str;

    /// By which fraction an oscillation's bounds lie above its exact ones, for what its evaluation
    /// rounds.
    const BOUND_MARGIN: Self;

    /// Which fraction of a motion's own distances and velocities counts as rounding at its end, when a motion is planned
    /// anew from a state on it: some hundred times what one evaluation rounds, in `f32` some times.
    const END_MARGIN: Self;

    /// Whether `0 ≤ self < end`, for an `end` that is not negative; false for NaN and for a zero
    /// with its sign set.
    ///
    /// The bits of numbers that are not negative order as the numbers do; a sign bit or NaN makes
    /// them greater than any number. So it is one comparison of integers.
    #[must_use]
    fn is_before(self, end: Self) -> bool;

    /// The number of so many.
    #[must_use]
    fn count(number: u32) -> Self;

    /// Sine and cosine of 2π times a number from 0 to 1.
    #[must_use]
    fn sin_cos_turn(self) -> (Self, Self);
}

macro_rules! real {
    ($t:ident, $turn:path, $cycles:literal, $margin:literal, $end:literal) => {
        impl Real for $t {
            const MAX_CYCLES: Self = $cycles;
            const VALID_CYCLES: &'static str = concat!("at most ", stringify!($cycles));
            const BOUND_MARGIN: Self = $margin;
            const END_MARGIN: Self = $end;

            #[inline(always)]
            fn is_before(self, end: Self) -> bool {
                self.to_bits() < end.to_bits()
            }

            #[inline(always)]
            fn count(number: u32) -> Self {
                number as $t
            }

            #[inline]
            fn sin_cos_turn(self) -> (Self, Self) {
                $turn(self)
            }
        }
    };
}

real!(f64, turn_f64, 1e9, 1e-12, 1e-13);
// libm's sincosf computes in f64, which a controller does in software.
real!(f32, turn_f32, 1e4, 1e-5, 5e-7);

#[inline]
fn turn_f64(x: f64) -> (f64, f64) {
    libm::sincos(core::f64::consts::TAU * x)
}

/// The quarter turn is taken off exactly; for the rest, up to π/4, the polynomials of S. L. Moshier's
/// Cephes library (sinf.c, 1992). Within 9.1e-8.
#[inline]
fn turn_f32(x: f32) -> (f32, f32) {
    let quarters = (4.0 * x + 0.5) as u32; // cuts: the nearest whole number
    let y = core::f32::consts::TAU * (x - 0.25 * quarters as f32);
    let z = y * y;
    let sin = ((-1.951_529_6e-4 * z + 8.332_161e-3) * z - 1.666_665_5e-1) * z * y + y;
    let cos =
        ((2.443_315_8e-5 * z - 1.388_731_6e-3) * z + 4.166_664_6e-2) * (z * z) - 0.5 * z + 1.0;
    match quarters & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_of_single_precision_are_those_of_double() {
        let mut worst = 0.0_f64;
        for i in 0..=1_000_000_u32 {
            let x = i as f32 * 1e-6;
            let (a, b) = (x.sin_cos_turn(), f64::from(x).sin_cos_turn());
            let off = (f64::from(a.0) - b.0)
                .abs()
                .max((f64::from(a.1) - b.1).abs());
            worst = worst.max(off);
        }
        assert!(worst < 1.5e-7, "{worst:e}");
        assert_eq!(0.0_f32.sin_cos_turn(), (0.0, 1.0));
        assert_eq!(0.25_f32.sin_cos_turn(), (1.0, 0.0));
        assert!(f32::NAN.sin_cos_turn().0.is_nan());
    }
}
