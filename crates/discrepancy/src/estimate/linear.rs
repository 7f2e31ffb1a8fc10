//! The linearised model, and D at its minimum without the bins.
//!
//! With columns c_i the residual is r − Σ x_i c_i, and the spectral matrix of a band
//! Σ y_i y_j P_ij / n with y = (1, −x) and P_ij = Σ c_i c_jᴴ summed over its bins
//! once. D = 2 Σ n log det S is concave in S: least squares weighed by the last S
//! lowers it in every round. The fall of D of effects whose answer grows with their
//! size came out within a third of that of their simulation, of a force in time within
//! a fifth.

use std::ops::Range;

use axis_sim::Axis;
use nalgebra::{Complex, DMatrix, DVector};
use rayon::prelude::*;

use crate::estimate::bounded::bounded;
use crate::estimate::known::{known_deviations, tolerances};
use crate::spectrum::{Amplitudes, Layout, deviance_of, regular};

type C64 = Complex<f64>;

/// Rounds of reweighing at most.
const ROUNDS: usize = 8;

/// Moves of all unknowns, in their standard deviations, below which it ends.
const STILL: f64 = 0.1;

/// Products between columns and channels, band by band.
pub struct Products {
    channels: usize,
    columns: usize,
    values: Vec<f64>,
    /// Variances by which simulations may be off.
    inexact: Vec<f64>,
    /// Block (i, j), by columns, at (i · columns + j) · channels².
    bands: Vec<Vec<C64>>,
}

impl Products {
    /// Of all these columns, the residual first.
    pub fn new(layout: &Layout, columns: &[&Amplitudes]) -> Self {
        let (m, n) = (layout.channels(), columns.len());
        let band = |(b, &count): (usize, &usize)| {
            let mut re = DMatrix::<f64>::zeros(count, n * m);
            let mut im = re.clone();
            for (c, column) in columns.iter().enumerate() {
                for (row, bin) in layout.bins_of(b, column).enumerate() {
                    for (i, value) in bin.iter().enumerate() {
                        re[(row, c * m + i)] = value.re;
                        im[(row, c * m + i)] = value.im;
                    }
                }
            }
            let real = re.transpose() * &re + im.transpose() * &im;
            let cross = im.transpose() * &re;
            let mut blocks = Vec::with_capacity(n * n * m * m);
            for i in 0..n {
                for j in 0..n {
                    for q in 0..m {
                        for p in 0..m {
                            let (row, column) = (i * m + p, j * m + q);
                            let imaginary = cross[(row, column)] - cross[(column, row)];
                            blocks.push(C64::new(real[(row, column)], imaginary));
                        }
                    }
                }
            }
            blocks
        };
        Self {
            channels: m,
            columns: n,
            values: layout.values().to_vec(),
            inexact: layout.inexactness().to_vec(),
            bands: (layout.counts().par_iter().enumerate().map(band)).collect(),
        }
    }

    fn block(&self, band: usize, i: usize, j: usize) -> &[C64] {
        let size = self.channels * self.channels;
        let at = (i * self.columns + j) * size;
        &self.bands[band][at..at + size]
    }
}

/// Least and most that a column may count, where it has bounds.
pub type Room = Option<[f64; 2]>;

/// A fit of the residual by some of the columns.
pub struct Problem<'a> {
    products: &'a Products,
    /// Columns: the residual, those of known parameters, others.
    places: Vec<usize>,
    /// Of the sum of some others, which is the last column: its blocks with all
    /// before it and with itself.
    sum: Vec<Vec<C64>>,
    /// Of the last columns.
    rooms: Vec<Room>,
    /// Of the known parameters.
    shares: &'a [f64],
    tolerances: Vec<f64>,
    /// Of a departure of theirs.
    weights: Vec<f64>,
}

/// Weights of the known parameters' departures.
fn weights(machine: &Axis) -> Vec<f64> {
    let deviations = known_deviations(machine).into_iter();
    deviations.map(|deviation| deviation.powi(-2)).collect()
}

/// Where D is least.
pub struct Minimum {
    /// D, with the departures of known parameters.
    pub deviance: f64,
    /// Of the columns.
    pub x: DVector<f64>,
}

impl<'a> Problem<'a> {
    /// Of these columns: the residual, those of the known parameters, which are at
    /// `shares` now, and others, of which the last have these bounds.
    pub fn new(
        machine: &Axis,
        products: &'a Products,
        places: Vec<usize>,
        rooms: Vec<Room>,
        shares: &'a [f64],
    ) -> Self {
        Self {
            products,
            places,
            sum: Vec::new(),
            rooms,
            shares,
            tolerances: tolerances(machine),
            weights: weights(machine),
        }
    }

    /// With one column more, the sum of these.
    pub fn with_sum(self, summed: Range<usize>) -> Self {
        let size = self.products.channels * self.products.channels;
        let kept = self.places.len();
        let blocks = |band: usize| {
            let mut out = vec![C64::ZERO; (kept + 1) * size];
            let mut add = |j: usize, block: &[C64]| {
                let into = &mut out[j * size..(j + 1) * size];
                into.iter_mut().zip(block).for_each(|(a, b)| *a += b);
            };
            for i in summed.clone() {
                for (j, &place) in self.places.iter().enumerate() {
                    add(j, self.products.block(band, i, place));
                }
                for j in summed.clone() {
                    add(kept, self.products.block(band, i, j));
                }
            }
            out
        };
        let sum = (0..self.products.bands.len()).map(blocks).collect();
        Self { sum, ..self }
    }

    /// Number of columns beside the residual.
    fn unknowns(&self) -> usize {
        self.places.len() - usize::from(self.sum.is_empty())
    }

    /// Block (i, j), j ≤ i.
    fn block(&self, band: usize, i: usize, j: usize) -> &[C64] {
        if i < self.places.len() {
            return self.products.block(band, self.places[i], self.places[j]);
        }
        let size = self.products.channels * self.products.channels;
        &self.sum[band][j * size..(j + 1) * size]
    }

    fn spectral_matrices(&self, x: &DVector<f64>) -> Vec<DMatrix<C64>> {
        let m = self.products.channels;
        let y = |i: usize| if i == 0 { 1.0 } else { -x[i - 1] };
        let one = |(band, &values): (usize, &f64)| {
            let mut half = vec![C64::ZERO; m * m];
            for i in 0..=x.len() {
                for j in 0..=i {
                    let weight = y(i) * y(j) * if i == j { 0.5 } else { 1.0 };
                    let block = self.block(band, i, j);
                    half.iter_mut()
                        .zip(block)
                        .for_each(|(s, b)| *s += b * weight);
                }
            }
            let half = DMatrix::from_vec(m, m, half) / C64::new(values.max(1.0), 0.0);
            regular(&half + half.adjoint(), &self.products.inexact)
        };
        self.products.values.iter().enumerate().map(one).collect()
    }

    /// Products of all columns, the residual's among them, whitened by these matrices.
    fn weighed(&self, matrices: &[DMatrix<C64>]) -> DMatrix<f64> {
        let n = self.unknowns() + 1;
        let mut all = DMatrix::zeros(n, n);
        for (band, s) in matrices.iter().enumerate() {
            let Some(inverse) = s.clone().cholesky().map(|c| c.inverse()) else {
                continue;
            };
            for i in 0..n {
                for j in 0..=i {
                    // The inverse is Hermitian: tr(S⁻¹ P) = Σ conj(S⁻¹) ∘ P.
                    let pairs = self.block(band, i, j).iter().zip(inverse.iter());
                    let trace: f64 = pairs.map(|(p, s)| p.re * s.re + p.im * s.im).sum();
                    all[(i, j)] += 2.0 * trace;
                }
            }
        }
        all.fill_upper_triangle_with_lower_triangle();
        all
    }

    /// The least D, sought from `start` on, the known parameters inside their
    /// tolerance. The residual's spectrum is estimated anew in every round: with the
    /// rest as it is at the start in the weights, where an effect acts hardly
    /// counts.
    pub fn minimum(&self, start: &DVector<f64>) -> Minimum {
        self.descend(start.clone(), self.spectral_matrices(start))
    }

    /// The least D, sought from least squares on that are weighed by these spectral
    /// matrices. D has two minima where the residual with half of an effect is not
    /// less than with nothing, as of a gap: from a residual without it on, nothing goes
    /// downhill.
    pub fn minimum_weighed(&self, matrices: &[DMatrix<C64>]) -> Minimum {
        self.descend(DVector::zeros(self.unknowns()), matrices.to_vec())
    }

    fn descend(&self, mut x: DVector<f64>, mut matrices: Vec<DMatrix<C64>>) -> Minimum {
        let n = self.unknowns();
        let known = self.shares.len();
        let room = |i: usize| match i.checked_sub(n - self.rooms.len()) {
            Some(last) => self.rooms[last],
            None => (i < known).then(|| {
                let share = self.shares[i];
                [-self.tolerances[i] - share, self.tolerances[i] - share]
            }),
        };
        for _ in 0..ROUNDS {
            let gram = self.weighed(&matrices);
            let mut normal = gram.view((1, 1), (n, n)).into_owned();
            let mut right = gram.view((1, 0), (n, 1)).column(0).into_owned();
            for i in 0..known {
                normal[(i, i)] += self.weights[i];
                right[i] -= self.weights[i] * self.shares[i];
            }
            let before = std::mem::replace(&mut x, bounded(&normal, &right, room));
            matrices = self.spectral_matrices(&x);
            let moved = |i: usize| (x[i] - before[i]).abs() * normal[(i, i)].max(0.0).sqrt();
            if (0..n).all(|i| moved(i) < STILL) {
                break;
            }
        }
        let departures = x.iter().zip(self.shares).zip(&self.weights);
        let departure: f64 = departures.map(|((x, s), w)| w * (x + s).powi(2)).sum();
        let bands = matrices.iter().zip(&self.products.values);
        let deviance = bands.map(deviance_of).sum::<f64>() + departure;
        Minimum { deviance, x }
    }
}

#[cfg(test)]
mod tests {
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    use super::*;

    /// Amplitudes of noise in two channels of a log of 1 s at 1 kHz.
    fn noise(layout: &Layout, rng: &mut StdRng) -> Amplitudes {
        let mut samples = || (0..1000).map(|_| rng.random_range(-1.0..1.0)).collect();
        let series: [Vec<f64>; 2] = [samples(), samples()];
        vec![layout.transform(0, &series, &[false, false])]
    }

    #[test]
    fn products_hold_what_the_bins_hold_and_the_minimum_is_one() {
        let layout = Layout::new(2, &[(1000, 1e-3)]);
        let mut rng = StdRng::seed_from_u64(5);
        let all: Vec<Amplitudes> = (0..5).map(|_| noise(&layout, &mut rng)).collect();
        let products = Products::new(&layout, &all.iter().collect::<Vec<_>>());
        let axis = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
        let axis = axis_sim::Axis::read(axis.as_ref()).unwrap();
        let machine = axis;
        // The residual, one column, and the sum of two of three slots.
        let problem = Problem::new(&machine, &products, vec![0, 1], Vec::new(), &[]);
        let problem = problem.with_sum(3..5);
        let direct = |x: &DVector<f64>| {
            let left = |bin: usize| {
                all[0][0][bin] - all[1][0][bin] * x[0] - (all[3][0][bin] + all[4][0][bin]) * x[1]
            };
            let rest: Amplitudes = vec![(0..all[0][0].len()).map(left).collect()];
            layout.deviance(&rest)
        };
        let least = problem.minimum(&DVector::zeros(2));
        let at_least = direct(&least.x);
        assert!((least.deviance - at_least).abs() < 1e-9 * at_least.abs());
        for (i, by) in [(0, 0.01), (0, -0.01), (1, 0.01), (1, -0.01)] {
            let mut x = least.x.clone();
            x[i] += by;
            assert!(direct(&x) > at_least);
        }
    }
}
