//! A residual from what a model left unexplained in the logs of ordinary moves.
//!
//! A linear regression with a Gaussian prior, which adds up from move to move.
//!
//! A gate keeps it from doing harm: it is used only while it has explained a material part
//! of the last moves *before* it learned from them, and no stretch of the last one, nor its
//! slow part, where an axis breaks away and errors peak, would have been worse with it.

use std::vec::Vec;

use libm::sqrt;
use nalgebra::{DMatrix, DVector};

use super::unexplained::Unexplained;
use super::{ResidualBasis, ResidualRow, ResidualTables};

/// Part of the power of a move not learned from that must be explained for use, and of the
/// power of its changes. A peak depends on a few milliseconds of a move: what explains less than
/// half may add to it there.
const LEAST_EXPLAINED: f64 = 0.5;
/// Over how long changes are taken, s. A servo takes slow torque away by itself: what follows
/// that alone explains power and leaves the peak.
const CHANGE: f64 = 0.01;
/// RMS of what is explained, as a share of the Coulomb level: less is not worth the risk.
const LEAST_SIZE: f64 = 0.01;

/// Share of the Coulomb level that bristles hold at least where an axis slides.
const SLIDES: f64 = 0.95;
/// Length of a stretch that is judged by itself, s.
const STRETCH: f64 = 0.05;
/// Share of the greatest speed below which an axis is slow.
const SLOW: f64 = 0.1;

/// Learns a residual from move to move, a [`super::ResidualModel`] if nothing else is
/// named.
#[derive(Clone, Debug)]
pub struct ResidualLearner<B: ResidualBasis = ResidualTables> {
    basis: B,
    /// Coulomb level at the motor, N·m.
    level: f64,
    coefficients: DVector<f64>,
    model: B::Model,
    /// Prior and moves: normal matrix and right side, in units of the noise.
    normal: DMatrix<f64>,
    right: DVector<f64>,
    /// Share of the power of each move, and of its changes, the lesser, that the model
    /// explained before it saw it.
    explained: Vec<f64>,
}

impl ResidualLearner {
    /// Nothing learned, on an axis with the stroke `stroke`, the travel per radian
    /// `travel` and friction of the Coulomb level `coulomb` (torque at the motor, N·m).
    #[must_use]
    pub fn new(stroke: [f64; 2], travel: f64, coulomb: f64) -> Self {
        Self::of(ResidualTables::new(stroke, travel, coulomb), coulomb)
    }
}

impl<B: ResidualBasis> ResidualLearner<B> {
    /// Nothing learned of the coefficients of `basis`, on an axis with friction of the
    /// Coulomb level `coulomb` (torque at the motor, N·m).
    #[must_use]
    pub fn of(basis: B, coulomb: f64) -> Self {
        let (normal, mean) = basis.prior();
        Self {
            level: coulomb.max(1e-9),
            model: basis.model(mean.as_slice()),
            right: &normal * &mean,
            coefficients: mean,
            normal,
            basis,
            explained: Vec::new(),
        }
    }

    /// Learns from a move: `log` at instants `spacing` seconds apart, its torques smoothed
    /// by a Gaussian of the deviation `smoothing` (s). The share of its power that was
    /// explained before learning from it.
    pub fn learn(&mut self, log: &[Unexplained], spacing: f64, smoothing: f64) -> f64 {
        let explained = self.judge(log, log, spacing, smoothing);
        self.fit(log, spacing, smoothing);
        explained
    }

    /// Judges the residual by a move that neither it nor the parameters have learned from;
    /// otherwise as [`ResidualLearner::learn`], of which it is the first half. `beside` is what
    /// parameters that were found beside the residual leave of the move, `alone` what the
    /// residual must be better than: what parameters that were found without it leave, at
    /// the same instants. The share of the power of the latter that is explained.
    pub fn judge(
        &mut self,
        beside: &[Unexplained],
        alone: &[Unexplained],
        spacing: f64,
        smoothing: f64,
    ) -> f64 {
        self.basis.linearise(self.coefficients.as_slice());
        let both = beside.iter().zip(alone).enumerate();
        let both = both.filter(|(_, (beside, alone))| sound(beside) && sound(alone));
        let mut foreseen = 0.0;
        let mut instants = Vec::new();
        let (log, rests): (Vec<&Unexplained>, Vec<[f64; 2]>) = both
            .map(|(i, (u, alone))| {
                let row = self.basis.row(u, smoothing);
                let part = row.times(self.coefficients.as_slice());
                foreseen += part * part;
                instants.push(i);
                (u, [u.torque - part, alone.torque])
            })
            .unzip();
        let explained = share(powers(&rests));
        if rests.is_empty() || !explained.is_finite() {
            return 0.0;
        }
        let size = sqrt(foreseen / rests.len() as f64);
        let worth = size >= LEAST_SIZE * self.level;
        let harmless = slow_is_no_worse(&log, &rests) && peak_is_no_worse(&rests, spacing);
        let counted = explained.min(share(powers(&changes(&rests, &instants, spacing))));
        self.explained
            .push(if worth && harmless { counted } else { 0.0 });
        explained
    }

    /// Fits the residual to what the parameters leave of a move, besides all moves before;
    /// otherwise as [`ResidualLearner::learn`], of which it is the second half.
    pub fn fit(&mut self, log: &[Unexplained], spacing: f64, smoothing: f64) {
        self.basis.linearise(self.coefficients.as_slice());
        let log = log.iter().filter(|u| sound(u));
        let rows: Vec<(ResidualRow, f64)> = log
            .map(|u| (self.basis.row(u, smoothing), u.torque))
            .collect();
        if rows.is_empty() {
            return;
        }
        let rests = rows
            .iter()
            .map(|(row, torque)| [torque - row.times(self.coefficients.as_slice()), *torque]);
        let [left, whole] = powers(&rests.collect::<Vec<_>>());
        // Neighbours within the Gaussian say the same.
        let same = (2.0 * sqrt(core::f64::consts::PI) * smoothing / spacing).max(1.0);
        self.solve(&rows, same, left.min(whole) / rows.len() as f64);
    }

    /// Adds the rows, `same` of which count as one; their noise is what the fit leaves,
    /// found in a few rounds from `noise` on, N²·m².
    fn solve(&mut self, rows: &[(ResidualRow, f64)], same: f64, mut noise: f64) {
        let mut found = None;
        for _ in 0..3 {
            let weight = 1.0 / (same * noise.max(1e-30));
            let (mut normal, mut right) = (self.normal.clone(), self.right.clone());
            for (row, torque) in rows {
                row.add_to(*torque, weight, &mut normal, &mut right);
            }
            let Some(solved) = normal.clone().cholesky() else {
                break;
            };
            let coefficients = solved.solve(&right);
            let rests = rows
                .iter()
                .map(|(row, torque)| torque - row.times(coefficients.as_slice()));
            noise = rests.map(|rest| rest * rest).sum::<f64>() / rows.len() as f64;
            found = Some((normal, right, coefficients));
        }
        if let Some((normal, right, coefficients)) = found {
            (self.normal, self.right) = (normal, right);
            self.model = self.basis.model(coefficients.as_slice());
            self.coefficients = coefficients;
        }
    }

    /// The model, where it may be used: where it has explained a material part of the last
    /// move, and of the last three together, before it learned from them.
    #[must_use]
    pub fn model(&self) -> Option<&B::Model> {
        let last: Vec<f64> = self.explained.iter().rev().take(3).copied().collect();
        let newest = last.first().copied().unwrap_or(0.0);
        let mean = last.iter().sum::<f64>() / last.len().max(1) as f64;
        (newest > LEAST_EXPLAINED && mean > 0.0).then_some(&self.model)
    }

    /// The model as it is learned, whether or not it may be used.
    #[must_use]
    pub fn latest(&self) -> &B::Model {
        &self.model
    }

    /// Share of the power of each move, and of its changes over 10 ms, the lesser of both, that
    /// was explained before learning from it; 0 if that was too little to matter, or would
    /// have done harm somewhere.
    #[must_use]
    pub fn explained(&self) -> &[f64] {
        &self.explained
    }

    /// The coefficients as they are known now.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        self.coefficients.as_slice()
    }
}

/// Whether an instant of a log can be learned from. While bristles are being loaded, an error
/// of the friction law is far more than what repeats with angle and position; and moves that
/// begin at one place would put it there.
fn sound(at: &Unexplained) -> bool {
    at.torque.is_finite() && at.motor_angle.is_finite() && at.direction.abs() >= SLIDES
}

/// Sums of squares with the residual and without.
fn powers(rests: &[[f64; 2]]) -> [f64; 2] {
    rests.iter().fold([0.0; 2], |[a, b], [with, without]| {
        [a + with * with, b + without * without]
    })
}

/// Share of a power that is gone: of the sums of squares with the residual and without.
fn share([with, without]: [f64; 2]) -> f64 {
    if without > 0.0 {
        1.0 - with / without
    } else {
        0.0
    }
}

/// Changes of the rests over [`CHANGE`], between samples `instants` of a log that are so far apart.
fn changes(rests: &[[f64; 2]], instants: &[usize], spacing: f64) -> Vec<[f64; 2]> {
    let apart = ((CHANGE / spacing) as usize).max(1);
    let pairs = (apart..rests.len()).filter(|i| instants[*i] - instants[i - apart] == apart);
    pairs
        .map(|i| [0, 1].map(|of| rests[i][of] - rests[i - apart][of]))
        .collect()
}

/// Whether the slow part of a log has no more power with the residual (each pair: with it, without) than without.
fn slow_is_no_worse(log: &[&Unexplained], rests: &[[f64; 2]]) -> bool {
    let speeds = log.iter().map(|u| u.motor_speed.abs());
    let slow = SLOW * speeds.clone().fold(0.0, f64::max);
    let pairs = speeds.zip(rests).filter(|(speed, _)| *speed <= slow);
    let [with, without] = powers(&pairs.map(|(_, rest)| *rest).collect::<Vec<_>>());
    with <= without
}

/// Whether the worst stretch of a log has no more power with the residual than the worst
/// without.
fn peak_is_no_worse(rests: &[[f64; 2]], spacing: f64) -> bool {
    let length = ((STRETCH / spacing) as usize).max(1);
    let worst = |of: usize| {
        let powers = rests.chunks(length).map(|stretch| {
            let squares = stretch.iter().map(|rest| rest[of] * rest[of]);
            squares.sum::<f64>() / stretch.len() as f64
        });
        powers.fold(0.0, f64::max)
    };
    worst(0) <= worst(1)
}
