//! Latin hypercubes from orthogonal arrays of strength 2.

use crate::design::{check_dims, zeros};
use crate::permutation::{Permutation, Purpose, below, stream};
use crate::stratum::Strata;
use crate::{Design, LhsError, Placement};
use rand_chacha::rand_core::Rng;

/// Greatest prime of an [`OrthogonalArray`]: its square, the number of points,
/// is below 2³².
pub const MAX_PRIME: usize = 65_521;

/// A Latin hypercube of p² points, p a prime, in up to p + 1 variables, that
/// is even in every two variables too: each cell of the p × p grid over two
/// variables holds exactly one point.
///
/// ```
/// use lhs::{OrthogonalArray, Placement};
///
/// let array = OrthogonalArray { prime: 7, dims: 4, placement: Placement::Random, seed: 1 };
/// let design = array.design()?;
/// assert_eq!((design.len(), design.dims()), (49, 4));
/// let low = design.rows().filter(|x| x[0] < 2.0 / 7.0 && x[3] < 3.0 / 7.0).count();
/// assert_eq!(low, 2 * 3);
/// # Ok::<(), lhs::LhsError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OrthogonalArray {
    /// The prime p, 2 to [`MAX_PRIME`].
    pub prime: usize,
    /// Variables m, 1 to p + 1, at most [`MAX_DIMS`](crate::MAX_DIMS).
    pub dims: usize,
    /// Where in their strata the points lie.
    pub placement: Placement,
    /// Seed of the levels, strata and points.
    pub seed: u64,
}

impl OrthogonalArray {
    /// The p² levels of column `dim`, 0 to p − 1, before they are made random:
    /// Bose's construction (1938, Sankhyā 3, 323–338). Row (a, b) has level
    /// a + dim·b mod p, and b in column p.
    fn level(&self, row: usize, dim: usize) -> usize {
        let p = self.prime;
        let (a, b) = (row / p, row % p);
        if dim == p { b } else { (a + dim * b) % p }
    }

    /// The Latin hypercube of the array (Tang 1993, doi
    /// 10.1080/01621459.1993.10476423): levels are renamed at random in each
    /// column, and the p points of a level get its p strata at random.
    ///
    /// # Errors
    /// `prime` is not a prime from 2 to [`MAX_PRIME`], `dims` is 0, above
    /// p + 1 or above [`MAX_DIMS`](crate::MAX_DIMS), or the design does not
    /// fit in memory.
    pub fn design(&self) -> Result<Design, LhsError> {
        let (p, dims) = (self.prime, self.dims);
        if p > MAX_PRIME || !is_prime(p) {
            return Err(LhsError::Argument {
                what: "prime",
                found: p,
                valid: "a prime from 2 to 65521 (p^2 points: 4, 9, 25, 49, 121, 169, ...)",
            });
        }
        check_dims(dims)?;
        if dims > p + 1 {
            return Err(LhsError::Index {
                what: "variables of an orthogonal array:",
                found: dims,
                valid: "at most the prime plus 1,",
                limit: p + 1,
            });
        }
        let strata = Strata::new(p * p)?;
        let mut values = zeros(p * p, dims)?;
        for dim in 0..dims {
            let mut rng = stream(self.seed, Purpose::Orthogonal, dim as u64);
            let names = Permutation::draw(p, &mut rng);
            // The strata of a level that are still to be given away.
            let mut open: Vec<Vec<u32>> = vec![(0..p as u32).collect(); p];
            for (row, value) in values[dim..].iter_mut().step_by(dims).enumerate() {
                let level = self.level(row, dim);
                let left = &mut open[level];
                let at = below(&mut rng, left.len() as u64) as usize;
                let cell = names.apply(level as u64) * p as u64 + u64::from(left.swap_remove(at));
                *value = match self.placement {
                    Placement::Centred => strata.middle(cell),
                    Placement::Random => strata.point(cell, rng.next_u64()),
                };
            }
        }
        Ok(Design::from_valid(dims, values))
    }
}

/// By trial division; numbers up to [`MAX_PRIME`] take at most 255 of them.
fn is_prime(p: usize) -> bool {
    p >= 2
        && (2..)
            .take_while(|d| d * d <= p)
            .all(|d| !p.is_multiple_of(d))
}
