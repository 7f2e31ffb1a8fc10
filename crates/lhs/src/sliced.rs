//! Sliced Latin hypercubes: designs that are Latin as a whole and in parts.

use crate::design::{check_dims, zeros};
use crate::permutation::{Permutation, Purpose, below, stream};
use crate::stratum::Strata;
use crate::{Design, LhsError, Placement};
use rand_chacha::rand_core::Rng;

/// The shape of a sliced Latin hypercube: `slices` × `points` points.
///
/// Of use where the parts are run on different machines or models, or at
/// different levels of a categorical variable; and, taking the first slice
/// alone, as a nested design: few points for an expensive model within many
/// for a cheap one (Qian 2009, doi 10.1093/biomet/asp045).
///
/// ```
/// use lhs::{Placement, SlicedHypercube};
///
/// let shape = SlicedHypercube { slices: 3, points: 8, dims: 2, placement: Placement::Centred, seed: 1 };
/// let made = shape.design()?;
/// assert_eq!(made.design.len(), 24);
/// assert_eq!(made.slice(2).map(|slice| slice.len()), Some(8));
/// # Ok::<(), lhs::LhsError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SlicedHypercube {
    /// Slices t, at least 1.
    pub slices: usize,
    /// Points of a slice, at least 1.
    pub points: usize,
    /// Variables m, 1 to [`MAX_DIMS`](crate::MAX_DIMS).
    pub dims: usize,
    /// Where in their strata the points lie.
    pub placement: Placement,
    /// Seed of the design.
    pub seed: u64,
}

/// A sliced design.
#[derive(Debug, Clone, PartialEq)]
pub struct Sliced {
    /// All points, slice after slice.
    pub design: Design,
    /// Points of a slice.
    pub points: usize,
}

impl Sliced {
    /// Slice `t`, a Latin hypercube of its own; none when there is no such
    /// slice.
    pub fn slice(&self, t: usize) -> Option<Design> {
        let dims = self.design.dims();
        let len = self.points.checked_mul(dims)?;
        let start = t.checked_mul(len)?;
        let values = self.design.values().get(start..start.checked_add(len)?)?;
        Some(Design::from_valid(dims, values.to_vec()))
    }
}

impl SlicedHypercube {
    /// The design, by the construction of Qian 2012, doi
    /// 10.1080/01621459.2011.644132: each of the `points` coarse strata of a
    /// column is cut into as many fine ones as there are slices, which are
    /// dealt out to the slices at random; within a slice the coarse strata are
    /// combined at random. So the whole is Latin in `slices`·`points` strata
    /// and each slice in `points`.
    ///
    /// # Errors
    /// A number is 0, the points are more than 2^53, the variables more than
    /// [`MAX_DIMS`](crate::MAX_DIMS), or all do not fit in memory.
    pub fn design(&self) -> Result<Sliced, LhsError> {
        let (slices, points, dims) = (self.slices, self.points, self.dims);
        check_dims(dims)?;
        for (what, found) in [("slices", slices), ("points of a slice", points)] {
            if found == 0 {
                let valid = "at least 1";
                return Err(LhsError::Argument { what, found, valid });
            }
        }
        let strata = Strata::new(slices.saturating_mul(points))?;
        let mut values = zeros(strata.count(), dims)?;
        for dim in 0..dims {
            let mut rng = stream(self.seed, Purpose::Sliced, dim as u64);
            let mut dealt = Dealer::new(strata.count(), slices)?;
            dealt.deal(&mut rng);
            for (t, slice) in values.chunks_exact_mut(points * dims).enumerate() {
                let order = Permutation::draw(points, &mut rng);
                for (i, value) in slice[dim..].iter_mut().step_by(dims).enumerate() {
                    let coarse = order.apply(i as u64) as usize;
                    let cell = (coarse * slices + dealt.fine(coarse, t)) as u64;
                    *value = match self.placement {
                        Placement::Centred => strata.middle(cell),
                        Placement::Random => strata.point(cell, rng.next_u64()),
                    };
                }
            }
        }
        let design = Design::from_valid(dims, values);
        Ok(Sliced { design, points })
    }
}

/// For each coarse stratum, a random order of its fine ones.
struct Dealer {
    slices: usize,
    fine: Vec<usize>,
}

impl Dealer {
    fn new(count: usize, slices: usize) -> Result<Self, LhsError> {
        let mut fine = Vec::new();
        let refused = |_| LhsError::Memory {
            rows: count,
            dims: 1,
        };
        fine.try_reserve_exact(count).map_err(refused)?;
        fine.extend((0..count).map(|k| k % slices));
        Ok(Self { slices, fine })
    }

    fn deal(&mut self, rng: &mut rand_chacha::ChaCha8Rng) {
        for block in self.fine.chunks_exact_mut(self.slices) {
            for i in (1..block.len()).rev() {
                block.swap(i, below(rng, i as u64 + 1) as usize);
            }
        }
    }

    fn fine(&self, coarse: usize, slice: usize) -> usize {
        self.fine[coarse * self.slices + slice]
    }
}
