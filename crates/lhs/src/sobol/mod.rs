//! Sobol's sequence, plain and scrambled.

use crate::design::check_dims;
use crate::hypercube::counter_hash;
use crate::permutation::{Purpose, stream};
use crate::sequence::{GRID, MOST, Sequence};
use crate::{Design, LhsError};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use std::ops::Range;

/// Binary digits of a coordinate: those of an f64 in [½, 1).
const DIGITS: usize = 53;

/// Direction numbers of dimensions 2 to 1024, with their source and licence.
const JOE_KUO: &str = include_str!("joe_kuo.txt");

/// How the digits of a [`Sobol`] sequence are made random. Either keeps what is even about
/// the points, makes each coordinate uniform over the seeds, and with that a mean over the
/// points an estimate without bias.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Scrambling {
    /// Each digit is flipped at random, by all digits before it (Owen 1995, doi
    /// 10.1007/978-1-4612-2552-2_19). For smooth functions the variance of the mean falls as
    /// n⁻³ (log n)^(m − 1) (Owen 1997, doi 10.1214/aos/1031594731).
    Owen,
    /// A random lower triangular matrix over the digits, and a digital shift (Matoušek 1998,
    /// doi 10.1006/jcom.1998.0489). The same variance of a mean as [`Owen`](Self::Owen) (Owen
    /// 2003, doi 10.1145/945511.945518), made more than ten times as fast.
    LinearMatrix,
}

/// Sobol's sequence (1967, doi 10.1016/0041-5553(67)90144-9) in up to 1024 variables, with the
/// direction numbers of Joe and Kuo (2008, doi 10.1137/070709359), in the order of the Gray code
/// (Antonov and Saleev 1979, doi 10.1016/0041-5553(79)90085-5).
///
/// Each 2ᵏ points from a multiple of 2ᵏ on are a Latin hypercube to k binary digits, and even in
/// several variables together. Take a power of two of them, and do not leave out the first: both
/// lose what makes the points good (Owen 2020, arXiv 2008.08051).
///
/// ```
/// use lhs::{Scrambling, Sobol};
///
/// // The mean of x·y is ¼.
/// let mean = |points: &lhs::Design| points.rows().map(|x| x[0] * x[1]).sum::<f64>() / points.len() as f64;
/// let points = Sobol::scrambled(2, Scrambling::Owen, 7)?.design(1024)?;
/// assert!((mean(&points) - 0.25).abs() < 1e-4);
/// // More points later, without those that are there.
/// let more = Sobol::scrambled(2, Scrambling::Owen, 7)?.shard(1024..2048)?;
/// assert_eq!(more.len(), 1024);
/// # Ok::<(), lhs::LhsError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Sobol {
    columns: Vec<Column>,
    /// Whether the digits are scrambled, so that no coordinate may be 0.
    random: bool,
}

#[derive(Debug, Clone)]
struct Column {
    /// v₁ to v₅₃, the first binary digit at bit 52.
    directions: [u64; DIGITS],
    shift: u64,
    /// Key of Owen's flips.
    owen: Option<u64>,
}

impl Sobol {
    /// The plain sequence in `dims` variables. Its first point is 0 in all of them, which a
    /// marginal without a lower end does not take.
    ///
    /// # Errors
    /// `dims` is zero or above [`MAX_DIMS`](crate::MAX_DIMS).
    pub fn new(dims: usize) -> Result<Self, LhsError> {
        check_dims(dims)?;
        let columns = directions().take(dims).map(|directions| Column {
            directions,
            shift: 0,
            owen: None,
        });
        Ok(Self {
            columns: columns.collect(),
            random: false,
        })
    }

    /// The sequence in `dims` variables with its digits scrambled by `seed`: each coordinate in
    /// (0, 1).
    ///
    /// # Errors
    /// `dims` is zero or above [`MAX_DIMS`](crate::MAX_DIMS).
    pub fn scrambled(dims: usize, scrambling: Scrambling, seed: u64) -> Result<Self, LhsError> {
        let mut sobol = Self::new(dims)?;
        sobol.random = true;
        for (dim, column) in sobol.columns.iter_mut().enumerate() {
            let mut rng = stream(seed, Purpose::Sobol, dim as u64);
            match scrambling {
                Scrambling::Owen => column.owen = Some(rng.next_u64()),
                Scrambling::LinearMatrix => column.multiply(&mut rng),
            }
        }
        Ok(sobol)
    }

    /// Number of variables m.
    pub fn dims(&self) -> usize {
        self.columns.len()
    }

    /// Writes the m coordinates of point `i` to `out`: the same bits as in
    /// [`shard`](Self::shard).
    ///
    /// # Errors
    /// `i` is 2⁵³ or above, or `out` has not m elements; `out` is left as it is.
    pub fn row(&self, i: u64, out: &mut [f64]) -> Result<(), LhsError> {
        self.point(i, out)
    }

    /// The first `n` points.
    ///
    /// # Errors
    /// `n` is zero or above 2⁵³, or the points do not fit in memory.
    pub fn design(&self, n: u64) -> Result<Design, LhsError> {
        self.points(0..n)
    }

    /// Points `rows` of the sequence, without making the others.
    ///
    /// # Errors
    /// The range is empty, leaves 0..2⁵³, or does not fit in memory.
    pub fn shard(&self, rows: Range<u64>) -> Result<Design, LhsError> {
        self.points(rows)
    }
}

impl Sequence for Sobol {
    fn dims(&self) -> usize {
        self.columns.len()
    }

    fn coordinate(&self, i: u64, dim: usize) -> f64 {
        let column = &self.columns[dim];
        self.value(column, column.digits(i))
    }

    /// From one point to the next one digit of the Gray code changes.
    fn run<'a>(&self, first: u64, dim: usize, out: impl Iterator<Item = &'a mut f64>) {
        let column = &self.columns[dim];
        let mut digits = column.digits(first);
        for (next, value) in (first + 1..).zip(out) {
            *value = self.value(column, digits);
            // Bit 53 changes behind the last point of all.
            digits ^= column.directions[(next.trailing_zeros() as usize).min(DIGITS - 1)];
        }
    }
}

impl Sobol {
    fn value(&self, column: &Column, digits: u64) -> f64 {
        let digits = match column.owen {
            Some(key) => nested(key, digits),
            None => digits,
        };
        // An inverse CDF may be infinite at 0, so a random point steps over 0 itself.
        if digits == 0 && self.random {
            0.5 * GRID
        } else {
            digits as f64 * GRID
        }
    }
}

impl Column {
    /// The digits of point `i` before Owen's flips: the sum over the digits of its Gray code.
    fn digits(&self, i: u64) -> u64 {
        let mut gray = i ^ (i >> 1);
        let mut digits = self.shift;
        while gray != 0 {
            digits ^= self.directions[gray.trailing_zeros() as usize];
            gray &= gray - 1;
        }
        digits
    }

    /// Multiplies the directions by a random lower triangular matrix with ones on its diagonal,
    /// over the field of two elements, and draws a shift.
    fn multiply(&mut self, rng: &mut ChaCha8Rng) {
        let plain = self.directions;
        self.directions = [0; DIGITS];
        for bit in (0..DIGITS).rev() {
            // Digits before this one are the bits above it.
            let above = rng.next_u64() & (MOST - 1) & !((2 << bit) - 1);
            let row = above | (1 << bit);
            for (scrambled, v) in self.directions.iter_mut().zip(plain) {
                *scrambled |= u64::from((row & v).count_ones() & 1) << bit;
            }
        }
        self.shift = rng.next_u64() & (MOST - 1);
    }
}

/// Owen's scrambling of binary digits: the flip of a digit is a hash of its node in the tree of
/// all digits before it.
fn nested(key: u64, digits: u64) -> u64 {
    (0..DIGITS as u32).fold(digits, |scrambled, depth| {
        let below = DIGITS as u32 - depth;
        let node = (1 << depth) | (digits >> below);
        scrambled ^ ((counter_hash(key, node) >> 63) << (below - 1))
    })
}

/// Direction numbers v₁ to v₅₃ of one dimension after another.
fn directions() -> impl Iterator<Item = [u64; DIGITS]> {
    // The first dimension is van der Corput's sequence: every m is 1.
    let first = std::array::from_fn(|k| 1 << (DIGITS - 1 - k));
    let lines = JOE_KUO.lines().filter(|line| !line.starts_with('#'));
    std::iter::once(first).chain(lines.map(|line| {
        let mut numbers = line.split(' ').map(|number| number.parse().unwrap_or(0));
        let a = numbers.next().unwrap_or(0);
        recurrence(a, numbers)
    }))
}

/// v_k = a₁v_(k−1) ⊕ … ⊕ a_(s−1)v_(k−s+1) ⊕ v_(k−s) ⊕ v_(k−s)/2ˢ (Bratley and Fox 1988, doi
/// 10.1145/42288.214372, Section 2), from v_k = m_k/2ᵏ for k up to s.
fn recurrence(a: u64, initial: impl Iterator<Item = u64>) -> [u64; DIGITS] {
    let mut v = [0; DIGITS];
    let mut s = 0;
    for m in initial {
        v[s] = m << (DIGITS - 1 - s);
        s += 1;
    }
    for k in s..DIGITS {
        let oldest = v[k - s];
        v[k] = (1..s).fold(oldest ^ (oldest >> s), |sum, j| {
            sum ^ (((a >> (s - 1 - j)) & 1) * v[k - j])
        });
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The file is whole: each line has a degree s ≥ 1, odd m_k < 2ᵏ, and a < 2^(s − 1); no
    /// polynomial comes twice, and degrees do not fall.
    #[test]
    fn direction_numbers_are_valid() {
        assert_eq!(directions().count(), crate::MAX_DIMS);
        let mut before = (0, 0);
        for line in JOE_KUO.lines().filter(|line| !line.starts_with('#')) {
            let numbers: Vec<u64> = line.split(' ').map(|n| n.parse().unwrap()).collect();
            let (a, m) = numbers.split_first().unwrap();
            assert!(!m.is_empty() && *a < 1 << (m.len() - 1), "{line}");
            assert!((m.len(), *a) > before || before.0 == 0, "{line}");
            before = (m.len(), *a);
            for (k, m) in m.iter().enumerate() {
                assert!(m % 2 == 1 && *m < 2 << k, "{line}");
            }
        }
    }
}
