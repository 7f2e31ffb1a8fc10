//! Keyed permutations of [0, n): Step 4 of the paper without a shuffle.
//!
//! A shuffle needs the whole column in memory and one order of work. A keyed
//! bijection gives π(i) for any i alone, so rows can be made anywhere, in any
//! order. Up to [`TABLE_LIMIT`] points a stored Fisher–Yates permutation is
//! used, because there every one of the n! orders should be as likely as the
//! next; above, a Feistel network on the smallest power of two that holds n,
//! walked until it lands inside [0, n) (Black and Rogaway, "Ciphers with
//! arbitrary finite domains", CT-RSA 2002, doi 10.1007/3-540-45760-7_9).

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Largest n for which the permutation is stored, at 4 bytes a number. Below
/// about a thousand points the halves of a Feistel network have so few bits
/// that some keys show (see the theory page); 16 kB a column avoid it.
pub(crate) const TABLE_LIMIT: usize = 4096;

/// Numbers permuted together.
pub(crate) const BLOCK: usize = 128;

/// Feistel rounds. Four suffice for pseudo-random functions (Luby and
/// Rackoff 1988, doi 10.1137/0217022); the round function here is a single
/// multiplication, whose traces in tests of single keys end with the seventh.
const ROUNDS: usize = 8;

/// What a random stream is used for: two purposes never share bits.
#[derive(Clone, Copy)]
pub(crate) enum Purpose {
    Column = 1,
    Optimiser = 2,
    Lattice = 3,
    Augment = 4,
    Sliced = 5,
    Orthogonal = 6,
    Sobol = 7,
    Halton = 8,
}

/// The random stream of (`seed`, `purpose`, `index`). ChaCha8 is fixed by its
/// definition, so these bits never change with a library version.
pub(crate) fn stream(seed: u64, purpose: Purpose, index: u64) -> ChaCha8Rng {
    let mut key = [0_u8; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&(purpose as u64).to_le_bytes());
    let mut rng = ChaCha8Rng::from_seed(key);
    rng.set_stream(index);
    rng
}

/// A uniform integer in [0, bound), `bound` ≥ 1, without bias (Lemire 2019,
/// doi 10.1145/3230636).
pub(crate) fn below(rng: &mut ChaCha8Rng, bound: u64) -> u64 {
    loop {
        let wide = u128::from(rng.next_u64()) * u128::from(bound);
        // Low parts below 2^64 mod bound would favour some results.
        if (wide as u64) >= bound.wrapping_neg() % bound {
            return (wide >> 64) as u64;
        }
    }
}

/// A bijection of [0, n) fixed by its key.
#[derive(Debug, Clone)]
pub(crate) enum Permutation {
    Table(Vec<u32>),
    Feistel(Feistel),
}

impl Permutation {
    /// Draws a permutation of [0, n), 1 ≤ n ≤ 2^53.
    pub(crate) fn draw(n: usize, rng: &mut ChaCha8Rng) -> Self {
        if n > TABLE_LIMIT {
            return Self::Feistel(Feistel::draw(n as u64, rng));
        }
        let mut table: Vec<u32> = (0..n as u32).collect();
        for i in (1..n).rev() {
            table.swap(i, below(rng, i as u64 + 1) as usize);
        }
        Self::Table(table)
    }

    /// π(i) for i in [0, n).
    pub(crate) fn apply(&self, i: u64) -> u64 {
        match self {
            Self::Table(table) => u64::from(table[i as usize]),
            Self::Feistel(feistel) => feistel.apply(i),
        }
    }

    /// π(first), π(first + 1), … into `out`, which has at most [`BLOCK`]
    /// places and does not reach past π(n − 1).
    #[inline(always)]
    pub(crate) fn apply_block(&self, first: u64, out: &mut [u64]) {
        match self {
            Self::Table(table) => {
                for (x, &image) in out.iter_mut().zip(&table[first as usize..]) {
                    *x = u64::from(image);
                }
            }
            Self::Feistel(feistel) => feistel.apply_block(first, out),
        }
    }
}

/// Eight rounds on k bits, 2^(k−1) < n ≤ 2^k, then cycle walking: at most two
/// passes on average, close to one when n is just below a power of two.
#[derive(Debug, Clone)]
pub(crate) struct Feistel {
    n: u64,
    /// The lower half has `low_bits` bits, the upper as many or one fewer, at
    /// most 27 each.
    low_bits: u32,
    low_mask: u64,
    high_mask: u64,
    rounds: [Round; ROUNDS],
}

/// The key of one round.
#[derive(Debug, Clone, Copy)]
struct Round {
    mask: u64,
    multiplier: u64,
}

impl Round {
    fn draw(rng: &mut ChaCha8Rng) -> Self {
        Self {
            mask: rng.next_u64(),
            multiplier: rng.next_u64() | 1,
        }
    }

    /// The middle bits of a product, which every bit of `x` reaches:
    /// multiplicative hashing (Dietzfelbinger et al. 1997, doi
    /// 10.1006/jagm.1997.0873). A fixed shift, because one by a variable
    /// costs as much as the rest together.
    #[inline(always)]
    fn hash(self, x: u64) -> u64 {
        (x ^ self.mask).wrapping_mul(self.multiplier) >> 32
    }
}

impl Feistel {
    fn draw(n: u64, rng: &mut ChaCha8Rng) -> Self {
        let bits = u64::BITS - (n - 1).leading_zeros();
        let low_bits = bits - bits / 2;
        Self {
            n,
            low_bits,
            low_mask: (1 << low_bits) - 1,
            high_mask: (1 << (bits / 2)) - 1,
            rounds: std::array::from_fn(|_| Round::draw(rng)),
        }
    }

    fn apply(&self, i: u64) -> u64 {
        let mut x = self.pass(i);
        // i lies in [0, n), so the cycle through it comes back to [0, n).
        while x >= self.n {
            x = self.pass(x);
        }
        x
    }

    /// As [`apply`](Self::apply) without a branch that depends on a value:
    /// those still outside [0, n) are gathered and walk on.
    #[inline(always)]
    fn apply_block(&self, first: u64, out: &mut [u64]) {
        // Nothing but passes, which vector units do side by side.
        for (x, i) in out.iter_mut().zip(first..) {
            *x = self.pass(i);
        }
        let mut outside = [0_u16; BLOCK];
        let mut count = 0;
        for (at, x) in out.iter().enumerate() {
            outside[count] = at as u16;
            count += usize::from(*x >= self.n);
        }
        while count > 0 {
            let mut left = 0;
            for k in 0..count {
                let at = outside[k];
                let x = &mut out[usize::from(at)];
                *x = self.pass(*x);
                outside[left] = at;
                left += usize::from(*x >= self.n);
            }
            count = left;
        }
    }

    /// One pass over the k bits: each half in turn is masked by a hash of the
    /// other, which can be undone whatever the hash.
    #[inline(always)]
    fn pass(&self, x: u64) -> u64 {
        let mut low = x & self.low_mask;
        let mut high = x >> self.low_bits;
        for pair in self.rounds.chunks_exact(2) {
            high ^= pair[0].hash(low) & self.high_mask;
            low ^= pair[1].hash(high) & self.low_mask;
        }
        high << self.low_bits | low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_bijection(n: usize, seed: u64) -> bool {
        let permutation = Permutation::draw(n, &mut stream(seed, Purpose::Column, 0));
        let mut seen = vec![false; n];
        for i in 0..n as u64 {
            let image = permutation.apply(i) as usize;
            if image >= n || std::mem::replace(&mut seen[image], true) {
                return false;
            }
        }
        true
    }

    #[test]
    fn every_small_domain_is_permuted_exhaustively() {
        for n in (1..=1100).chain(4090..4110) {
            assert!(is_bijection(n, n as u64 ^ 0x5eed), "n = {n}");
        }
        for n in [8191, 8192, 8193, 10_007, 65_535, 65_536, 65_537, 1_000_003] {
            assert!(is_bijection(n, 7), "n = {n}");
        }
    }

    #[test]
    fn blocks_agree_with_single_numbers() {
        for n in [1, 5, 4096, 4097, 5000, 8190, 8192] {
            let permutation = Permutation::draw(n, &mut stream(1, Purpose::Column, 2));
            for first in [0, n / 2, n - 1] {
                let mut block = vec![0; BLOCK.min(n - first)];
                permutation.apply_block(first as u64, &mut block);
                let alone = (first..).take(block.len());
                let alone: Vec<u64> = alone.map(|i| permutation.apply(i as u64)).collect();
                assert_eq!(block, alone, "n = {n} from {first}");
            }
        }
    }

    /// All 6 orders of three points are equally likely: chi-square with 5
    /// degrees of freedom over 6000 keys; 25.7 is its 1e-4 quantile.
    #[test]
    fn small_tables_reach_every_order_evenly() {
        let mut counts = std::collections::BTreeMap::new();
        for seed in 0..6000 {
            let p = Permutation::draw(3, &mut stream(seed, Purpose::Column, 0));
            let order: Vec<u64> = (0..3).map(|i| p.apply(i)).collect();
            *counts.entry(order).or_insert(0.0) += 1.0;
        }
        assert_eq!(counts.len(), 6);
        let chi2: f64 = counts
            .values()
            .map(|c: &f64| (c - 1000.0).powi(2) / 1000.0)
            .sum();
        assert!(chi2 < 25.7, "chi2 = {chi2}");
    }

    /// Over many keys the Feistel network sends neighbours i, i + 1 to pairs
    /// spread over a 16 × 16 grid as a random permutation would. Per n: 255
    /// degrees of freedom, mean 255, standard deviation 22.6; ± 6 of them.
    #[test]
    fn neighbours_are_sent_anywhere() {
        for n in [300_u64, 4097, 5000, 1 << 20, 1_000_000, 1 << 40] {
            let mut counts = [0.0; 256];
            let (keys, pairs) = (400, 128);
            for seed in 0..keys {
                let p = Permutation::draw(n as usize, &mut stream(seed, Purpose::Column, n));
                for t in 0..pairs {
                    let i = t * (n - 1) / pairs;
                    let cell = |x: u64| (u128::from(x) * 16 / u128::from(n)) as usize;
                    counts[16 * cell(p.apply(i)) + cell(p.apply(i + 1))] += 1.0;
                }
            }
            let total = (keys * pairs) as f64;
            let chi2: f64 = (0..256)
                .map(|c| {
                    let expected = total * pair_probability(n, c / 16, c % 16);
                    (counts[c] - expected).powi(2) / expected
                })
                .sum();
            assert!((119.0..391.0).contains(&chi2), "n = {n}: chi2 = {chi2}");
        }
    }

    /// Under single keys too: where π(i) and π(i + t) lie together, and how
    /// far apart, for steps t that change the lower half, the upper half or
    /// both. Chi-square over 256 cells, in standard deviations; as the totals
    /// of rows and columns are fixed, it lies about one below its mean. Four
    /// rounds in place of eight do not pass.
    #[test]
    fn single_keys_leave_no_trace() {
        let deviation = |counts: &[f64; 256]| {
            let expected = counts.iter().sum::<f64>() / 256.0;
            let chi2 = |c: &f64| (c - expected).powi(2) / expected;
            (counts.iter().map(chi2).sum::<f64>() - 255.0) / 510.0_f64.sqrt()
        };
        for (n, half) in [(5000_usize, 7), (65_536, 8)] {
            for seed in 0..20 {
                let p = Permutation::draw(n, &mut stream(seed, Purpose::Column, 3));
                let images: Vec<usize> = (0..n as u64).map(|i| p.apply(i) as usize).collect();
                for t in [1, 2, 1 << (half - 1), 1 << half, 2 << half] {
                    let (mut places, mut gaps) = ([0.0; 256], [0.0; 256]);
                    for (&a, &b) in images.iter().zip(&images[t..]) {
                        places[16 * (a * 16 / n) + b * 16 / n] += 1.0;
                        gaps[(a + n - b) % n * 256 / n] += 1.0;
                    }
                    let (z, y) = (deviation(&places), deviation(&gaps));
                    let seen = format!("n {n} seed {seed} step {t}: {z:.1}, {y:.1}");
                    assert!(z.abs() < 6.5 && y.abs() < 6.5, "{seen}");
                }
            }
        }
    }

    /// Chance that two different points of [0, n) fall into cells a and b.
    fn pair_probability(n: u64, a: usize, b: usize) -> f64 {
        let edge = |k: usize| (k as u128 * u128::from(n)).div_ceil(16) as f64;
        let size = |k: usize| edge(k + 1) - edge(k);
        let others = size(b) - if a == b { 1.0 } else { 0.0 };
        size(a) * others / (n as f64 * (n as f64 - 1.0))
    }
}
