//! What a residual is made of: coefficients, their prior, and what they do at an instant.

use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::Unexplained;
use crate::gaussian::bell;

/// Deviations between two instants of [`over_gaussian`]. The sum is exact but for
/// e^{−(2π/0.75 − ν)²/2} where what is averaged turns by ν radians in a deviation.
const STEP: f64 = 0.75;
/// Instants to either side: 3.75 deviations.
const SIDE: i32 = 5;

/// A residual that is linear, or nearly, in coefficients with a Gaussian prior.
pub trait ResidualBasis {
    /// What the coefficients make.
    type Model;

    /// How many coefficients there are.
    fn size(&self) -> usize;

    /// Their precisions before any move, a positive definite matrix, and their means.
    fn prior(&self) -> (DMatrix<f64>, DVector<f64>);

    /// Says at which coefficients the next rows are wanted: for what is not quite linear.
    fn linearise(&mut self, _coefficients: &[f64]) {}

    /// What the coefficients do to the torque at an instant of a log whose signals have
    /// passed a Gaussian of the deviation `smoothing` (s).
    fn row(&mut self, at: &Unexplained, smoothing: f64) -> ResidualRow;

    /// The residual of these coefficients.
    fn model(&self, coefficients: &[f64]) -> Self::Model;
}

/// One equation: torque at the motor = fixed + Σ values · coefficients.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResidualRow {
    /// Coefficients that matter, by their number, and what they do, N·m each.
    pub values: Vec<(usize, f64)>,
    /// Torque that no coefficient changes, N·m.
    pub fixed: f64,
}

impl ResidualRow {
    /// The torque, N·m.
    #[must_use]
    pub fn times(&self, coefficients: &[f64]) -> f64 {
        let terms = self.values.iter().map(|(i, v)| v * coefficients[*i]);
        self.fixed + terms.sum::<f64>()
    }

    /// Adds the equation for `torque` to normal equations.
    pub(super) fn add_to(
        &self,
        torque: f64,
        weight: f64,
        normal: &mut DMatrix<f64>,
        right: &mut DVector<f64>,
    ) {
        for (i, a) in &self.values {
            right[*i] += weight * a * (torque - self.fixed);
            for (j, b) in &self.values {
                normal[(*i, *j)] += weight * a * b;
            }
        }
    }
}

/// Calls `each` with instants around one of a log, `travel` being that of the load per
/// radian of the motor, and with their weights in a Gaussian of the deviation `smoothing`
/// (s): what a log behind that Gaussian shows of what depends on angle and position, the
/// speed being constant meanwhile.
pub fn over_gaussian(
    at: &Unexplained,
    travel: f64,
    smoothing: f64,
    mut each: impl FnMut(&Unexplained, f64),
) {
    let height = |i: i32| bell(STEP * f64::from(i));
    let sum: f64 = (-SIDE..=SIDE).map(height).sum();
    for i in -SIDE..=SIDE {
        let turned = at.motor_speed * smoothing * STEP * f64::from(i);
        let there = Unexplained {
            motor_angle: at.motor_angle + turned,
            position: at.position + travel * turned,
            ..*at
        };
        each(&there, height(i) / sum);
    }
}
