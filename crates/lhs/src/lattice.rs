//! Latin hypercubes from rank-1 lattices: a start that random exchanges would
//! take long to reach.
//!
//! The points i·(1, a, a², …)/N mod 1, i = 0 to N − 1, hit every stratum of
//! every axis once when a and N share no divisor (Korobov 1959; Sloan and
//! Joe, "Lattice Methods for Multiple Integration", 1994): they are a Latin
//! hypercube with the random combination of Step 4 replaced by a regular one.
//! N is n, or n + 1 with one point left out and the strata above it moved
//! down, which often has better a (Fang and Wang, "Number-Theoretic Methods
//! in Statistics", 1994).

use crate::design::zeros;
use crate::permutation::{Permutation, Purpose, below, stream};
use crate::power::power;
use crate::{Criterion, Design, LatinHypercube, LhsError};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Generators are tried until about this many coordinates have been looked at.
const EFFORT: usize = 20_000_000;

/// Fewest generators tried for each N, however large the design.
const FEWEST: usize = 4;

/// One lattice: its size N and the a of its generator.
#[derive(Clone, Copy)]
struct Generator {
    size: usize,
    a: usize,
}

impl LatinHypercube {
    /// A Latin hypercube of this n, m, seed and placement whose combination
    /// is that of a good lattice: the a that is best for `criterion` among
    /// all, or among as many random ones as can be tried in about 2·10⁷
    /// operations; then moved round the torus by a random whole number of
    /// strata in each column, and its rows shuffled.
    ///
    /// For [`Criterion::CentredDiscrepancy`] the best a is that of the least
    /// CD² averaged over such moves, for [`Criterion::Maximin`] that of the
    /// greatest distance on the torus.
    ///
    /// # Errors
    /// As for [`design`](Self::design).
    pub fn lattice(&self, criterion: Criterion) -> Result<Design, LhsError> {
        let (n, dims) = (self.len(), self.dims());
        let mut values = zeros(n, dims)?;
        let mut rng = stream(self.seed(), Purpose::Lattice, 0);
        let best = best_generator(n, dims, criterion, &mut rng);
        let order = Permutation::draw(n, &mut rng);
        let mut step = 1;
        for dim in 0..dims {
            let shift = below(&mut rng, best.size as u64) as usize;
            let at = |i: usize| multiply(i, step, best.size, shift);
            // Only N = n + 1 leaves a point out, the last.
            let left_out = if best.size > n { at(n) } else { n };
            for (i, cell) in (0..n).map(|i| (i, at(i))) {
                let row = order.apply(i as u64) as usize;
                let cell = cell - usize::from(cell > left_out);
                values[row * dims + dim] = self.place(row, dim, cell);
            }
            step = multiply(step, best.a, best.size, 0);
        }
        Ok(Design::from_valid(dims, values))
    }
}

/// (x·y + z) mod `size`, without overflow.
fn multiply(x: usize, y: usize, size: usize, z: usize) -> usize {
    ((x as u128 * y as u128 + z as u128) % size as u128) as usize
}

fn best_generator(n: usize, dims: usize, criterion: Criterion, rng: &mut ChaCha8Rng) -> Generator {
    let generators: Vec<Generator> = [n, n + 1]
        .into_iter()
        .flat_map(|size| candidates(size, EFFORT / (size * dims), rng))
        .collect();
    let scores: Vec<f64> = match criterion {
        Criterion::CentredDiscrepancy => scored(&generators, |g| mean_discrepancy(g, dims)),
        Criterion::Maximin => scored(&generators, |g| -torus_distance(g, dims)),
    };
    // The first of the best, whichever thread scored it.
    let first = (generators[0], f64::INFINITY);
    let lower = |best: (Generator, f64), next: (Generator, f64)| {
        if next.1 < best.1 { next } else { best }
    };
    generators.into_iter().zip(scores).fold(first, lower).0
}

fn scored(generators: &[Generator], score: impl Fn(Generator) -> f64 + Sync) -> Vec<f64> {
    generators.par_iter().map(|&g| score(g)).collect()
}

/// The a up to N/2 without a divisor in common with N (N − a mirrors a), or
/// about `most` random ones of them. Never empty: 1 is always in.
fn candidates(size: usize, most: usize, rng: &mut ChaCha8Rng) -> Vec<Generator> {
    let coprime = |a: &usize| gcd(*a, size) == 1;
    let generator = |a| Generator { size, a };
    let (half, most) = (size / 2, most.max(FEWEST));
    let rest: Vec<usize> = if half <= most {
        (2..=half).filter(coprime).collect()
    } else {
        // The coprime share is at least 0.15 for any N up to 2^53 (the worst
        // is the product of the primes to 41), so these are `most` or nearly.
        (0..6 * most)
            .map(|_| 2 + below(rng, half as u64 - 1) as usize)
            .filter(coprime)
            .take(most)
            .collect()
    };
    std::iter::once(1).chain(rest).map(generator).collect()
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Calls `visit` with the residues i·aʲ mod N of the points i = 1 to N/2; the
/// others mirror them.
fn for_each_point(g: Generator, dims: usize, mut visit: impl FnMut(&[usize])) {
    let mut steps = vec![1 % g.size; dims];
    for dim in 1..dims {
        steps[dim] = multiply(steps[dim - 1], g.a, g.size, 0);
    }
    let mut residues = vec![0; dims];
    for _ in 1..=g.size / 2 {
        for (residue, step) in residues.iter_mut().zip(&steps) {
            *residue += step;
            if *residue >= g.size {
                *residue -= g.size;
            }
        }
        visit(&residues);
    }
}

/// CD² averaged over all moves round the torus. With t the distance in one
/// axis, the average of the factor ½|x| + … of CD² over a common move of both
/// points is 5/4 − t(1 − t); so the mean is
/// −(13/12)^m + (1/N) Σᵢ Πⱼ (5/4 − tᵢⱼ(1 − tᵢⱼ)).
fn mean_discrepancy(g: Generator, dims: usize) -> f64 {
    let width = 1.0 / g.size as f64;
    let factor = |r: usize| {
        let t = r as f64 * width;
        1.25 - t * (1.0 - t)
    };
    let product = |residues: &[usize]| residues.iter().map(|&r| factor(r)).product::<f64>();
    let (mut sum, mut last) = (0.0, 0.0);
    for_each_point(g, dims, |residues| {
        last = product(residues);
        sum += 2.0 * last;
    });
    // The point N/2 of an even N is its own mirror image.
    if g.size.is_multiple_of(2) {
        sum -= last;
    }
    (sum + product(&vec![0; dims])) * width - power(13.0 / 12.0, dims)
}

/// The least squared distance between two points on the torus, in strata².
fn torus_distance(g: Generator, dims: usize) -> f64 {
    let mut least = f64::INFINITY;
    for_each_point(g, dims, |residues| {
        let near = |&r: &usize| {
            let gap = r.min(g.size - r) as f64;
            gap * gap
        };
        least = least.min(residues.iter().map(near).sum());
    });
    least
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::criteria::centred_discrepancy;

    /// The formula against CD² averaged over all moves by whole strata of a
    /// small centred lattice. Those moves are a trapezoidal average over the
    /// torus, so the two differ by a few times 1/(12 N²).
    #[test]
    fn mean_discrepancy_is_the_mean() {
        for (size, a) in [(13, 5), (16, 5)] {
            let g = Generator { size, a };
            let mut sum = 0.0;
            for shift in 0..size * size {
                let middle = |c: usize| (c as f64 + 0.5) / size as f64;
                let point = |i| {
                    let x = multiply(i, 1, size, shift / size);
                    [middle(x), middle(multiply(i, a, size, shift % size))]
                };
                let values = (0..size).flat_map(point).collect();
                sum += centred_discrepancy(&Design::from_valid(2, values));
            }
            let (mean, formula) = (sum / (size * size) as f64, mean_discrepancy(g, 2));
            let rest = 1.0 / (12.0 * (size * size) as f64);
            assert!((mean - formula).abs() < 3.0 * rest, "{mean} {formula}");
            assert!(
                formula > 3.0 * rest,
                "the check must be finer than the value"
            );
        }
    }

    /// i·(1, 5) mod 13: the nearest to the origin are (1, 5), (2, −3), (3, 2)
    /// and their turns: 4 + 9.
    #[test]
    fn torus_distance_of_a_known_lattice() {
        let g = Generator { size: 13, a: 5 };
        assert_eq!(torus_distance(g, 2), 13.0);
    }
}
