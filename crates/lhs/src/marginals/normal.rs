//! The normal distribution and its inverse.

use super::{Cumulative, Marginal, checked, is_probability};
use crate::LhsError;
use std::f64::consts::FRAC_1_SQRT_2;

/// The normal distribution.
///
/// Its inverse is Wichura's PPND16 (Algorithm AS 241, Applied Statistics 37,
/// 1988, doi 10.2307/2347330), stated by its author to be good to about 1
/// part in 10^16, down to the smallest p; the distribution function is the
/// complementary error function of libm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normal {
    mean: f64,
    standard_deviation: f64,
}

impl Normal {
    /// Normal with `mean` and `standard_deviation`, both in the unit of the
    /// variable.
    ///
    /// # Errors
    /// A parameter is not finite, or `standard_deviation` is not positive.
    pub fn new(mean: f64, standard_deviation: f64) -> Result<Self, LhsError> {
        checked("Normal", "mean", mean, mean.is_finite(), "finite")?;
        let sd = standard_deviation;
        let good = sd.is_finite() && sd > 0.0;
        checked(
            "Normal",
            "standard_deviation",
            sd,
            good,
            "positive and finite",
        )?;
        Ok(Self {
            mean,
            standard_deviation,
        })
    }

    fn standardised(&self, x: f64) -> f64 {
        (x - self.mean) / self.standard_deviation
    }
}

impl Marginal for Normal {
    fn inverse_cdf(&self, p: f64) -> f64 {
        self.mean + self.standard_deviation * standard_inverse(p)
    }
}

impl Cumulative for Normal {
    fn cdf(&self, x: f64) -> f64 {
        0.5 * libm::erfc(-self.standardised(x) * FRAC_1_SQRT_2)
    }

    fn survival(&self, x: f64) -> f64 {
        0.5 * libm::erfc(self.standardised(x) * FRAC_1_SQRT_2)
    }

    fn inverse_survival(&self, q: f64) -> f64 {
        self.mean - self.standard_deviation * standard_inverse(q)
    }
}

/// Φ⁻¹(p): −∞ at 0, +∞ at 1, NaN outside [0, 1].
fn standard_inverse(p: f64) -> f64 {
    if !is_probability(p) {
        return f64::NAN;
    }
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180_625 - q * q;
        return q * ratio(&CENTRE, r);
    }
    let tail = if q < 0.0 { p } else { 1.0 - p };
    if tail == 0.0 {
        return f64::INFINITY.copysign(q);
    }
    let r = (-libm::log(tail)).sqrt();
    let x = if r <= 5.0 {
        ratio(&MIDDLE, r - 1.6)
    } else {
        ratio(&TAIL, r - 5.0)
    };
    x.copysign(q)
}

/// A ratio of two polynomials of degree 7; coefficients from r⁰ up.
fn ratio([upper, lower]: &[[f64; 8]; 2], r: f64) -> f64 {
    let at = |c: &[f64; 8]| c.iter().rev().fold(0.0, |sum, k| sum * r + k);
    at(upper) / at(lower)
}

/// AS 241, coefficients a and b: |p − 1/2| ≤ 0.425.
#[expect(clippy::excessive_precision, reason = "digits as published")]
const CENTRE: [[f64; 8]; 2] = [
    [
        3.387_132_872_796_366_608,
        133.141_667_891_784_377_45,
        1_971.590_950_306_551_442_7,
        13_731.693_765_509_461_125,
        45_921.953_931_549_871_457,
        67_265.770_927_008_700_853,
        33_430.575_583_588_128_105,
        2_509.080_928_730_122_672_7,
    ],
    [
        1.0,
        42.313_330_701_600_911_252,
        687.187_007_492_057_908_3,
        5_394.196_021_424_751_107_7,
        21_213.794_301_586_595_867,
        39_307.895_800_092_710_61,
        28_729.085_735_721_942_674,
        5_226.495_278_852_854_561,
    ],
];

/// AS 241, coefficients c and d: √(−ln tail) ≤ 5.
#[expect(clippy::excessive_precision, reason = "digits as published")]
const MIDDLE: [[f64; 8]; 2] = [
    [
        1.423_437_110_749_683_577_34,
        4.630_337_846_156_545_295_9,
        5.769_497_221_460_691_405_5,
        3.647_848_324_763_204_605_04,
        1.270_458_252_452_368_382_58,
        2.417_807_251_774_506_117_7e-1,
        2.272_384_498_926_918_458_33e-2,
        7.745_450_142_783_414_076_4e-4,
    ],
    [
        1.0,
        2.053_191_626_637_758_821_87,
        1.676_384_830_183_803_849_4,
        6.897_673_349_851_000_045_5e-1,
        1.481_039_764_274_800_745_9e-1,
        1.519_866_656_361_645_719_66e-2,
        5.475_938_084_995_344_946e-4,
        1.050_750_071_644_416_843_24e-9,
    ],
];

/// AS 241, coefficients e and f: beyond.
#[expect(clippy::excessive_precision, reason = "digits as published")]
const TAIL: [[f64; 8]; 2] = [
    [
        6.657_904_643_501_103_777_2,
        5.463_784_911_164_114_369_9,
        1.784_826_539_917_291_335_8,
        2.965_605_718_285_048_912_3e-1,
        2.653_218_952_657_612_309_3e-2,
        1.242_660_947_388_078_438_6e-3,
        2.711_555_568_743_487_578_15e-5,
        2.010_334_399_292_288_132_65e-7,
    ],
    [
        1.0,
        5.998_322_065_558_879_376_9e-1,
        1.369_298_809_227_358_053_1e-1,
        1.487_536_129_085_061_485_25e-2,
        7.868_691_311_456_132_591e-4,
        1.846_318_317_510_054_681_8e-5,
        1.421_511_758_316_445_888_7e-7,
        2.044_263_103_389_939_785_64e-15,
    ],
];
