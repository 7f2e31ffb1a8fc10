//! More points for an existing design.

use crate::criteria::centred_discrepancy;
use crate::design::zeros;
use crate::permutation::{Permutation, Purpose, stream};
use crate::stratum::Strata;
use crate::{Design, LhsError, Placement};
use rand_chacha::rand_core::Rng;

/// What is added to a design.
///
/// ```
/// use lhs::{Augmentation, LatinHypercube, Placement};
///
/// let first = LatinHypercube::new(20, 3, 1)?.design()?;
/// let more = Augmentation { points: 20, placement: Placement::Random, candidates: 50, seed: 2 };
/// let whole = more.of(&first)?;
/// assert_eq!(whole.design.len(), 40);
/// assert!(whole.is_latin()); // 40 is a multiple of 20
/// # Ok::<(), lhs::LhsError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Augmentation {
    /// Points to be added, at least 1.
    pub points: usize,
    /// Where in their strata the new points lie.
    pub placement: Placement,
    /// Random combinations of the new strata that are tried, at least 1; kept
    /// is the one with which the whole design has the least
    /// [`centred_discrepancy`], which takes O(N² m) time for each of several.
    pub candidates: usize,
    /// Seed of the new points.
    pub seed: u64,
}

/// A design with added points.
#[derive(Debug, Clone, PartialEq)]
pub struct Augmented {
    /// All N points: those that were there first, bit for bit, then the new.
    pub design: Design,
    /// For each column, how many of its N strata hold no point. All are 0 if
    /// the whole is a Latin hypercube.
    pub empty_strata: Vec<usize>,
}

impl Augmented {
    /// Whether the whole is a Latin hypercube of N points.
    pub fn is_latin(&self) -> bool {
        self.empty_strata.iter().all(|&empty| empty == 0)
    }
}

impl Augmentation {
    /// Adds points to `design`, whose values are probabilities. Each column is
    /// cut into N = n + `points` strata, and the new points go to strata that
    /// hold none.
    ///
    /// The whole is Latin if no two points of `design` share one of the N
    /// strata of a column. For a Latin hypercube that is certain if N is a
    /// multiple of n: each of the n strata is then cut into whole ones. Else
    /// it may fail; then as many strata as possible hold a point, the empty
    /// ones are spread over the range, and
    /// [`empty_strata`](Augmented::empty_strata) says how many there are.
    ///
    /// # Errors
    /// `points` or `candidates` is 0, N is above 2^53 or does not fit in
    /// memory, or a value is not in [0, 1).
    pub fn of(&self, design: &Design) -> Result<Augmented, LhsError> {
        let (n, dims) = (design.len(), design.dims());
        for (what, found) in [
            ("points to be added", self.points),
            ("candidates", self.candidates),
        ] {
            if found == 0 {
                let valid = "at least 1";
                return Err(LhsError::Argument { what, found, valid });
            }
        }
        let inside = |v: &f64| (0.0..1.0).contains(v);
        if let Some(at) = design.values().iter().position(|v| !inside(v)) {
            return Err(LhsError::NoStratum {
                row: at / dims,
                dim: at % dims,
                value: design.values()[at],
            });
        }
        let total = n.saturating_add(self.points);
        let strata = Strata::new(total)?;
        // Room for all is asked for before any is used.
        drop(zeros(total, dims.max(2))?);
        let free: Vec<Vec<usize>> = (0..dims).map(|j| free_strata(design, j, total)).collect();
        let mut best: Option<(f64, Design)> = None;
        for candidate in 0..self.candidates {
            let made = self.candidate(design, strata, &free, candidate)?;
            if self.candidates == 1 {
                best = Some((0.0, made));
                break;
            }
            let value = centred_discrepancy(&made);
            if best.as_ref().is_none_or(|(least, _)| value < *least) {
                best = Some((value, made));
            }
        }
        let (_, design) = best.ok_or(LhsError::Points { n: 0 })?;
        let empty = |column: &Vec<usize>| column.len() - self.points;
        Ok(Augmented {
            design,
            empty_strata: free.iter().map(empty).collect(),
        })
    }

    fn candidate(
        &self,
        design: &Design,
        strata: Strata,
        free: &[Vec<usize>],
        candidate: usize,
    ) -> Result<Design, LhsError> {
        let (n, dims) = (design.len(), design.dims());
        let mut values = zeros(strata.count(), dims)?;
        let (old, new) = values.split_at_mut(n * dims);
        old.copy_from_slice(design.values());
        for (dim, column) in free.iter().enumerate() {
            let index = (candidate as u64).wrapping_mul(dims as u64) + dim as u64;
            let mut rng = stream(self.seed, Purpose::Augment, index);
            let permutation = Permutation::draw(self.points, &mut rng);
            // One stratum from each of as many equal parts of the free ones.
            let turn = u128::from(rng.next_u64() >> 32);
            for (i, value) in new[dim..].iter_mut().step_by(dims).enumerate() {
                let part = u128::from(permutation.apply(i as u64));
                let share = (part << 32) + turn;
                let at = (share * column.len() as u128 / self.points as u128) >> 32;
                let cell = column[at as usize] as u64;
                *value = match self.placement {
                    Placement::Centred => strata.middle(cell),
                    Placement::Random => strata.point(cell, rng.next_u64()),
                };
            }
        }
        Ok(Design::from_valid(dims, values))
    }
}

/// The strata of `total` that hold no value of column `dim`, rising.
fn free_strata(design: &Design, dim: usize, total: usize) -> Vec<usize> {
    let mut held = vec![false; total];
    for v in design.column(dim) {
        // Values just below 1 may round up to `total`.
        held[((v * total as f64) as usize).min(total - 1)] = true;
    }
    (0..total).filter(|&cell| !held[cell]).collect()
}
