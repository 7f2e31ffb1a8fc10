use super::{Exponential, double, single};
use proptest::prelude::*;

// The reference, libm's expm1 and exp, is itself within 1 ulp; two of ours
// come on top (one product and one sum after the polynomial or table).
const ULPS: f64 = 3.0 * f64::EPSILON;

proptest! {
    #[test]
    fn agrees_with_expm1(exponent in -300.0f64..2.0) {
        let a = libm::pow(10.0, exponent);
        let reference = -libm::expm1(-a);
        prop_assert!((a.one_minus_exp() / reference - 1.0).abs() <= ULPS);
        prop_assert!((a.mean_decay() / (reference / a) - 1.0).abs() <= 2.0 * ULPS);
        prop_assert!((0.0..=1.0).contains(&a.one_minus_exp()));
    }

    #[test]
    fn agrees_with_exp(u in 0.0f64..707.0) {
        prop_assert!((u.exp_minus() / libm::exp(-u) - 1.0).abs() <= ULPS);
    }
}

/// Greatest deviation of `f` from `reference` in units in the last place of `f32`,
/// over every 50th number from `low` to `high`.
fn worst(f: impl Fn(f32) -> f32, reference: impl Fn(f64) -> f64, low: f32, high: f32) -> f64 {
    let numbers = (low.to_bits()..high.to_bits()).step_by(50);
    numbers.fold(0.0, |worst, bits| {
        let x = f32::from_bits(bits);
        let exact = reference(f64::from(x));
        let unit = f64::from((exact as f32).next_up()) - f64::from(exact as f32);
        ((f64::from(f(x)) - exact).abs() / unit).max(worst)
    })
}

#[test]
fn single_precision_is_within_units_in_the_last_place() {
    let decay = |a: f64| -libm::expm1(-a);
    let mean = |a: f64| -libm::expm1(-a) / a;
    let growth = |u: f64| libm::exp(-u);
    let [tiny, short, long] = [1e-20, 0.125, 0.7];
    let decays = |low, high| worst(single::one_minus_exp, decay, low, high);
    // 0.605, 1.339, 0.998, 1.822 and 1.003 measured.
    assert!(decays(tiny, short) < 0.7);
    assert!(decays(short, long) < 1.4);
    assert!(decays(long, 100.0) < 1.1);
    assert!(worst(single::mean_decay, mean, tiny, 100.0) < 1.9);
    assert!(worst(single::exp_minus, growth, tiny, 87.0) < 1.1);
}

/// The polynomials meet without falling: a longer step never relaxes less, to
/// two units in the last place.
#[test]
fn branches_meet() {
    for border in [0.125_f32, 0.7, 18.0] {
        let (before, at) = (border.next_down().one_minus_exp(), border.one_minus_exp());
        assert!((at - before).abs() <= 2.0 * f32::EPSILON * at, "{border}");
    }
}

#[test]
fn limits() {
    fn check<T: Exponential>() {
        assert_eq!(T::ZERO.one_minus_exp(), T::ZERO);
        assert_eq!(T::ZERO.mean_decay(), T::ONE);
        assert_eq!(T::INFINITY.one_minus_exp(), T::ONE);
        assert_eq!(T::INFINITY.mean_decay(), T::ZERO);
        assert_eq!(T::ZERO.exp_minus(), T::ONE);
        assert_eq!(T::INFINITY.exp_minus(), T::ZERO);
        for f in [T::exp_minus, T::one_minus_exp, T::mean_decay] {
            assert!(f(T::NAN).is_nan());
        }
    }
    check::<f32>();
    check::<f64>();
    assert_eq!(double::one_minus_exp(37.9), 1.0 - double::exp_minus(37.9));
}
