//! The functions against those of the standard library in `f64`: another code, and for
//! an `f32` one whose rounding does not count.

use super::*;
use proptest::prelude::*;

/// |single − truth| in units of ε and of the truth, or of the least normal number.
fn units(single: f32, truth: f64) -> f64 {
    let scale = truth.abs().max(f64::from(f32::MIN_POSITIVE));
    (f64::from(single) - truth).abs() / (f64::from(f32::EPSILON) * scale)
}

/// That the functions of `x` are those of the same `f64`. The bounds are the errors on
/// the crate's page, which are of 1.1e8 numbers from all over the range.
fn compare(x: f32) -> Result<(), TestCaseError> {
    let wide = f64::from(x);
    let within = |name: &str, single: f32, truth: f64, most: f64| {
        // Beyond the range it is infinite, and what rounds to that may be.
        let large = truth.abs() > f64::from(f32::MAX);
        let good = units(single, truth) <= most || (large && single.is_infinite());
        prop_assert!(good, "{name} of {x:e} is {single:e}, not {truth:e}");
        Ok(())
    };
    let (sin, cos) = Scalar::sin_cos(x);
    within("sin", sin, wide.sin(), 1.05)?;
    within("cos", cos, wide.cos(), 1.05)?;
    within("cbrt", Scalar::cbrt(x), wide.cbrt(), 0.51)?;
    within("exp", Scalar::exp(x), wide.exp(), 0.65)?;
    within("exp_m1", Scalar::exp_m1(x), wide.exp_m1(), 0.7)?;
    within("tanh", Scalar::tanh(x), wide.tanh(), 1.4)?;
    within("sqrt", Scalar::sqrt(x.abs()), wide.abs().sqrt(), 0.5)?;
    if x != 0.0 {
        within("ln", Scalar::ln(x.abs()), wide.abs().ln(), 0.7)?;
    }
    if x > -1.0 {
        within("ln_1p", Scalar::ln_1p(x), wide.ln_1p(), 1.0)?;
    }
    for other in [x, 1.0, 0.75 * x, -1e-3 * x, 1e19] {
        let truth = wide.hypot(f64::from(other));
        within("hypot", Scalar::hypot(x, other), truth, HYPOT)?;
    }
    prop_assert_eq!(f64::from(Scalar::floor(x)), wide.floor());
    prop_assert_eq!(f64::from(Scalar::ceil(x)), wide.ceil());
    prop_assert_eq!(f32::of(wide), x);
    prop_assert_eq!(x.to_f64(), wide);
    Ok(())
}

/// In ε: the ratio, its square plus 1, the root and the product, each rounded once; not of
/// results below the normal numbers.
const HYPOT: f64 = 2.0;

/// Every 10007th `f32`, of either sign: all exponents, all kinds of mantissas.
#[test]
fn single_precision_follows_double_over_the_whole_range() {
    for bits in (0..0x7f80_0000).step_by(10_007) {
        compare(f32::from_bits(bits)).unwrap();
        compare(-f32::from_bits(bits)).unwrap();
    }
}

/// Where a sine or a cosine is small: the reduction must not cancel there.
#[test]
fn single_precision_follows_double_beside_multiples_of_a_quarter_turn() {
    for quarters in 1..20_000 {
        let angle = (f64::from(quarters) * core::f64::consts::FRAC_PI_2) as f32;
        for bits in angle.to_bits() - 2..=angle.to_bits() + 2 {
            compare(f32::from_bits(bits)).unwrap();
        }
    }
    // Of all f32 the one that is nearest to a multiple of π/2: its cosine is 1.6e-9
    // (J.-M. Muller, Elementary Functions, 2006, Table 11.1).
    let nearest = 16_367_173.0 * (2.0_f32).powi(72);
    assert!(Scalar::sin_cos(nearest).1.abs() < 1.7e-9);
    compare(nearest).unwrap();
}

#[test]
fn what_is_no_number_stays_none_and_zeros_keep_their_sign() {
    for none in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let (sin, cos) = Scalar::sin_cos(none);
        assert!(sin.is_nan() && cos.is_nan());
    }
    assert!(Scalar::cbrt(f32::NAN).is_nan());
    assert_eq!(Scalar::cbrt(f32::NEG_INFINITY), f32::NEG_INFINITY);
    assert_eq!(Scalar::hypot(f32::INFINITY, 1.0), f32::INFINITY);
    assert!(Scalar::hypot(f32::NAN, 1.0).is_nan() && Scalar::hypot(1.0, f32::NAN).is_nan());
    assert_eq!(Scalar::hypot(0.0_f32, -0.0), 0.0);
    assert_eq!(Scalar::ln_1p(-1.0_f32), f32::NEG_INFINITY);
    assert!(Scalar::ln_1p(-2.0_f32).is_nan());
    for zero in [0.0_f32, -0.0] {
        assert_eq!(Scalar::sin_cos(zero).0.to_bits(), zero.to_bits());
        assert_eq!(Scalar::cbrt(zero).to_bits(), zero.to_bits());
    }
}

proptest! {
    #[test]
    fn single_precision_follows_double(x in prop::num::f32::NORMAL, small in -20.0_f32..20.0) {
        compare(x)?;
        compare(small)?;
    }

    #[test]
    fn double_precision_is_that_of_the_standard_library(x in -20.0_f64..20.0) {
        let close = |a: f64, b: f64| (a - b).abs() <= 2.0 * f64::EPSILON * b.abs();
        prop_assert!(close(Scalar::exp(x), f64::exp(x)));
        prop_assert!(close(Scalar::exp_m1(x), f64::exp_m1(x)));
        prop_assert!(close(Scalar::tanh(x), f64::tanh(x)));
        prop_assert!(close(Scalar::cbrt(x), f64::cbrt(x)));
        prop_assert!(close(Scalar::ln(x.abs()), f64::ln(x.abs())));
        prop_assert!(close(Scalar::ln_1p(x.abs()), f64::ln_1p(x.abs())));
        prop_assert!(close(Scalar::hypot(x, 3.0), f64::hypot(x, 3.0)));
        prop_assert_eq!(Scalar::sqrt(x.abs()), f64::sqrt(x.abs()));
        prop_assert_eq!(Scalar::floor(x), f64::floor(x));
        let (s, c) = Scalar::sin_cos(x);
        prop_assert!(close(s, f64::sin(x)) && close(c, f64::cos(x)));
    }
}
