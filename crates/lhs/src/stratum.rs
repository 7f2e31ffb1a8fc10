//! The n strata of equal probability, Eqs. (21) to (23), in f64.
//!
//! A stratum [c/n, (c + 1)/n) must hold its point after rounding too. Up to
//! [`FAST_LIMIT`] strata this is had by keeping u away from the two edges by
//! more than the rounding of (c + u)/n; above, the point is chosen among the
//! multiples of 2⁻⁵³ in the stratum by exact integer arithmetic.

use crate::LhsError;

/// Most strata that f64 can tell apart just below 1.
const MOST: u64 = 1 << 53;

/// Up to here the rounding of (c + u)/n costs u less than 2^-19 at an edge.
const FAST_LIMIT: u64 = 1 << 32;

const GRID: f64 = 1.0 / MOST as f64;

/// The partition of [0, 1) into n strata.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Strata {
    n: u64,
    /// u = edge + span · r for r uniform on [0, 1).
    edge: f64,
    span: f64,
}

impl Strata {
    pub(crate) fn new(n: usize) -> Result<Self, LhsError> {
        if n == 0 || n as u64 > MOST {
            return Err(LhsError::Points { n });
        }
        // c + u and the quotient round by at most n·2⁻⁵³ strata together, and
        // a caller's v·n by half as much again: 4·n·2⁻⁵³ is a safe margin.
        let edge = 4.0 * n as f64 * GRID;
        Ok(Self {
            n: n as u64,
            edge,
            span: 1.0 - 2.0 * edge,
        })
    }

    pub(crate) fn count(&self) -> usize {
        self.n as usize
    }

    /// Whether all points of a partition are of the fast kind.
    #[inline(always)]
    pub(crate) fn is_fast(&self) -> bool {
        self.n <= FAST_LIMIT
    }

    /// The point of stratum `c` at a random place, made of 64 random `bits`.
    #[inline]
    pub(crate) fn point(&self, c: u64, bits: u64) -> f64 {
        match self.is_fast() {
            true => self.fast_point(c, bits),
            false => self.grid_point(c, bits),
        }
    }

    /// The middle of stratum `c`.
    #[inline]
    pub(crate) fn middle(&self, c: u64) -> f64 {
        match self.is_fast() {
            true => self.fast_middle(c),
            false => self.grid_point(c, 1 << 63),
        }
    }

    /// As [`point`](Self::point), where all are fast.
    #[inline(always)]
    pub(crate) fn fast_point(&self, c: u64, bits: u64) -> f64 {
        // Through i64, for which every processor has the conversion.
        let u = self.edge + self.span * ((bits >> 11) as i64 as f64 * GRID);
        (c as i64 as f64 + u) / self.n as f64
    }

    /// As [`middle`](Self::middle), where all are fast.
    #[inline(always)]
    pub(crate) fn fast_middle(&self, c: u64) -> f64 {
        (c as i64 as f64 + 0.5) / self.n as f64
    }

    #[cold]
    fn grid_point(&self, c: u64, bits: u64) -> f64 {
        let first = self.first_multiple(c);
        let room = self.first_multiple(c + 1) - first;
        // room ≥ 1, because a stratum is at least 2⁻⁵³ wide.
        let multiple = first + ((u128::from(bits) * u128::from(room)) >> 64) as u64;
        // An inverse CDF may be infinite at 0, so 0 itself is stepped over.
        if multiple == 0 {
            0.5 * GRID
        } else {
            multiple as f64 * GRID
        }
    }

    /// The least multiple of 2⁻⁵³, in units of it, at or above c/n.
    fn first_multiple(&self, c: u64) -> u64 {
        (u128::from(c) * u128::from(MOST)).div_ceil(u128::from(self.n)) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// floor(v·n) without rounding, for v a multiple of 2⁻¹¹⁷ or coarser.
    fn exact_stratum(v: f64, n: u64) -> u64 {
        // v = mantissa · 2^-shift exactly.
        let bits = v.to_bits();
        let exponent = (bits >> 52) as i32 - 1075;
        let mantissa = (bits & ((1 << 52) - 1)) | (1 << 52);
        let product = u128::from(mantissa) * u128::from(n);
        product.checked_shr((-exponent) as u32).unwrap_or(0) as u64
    }

    proptest! {
        #[test]
        fn a_point_stays_in_its_stratum_exactly(
            n in prop_oneof![1..100_u64, 1..=MOST, Just(FAST_LIMIT), Just(MOST), Just(MOST - 1)],
            share in 0.0..1.0_f64,
            bits in prop_oneof![any::<u64>(), Just(0), Just(u64::MAX)],
            end in 0..3_u8,
        ) {
            let strata = Strata::new(n as usize).unwrap();
            let c = match end { 0 => 0, 1 => n - 1, _ => ((n as f64 * share) as u64).min(n - 1) };
            for v in [strata.point(c, bits), strata.middle(c)] {
                prop_assert!(v > 0.0 && v < 1.0);
                prop_assert_eq!(exact_stratum(v, n), c);
                if n <= FAST_LIMIT {
                    prop_assert_eq!((v * n as f64) as u64, c, "as a caller would count");
                }
            }
        }
    }
}
