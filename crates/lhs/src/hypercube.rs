//! The random Latin hypercube: Steps 1, 2 and 4 of the paper.

use crate::design::{check_dims, zeros};
use crate::permutation::{BLOCK, Permutation, Purpose, stream};
use crate::stratum::Strata;
use crate::{Design, LhsError};
use rand_chacha::rand_core::Rng;
use rayon::prelude::*;
use std::ops::Range;

/// Rows filled by one task: 1024 rows of a few columns stay in the first
/// cache, and the task outweighs its scheduling.
const ROWS_PER_TASK: usize = 1024;

/// Fewer rows than this are made by the calling thread alone.
const PARALLEL_FROM: usize = 8 * ROWS_PER_TASK;

/// Where in its stratum a point lies: u of Eq. (23).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Placement {
    /// u uniform on (0, 1), drawn for each row and column.
    #[default]
    Random,
    /// u = 1/2, the middle of the stratum.
    Centred,
}

/// A Latin hypercube design of n points in m variables, held as its seed:
/// any row can be computed alone, without memory and without the others.
#[derive(Debug, Clone)]
pub struct LatinHypercube {
    strata: Strata,
    seed: u64,
    placement: Placement,
    columns: Vec<Column>,
}

/// What fixes one column: its permutation, and the key of its jitter.
#[derive(Debug, Clone)]
struct Column {
    permutation: Permutation,
    jitter: u64,
}

impl LatinHypercube {
    /// The design of `n` points in `dims` variables that belongs to `seed`.
    ///
    /// # Errors
    /// `n` is zero or above 2^53 (strata narrower than f64 resolves), or
    /// `dims` is zero or above [`MAX_DIMS`](crate::MAX_DIMS).
    pub fn new(n: usize, dims: usize, seed: u64) -> Result<Self, LhsError> {
        let strata = Strata::new(n)?;
        check_dims(dims)?;
        let column = |dim: usize| {
            let mut rng = stream(seed, Purpose::Column, dim as u64);
            Column {
                jitter: rng.next_u64(),
                permutation: Permutation::draw(n, &mut rng),
            }
        };
        Ok(Self {
            strata,
            seed,
            placement: Placement::Random,
            columns: (0..dims).map(column).collect(),
        })
    }

    /// The same strata and combinations, each point in the middle of its
    /// stratum.
    pub fn centred(self) -> Self {
        self.with_placement(Placement::Centred)
    }

    /// The same strata and combinations with another place of the points in their strata.
    pub fn with_placement(self, placement: Placement) -> Self {
        Self { placement, ..self }
    }

    /// Number of points n.
    pub fn len(&self) -> usize {
        self.strata.count()
    }

    /// Always false: a design has at least one point.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Number of variables m.
    pub fn dims(&self) -> usize {
        self.columns.len()
    }

    /// The seed that the design belongs to.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Where in their strata the points lie.
    pub fn placement(&self) -> Placement {
        self.placement
    }

    /// The stratum, 0 to n − 1, of variable `dim` in row `row`: k − 1 of
    /// Eq. (23) after the random combination of Eq. (26).
    ///
    /// # Errors
    /// [`LhsError::Index`] when `row` ≥ n or `dim` ≥ m.
    pub fn cell(&self, row: usize, dim: usize) -> Result<usize, LhsError> {
        self.check_row(row)?;
        below("dim", dim, self.dims())?;
        Ok(self.columns[dim].permutation.apply(row as u64) as usize)
    }

    /// Writes the m coordinates of row `i`, each in (0, 1), to `out`: the
    /// same bits as row `i` of [`design`](Self::design).
    ///
    /// # Errors
    /// [`LhsError::Index`] when `i` ≥ n or `out` has not m elements; `out` is
    /// left as it is.
    pub fn row(&self, i: usize, out: &mut [f64]) -> Result<(), LhsError> {
        self.check_row(i)?;
        if out.len() != self.dims() {
            return Err(LhsError::Index {
                what: "length of out",
                found: out.len(),
                valid: "the number of variables,",
                limit: self.dims(),
            });
        }
        for (dim, value) in out.iter_mut().enumerate() {
            let cell = self.columns[dim].permutation.apply(i as u64);
            *value = self.place(i, dim, cell as usize);
        }
        Ok(())
    }

    /// The whole design, made by the current rayon pool when it is large.
    /// The bits do not depend on the number of threads.
    ///
    /// # Errors
    /// [`LhsError::Memory`] when n·m values do not fit in memory.
    pub fn design(&self) -> Result<Design, LhsError> {
        let values = zeros(self.len(), self.dims())?;
        Ok(self.filled(0, values))
    }

    /// Rows `rows` of the design, without making the others.
    ///
    /// # Errors
    /// The range is empty, leaves 0..n, or does not fit in memory.
    pub fn shard(&self, rows: Range<usize>) -> Result<Design, LhsError> {
        let Range { start, end } = rows;
        let n = self.len();
        if start >= end || end > n {
            return Err(LhsError::Rows { start, end, n });
        }
        let values = zeros(end - start, self.dims())?;
        Ok(self.filled(start, values))
    }

    fn filled(&self, first: usize, mut values: Vec<f64>) -> Design {
        let dims = self.dims();
        if values.len() / dims < PARALLEL_FROM {
            self.fill(first, &mut values);
        } else {
            values
                .par_chunks_mut(ROWS_PER_TASK * dims)
                .enumerate()
                .for_each(|(task, chunk)| self.fill(first + task * ROWS_PER_TASK, chunk));
        }
        Design::from_valid(dims, values)
    }

    /// Fills whole rows, from row `first` on, with the widest vectors that the
    /// processor has (feature `simd`): nothing is fused, so the bits are the same with any.
    fn fill(&self, first: usize, out: &mut [f64]) {
        let fill = Fill {
            hypercube: self,
            first,
            out,
        };
        #[cfg(feature = "simd")]
        pulp::Arch::new().dispatch(fill);
        #[cfg(not(feature = "simd"))]
        fill.run();
    }

    /// Points of neighbouring rows of a column, from row `first` on, in these cells.
    #[inline(always)]
    fn place_block(&self, jitter: u64, first: u64, cells: &[u64], points: &mut [f64]) {
        let strata = self.strata;
        let bits = |i: usize| counter_hash(jitter, first + i as u64);
        // Chosen outside of the loop: inside, the compiler would use no vector instructions.
        match (self.placement, strata.is_fast()) {
            (Placement::Centred, true) => each(points, cells, |_, c| strata.fast_middle(c)),
            (Placement::Centred, false) => each(points, cells, |_, c| strata.middle(c)),
            (Placement::Random, true) => each(points, cells, |i, c| strata.fast_point(c, bits(i))),
            (Placement::Random, false) => each(points, cells, |i, c| strata.point(c, bits(i))),
        }
    }

    /// A point of stratum `cell`, placed as row `row` of column `dim` is.
    pub(crate) fn place(&self, row: usize, dim: usize, cell: usize) -> f64 {
        match self.placement {
            Placement::Centred => self.strata.middle(cell as u64),
            Placement::Random => {
                let bits = counter_hash(self.columns[dim].jitter, row as u64);
                self.strata.point(cell as u64, bits)
            }
        }
    }

    fn check_row(&self, row: usize) -> Result<(), LhsError> {
        below("row", row, self.len())
    }
}

/// Refuses an index that is not below `limit`.
fn below(what: &'static str, found: usize, limit: usize) -> Result<(), LhsError> {
    if found < limit {
        return Ok(());
    }
    Err(LhsError::Index {
        what,
        found,
        valid: "below",
        limit,
    })
}

#[inline(always)]
fn each(points: &mut [f64], cells: &[u64], place: impl Fn(usize, u64) -> f64) {
    for (i, (point, &cell)) in points.iter_mut().zip(cells).enumerate() {
        *point = place(i, cell);
    }
}

/// Whole rows to be filled, a block of one column at a time.
struct Fill<'a> {
    hypercube: &'a LatinHypercube,
    first: usize,
    out: &'a mut [f64],
}

#[cfg(feature = "simd")]
impl pulp::WithSimd for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.run();
    }
}

impl Fill<'_> {
    #[inline(always)]
    fn run(self) {
        let dims = self.hypercube.dims();
        let (mut cells, mut points) = ([0; BLOCK], [0.0; BLOCK]);
        for (block, rows) in self.out.chunks_mut(BLOCK * dims).enumerate() {
            let first = (self.first + block * BLOCK) as u64;
            let count = rows.len() / dims;
            let (cells, points) = (&mut cells[..count], &mut points[..count]);
            for (dim, column) in self.hypercube.columns.iter().enumerate() {
                column.permutation.apply_block(first, cells);
                (self.hypercube).place_block(column.jitter, first, cells, points);
                for (value, point) in rows[dim..].iter_mut().step_by(dims).zip(&*points) {
                    *value = *point;
                }
            }
        }
    }
}

/// Output number `counter` of the SplitMix64 generator started at `key`
/// (Steele, Lea and Flood 2014, doi 10.1145/2714064.2660195), which can be
/// computed alone.
#[inline(always)]
pub(crate) fn counter_hash(key: u64, counter: u64) -> u64 {
    let mut z = key.wrapping_add(counter.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::counter_hash;

    /// The first outputs of SplitMix64 from state 1234567, as published with
    /// the generator's reference implementation.
    #[test]
    fn jitter_is_splitmix64() {
        let expected = [
            6_457_827_717_110_365_317_u64,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        for (counter, value) in expected.into_iter().enumerate() {
            assert_eq!(counter_hash(1_234_567, counter as u64), value);
        }
    }
}
