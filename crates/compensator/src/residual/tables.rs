//! Harmonics of the motor's angle and curves along the stroke as a basis.

use std::boxed::Box;
use std::vec::Vec;

use libm::exp;
use nalgebra::{DMatrix, DVector};

use super::{HARMONICS, KNOTS, ResidualBasis, ResidualModel, ResidualRow, Unexplained};

const SIZE: usize = 2 * HARMONICS + 2 * KNOTS;
/// Amplitudes that are expected, as a share of the Coulomb level.
const HARMONIC_SHARE: f64 = 0.1;
const CURVE_SHARE: f64 = 0.1;
/// Length over which curves along the stroke vary, as a share of it and at least a knot.
const CURVE_LENGTH: f64 = 0.01;

/// The coefficients of a [`ResidualModel`]: amplitudes of harmonics are of the size of a
/// share of the Coulomb level, the curves along the stroke too, and smooth over a hundredth
/// of it. What was not visited stays at nothing.
#[derive(Clone, Debug)]
pub struct ResidualTables {
    travel: f64,
    level: f64,
    none: Box<ResidualModel>,
}

impl ResidualTables {
    /// On an axis with the stroke `stroke` (m or rad), the travel per radian `travel` and
    /// friction of the Coulomb level `coulomb` (torque at the motor, N·m).
    #[must_use]
    pub fn new(stroke: [f64; 2], travel: f64, coulomb: f64) -> Self {
        Self {
            travel,
            level: coulomb.max(1e-9),
            none: Box::new(ResidualModel::none(stroke)),
        }
    }
}

impl ResidualBasis for ResidualTables {
    type Model = Box<ResidualModel>;

    fn size(&self) -> usize {
        SIZE
    }

    fn prior(&self) -> (DMatrix<f64>, DVector<f64>) {
        let mut normal = DMatrix::zeros(SIZE, SIZE);
        let amplitude = HARMONIC_SHARE * self.level;
        for i in 0..2 * HARMONICS {
            normal[(i, i)] = 1.0 / (amplitude * amplitude);
        }
        let knots = (KNOTS - 1) as f64;
        let length = (CURVE_LENGTH * knots).max(1.0);
        let force = CURVE_SHARE * self.level / self.travel;
        for curve in 0..2 {
            let at = |i: usize| 2 * HARMONICS + curve * KNOTS + i;
            for i in 0..KNOTS {
                // Of a smooth curve each knot stands for as many as it is long.
                normal[(at(i), at(i))] += 1.0 / (force * force * length);
            }
            let bend = force / (length * length);
            for i in 1..KNOTS - 1 {
                let row = [(at(i - 1), 1.0), (at(i), -2.0), (at(i + 1), 1.0)];
                for (a, wa) in row {
                    for (b, wb) in row {
                        normal[(a, b)] += wa * wb / (bend * bend) / length;
                    }
                }
            }
        }
        (normal, DVector::zeros(SIZE))
    }

    fn row(&mut self, at: &Unexplained, smoothing: f64) -> ResidualRow {
        let mut values = Vec::with_capacity(2 * HARMONICS + 4);
        for n in 1..=HARMONICS {
            let order = n as f64;
            // What the Gaussian over the log leaves of a harmonic at this speed.
            let turned = order * at.motor_speed * smoothing;
            let gain = exp(-0.5 * turned * turned);
            let (sin, cos) = libm::sincos(order * at.motor_angle);
            values.push((2 * n - 2, gain * cos));
            values.push((2 * n - 1, gain * sin));
        }
        let (knot, share) = self.none.knot(at.position);
        for (curve, by) in [(0, self.travel * at.direction), (1, self.travel)] {
            let place = 2 * HARMONICS + curve * KNOTS + knot;
            values.push((place, by * (1.0 - share)));
            values.push((place + 1, by * share));
        }
        ResidualRow { values, fixed: 0.0 }
    }

    fn model(&self, coefficients: &[f64]) -> Box<ResidualModel> {
        let mut model = self.none.clone();
        let (harmonics, curves) = coefficients.split_at(2 * HARMONICS);
        for (pair, from) in model.harmonics.iter_mut().zip(harmonics.chunks(2)) {
            pair.copy_from_slice(from);
        }
        model.friction.copy_from_slice(&curves[..KNOTS]);
        model.force.copy_from_slice(&curves[KNOTS..]);
        model
    }
}
