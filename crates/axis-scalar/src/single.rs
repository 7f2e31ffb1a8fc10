//! Functions in the arithmetic of `f32` and of whole numbers: those of `libm` compute in
//! `f64`, which a controller does in software.

/// 2/π in binary, after 32 zeros: enough for every exponent of an `f32`.
const TWO_OVER_PI: [u32; 8] = [
    0,
    0xa2f9_836e,
    0x4e44_1529,
    0xfc27_57d1,
    0xf534_ddc0,
    0xdb62_9599,
    0x3c43_9041,
    0xfe51_63ab,
];

/// π/2 · 2³¹.
const QUARTER_TURN: u64 = 0xc90f_daa2;

/// Sine and cosine of an angle, rad.
pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
    let magnitude = angle.abs();
    let (quarters, (sin, cos)) = if magnitude <= core::f32::consts::FRAC_PI_4 {
        (0, near_zero(magnitude))
    } else if magnitude.is_finite() {
        let (quarters, rest) = reduce(magnitude);
        (quarters, near_zero(rest))
    } else {
        return (f32::NAN, f32::NAN);
    };
    let (sin, cos) = match quarters {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    };
    (if angle.is_sign_negative() { -sin } else { sin }, cos)
}

/// The nearest multiple of a quarter turn, modulo 4, and what is left of an angle above
/// π/4, rounded once; exact before that, after M. H. Payne and R. N. Hanek, "Radian
/// reduction for trigonometric functions", ACM SIGNUM Newsletter 18 (1983) 19–24.
///
/// The angle is m 2ᵉ with m below 2²⁴. Bits of 2/π that make whole turns of m 2ᵉ · 2/π
/// are left out; of the rest 96 do: the product is then known to 2⁻⁷⁰ quarter turns, and
/// no `f32` comes nearer to a multiple of one than 2⁻³⁰.
fn reduce(angle: f32) -> (u32, f32) {
    let bits = angle.to_bits();
    let mantissa = u64::from((bits & 0x007f_ffff) | 0x0080_0000);
    // e is (bits >> 23) − 150; the first bit that counts has the weight 2^(1−e), that
    // is e − 1 bits into 2/π. Above π/4 this is never before the zeros.
    let first = (bits >> 23) + 30 - 150;
    let word = |i: usize| {
        let at = (first >> 5) as usize + i;
        let pair = (u64::from(TWO_OVER_PI[at]) << 32) | u64::from(TWO_OVER_PI[at + 1]);
        ((pair << (first & 31)) >> 32) * mantissa
    };
    let low = word(2);
    let middle = word(1) + (low >> 32);
    let high = word(0) + (middle >> 32);
    // In units of 2⁻⁶² quarter turns, modulo 4 of them.
    let turned = (high << 32) | (middle & 0xffff_ffff);
    let quarters = turned.wrapping_add(1 << 61) >> 62;
    let rest = turned.wrapping_sub(quarters << 62) as i64;
    // Times π/2, both to 32 bits.
    let zeros = rest.unsigned_abs().leading_zeros();
    let leading = (rest.unsigned_abs() << zeros) >> 32;
    let product = ((leading * QUARTER_TURN) >> 32) as u32;
    let scale = f32::from_bits((127 - 29 - zeros) << 23);
    let size = product as f32 * scale;
    (quarters as u32, if rest < 0 { -size } else { size })
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

/// Cube root.
pub(crate) fn cbrt(x: f32) -> f32 {
    const SUBNORMAL: f32 = 16_777_216.0; // 2²⁴, whose cube root is 2⁸
    let size = x.abs();
    if size == 0.0 || !size.is_finite() {
        return x;
    }
    let root = if size < f32::MIN_POSITIVE {
        normal_cbrt(size * SUBNORMAL) * (1.0 / 256.0)
    } else {
        normal_cbrt(size)
    };
    root.copysign(x)
}

/// A root t of 8 bits, whose cube is exact, and the series of t (1 + δ)^(1/3) with
/// δ = (x − t³)/t³, of which the subtraction is exact too. |δ| is below 0.012, so that
/// the first term left out, 10 δ⁴/243, is below 1e-9.
fn normal_cbrt(x: f32) -> f32 {
    // A third of the exponent (W. Kahan, in FreeBSD's `s_cbrtf.c`) is right to 4 %, one
    // step of Halley's makes 1e-4 of it.
    let guess = f32::from_bits(x.to_bits() / 3 + 709_958_130);
    let over = x / (guess * guess) / guess;
    let better = guess * ((1.0 + 2.0 * over) / (2.0 + over));
    let root = f32::from_bits((better.to_bits() + 0x8000) & 0xffff_0000);
    let cube = root * root * root;
    let part = (x - cube) / cube;
    let series = 1.0 / 3.0 - part * (1.0 / 9.0 - part * (5.0 / 81.0));
    root + root * (part * series)
}

/// √(x² + y²) by the ratio of the two: nothing overflows that the result does not.
#[inline]
pub(crate) fn hypot(x: f32, y: f32) -> f32 {
    let (x, y) = (x.abs(), y.abs());
    let (large, small) = if x < y { (y, x) } else { (x, y) };
    if large == 0.0 || !large.is_finite() {
        return large + small;
    }
    let ratio = small / large;
    large * libm::sqrtf(1.0 + ratio * ratio)
}
