//! The functions that [`Scalar`] lacks.

use scalar::Scalar;

/// `x` between two bounds; what is not a number passes, which `min` and `max`
/// would hide.
#[inline]
pub(crate) fn clamp<T: Scalar>(x: T, low: T, high: T) -> T {
    let above = if x < low { low } else { x };
    if above > high { high } else { above }
}

/// Sine and cosine of an angle, rad, in the arithmetic of its own type: those
/// of [`Scalar`] compute in `f64` for an `f32`.
#[inline]
pub(crate) fn sin_cos<T: Scalar>(angle: T) -> (T, T) {
    if T::EPSILON > T::of(1e-10) {
        single(angle)
    } else {
        angle.sin_cos()
    }
}

/// π/2 in three parts (Cody and Waite): a multiple of the first, up to 2¹⁶,
/// has no rounding in `f32`.
const QUARTER_TURN: [f64; 3] = [
    1.570_312_5,
    4.837_512_969_970_703e-4,
    7.549_789_954_891_882e-8,
];

/// Sine and cosine to the rounding of `f32`.
fn single<T: Scalar>(angle: T) -> (T, T) {
    let (mut rest, mut quarters) = (angle, T::ZERO);
    // One round brings an angle of up to 10⁴ rad within ±π/4; each leaves at
    // most a few roundings of it, so that 7 do for the greatest number.
    for _ in 0..7 {
        if rest.abs() < T::of(0.8) {
            break;
        }
        let turns = (rest * T::of(core::f64::consts::FRAC_2_PI) + T::HALF).floor();
        for part in QUARTER_TURN {
            rest -= turns * T::of(part);
        }
        quarters += remainder_of_four(turns);
    }
    let (sin, cos) = near_zero(rest);
    let quarter = remainder_of_four(quarters);
    if quarter == T::ZERO {
        (sin, cos)
    } else if quarter == T::ONE {
        (cos, -sin)
    } else if quarter == T::TWO {
        (-sin, -cos)
    } else {
        (-cos, sin)
    }
}

fn remainder_of_four<T: Scalar>(whole: T) -> T {
    whole - T::of(4.0) * (whole * T::of(0.25)).floor()
}

/// Minimax polynomials for |x| ≤ π/4: S. L. Moshier, Cephes, `sinf.c`.
fn near_zero<T: Scalar>(x: T) -> (T, T) {
    let z = x * x;
    let sin = (T::of(-1.951_529_589_1e-4) * z + T::of(8.332_160_873_6e-3)) * z;
    let sin = (sin - T::of(1.666_665_461_1e-1)) * z * x + x;
    let cos = (T::of(2.443_315_711_809_948e-5) * z - T::of(1.388_731_625_493_765e-3)) * z;
    let cos = (cos + T::of(4.166_664_568_298_827e-2)) * z * z - T::HALF * z + T::ONE;
    (sin, cos)
}
