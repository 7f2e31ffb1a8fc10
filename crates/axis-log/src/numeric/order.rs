//! Order statistics.

/// The median of finite numbers, 0 of none: the upper one of an even count. Reorders them.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Standard deviation over median absolute deviation, of Gaussian numbers:
/// 1 / Φ⁻¹(3/4).
pub(crate) const SIGMA_OF_MAD: f64 = 1.482_602_218_505_602;
