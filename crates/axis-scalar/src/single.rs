//! Sine and cosine in the arithmetic of `f32`: those of `libm` compute in `f64`, which a
//! controller does in software.

/// π/2 in three parts (Cody and Waite): a multiple of the first, up to 2¹⁶,
/// has no rounding in `f32`.
const QUARTER_TURN: [f32; 3] = [1.570_312_5, 4.837_513e-4, 7.549_79e-8];

/// Sine and cosine of an angle, rad, to the rounding of `f32`.
pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
    let (mut rest, mut quarters) = (angle, 0.0);
    // One round brings an angle of up to 10⁴ rad within ±π/4; each leaves at
    // most a few roundings of it, so that 7 do for the greatest number.
    for _ in 0..7 {
        if rest.abs() < 0.8 {
            break;
        }
        let turns = libm::floorf(rest * core::f32::consts::FRAC_2_PI + 0.5);
        for part in QUARTER_TURN {
            rest -= turns * part;
        }
        quarters += remainder_of_four(turns);
    }
    let (sin, cos) = near_zero(rest);
    match remainder_of_four(quarters) {
        0.0 => (sin, cos),
        1.0 => (cos, -sin),
        2.0 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

fn remainder_of_four(whole: f32) -> f32 {
    whole - 4.0 * libm::floorf(whole * 0.25)
}

/// Minimax polynomials for |x| ≤ π/4: S. L. Moshier, Cephes, `sinf.c`.
fn near_zero(x: f32) -> (f32, f32) {
    let z = x * x;
    let sin = (-1.951_529_6e-4 * z + 8.332_161e-3) * z;
    let sin = (sin - 1.666_665_5e-1) * z * x + x;
    let cos = (2.443_315_7e-5 * z - 1.388_731_6e-3) * z;
    let cos = (cos + 4.166_664_6e-2) * z * z - 0.5 * z + 1.0;
    (sin, cos)
}
