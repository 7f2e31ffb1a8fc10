//! The rotating chain: motor, torque sensor and the screw in torsion.

use nalgebra::{DMatrix, DVector};

use crate::parameters::Parameters;

/// Elements of the screw.
const ELEMENTS: usize = 40;
/// Nodes before the screw's: motor and sensor.
const BEFORE: usize = 2;

/// Where the nut stands: two neighbouring nodes and their weights.
#[derive(Clone, Copy, Debug)]
pub struct Nut {
    /// The first of the two nodes.
    pub node: usize,
    /// Weights of that node and of the next.
    pub weight: [f64; 2],
}

impl Nut {
    /// The nut's share in a vector of the chain, n(x)ᵀ v.
    pub fn of(&self, v: &DVector<f64>) -> f64 {
        self.weight[0] * v[self.node] + self.weight[1] * v[self.node + 1]
    }
}

/// Matrices of the chain, and the implicit midpoint rule on it.
///
/// Consistent mass of two-node elements of length l: ρ I_p l/6 [[2, 1], [1, 2]]; stiffness
/// G I_p/l [[1, −1], [−1, 1]] (Przemieniecki, Theory of Matrix Structural Analysis, 1968).
#[derive(Clone, Debug)]
pub struct Chain {
    mass: DMatrix<f64>,
    /// Stiffness between each node and the next, N·m/rad.
    springs: Vec<f64>,
    /// (M + h/2 βK + h²/4 K)⁻¹.
    solved: DMatrix<f64>,
    half_step: f64,
    element_length: f64,
}

impl Chain {
    /// The chain for steps of `step` seconds.
    pub fn new(p: &Parameters, step: f64) -> Self {
        let polar = std::f64::consts::PI * p.screw_diameter.powi(4) / 32.0;
        let shear = p.youngs_modulus / (2.0 * (1.0 + p.poisson_ratio));
        let l = p.screw_length / ELEMENTS as f64;
        let n = BEFORE + ELEMENTS + 1;
        let mut springs = vec![p.motor_coupling, p.screw_coupling];
        springs.extend([shear * polar / l; ELEMENTS]);
        let mut stiffness = DMatrix::zeros(n, n);
        for (i, k) in springs.iter().enumerate() {
            stiffness[(i, i)] += k;
            stiffness[(i + 1, i + 1)] += k;
            stiffness[(i, i + 1)] -= k;
            stiffness[(i + 1, i)] -= k;
        }
        let mut mass = DMatrix::zeros(n, n);
        mass[(0, 0)] = p.motor_inertia;
        mass[(1, 1)] = p.sensor_inertia;
        let sixth = p.density * polar * l / 6.0;
        for i in BEFORE..n - 1 {
            mass[(i, i)] += 2.0 * sixth;
            mass[(i + 1, i + 1)] += 2.0 * sixth;
            mass[(i, i + 1)] += sixth;
            mass[(i + 1, i)] += sixth;
        }
        let half_step = 0.5 * step;
        let system = &mass + &stiffness * (half_step * p.stiffness_damping + half_step * half_step);
        let identity = || DMatrix::identity(n, n);
        // Symmetric and positive definite, as every inertia is positive.
        let solved = system.cholesky().map_or_else(identity, |c| c.inverse());
        Self {
            mass,
            springs,
            solved,
            half_step,
            element_length: l,
        }
    }

    /// Number of angles.
    pub fn len(&self) -> usize {
        self.springs.len() + 1
    }

    /// The nut at place `x` on the screw, m.
    pub fn nut(&self, x: f64) -> Nut {
        let along = (x / self.element_length).clamp(0.0, ELEMENTS as f64);
        let element = (along as usize).min(ELEMENTS - 1);
        let part = along - element as f64;
        Nut {
            node: BEFORE + element,
            weight: [1.0 - part, part],
        }
    }

    /// Rates in the middle of a step under a torque on the motor, without the nut's force.
    pub fn free(&self, q: &DVector<f64>, rate: &DVector<f64>, torque: f64) -> DVector<f64> {
        let mut right = DVector::zeros(self.len());
        right[0] = self.half_step * torque;
        for i in 0..self.len() {
            for j in i.saturating_sub(1)..(i + 2).min(self.len()) {
                right[i] += self.mass[(i, j)] * rate[j];
            }
        }
        for (i, k) in self.springs.iter().enumerate() {
            let twist = self.half_step * k * (q[i + 1] - q[i]);
            right[i] += twist;
            right[i + 1] -= twist;
        }
        &self.solved * right
    }

    /// Rate at the nut in the middle of a step per unit of torque at the nut.
    pub fn mobility(&self, nut: &Nut) -> f64 {
        let (i, [a, b]) = (nut.node, nut.weight);
        let s = &self.solved;
        let sum = a * a * s[(i, i)] + 2.0 * a * b * s[(i, i + 1)] + b * b * s[(i + 1, i + 1)];
        self.half_step * sum
    }

    /// Takes a torque at the nut into rates in the middle of a step.
    pub fn load(&self, rate: &mut DVector<f64>, nut: &Nut, torque: f64) {
        for (place, weight) in nut.weight.into_iter().enumerate() {
            let by = self.half_step * weight * torque;
            rate.axpy(by, &self.solved.column(nut.node + place), 1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turned as one the chain has the inertia of motor, sensor and ρ I_p L, and no spring
    /// holds it.
    #[test]
    fn turned_as_one_it_is_an_inertia() {
        let p = Parameters::paper();
        let chain = Chain::new(&p, 1e-5);
        let polar = std::f64::consts::PI * p.screw_diameter.powi(4) / 32.0;
        let whole = p.motor_inertia + p.sensor_inertia + p.density * polar * p.screw_length;
        assert!((chain.mass.sum() / whole - 1.0).abs() < 1e-12);
        let even = DVector::from_element(chain.len(), 0.7);
        let middle = chain.free(&even, &even, 0.0);
        assert!(middle.iter().all(|w| (w - 0.7).abs() < 1e-10));
    }
}
