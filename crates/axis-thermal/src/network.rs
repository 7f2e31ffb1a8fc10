//! A linear network of heat capacities and conductances, solved exactly.
//!
//! ```text
//! C Ṫ = −K T + P,      C = diag(capacities), K symmetric
//! u = C^½ T,   C^−½ K C^−½ = Q Λ Qᵀ,   y = Qᵀ u,   ẏ = −Λ y + Qᵀ C^−½ P
//! ```
//!
//! K is positive semidefinite, so that no λ is below 0. Powers that depend on temperature are
//! taken by the exponential Runge–Kutta method of second order, ETD2RK (Cox, Matthews,
//! J. Comput. Phys. 176 (2002) 430, doi:10.1006/jcph.2002.6995, equation 22):
//!
//! ```text
//! a = e^{−Λh} y + h φ₁(−Λh) s(y),     y⁺ = a + h φ₂(−Λh) (s(a) − s(y))
//! φ₁(z) = (e^z − 1)/z,    φ₂(z) = (e^z − 1 − z)/z²
//! ```
//!
//! Powers that are constant or change linearly in time are exact. The last term is what the method
//! of first order, the exponential Euler method, is off by, and decides on the step.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Conductances and capacities while they are put together.
pub(crate) struct Assembly {
    capacity: Vec<f64>,
    matrix: DMatrix<f64>,
    to_air: Vec<f64>,
}

impl Assembly {
    pub fn new(capacity: Vec<f64>) -> Self {
        let n = capacity.len();
        Self {
            capacity,
            matrix: DMatrix::zeros(n, n),
            to_air: vec![0.0; n],
        }
    }

    /// A conductance between two nodes, W/K.
    pub fn link(&mut self, a: usize, b: usize, conductance: f64) {
        self.matrix[(a, a)] += conductance;
        self.matrix[(b, b)] += conductance;
        self.matrix[(a, b)] -= conductance;
        self.matrix[(b, a)] -= conductance;
    }

    /// A conductance to the air, W/K.
    pub fn air(&mut self, node: usize, conductance: f64) {
        self.matrix[(node, node)] += conductance;
        self.to_air[node] += conductance;
    }

    pub fn solve(self) -> Network {
        let n = self.capacity.len();
        let root = DVector::from_iterator(n, self.capacity.iter().map(|c| c.sqrt()));
        let scaled = DMatrix::from_fn(n, n, |i, j| self.matrix[(i, j)] / (root[i] * root[j]));
        let SymmetricEigen {
            eigenvalues,
            eigenvectors,
        } = SymmetricEigen::new(scaled);
        // T = C^−½ Q y, and Qᵀ C^−½ P of powers is the transpose of that.
        let shapes = DMatrix::from_fn(n, n, |i, j| eigenvectors[(i, j)] / root[i]);
        Network {
            capacity: DVector::from_vec(self.capacity),
            rates: eigenvalues.map(|rate| rate.max(0.0)),
            shapes,
            to_air: DVector::from_vec(self.to_air),
        }
    }
}

/// The network with its modes.
#[derive(Clone, Debug)]
pub(crate) struct Network {
    capacity: DVector<f64>,
    /// λ, 1/s.
    rates: DVector<f64>,
    /// Temperatures of each mode.
    shapes: DMatrix<f64>,
    /// Conductances to the air, W/K.
    pub to_air: DVector<f64>,
}

/// A step of the network.
pub(crate) struct Stepped {
    /// Temperatures after it.
    pub temperatures: DVector<f64>,
    /// Powers there, as the caller's law has them at temperatures of the second order's accuracy.
    pub error: f64,
}

impl Network {
    /// Temperatures `h` seconds later. `power` gives the powers of all nodes, W, at temperatures
    /// and a time since the step's begin.
    pub fn step(
        &self,
        temperatures: &DVector<f64>,
        h: f64,
        power: &mut impl FnMut(&DVector<f64>, f64) -> DVector<f64>,
    ) -> Stepped {
        let begin = power(temperatures, 0.0);
        let modes = self
            .shapes
            .tr_mul(&self.capacity.component_mul(temperatures));
        let sources = self.shapes.tr_mul(&begin);
        let first = DVector::from_fn(modes.len(), |i, _| {
            let z = -self.rates[i] * h;
            z.exp() * modes[i] + h * phi_1(z) * sources[i]
        });
        let first = &self.shapes * first;
        let change = power(&first, h) - begin;
        let change = self.shapes.tr_mul(&change);
        let second = change.map_with_location(|i, _, s| h * phi_2(-self.rates[i] * h) * s);
        let correction = &self.shapes * second;
        Stepped {
            error: correction.amax(),
            temperatures: first + correction,
        }
    }
}

/// (e^z − 1)/z for z ≤ 0.
fn phi_1(z: f64) -> f64 {
    match z == 0.0 {
        true => 1.0,
        false => z.exp_m1() / z,
    }
}

/// (e^z − 1 − z)/z² for z ≤ 0; its series near 0, where the difference loses its digits: the first
/// term left out is z⁶/40320, below 3e-17 of ½ at the limit.
fn phi_2(z: f64) -> f64 {
    const TERMS: [f64; 6] = [
        1.0 / 5040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        1.0 / 2.0,
    ];
    match z.abs() < 1e-2 {
        true => TERMS.iter().fold(0.0, |sum, term| sum * z + term),
        false => (z.exp_m1() - z) / (z * z),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the integrals that define them, φ₁ = ∫₀¹ e^{zs} ds and φ₂ = ∫₀¹ (1 − s) e^{zs} ds,
    /// by Simpson's rule.
    #[test]
    fn the_functions_are_their_integrals() {
        for z in [0.0, -1e-9, -1e-3, -0.0099, -0.0101, -0.3, -2.0, -30.0_f64] {
            let n = 20_000_usize;
            let simpson = |f: &dyn Fn(f64) -> f64| {
                let weight = |i: usize| {
                    if i == 0 || i == n {
                        1.0
                    } else {
                        [2.0, 4.0][i % 2]
                    }
                };
                let term = |i: usize| weight(i) * f(i as f64 / n as f64);
                (0..=n).map(term).sum::<f64>() / (3 * n) as f64
            };
            let one = simpson(&|s: f64| (z * s).exp());
            let two = simpson(&|s: f64| (1.0 - s) * (z * s).exp());
            assert!((phi_1(z) - one).abs() < 1e-12, "{z}");
            // Near the series' limit the difference keeps 12 digits.
            assert!((phi_2(z) - two).abs() < 3e-12, "{z}: {} {two}", phi_2(z));
        }
    }
}
