//! The residual model from what a model left unexplained in the logs of ordinary moves.
//!
//! A linear regression with a Gaussian prior, which adds up from move to move: amplitudes
//! of harmonics are of the size of a share of the Coulomb level, the curves along the
//! stroke too, and smooth over some 10 mm. What was not visited stays at nothing.
//!
//! A gate keeps it from doing harm: it is used only while it has explained a material part
//! of the last moves *before* it learned from them.

use std::boxed::Box;
use std::vec::Vec;

use libm::{exp, sqrt};
use nalgebra::{DMatrix, DVector};

use super::{HARMONICS, KNOTS, ResidualModel};

const SIZE: usize = 2 * HARMONICS + 2 * KNOTS;
/// Amplitudes that are expected, as a share of the Coulomb level.
const HARMONIC_SHARE: f64 = 0.1;
const CURVE_SHARE: f64 = 0.1;
/// Length over which curves along the stroke vary, as a share of it and at least a knot.
const CURVE_LENGTH: f64 = 0.01;
/// Part of the power of a move not learned from that must be explained for use.
const LEAST_EXPLAINED: f64 = 0.1;
/// RMS of what is explained, as a share of the Coulomb level: less is not worth the risk.
const LEAST_SIZE: f64 = 0.01;

/// What the model did not explain at an instant of a log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unexplained {
    /// Position of the load, m or rad.
    pub position: f64,
    /// Angle of the motor, rad.
    pub motor_angle: f64,
    /// Its speed, rad/s.
    pub motor_speed: f64,
    /// Share of the Coulomb level that the bristles hold, −1 to 1.
    pub direction: f64,
    /// Torque at the motor that was needed besides, N·m, smoothed by a Gaussian.
    pub torque: f64,
}

/// Learns a [`ResidualModel`] from move to move.
#[derive(Clone, Debug)]
pub struct ResidualLearner {
    travel: f64,
    /// Coulomb level at the motor, N·m.
    level: f64,
    model: Box<ResidualModel>,
    /// Prior and moves: normal matrix and right side, in units of the noise.
    normal: DMatrix<f64>,
    right: DVector<f64>,
    /// Share of the power of each move that the model explained before it saw it.
    explained: Vec<f64>,
}

impl ResidualLearner {
    /// Nothing learned, on an axis with the stroke `stroke`, the travel per radian
    /// `travel` and friction of the Coulomb level `coulomb` (torque at the motor, N·m).
    #[must_use]
    pub fn new(stroke: [f64; 2], travel: f64, coulomb: f64) -> Self {
        let model = ResidualModel::none(stroke);
        let mut normal = DMatrix::zeros(SIZE, SIZE);
        let level = coulomb.max(1e-9);
        let amplitude = HARMONIC_SHARE * level;
        for i in 0..2 * HARMONICS {
            normal[(i, i)] = 1.0 / (amplitude * amplitude);
        }
        let knots = (KNOTS - 1) as f64;
        let length = (CURVE_LENGTH * knots).max(1.0);
        let force = CURVE_SHARE * level / travel;
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
        Self {
            travel,
            level,
            model: Box::new(model),
            normal,
            right: DVector::zeros(SIZE),
            explained: Vec::new(),
        }
    }

    /// Learns from a move: `log` at instants `spacing` seconds apart, its torques smoothed
    /// by a Gaussian of the deviation `smoothing` (s). The share of its power that was
    /// explained before learning from it.
    pub fn learn(&mut self, log: &[Unexplained], spacing: f64, smoothing: f64) -> f64 {
        let mut left = 0.0;
        let mut whole = 0.0;
        let rows: Vec<Row> = log
            .iter()
            .filter(|u| u.torque.is_finite() && u.motor_angle.is_finite())
            .map(|u| self.row(u, smoothing))
            .collect();
        let before = self.coefficients();
        let mut foreseen = 0.0;
        for row in &rows {
            let part = row.times(&before);
            let rest = row.torque - part;
            foreseen += part * part;
            left += rest * rest;
            whole += row.torque * row.torque;
        }
        let explained = if whole > 0.0 { 1.0 - left / whole } else { 0.0 };
        if rows.is_empty() || !explained.is_finite() {
            return 0.0;
        }
        let size = sqrt(foreseen / rows.len() as f64);
        let worth = size >= LEAST_SIZE * self.level;
        self.explained.push(if worth { explained } else { 0.0 });
        // Neighbours within the Gaussian say the same.
        let same = (2.0 * sqrt(core::f64::consts::PI) * smoothing / spacing).max(1.0);
        let count = rows.len() as f64;
        // The noise is what the fit leaves: found in a few rounds.
        let mut noise = left.min(whole) / count;
        let mut found = None;
        for _ in 0..3 {
            let weight = 1.0 / (same * noise.max(1e-30));
            let (mut normal, mut right) = (self.normal.clone(), self.right.clone());
            for row in &rows {
                row.add_to(&mut normal, &mut right, weight);
            }
            let Some(solved) = normal.clone().cholesky() else {
                break;
            };
            let coefficients = solved.solve(&right);
            let rests = rows
                .iter()
                .map(|row| row.torque - row.times(coefficients.as_slice()));
            noise = rests.map(|rest| rest * rest).sum::<f64>() / count;
            found = Some((normal, right, coefficients));
        }
        if let Some((normal, right, coefficients)) = found {
            (self.normal, self.right) = (normal, right);
            self.keep(coefficients.as_slice());
        }
        explained
    }

    /// The model, where it may be used: where it has explained a material part of the last
    /// move, and of the last three together, before it learned from them.
    #[must_use]
    pub fn model(&self) -> Option<&ResidualModel> {
        let last: Vec<f64> = self.explained.iter().rev().take(3).copied().collect();
        // The first move was explained by nothing.
        let tested = self.explained.len() > 1;
        let newest = last.first().copied().unwrap_or(0.0);
        let mean = last.iter().sum::<f64>() / last.len().max(1) as f64;
        let fits = newest > LEAST_EXPLAINED && mean > 0.0;
        (tested && fits).then_some(&*self.model)
    }

    /// Share of the power of each move that was explained before learning from it; 0 where
    /// that was too little to matter.
    #[must_use]
    pub fn explained(&self) -> &[f64] {
        &self.explained
    }

    fn coefficients(&self) -> Vec<f64> {
        let m = &*self.model;
        let harmonics = m.harmonics.iter().flatten();
        harmonics
            .chain(&m.friction)
            .chain(&m.force)
            .copied()
            .collect()
    }

    fn keep(&mut self, coefficients: &[f64]) {
        let (harmonics, curves) = coefficients.split_at(2 * HARMONICS);
        for (pair, from) in self.model.harmonics.iter_mut().zip(harmonics.chunks(2)) {
            pair.copy_from_slice(from);
        }
        self.model.friction.copy_from_slice(&curves[..KNOTS]);
        self.model.force.copy_from_slice(&curves[KNOTS..]);
    }

    fn row(&self, u: &Unexplained, smoothing: f64) -> Row {
        let mut values = Vec::with_capacity(2 * HARMONICS + 4);
        for n in 1..=HARMONICS {
            let order = n as f64;
            // What the Gaussian over the log leaves of a harmonic at this speed.
            let turned = order * u.motor_speed * smoothing;
            let gain = exp(-0.5 * turned * turned);
            let (sin, cos) = libm::sincos(order * u.motor_angle);
            values.push((2 * n - 2, gain * cos));
            values.push((2 * n - 1, gain * sin));
        }
        let (knot, share) = self.model.knot(u.position);
        for (curve, by) in [(0, self.travel * u.direction), (1, self.travel)] {
            let at = 2 * HARMONICS + curve * KNOTS + knot;
            values.push((at, by * (1.0 - share)));
            values.push((at + 1, by * share));
        }
        Row {
            values,
            torque: u.torque,
        }
    }
}

/// One equation: its few coefficients that are not 0.
struct Row {
    values: Vec<(usize, f64)>,
    torque: f64,
}

impl Row {
    fn times(&self, coefficients: &[f64]) -> f64 {
        self.values.iter().map(|(i, v)| v * coefficients[*i]).sum()
    }

    fn add_to(&self, normal: &mut DMatrix<f64>, right: &mut DVector<f64>, weight: f64) {
        for (i, a) in &self.values {
            right[*i] += weight * a * self.torque;
            for (j, b) in &self.values {
                normal[(*i, *j)] += weight * a * b;
            }
        }
    }
}
