//! Levenberg–Marquardt for a few scaled, bounded parameters.

use nalgebra::{SMatrix, SVector};

/// How a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FitOutcome {
    /// The step or the predicted gain vanished.
    Converged,
    /// The limit of iterations came first: judge the result with care.
    IterationLimit,
}

/// `residuals(x, out)` writes all residuals, already divided by their
/// standard deviations where those are known.
pub(super) struct Problem<'a, const N: usize> {
    pub residuals: &'a dyn Fn(&[f64; N], &mut [f64]),
    /// Number of residuals.
    pub count: usize,
    /// A typical magnitude of each parameter, for steps and convergence.
    pub scale: [f64; N],
    /// Lower bounds; −∞ if there is none.
    pub lower: [f64; N],
    /// Parameters that take part; the others keep their starting values.
    pub free: [bool; N],
}

pub(super) struct Minimum<const N: usize> {
    pub x: [f64; N],
    pub residuals: Vec<f64>,
    /// Jacobian at `x`, one column a parameter (zero where not free).
    pub jacobian: Vec<Vec<f64>>,
    /// `(JᵀJ)⁻¹` over the free parameters, zero elsewhere; `None` if singular.
    pub inverse: Option<SMatrix<f64, N, N>>,
    pub outcome: FitOutcome,
}

const ITERATIONS: usize = 100;

impl<const N: usize> Problem<'_, N> {
    /// Minimises the sum of squares from `x`. Damping starts at 1e-3 and moves
    /// by factors of 10 on the diagonal of `JᵀJ` (Marquardt's scaling); steps
    /// are projected on the bounds.
    pub fn minimise(&self, mut x: [f64; N]) -> Minimum<N> {
        let mut r = self.at(&x);
        let mut cost = square(&r);
        let mut damping = 1e-3;
        let mut outcome = FitOutcome::IterationLimit;
        let mut jacobian = self.jacobian(&x);
        for _ in 0..ITERATIONS {
            let Some(step) = self.step(&x, &r, &jacobian, damping) else {
                damping *= 10.0;
                if damping > 1e12 {
                    break;
                }
                continue;
            };
            let trial: [f64; N] = core::array::from_fn(|i| (x[i] + step[i]).max(self.lower[i]));
            let moved = (0..N).map(|i| (trial[i] - x[i]).abs() / self.scale[i]);
            let small = moved.fold(0.0, f64::max) < 1e-9;
            let trial_r = self.at(&trial);
            let trial_cost = square(&trial_r);
            if trial_cost <= cost {
                let gain = cost - trial_cost;
                let done = small || gain <= 1e-14 * cost;
                (x, r, cost) = (trial, trial_r, trial_cost);
                jacobian = self.jacobian(&x);
                damping = (damping * 0.1).max(1e-12);
                if done {
                    outcome = FitOutcome::Converged;
                    break;
                }
            } else if small {
                // No smaller step can lower the cost beyond rounding.
                outcome = FitOutcome::Converged;
                break;
            } else {
                damping *= 10.0;
            }
        }
        let inverse = self.normal(&jacobian).try_inverse().map(|m| self.masked(m));
        Minimum {
            x,
            residuals: r,
            jacobian,
            inverse,
            outcome,
        }
    }

    fn at(&self, x: &[f64; N]) -> Vec<f64> {
        let mut out = vec![0.0; self.count];
        (self.residuals)(x, &mut out);
        out
    }

    /// Central differences: error of about 1e-10 of each column.
    fn jacobian(&self, x: &[f64; N]) -> Vec<Vec<f64>> {
        (0..N)
            .map(|i| {
                if !self.free[i] {
                    return vec![0.0; self.count];
                }
                let h = 1e-5 * self.scale[i];
                central_difference(self.residuals, x, i, h, self.count)
            })
            .collect()
    }

    /// `JᵀJ` over the free parameters, with ones on the diagonal elsewhere.
    fn normal(&self, jacobian: &[Vec<f64>]) -> SMatrix<f64, N, N> {
        SMatrix::from_fn(|i, j| {
            if self.free[i] && self.free[j] {
                dot(&jacobian[i], &jacobian[j])
            } else {
                f64::from(u8::from(i == j))
            }
        })
    }

    fn masked(&self, mut m: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
        for i in (0..N).filter(|&i| !self.free[i]) {
            m[(i, i)] = 0.0;
        }
        m
    }

    /// The damped step; parameters that sit on a bound and are pushed against
    /// it stay there.
    fn step(
        &self,
        x: &[f64; N],
        r: &[f64],
        jacobian: &[Vec<f64>],
        damping: f64,
    ) -> Option<SVector<f64, N>> {
        let mut gradient = SVector::<f64, N>::from_fn(|i, _| dot(&jacobian[i], r));
        let mut normal = self.normal(jacobian);
        for i in 0..N {
            normal[(i, i)] *= 1.0 + damping;
            if x[i] <= self.lower[i] && gradient[i] > 0.0 {
                gradient[i] = 0.0;
                normal.row_mut(i).fill(0.0);
                normal.column_mut(i).fill(0.0);
                normal[(i, i)] = 1.0;
            }
        }
        // Parameters differ by orders of magnitude: equilibrate first.
        let d = SVector::<f64, N>::from_fn(|i, _| 1.0 / normal[(i, i)].sqrt());
        let scaled = SMatrix::<f64, N, N>::from_fn(|i, j| normal[(i, j)] * d[i] * d[j]);
        let solution = scaled.cholesky()?.solve(&(-gradient.component_mul(&d)));
        Some(solution.component_mul(&d))
    }
}

/// `∂f/∂x_i` by `(f(x + h) − f(x − h)) / 2h`.
pub(super) fn central_difference<const N: usize>(
    f: &dyn Fn(&[f64; N], &mut [f64]),
    x: &[f64; N],
    i: usize,
    h: f64,
    count: usize,
) -> Vec<f64> {
    let (mut up, mut down) = (*x, *x);
    up[i] += h;
    down[i] -= h;
    let (mut above, mut below) = (vec![0.0; count], vec![0.0; count]);
    f(&up, &mut above);
    f(&down, &mut below);
    let width = up[i] - down[i];
    for (a, b) in above.iter_mut().zip(&below) {
        *a = (*a - b) / width;
    }
    above
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

pub(super) fn square(a: &[f64]) -> f64 {
    dot(a, a)
}
