//! Decaying exponentials, inlined and the same to the bit on every platform.
//!
//! `1 − e^{−a} = a + a² Q(a)`, with `Q` the interpolant at Chebyshev nodes: of
//! degree 6 up to 0.125, of degree 10 up to 0.7. Their relative errors in
//! `1 − e^{−a}`, 2.1e-17 and 1.1e-18 (evaluated with 50 digits), are below
//! rounding, and the leading term is exact, so small `a` lose nothing.
//!
//! `e^{−u} = 2^{−k/64} e^{−r}` with `|r| ≤ ln 2 / 128`: a table of the 64
//! fractions and a polynomial of degree 5, relative error 4.4e-18.
//!
//! They are here because they pay: with `libm`'s `exp` and `expm1` instead a
//! step takes 1.2 to 1.8 times as long and axis-sim's closed loop 7 to 15 %
//! longer; the standard library's cost the loop 2 to 10 %, need `std` and are
//! not the same on every platform (`benches/step.rs` sets the three side by
//! side).
//!
//! All are forced inline, as are their callers inside the crate: left to itself
//! the compiler calls them, which made a step 10 to 25 % slower.

/// Below it the short polynomial serves: every step of a control loop.
const SHORT: f64 = 0.125;

/// Below it the long polynomial serves; above it `1 − e^{−a}` cancels nothing.
const LONG: f64 = 0.7;

/// Beyond this `1 − e^{−a}` rounds to 1: `e^{−38} < 2^{−54}`.
const SATURATED: f64 = 38.0;

const Q_SHORT: [f64; 7] = [
    -0.49999999999999983,
    0.16666666666654625,
    -0.041666666651245174,
    0.0083333325921337,
    -0.0013888719081693336,
    0.00019821262679681735,
    -2.3627378260456814e-05,
];

const Q_LONG: [f64; 11] = [
    -0.5,
    0.16666666666666627,
    -0.04166666666664386,
    0.008333333332824176,
    -0.0013888888830518855,
    0.00019841265932179708,
    -2.480142376828825e-05,
    2.755291193085996e-06,
    -2.748060254827596e-07,
    2.4213936178477727e-08,
    -1.5562991015725103e-09,
];

/// `2^{−j/64}`, correctly rounded.
#[rustfmt::skip] // four a line
const FRACTIONS: [f64; 64] = [
    1.0, 0.9892280131939755, 0.9785720620877001, 0.9680308967461472,
    0.9576032806985737, 0.9472879907934828, 0.93708381705515, 0.9269895625416927,
    0.9170040432046712, 0.9071260877501994, 0.8973545375015536, 0.8876882462632606,
    0.8781260801866497, 0.8686669176368531, 0.859309649061239, 0.8500531768592617,
    0.8408964152537145, 0.8318382901633682, 0.8228777390769825, 0.8140137109286739,
    0.8052451659746271, 0.7965710756711335, 0.7879904225539432, 0.7795022001189185,
    0.7711054127039704, 0.7627990753722692, 0.7545822137967114, 0.7464538641456324,
    0.7384130729697497, 0.7304588970903235, 0.7225904034885233, 0.714806669195985,
    core::f64::consts::FRAC_1_SQRT_2, 0.6994898362691556, 0.691954940981916, 0.6845012114872953,
    0.6771277734684463, 0.6698337620266515, 0.6626183215798707, 0.6554806057623822,
    0.6484197773255048, 0.6414350080393891, 0.6345254785958666, 0.6276903785123455,
    0.620928906036742, 0.614240268053435, 0.6076236799902345, 0.6010783657263515,
    0.5946035575013605, 0.5881984958251406, 0.5818624293887887, 0.5755946149764913,
    0.5693943173783458, 0.5632608093041209, 0.5571933712979462, 0.5511912916539204,
    0.5452538663326288, 0.5393803988785599, 0.5335702003384118, 0.5278225891802786,
    0.5221368912137069, 0.5165124395106142, 0.5109485743270583, 0.5054446430258502,
];

/// `Q(a)` by Estrin's scheme, which has a third of the chain of dependent
/// operations of Horner's.
#[inline(always)]
fn q_short(a: f64) -> f64 {
    let q = &Q_SHORT;
    let a2 = a * a;
    let low = (q[0] + q[1] * a) + (q[2] + q[3] * a) * a2;
    low + ((q[4] + q[5] * a) + q[6] * a2) * (a2 * a2)
}

#[inline(always)]
fn q_long(a: f64) -> f64 {
    let q = &Q_LONG;
    let a2 = a * a;
    let a4 = a2 * a2;
    let low = (q[0] + q[1] * a) + (q[2] + q[3] * a) * a2;
    let middle = (q[4] + q[5] * a) + (q[6] + q[7] * a) * a2;
    let high = (q[8] + q[9] * a) + q[10] * a2;
    low + (middle + high * a4) * a4
}

/// `e^{−u}` for `u ≥ 0`, NaN for NaN.
#[inline(always)]
pub(crate) fn exp_minus(u: f64) -> f64 {
    // 1.5 · 2^52: adding it rounds to an integer, found in the last bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const PER_STEP: f64 = 92.33248261689366; // 64 / ln 2
    // ln 2 / 64 in two parts; the first ends in 24 zero bits, so that k times
    // it is exact for every k below 2^24.
    const STEP_HIGH: f64 = 0.010830424667801708;
    const STEP_LOW: f64 = 2.8447437476627285e-11;
    if u > 708.0 {
        return 0.0; // below the smallest normal number
    }
    let rounded = u * PER_STEP + ROUND;
    let k = rounded - ROUND;
    let r = (u - k * STEP_HIGH) - k * STEP_LOW;
    let r2 = r * r;
    // e^{−r} − 1
    let tail = ((0.49999999999985073 - 0.16666666666664534 * r)
        + (0.04166670739519204 - 0.008333339151693509 * r) * r2)
        * r2
        - r;
    let k = rounded.to_bits().wrapping_sub(ROUND.to_bits());
    let fraction = FRACTIONS[(k & 63) as usize];
    let scale = f64::from_bits(1023_u64.wrapping_sub(k >> 6) << 52);
    (fraction + fraction * tail) * scale
}

/// `1 − e^{−a}` for `a ≥ 0` (also infinite), in `[0, 1]`; NaN for NaN.
#[inline(always)]
pub(crate) fn one_minus_exp(a: f64) -> f64 {
    if a < SHORT {
        a + a * a * q_short(a)
    } else if a < LONG {
        a + a * a * q_long(a)
    } else if a < SATURATED {
        1.0 - exp_minus(a)
    } else if a.is_nan() {
        a
    } else {
        1.0
    }
}

/// `(1 − e^{−a}) / a` for `a ≥ 0`, continued to 1 at `a = 0`; NaN for NaN.
#[inline(always)]
pub(crate) fn mean_decay(a: f64) -> f64 {
    if a < SHORT {
        1.0 + a * q_short(a)
    } else if a < LONG {
        1.0 + a * q_long(a)
    } else {
        one_minus_exp(a) / a
    }
}

#[cfg(test)]
mod tests {
    use super::{exp_minus, mean_decay, one_minus_exp};
    use proptest::prelude::*;

    // The reference, libm's expm1 and exp, is itself within 1 ulp; two of ours
    // come on top (one product and one sum after the polynomial or table).
    const ULPS: f64 = 3.0 * f64::EPSILON;

    proptest! {
        #[test]
        fn agrees_with_expm1(exponent in -300.0f64..2.0) {
            let a = libm::pow(10.0, exponent);
            let reference = -libm::expm1(-a);
            prop_assert!((one_minus_exp(a) / reference - 1.0).abs() <= ULPS);
            prop_assert!((mean_decay(a) / (reference / a) - 1.0).abs() <= 2.0 * ULPS);
            prop_assert!((0.0..=1.0).contains(&one_minus_exp(a)));
        }

        #[test]
        fn agrees_with_exp(u in 0.0f64..707.0) {
            prop_assert!((exp_minus(u) / libm::exp(-u) - 1.0).abs() <= ULPS);
        }
    }

    #[test]
    fn limits() {
        assert_eq!(one_minus_exp(0.0), 0.0);
        assert_eq!(mean_decay(0.0), 1.0);
        assert_eq!(one_minus_exp(f64::INFINITY), 1.0);
        assert_eq!(mean_decay(f64::INFINITY), 0.0);
        assert_eq!(exp_minus(0.0), 1.0);
        assert_eq!(exp_minus(f64::INFINITY), 0.0);
        for f in [exp_minus, one_minus_exp, mean_decay] {
            assert!(f(f64::NAN).is_nan());
        }
    }
}
