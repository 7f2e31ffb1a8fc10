//! Hyperbolic tangent without branches, so that the compiler vectorises it on
//! any target (SSE2 on plain x86-64).
//!
//! With `|x| = (k + f) ln2 / 2`, `k` an integer and `|f| <= 1/2`, and a
//! rational approximation `tanh(f ln2 / 2) = f P(f²) / Q(f²)`, the exponential
//! `2^f = (Q + fP) / (Q - fP)` gives
//!
//! ```text
//! tanh|x| = (2^k 2^f - 1) / (2^k 2^f + 1)
//!         = ((2^k - 1) Q + (2^k + 1) fP) / ((2^k + 1) Q + (2^k - 1) fP)
//! ```
//!
//! For `k = 0` the quotient is `fP / Q` itself, so the relative accuracy holds
//! down to the smallest arguments; for `k > 0` nothing cancels badly, and the
//! rounding of `k + f` weighs less than it does for `k = 0`, since tanh grows
//! more slowly than its argument. One division, about thirty operations.
//!
//! The coefficients are minimax ones for the relative error on `f² <= 1/4`
//! (Remez's exchange in 50 digits), scaled so that the first of `P` is 1:
//! `python3 crates/cfnn/tests/golden/tansig_minimax.py` finds them and judges
//! those used here. Before rounding they are good to `4.8e-18` relative, as
//! doubles to `1.1e-16`, about half a unit in the last place.

use core::array::from_fn;

/// `tanh` of each element in double precision. Step by step over all elements,
/// so that each step becomes whole vectors.
#[inline(always)]
pub(crate) fn tansig_f64<const C: usize>(x: [f64; C]) -> [f64; C] {
    // 1.5 * 2^52: adding it leaves the rounded integer in the lowest bits.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    const TWO_OVER_LN2: f64 = 2.0 * core::f64::consts::LOG2_E;
    // Beyond this tanh rounds to 1. The comparison lets NaN through.
    const SATURATED: f64 = 19.25;

    let t: [f64; C] = from_fn(|c| {
        let magnitude = x[c].abs();
        let a = if SATURATED < magnitude {
            SATURATED
        } else {
            magnitude
        };
        a * TWO_OVER_LN2
    });
    let shifted: [f64; C] = from_fn(|c| t[c] + SHIFT);
    let f: [f64; C] = from_fn(|c| t[c] - (shifted[c] - SHIFT));
    let power: [f64; C] =
        from_fn(|c| f64::from_bits(shifted[c].to_bits().wrapping_add(1023) << 52));
    let s: [f64; C] = from_fn(|c| f[c] * f[c]);
    let fp: [f64; C] =
        from_fn(|c| f[c] * ((s[c] + 874.742_790_105_166_1) * s[c] + 65_550.947_589_861_83));
    let q: [f64; C] = from_fn(|c| {
        (43.300_524_565_223_355 * s[c] + 10_096.716_588_166_924) * s[c] + 189_140.054_026_932
    });
    let less: [f64; C] = from_fn(|c| power[c] - 1.0);
    let more: [f64; C] = from_fn(|c| power[c] + 1.0);
    let above: [f64; C] = from_fn(|c| less[c] * q[c] + more[c] * fp[c]);
    let below: [f64; C] = from_fn(|c| more[c] * q[c] + less[c] * fp[c]);
    from_fn(|c| {
        let value = above[c] / below[c];
        // Rounding may carry the quotient one unit past 1.
        let value = if 1.0 < value { 1.0 } else { value };
        value.copysign(x[c])
    })
}

/// `tanh` of each element in single precision: the same with an approximation
/// good to `5.3e-10` relative before its coefficients are rounded, to `4.7e-9`
/// after.
#[inline(always)]
pub(crate) fn tansig_f32<const C: usize>(x: [f32; C]) -> [f32; C] {
    // 1.5 * 2^23: adding it leaves the rounded integer in the lowest bits.
    const SHIFT: f32 = 12_582_912.0;
    const TWO_OVER_LN2: f32 = 2.0 * core::f32::consts::LOG2_E;
    // Beyond this tanh rounds to 1. The comparison lets NaN through.
    const SATURATED: f32 = 9.25;

    let t: [f32; C] = from_fn(|c| {
        let magnitude = x[c].abs();
        let a = if SATURATED < magnitude {
            SATURATED
        } else {
            magnitude
        };
        a * TWO_OVER_LN2
    });
    let shifted: [f32; C] = from_fn(|c| t[c] + SHIFT);
    let f: [f32; C] = from_fn(|c| t[c] - (shifted[c] - SHIFT));
    let power: [f32; C] = from_fn(|c| f32::from_bits(shifted[c].to_bits().wrapping_add(127) << 23));
    let s: [f32; C] = from_fn(|c| f[c] * f[c]);
    let fp: [f32; C] = from_fn(|c| f[c] * (s[c] + 125.042_73));
    let q: [f32; C] = from_fn(|c| 17.330_88 * s[c] + 360.797_06);
    let less: [f32; C] = from_fn(|c| power[c] - 1.0);
    let more: [f32; C] = from_fn(|c| power[c] + 1.0);
    let above: [f32; C] = from_fn(|c| less[c] * q[c] + more[c] * fp[c]);
    let below: [f32; C] = from_fn(|c| more[c] * q[c] + less[c] * fp[c]);
    from_fn(|c| {
        let value = above[c] / below[c];
        // Rounding may carry the quotient one unit past 1.
        let value = if 1.0 < value { 1.0 } else { value };
        value.copysign(x[c])
    })
}

#[cfg(test)]
mod tests {
    use std::println;

    fn tansig_f64(x: f64) -> f64 {
        super::tansig_f64([x])[0]
    }

    fn tansig_f32(x: f32) -> f32 {
        super::tansig_f32([x])[0]
    }

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
        let smallest = f64::MIN_POSITIVE;
        assert!(ulps(tansig_f64(smallest), smallest) <= 8);
    }
}
