//! Whole powers with specified bits.
//!
//! `f64::powi` may round as the platform likes; a multiplication may not. What
//! decides which design is kept rests on these bits.

/// x^e by repeated squaring, from the lowest bit of `e` up: at most 2 log₂ e
/// roundings of one multiplication each, in an order that `e` alone fixes.
pub(crate) fn power(x: f64, e: usize) -> f64 {
    let (mut result, mut square, mut left) = (1.0, x, e);
    loop {
        if left & 1 == 1 {
            result *= square;
        }
        left >>= 1;
        if left == 0 {
            return result;
        }
        square *= square;
    }
}

#[cfg(test)]
mod tests {
    use super::power;

    /// Powers that f64 holds exactly, by whole-number arithmetic.
    #[test]
    fn exact_powers_are_exact() {
        for base in [1_u64, 2, 3, 5, 7, 12] {
            let mut exact = 1_u64;
            for e in 0..64 {
                assert_eq!(power(base as f64, e), exact as f64, "{base}^{e}");
                match exact.checked_mul(base) {
                    Some(next) if next < 1 << 53 => exact = next,
                    _ => break,
                }
            }
        }
        assert_eq!(power(2.0, 1023), f64::from_bits(0x7fe0_0000_0000_0000));
        assert_eq!(power(2.0, usize::MAX), f64::INFINITY);
        assert_eq!(power(0.5, usize::MAX), 0.0);
    }

    /// (13/12)^m against libm's power, which is good to one unit; roundings of
    /// the first squares come back m-fold: 40 units measured at most.
    #[test]
    fn powers_of_the_discrepancy_are_close() {
        for m in 0..=1024_usize {
            let exact = libm::pow(13.0 / 12.0, m as f64);
            let error = (power(13.0 / 12.0, m) / exact - 1.0).abs() / f64::EPSILON;
            assert!(error < 100.0, "m = {m}: {error} units");
        }
    }
}
