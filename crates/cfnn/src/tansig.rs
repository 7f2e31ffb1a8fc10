//! Hyperbolic tangent without branches, so that the compiler vectorises it on
//! any target (SSE2 on plain x86-64).
//!
//! With `|x| = y + k ln2 / 2`, `k` an integer and `|y| <= ln2 / 4`, and the
//! rational approximation `tanh y = y P(y²) / Q(y²)` (a convergent of
//! Lambert's continued fraction), `e^{2y} = (Q + yP) / (Q - yP)` gives
//!
//! ```text
//! tanh|x| = (2^k e^{2y} - 1) / (2^k e^{2y} + 1)
//!         = ((2^k - 1) Q + (2^k + 1) yP) / ((2^k + 1) Q + (2^k - 1) yP)
//! ```
//!
//! For `k = 0` the quotient is `yP / Q` itself, so the relative accuracy holds
//! down to the smallest arguments; for `k > 0` nothing cancels badly. One
//! division, about thirty operations.

/// `tanh(x)` in double precision.
///
/// The truncation error of the convergent `y (10395 + 1260 y² + 21 y⁴) /
/// (10395 + 4725 y² + 210 y⁴ + y⁶)` is below `5e-19` relative at
/// `y = ln2 / 4`; what remains is rounding.
#[inline(always)]
pub(crate) fn tansig_f64(x: f64) -> f64 {
    // 1.5 * 2^52: adding it leaves the rounded integer in the lowest bits.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    const TWO_OVER_LN2: f64 = 2.0 * core::f64::consts::LOG2_E;
    // ln2 / 2 in two parts; the first has 33 significant bits, so that its
    // product with k is exact.
    const HALF_LN2_HIGH: f64 = 0.5 * 6.931_471_803_691_238e-1;
    const HALF_LN2_LOW: f64 = 0.5 * 1.908_214_929_270_587_7e-10;
    // Beyond this tanh rounds to 1. The comparison lets NaN through.
    const SATURATED: f64 = 19.25;

    let magnitude = x.abs();
    let a = if SATURATED < magnitude {
        SATURATED
    } else {
        magnitude
    };
    let shifted = a * TWO_OVER_LN2 + SHIFT;
    let k = shifted - SHIFT;
    let power = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    let y = (a - k * HALF_LN2_HIGH) - k * HALF_LN2_LOW;
    let s = y * y;
    let yp = y * (10395.0 + s * (1260.0 + s * 21.0));
    let q = 10395.0 + s * (4725.0 + s * (210.0 + s));
    let less = power - 1.0;
    let more = power + 1.0;
    let value = (less * q + more * yp) / (more * q + less * yp);
    // Rounding may carry the quotient one unit past 1.
    let value = if 1.0 < value { 1.0 } else { value };
    value.copysign(x)
}

/// `tanh(x)` in single precision: the same construction with the convergent
/// `y (105 + 10 y²) / (105 + 45 y² + y⁴)`, truncation below `1e-11` relative.
#[inline(always)]
pub(crate) fn tansig_f32(x: f32) -> f32 {
    const SHIFT: f32 = 12_582_912.0;
    const TWO_OVER_LN2: f32 = 2.0 * core::f32::consts::LOG2_E;
    const HALF_LN2_HIGH: f32 = 0.5 * 0.693_138_1;
    const HALF_LN2_LOW: f32 = 0.5 * 9.058_001e-6;
    const SATURATED: f32 = 9.25;

    let magnitude = x.abs();
    let a = if SATURATED < magnitude {
        SATURATED
    } else {
        magnitude
    };
    let shifted = a * TWO_OVER_LN2 + SHIFT;
    let k = shifted - SHIFT;
    let power = f32::from_bits(shifted.to_bits().wrapping_add(127) << 23);
    let y = (a - k * HALF_LN2_HIGH) - k * HALF_LN2_LOW;
    let s = y * y;
    let yp = y * (105.0 + s * 10.0);
    let q = 105.0 + s * (45.0 + s);
    let less = power - 1.0;
    let more = power + 1.0;
    let value = (less * q + more * yp) / (more * q + less * yp);
    let value = if 1.0 < value { 1.0 } else { value };
    value.copysign(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::println;

    fn ulps(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    /// Eight units in the last place: four roundings on each side of the
    /// division, and libm's own error of about one unit.
    #[test]
    fn agrees_with_libm_densely() {
        let mut worst = 0;
        for i in 0..=4_000_000_u32 {
            let x = f64::from(i) * 5.5e-6;
            worst = worst.max(ulps(tansig_f64(x), libm::tanh(x)));
            assert_eq!(tansig_f64(-x), -tansig_f64(x));
            assert!(tansig_f64(x) <= 1.0);
        }
        for exponent in -300..1 {
            let x = 10f64.powi(exponent) * 0.987;
            worst = worst.max(ulps(tansig_f64(x), libm::tanh(x)));
        }
        println!("worst deviation {worst} ulp");
        assert!(worst <= 8, "{worst} ulp");
    }

    #[test]
    fn single_precision_agrees_with_double() {
        let mut worst = 0;
        for i in 0..=2_000_000_u32 {
            let x = i as f32 * 5.5e-6;
            let reference = libm::tanh(f64::from(x)) as f32;
            worst = worst.max(tansig_f32(x).to_bits().abs_diff(reference.to_bits()));
            assert!(tansig_f32(x) <= 1.0);
        }
        println!("worst deviation {worst} ulp");
        assert!(worst <= 8, "{worst} ulp");
    }

    #[test]
    fn limits_and_nan() {
        assert_eq!(tansig_f64(f64::INFINITY), 1.0);
        assert_eq!(tansig_f64(f64::NEG_INFINITY), -1.0);
        assert_eq!(tansig_f64(0.0).to_bits(), 0.0f64.to_bits());
        assert_eq!(tansig_f64(-0.0).to_bits(), (-0.0f64).to_bits());
        assert!(tansig_f64(f64::NAN).is_nan());
        assert!(tansig_f32(f32::NAN).is_nan());
        assert_eq!(tansig_f32(f32::NEG_INFINITY), -1.0);
        assert_eq!(tansig_f64(f64::MIN_POSITIVE), f64::MIN_POSITIVE);
    }
}
