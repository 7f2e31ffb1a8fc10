//! The exponentials in single precision: the method of `double.rs` with shorter
//! polynomials; errors stand in `exponential.rs`.

super::decays!(f32);

/// Beyond this `1 − e^{−a}` rounds to 1: `e^{−18} < 2^{−25}`.
const SATURATED: f32 = 18.0;

const Q_SHORT: [f32; 4] = [-0.5, 0.166_666_02, -0.041_640_393, 0.007_994_481];

const Q_LONG: [f32; 6] = [
    -0.5,
    0.166_666_55,
    -0.041_664_712,
    0.008_321_282,
    -0.001_354_932_1,
    0.000_153_185_09,
];

/// `2^{−j/64}`, correctly rounded.
#[rustfmt::skip] // four a line
const FRACTIONS: [f32; 64] = [
    1.0, 0.989_228, 0.978_572_1, 0.968_030_87,
    0.957_603_3, 0.947_288, 0.937_083_84, 0.926_989_56,
    0.917_004_05, 0.907_126_07, 0.897_354_54, 0.887_688_2,
    0.878_126_1, 0.868_666_95, 0.859_309_7, 0.850_053_2,
    0.840_896_4, 0.831_838_3, 0.822_877_76, 0.814_013_7,
    0.805_245_16, 0.796_571_1, 0.787_990_45, 0.779_502_2,
    0.771_105_4, 0.762_799_1, 0.754_582_2, 0.746_453_9,
    0.738_413_1, 0.730_458_9, 0.722_590_4, 0.714_806_7,
    core::f32::consts::FRAC_1_SQRT_2, 0.699_489_83, 0.691_955, 0.684_501_23,
    0.677_127_8, 0.669_833_8, 0.662_618_34, 0.655_480_6,
    0.648_419_8, 0.641_435, 0.634_525_5, 0.627_690_4,
    0.620_928_9, 0.614_240_3, 0.607_623_7, 0.601_078_4,
    0.594_603_54, 0.588_198_5, 0.581_862_45, 0.575_594_6,
    0.569_394_3, 0.563_260_8, 0.557_193_4, 0.551_191_3,
    0.545_253_9, 0.539_380_4, 0.533_570_23, 0.527_822_6,
    0.522_136_87, 0.516_512_45, 0.510_948_6, 0.505_444_65,
];

/// `Q(a)` by Estrin's scheme.
#[inline(always)]
fn q_short(a: f32) -> f32 {
    let q = &Q_SHORT;
    (q[0] + q[1] * a) + (q[2] + q[3] * a) * (a * a)
}

#[inline(always)]
fn q_long(a: f32) -> f32 {
    let q = &Q_LONG;
    let a2 = a * a;
    (q[0] + q[1] * a) + ((q[2] + q[3] * a) + (q[4] + q[5] * a) * a2) * a2
}

/// `e^{−u}` for `u ≥ 0`, NaN for NaN.
#[inline(always)]
pub(super) fn exp_minus(u: f32) -> f32 {
    // 1.5 · 2^23: adding it rounds to an integer, found in the last bits.
    const ROUND: f32 = 12_582_912.0;
    const PER_STEP: f32 = 92.332_48; // 64 / ln 2
    // ln 2 / 64 in two parts; the first has 11 significant bits, so that k
    // times it is exact for every k below 2^13.
    const STEP_HIGH: f32 = 0.010_833_74;
    const STEP_LOW: f32 = -3.315_538_2e-6;
    if u > 87.0 {
        return 0.0; // below the smallest normal number
    }
    let rounded = u * PER_STEP + ROUND;
    let k = rounded - ROUND;
    let r = (u - k * STEP_HIGH) - k * STEP_LOW;
    // e^{−r} − 1
    let tail = (0.5 - 0.166_666_67 * r) * (r * r) - r;
    let k = rounded.to_bits().wrapping_sub(ROUND.to_bits());
    let fraction = FRACTIONS[(k & 63) as usize];
    let scale = f32::from_bits(127_u32.wrapping_sub(k >> 6) << 23);
    (fraction + fraction * tail) * scale
}
