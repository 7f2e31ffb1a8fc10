//! What exchanges change in Σ d⁻ᵖ, the sum behind φ_p.

use super::{MAXIMIN_P, Objective};
use crate::Design;
use crate::permutation::below;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use rayon::prelude::*;

/// Points pushing each other away with energy (s/d)²⁰, s = n^(−1/m) being
/// the spacing of a regular grid; columns are kept one after the other.
pub(super) struct Repulsion {
    n: usize,
    /// Coordinates divided by s, column after column.
    columns: Vec<f64>,
    spacing: f64,
    /// Energy of each point with all others.
    energies: Vec<f64>,
    /// Half their sum: each pair once.
    sum: f64,
    /// When the energies were last summed afresh: what `sum` was, and the
    /// exchanges since.
    fresh: (f64, usize),
    /// Work space, one value for each point.
    first: Vec<f64>,
    second: Vec<f64>,
    terms: Vec<f64>,
}

/// Coincident points would have infinite energy, and ∞ − ∞ is no change: d²
/// is not taken below this share of s².
const LEAST: f64 = 1e-12;

/// (d/s)²⁰ from u = (d/s)²: the reciprocal of the energy.
#[inline]
fn inverse_energy(u: f64) -> f64 {
    let u = if u > LEAST { u } else { LEAST };
    let u2 = u * u;
    let u4 = u2 * u2;
    u4 * u4 * u2
}

/// The sum of two energies, with one division.
#[inline]
fn energy_of_two(u: f64, v: f64) -> f64 {
    let (a, b) = (inverse_energy(u), inverse_energy(v));
    (a + b) / (a * b)
}

/// A sum in eight interleaved parts, so that additions need not wait for each
/// other; the order depends on the length alone.
fn sum(terms: &[f64]) -> f64 {
    let mut lanes = [0.0; 8];
    let chunks = terms.chunks_exact(8);
    let rest: f64 = chunks.remainder().iter().sum();
    for chunk in chunks {
        for (lane, term) in lanes.iter_mut().zip(chunk) {
            *lane += term;
        }
    }
    lanes.iter().sum::<f64>() + rest
}

impl Repulsion {
    pub(super) fn new(design: &Design) -> Self {
        let (n, dims) = (design.len(), design.dims());
        let spacing = libm::pow(n as f64, -1.0 / dims as f64);
        let scaled = |dim| design.column(dim).map(move |x| x / spacing);
        let mut repulsion = Self {
            n,
            columns: (0..dims).flat_map(scaled).collect(),
            spacing,
            energies: vec![0.0; n],
            sum: 0.0,
            fresh: (0.0, 0),
            first: vec![0.0; n],
            second: vec![0.0; n],
            terms: vec![0.0; n],
        };
        repulsion.refresh();
        repulsion
    }

    /// Sums all energies afresh, O(n² m).
    fn refresh(&mut self) {
        // Each sum on one thread, in one order: the same bits on any number.
        self.energies = (0..self.n)
            .into_par_iter()
            .map_init(
                || vec![0.0; self.n],
                |work, i| {
                    self.energies_with(i, work);
                    sum(work)
                },
            )
            .collect();
        self.sum = 0.5 * sum(&self.energies);
        self.fresh = (self.sum, 0);
    }

    /// Squared distance of each point from point `i`, in s².
    fn distances_from(&self, i: usize, out: &mut [f64]) {
        out.fill(0.0);
        for column in self.columns.chunks_exact(self.n) {
            let own = column[i];
            for (d2, x) in out.iter_mut().zip(column) {
                *d2 += (own - x) * (own - x);
            }
        }
    }

    /// Energy of each point with point `i`, zero for `i` itself.
    fn energies_with(&self, i: usize, out: &mut [f64]) {
        self.distances_from(i, out);
        for d2 in out.iter_mut() {
            *d2 = 1.0 / inverse_energy(*d2);
        }
        out[i] = 0.0;
    }

    /// Adds `sign` times the energies with point `i` to those of the others,
    /// and returns their sum.
    fn spread(&mut self, i: usize, sign: f64) -> f64 {
        let mut with = std::mem::take(&mut self.terms);
        self.energies_with(i, &mut with);
        for (energy, e) in self.energies.iter_mut().zip(&with) {
            *energy += sign * e;
        }
        let total = sum(&with);
        self.terms = with;
        total
    }
}

impl Objective for Repulsion {
    fn changes(&mut self, i: usize, j: usize, out: &mut [f64]) {
        let mut first = std::mem::take(&mut self.first);
        let mut second = std::mem::take(&mut self.second);
        self.distances_from(i, &mut first);
        self.distances_from(j, &mut second);
        for (column, change) in self.columns.chunks_exact(self.n).zip(out) {
            let (own_i, own_j) = (column[i], column[j]);
            let pairs = first.iter().zip(&second).zip(column);
            for (term, ((&u, &v), x)) in self.terms.iter_mut().zip(pairs) {
                let shift = (own_j - x) * (own_j - x) - (own_i - x) * (own_i - x);
                *term = energy_of_two(u + shift, v - shift) - energy_of_two(u, v);
            }
            // The distance between i and j themselves does not change.
            self.terms[i] = 0.0;
            self.terms[j] = 0.0;
            *change = sum(&self.terms);
        }
        self.first = first;
        self.second = second;
    }

    fn exchange(&mut self, i: usize, j: usize, dim: usize, _: f64) {
        for point in [i, j] {
            self.spread(point, -1.0);
        }
        self.columns.swap(dim * self.n + i, dim * self.n + j);
        let own = [i, j].map(|point| self.spread(point, 1.0));
        self.energies[i] = own[0];
        self.energies[j] = own[1];
        self.sum = 0.5 * sum(&self.energies);
        self.fresh.1 += 1;
        // Close points have energies like 10^30, which leave their rounding
        // behind when they part: not to be carried into much smaller sums.
        if self.sum < 1e-4 * self.fresh.0 || self.fresh.1 >= self.n {
            self.refresh();
        }
    }

    fn sum(&self) -> f64 {
        self.sum
    }

    fn criterion(&self, sum: f64) -> f64 {
        libm::pow(sum.max(0.0), 1.0 / MAXIMIN_P) / self.spacing
    }

    /// The point of most energy among 1, 2, 4, … randomly chosen ones: from a
    /// point at random to nearly the closest pair.
    fn pick(&self, rng: &mut ChaCha8Rng) -> usize {
        let doublings = self.n.ilog2() + 1;
        let contenders = 1_u64 << below(rng, u64::from(doublings));
        let mut best = below(rng, self.n as u64) as usize;
        for _ in 1..contenders {
            // Quick and biased by under n/2^32, which only steers the search.
            let i = (((rng.next_u64() >> 32) * self.n as u64) >> 32) as usize;
            if self.energies[i] > self.energies[best] {
                best = i;
            }
        }
        best
    }
}
