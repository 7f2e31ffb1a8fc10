//! The evidence of a hypothesis: what it does, integrated over its coefficients.
//!
//! With the rest r, columns c_i and coefficients x of the prior N(m, Λ⁻¹), by Laplace
//!
//! ```text
//! ln Z = −F(x̂) − ½ (x̂ − m)ᵀ Λ (x̂ − m) − ½ ln |H| + ½ ln |Λ|,     H = F'' + Λ
//! ```
//!
//! (MacKay, Neural Computation 4 (1992) 415–447, doi:10.1162/neco.1992.4.3.415). The deviation
//! of sizes that nobody knows is the one that makes Z greatest, less what that choice is worth.

use nalgebra::{DMatrix, DVector};
use statrs::function::erf::erfc;

use super::likelihood::Likelihood;
use super::products::{Products, weighed};
use crate::estimate::bounded::{bounded, inverse_of};

/// Prior of a coefficient.
#[derive(Clone, Copy, Debug)]
pub struct Prior {
    /// Column in the products.
    pub column: usize,
    pub mean: f64,
    pub precision: f64,
    /// Between which it lies.
    pub room: Option<[f64; 2]>,
}

/// Coefficients of one unknown deviation.
#[derive(Clone, Debug)]
pub struct Block {
    /// Their columns.
    pub columns: Vec<usize>,
    /// Bounds of each, where they have any.
    pub bounds: Vec<[f64; 2]>,
}

/// Least and greatest deviation of a block, in the unit of its columns, and where its choice begins.
const DEVIATIONS: [f64; 2] = [1e-4, 10.0];
const BEGIN: f64 = 1.0;

/// What choosing it costs: the logarithm of the range of its logarithm over the width of what is
/// likely.
pub const CHOICE: f64 = 2.0;

/// A hypothesis, integrated.
#[derive(Clone, Debug)]
pub struct Evidence {
    pub ln_z: f64,
    /// Coefficients, of priors and then of blocks.
    pub x: DVector<f64>,
    /// Covariance of these.
    pub covariance: DMatrix<f64>,
    /// Sums of squares that are left, by band and channel.
    pub squares: Vec<f64>,
    /// Effective numbers that are fitted in each.
    pub fitted: Vec<f64>,
    /// Their columns.
    pub columns: Vec<usize>,
    /// Deviations that were chosen.
    pub deviations: Vec<f64>,
}

/// A point of the descent.
struct Point {
    x: DVector<f64>,
    f: f64,
    squares: Vec<f64>,
}

struct Problem<'a> {
    counts: &'a [f64],
    /// Products of the rest and the columns.
    grams: Vec<DMatrix<f64>>,
    likelihood: Likelihood,
    mean: DVector<f64>,
    rooms: Vec<Option<[f64; 2]>>,
}

const ROUNDS: usize = 8;
const ENOUGH: f64 = 0.05;
const HALVINGS: usize = 3;

impl Problem<'_> {
    fn at(&self, x: DVector<f64>, precision: &DVector<f64>) -> Point {
        let mut y = DVector::zeros(x.len() + 1);
        y[0] = 1.0;
        y.rows_mut(1, x.len()).copy_from(&-&x);
        let squares = |gram: &DMatrix<f64>| 0.5 * (gram * &y).dot(&y).max(0.0);
        let squares: Vec<f64> = self.grams.iter().map(squares).collect();
        let pairs = self.counts.iter().zip(&squares);
        let data: f64 = pairs.map(|(n, r)| self.likelihood.minus_ln(*n, *r)).sum();
        let prior = (&x - &self.mean).map(|d| d * d).dot(precision);
        Point {
            f: data + 0.5 * prior,
            x,
            squares,
        }
    }

    fn weights(&self, point: &Point) -> Vec<f64> {
        let pairs = self.counts.iter().zip(&point.squares);
        pairs.map(|(n, r)| self.likelihood.weight(*n, *r)).collect()
    }

    /// Second derivatives of the data's part, and its pull at the origin.
    fn normal(&self, weights: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let all = weighed(&self.grams, weights);
        let n = all.ncols() - 1;
        let right = all.view((1, 0), (n, 1)).column(0).into_owned();
        (all.view((1, 1), (n, n)).into_owned(), right)
    }

    /// The most probable coefficients: least squares weighed anew in each round.
    fn descend(&self, start: DVector<f64>, precision: &DVector<f64>) -> Point {
        let mut point = self.at(start, precision);
        for _ in 0..ROUNDS {
            let (mut normal, mut right) = self.normal(&self.weights(&point));
            for i in 0..right.len() {
                normal[(i, i)] += precision[i];
                right[i] += precision[i] * self.mean[i];
            }
            let to = bounded(&normal, &right, |i| self.rooms[i]);
            let step = &to - &point.x;
            let tried = (0..=HALVINGS).map(|k| 0.4_f64.powi(k as i32));
            let mut tried = tried.map(|by| self.at(&point.x + by * &step, precision));
            let Some(next) = tried.find(|next| next.f < point.f) else {
                break;
            };
            let gain = point.f - next.f;
            point = next;
            if gain < ENOUGH {
                break;
            }
        }
        point
    }

    /// ln Z where the descent ended, with covariance and what is fitted in each band.
    fn laplace(&self, point: &Point, precision: &DVector<f64>) -> (f64, DMatrix<f64>, Vec<f64>) {
        let n = point.x.len();
        let weights = self.weights(point);
        let (mut normal, mut right) = self.normal(&weights);
        for i in 0..n {
            normal[(i, i)] += precision[i];
            right[i] += precision[i] * self.mean[i];
        }
        let slope = &normal * &point.x - right;
        let at_edge = |i: usize| {
            let edges = self.rooms[i]?;
            let near = 1e-9 * (edges[1] - edges[0]);
            let out = (point.x[i] >= edges[1] - near && slope[i] < 0.0)
                || (point.x[i] <= edges[0] + near && slope[i] > 0.0);
            out.then(|| slope[i].abs())
        };
        let mut ln_z = -point.f + 0.5 * precision.iter().map(|p| p.ln()).sum::<f64>();
        let mut free = Vec::with_capacity(n);
        for i in 0..n {
            match at_edge(i) {
                Some(slope) => {
                    let h = normal[(i, i)];
                    ln_z += beyond(slope / h.sqrt()) - 0.5 * h.ln();
                }
                None => free.push(i),
            }
        }
        let of_free = DMatrix::from_fn(free.len(), free.len(), |i, j| normal[(free[i], free[j])]);
        // In units of each coefficient's own, or rounding decides the determinant.
        let scale: Vec<f64> = (0..free.len()).map(|i| of_free[(i, i)].sqrt()).collect();
        let scaled = DMatrix::from_fn(free.len(), free.len(), |i, j| {
            of_free[(i, j)] / (scale[i] * scale[j])
        });
        let half_ln = scaled.cholesky().map(|c| {
            let l = c.l_dirty();
            (0..free.len()).map(|i| l[(i, i)].ln()).sum::<f64>()
        });
        ln_z -= half_ln.unwrap_or(0.0) + scale.iter().map(|s| s.ln()).sum::<f64>();
        let inverse = inverse_of(&of_free);
        let mut covariance = DMatrix::zeros(n, n);
        for (a, &i) in free.iter().enumerate() {
            for (b, &j) in free.iter().enumerate() {
                covariance[(i, j)] = inverse[(a, b)];
            }
        }
        let fitted = self.grams.iter().zip(&weights).map(|(gram, w)| {
            let own = gram.view((1, 1), (n, n));
            w * own
                .iter()
                .zip(covariance.iter())
                .map(|(g, c)| g * c)
                .sum::<f64>()
        });
        let fitted = fitted.collect();
        (ln_z, covariance, fitted)
    }
}

/// ln ∫₀^∞ e^{−ut − t²/2} dt / √(2π): what of a Gaussian lies inside an edge at which it still rises
/// by u of its deviations.
fn beyond(u: f64) -> f64 {
    match u < 25.0 {
        true => (0.5 * erfc(u / std::f64::consts::SQRT_2)).ln() + 0.5 * u * u,
        false => -u.ln() - 0.5 * std::f64::consts::TAU.ln(),
    }
}

/// Share of a Gaussian between two edges, in its deviations.
pub fn between(low: f64, high: f64) -> f64 {
    let above = |z: f64| 0.5 * erfc(z / std::f64::consts::SQRT_2);
    let share = match low > 0.0 {
        true => above(low) - above(high),
        false => above(-high) - above(-low),
    };
    share.max(1e-300)
}

/// Evidence of a rest that is explained by these coefficients and blocks.
pub fn evidence(
    products: &Products,
    likelihood: Likelihood,
    priors: &[Prior],
    blocks: &[Block],
) -> Evidence {
    let of_blocks = blocks.iter().flat_map(|b| &b.columns).copied();
    let columns: Vec<usize> = priors.iter().map(|p| p.column).chain(of_blocks).collect();
    let n = columns.len();
    let with_rest: Vec<usize> = std::iter::once(0).chain(columns.iter().copied()).collect();
    let mut rooms: Vec<Option<[f64; 2]>> = priors.iter().map(|p| p.room).collect();
    rooms.resize(n, None);
    let problem = Problem {
        counts: &products.counts,
        grams: products.of(&with_rest),
        likelihood,
        mean: DVector::from_fn(n, |i, _| priors.get(i).map_or(0.0, |p| p.mean)),
        rooms,
    };
    let mut deviations = vec![BEGIN; blocks.len()];
    let precision = |deviations: &[f64]| {
        let of_priors = priors.iter().map(|p| p.precision);
        let of_blocks = blocks.iter().zip(deviations);
        let of_blocks = of_blocks.flat_map(|(b, d)| vec![d.powi(-2); b.columns.len()]);
        DVector::from_iterator(n, of_priors.chain(of_blocks))
    };
    let start = DVector::from_fn(n, |i, _| match problem.rooms[i] {
        Some([low, high]) => problem.mean[i].clamp(low, high),
        None => problem.mean[i],
    });
    let mut now = precision(&deviations);
    let mut point = problem.descend(start, &now);
    if !blocks.is_empty() {
        deviations = chosen(&problem, &point, priors, blocks, deviations);
        now = precision(&deviations);
        let again = point.x.clone();
        point = problem.descend(again, &now);
    }
    let (mut ln_z, covariance, fitted) = problem.laplace(&point, &now);
    let mut at = priors.len();
    for (block, deviation) in blocks.iter().zip(&deviations) {
        ln_z -= CHOICE;
        for (i, [low, high]) in block.bounds.iter().enumerate() {
            let (mean, own) = (point.x[at + i], covariance[(at + i, at + i)].sqrt());
            let own = own.max(1e-150);
            ln_z += between((low - mean) / own, (high - mean) / own).ln()
                - between(low / deviation, high / deviation).ln();
        }
        at += block.columns.len();
    }
    Evidence {
        ln_z,
        x: point.x,
        covariance,
        squares: point.squares,
        fitted,
        columns,
        deviations,
    }
}

/// Deviations of blocks that make the evidence greatest (MacKay's update), at the weights of a point.
fn chosen(
    problem: &Problem<'_>,
    point: &Point,
    priors: &[Prior],
    blocks: &[Block],
    mut deviations: Vec<f64>,
) -> Vec<f64> {
    const UPDATES: usize = 20;
    let (data, right) = problem.normal(&problem.weights(point));
    let (known, all) = (priors.len(), right.len());
    let own = all - known;
    // The other coefficients integrated out.
    let mut others = data.view((0, 0), (known, known)).into_owned();
    let mut pull = right.rows(0, known).into_owned();
    for (i, prior) in priors.iter().enumerate() {
        others[(i, i)] += prior.precision;
        pull[i] += prior.precision * prior.mean;
    }
    let cross = data.view((0, known), (known, own)).into_owned();
    let through = inverse_of(&others) * &cross;
    let normal = data.view((known, known), (own, own)) - cross.tr_mul(&through);
    let right = right.rows(known, own) - through.tr_mul(&pull);
    for _ in 0..UPDATES {
        let mut with_prior = normal.clone();
        let each = blocks.iter().zip(&deviations);
        let each = each.flat_map(|(b, d)| vec![d.powi(-2); b.columns.len()]);
        for (i, precision) in each.enumerate() {
            with_prior[(i, i)] += precision;
        }
        let inverse = inverse_of(&with_prior);
        let x = &inverse * &right;
        let mut at = 0;
        let mut moved = 0.0_f64;
        for (block, deviation) in blocks.iter().zip(&mut deviations) {
            let places = at..at + block.columns.len();
            at = places.end;
            let unsure: f64 = places.clone().map(|i| inverse[(i, i)]).sum();
            let square: f64 = places.clone().map(|i| x[i] * x[i]).sum();
            let known = places.len() as f64 - unsure / deviation.powi(2);
            let next = (square / known.max(0.05)).sqrt();
            let next = next.clamp(DEVIATIONS[0], DEVIATIONS[1]);
            moved = moved.max((next / *deviation).ln().abs());
            *deviation = next;
        }
        if moved < 0.02 {
            break;
        }
    }
    deviations
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::{Prior, between, beyond, evidence};
    use crate::posterior::likelihood::{Likelihood, TEMPER};
    use crate::posterior::products::Products;

    /// A rest of `n` numbers below the reference spectrum, and columns.
    fn problem(n: usize, columns: usize) -> DMatrix<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut all = DMatrix::from_fn(n, columns + 1, |_, _| StandardNormal.sample(&mut random));
        all.column_mut(0).scale_mut(0.5);
        all
    }

    fn prior(column: usize, precision: f64, room: Option<[f64; 2]>) -> Prior {
        Prior {
            column,
            mean: 0.0,
            precision,
            room,
        }
    }

    /// Below the reference spectrum −ln p is a parabola, and the integral is the density of a Gaussian
    /// with the covariance I/τ + C Λ⁻¹ Cᵀ over that with I/τ.
    #[test]
    fn of_a_parabola_it_is_exact() {
        let (n, precisions) = (40, [0.3, 2.0, 9.0]);
        let all = problem(n, precisions.len());
        let products = Products::of_one_band(all.clone());
        let priors = precisions.iter().enumerate();
        let priors: Vec<Prior> = priors.map(|(i, p)| prior(i + 1, *p, None)).collect();
        let found = evidence(&products, Likelihood::Referenced, &priors, &[]).ln_z;
        let rest = all.column(0).into_owned();
        let c = all.columns(1, precisions.len()).into_owned();
        let spread =
            DMatrix::from_diagonal(&DVector::from_vec(precisions.map(|p| 1.0 / p).to_vec()));
        let of_noise = DMatrix::identity(n, n) / TEMPER;
        let covariance = &of_noise + &c * spread * c.transpose();
        let ln = |s: DMatrix<f64>| {
            let factor = s.cholesky().unwrap();
            let ln_det = 2.0 * factor.l().diagonal().map(f64::ln).sum();
            -0.5 * ln_det - 0.5 * rest.dot(&factor.solve(&rest))
        };
        let relative = ln(covariance) - ln(of_noise);
        let of_nothing = -TEMPER * (0.5 * rest.norm_squared() - 0.5 * n as f64);
        assert!((found - relative - of_nothing).abs() < 1e-9, "{found}");
    }

    /// Against the same integral by the trapezoidal rule, the best value beyond the edge.
    #[test]
    fn at_the_edge_of_its_room_it_is_that_of_what_lies_inside() {
        let mut all = problem(12, 1);
        all.column_mut(1).scale_mut(0.2);
        let column = all.column(1).into_owned();
        all.column_mut(0).axpy(3.5, &column, 0.6);
        let rest = all.column(0).into_owned();
        let products = Products::of_one_band(all);
        // With the prior the most probable is near 1.1.
        let edge = 0.4;
        let priors = [prior(1, 0.5, Some([-6.0, edge]))];
        let found = evidence(&products, Likelihood::Referenced, &priors, &[]).ln_z;
        let ln = |x: f64| {
            let left = (&rest - &column * x).norm_squared();
            -TEMPER * (0.5 * left - 6.0) - 0.25 * x * x
        };
        let step = 1e-4;
        let sum: f64 = (0..60_000).map(|k| ln(edge - step * k as f64).exp()).sum();
        let exact =
            (step * (sum - 0.5 * ln(edge).exp()) * (0.5 / std::f64::consts::TAU).sqrt()).ln();
        assert!((found - exact).abs() < 1e-3, "{found} {exact}");
    }

    #[test]
    fn tails_are_those_of_the_normal_distribution() {
        assert!((between(-1.959_964, 1.959_964) - 0.95).abs() < 1e-6);
        assert!((between(3.0, 4.0) / 1.318_227e-3 - 1.0).abs() < 1e-5);
        assert!((beyond(0.0) - 0.5_f64.ln()).abs() < 1e-12);
        // Mills' ratio at 3: 0.304590.
        let mills = (beyond(3.0) + 0.5 * std::f64::consts::TAU.ln()).exp();
        assert!((mills - 0.304_590).abs() < 1e-5, "{mills}");
        // Both branches meet: their ratio is 1 − 1/u².
        assert!((beyond(24.999) - beyond(25.001)).abs() < 2e-3);
    }
}
