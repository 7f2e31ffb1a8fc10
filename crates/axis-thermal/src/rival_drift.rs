//! Laws that need no heat, against which the network's states must hold: drifts with time and with the distance travelled.
//!
//! ```text
//! growth      δ = (a + b x) u
//! friction    P = (a + b u) P_dry + (c + d u) P_viscous
//! ```
//!
//! u is the time since the log's begin, or the distance travelled; a to d by linear least squares on what is fitted.

use nalgebra::{DMatrix, DVector};

use crate::growth_log::{GrowthLog, GrowthZeros, usual_duration};
use crate::heat_effects::{Deviations, Fitted, HeldLog};

/// What a rival drift is proportional to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum DriftOver {
    /// The time since the log began.
    Time,
    /// The distance that the axis has travelled since.
    Distance,
}

impl DriftOver {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Time, Self::Distance];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Distance => "distance travelled",
        }
    }
}

/// A drift beside the readings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RivalDrift {
    /// What it is proportional to.
    pub over: DriftOver,
    /// Sums of squares over the deviations: of what was fitted, of what was not.
    pub deviance: [f64; 2],
}

/// Rows of a linear problem: what each asks for, and whether it is fitted.
struct Rows<const N: usize> {
    columns: Vec<[f64; N]>,
    asked: Vec<f64>,
    fitted: Vec<bool>,
}

impl<const N: usize> Rows<N> {
    fn new() -> Self {
        Self {
            columns: Vec::new(),
            asked: Vec::new(),
            fitted: Vec::new(),
        }
    }

    /// Sums of squares of the residual: over the rows that are fitted, over the held-out rows.
    fn left(&self) -> [f64; 2] {
        let fitted: Vec<usize> = (0..self.asked.len()).filter(|i| self.fitted[*i]).collect();
        let matrix = DMatrix::from_fn(fitted.len(), N, |i, j| self.columns[fitted[i]][j]);
        let asked = DVector::from_iterator(fitted.len(), fitted.iter().map(|i| self.asked[*i]));
        // Columns of very different units.
        let norms: Vec<f64> = matrix.column_iter().map(|c| c.norm().max(1e-300)).collect();
        let scaled = DMatrix::from_fn(fitted.len(), N, |i, j| matrix[(i, j)] / norms[j]);
        let solved = scaled.svd(true, true).solve(&asked, 1e-9);
        let solved = solved.unwrap_or_else(|_| DVector::zeros(N));
        let mut sums = [0.0; 2];
        for (i, (row, asked)) in self.columns.iter().zip(&self.asked).enumerate() {
            let made: f64 = (0..N).map(|j| row[j] * solved[j] / norms[j]).sum();
            sums[usize::from(!self.fitted[i])] += (made - asked).powi(2);
        }
        sums
    }
}

/// u at the end of each stretch, and in its middle.
fn drifts(log: &GrowthLog, over: DriftOver) -> Vec<[f64; 2]> {
    let mut u = 0.0;
    let stretches = log.stretches.iter().map(|stretch| {
        let rate = match over {
            DriftOver::Time => 1.0,
            DriftOver::Distance => stretch.duty.mean_speed(),
        };
        let before = u;
        u += rate * stretch.duration;
        [u, 0.5 * (before + u)]
    });
    stretches.collect()
}

/// The best drifts of the growth.
pub(crate) fn of_growth(logs: &[HeldLog], deviation: f64) -> Vec<RivalDrift> {
    let one = |over: DriftOver| {
        let mut rows = Rows::<2>::new();
        for held in logs {
            let drifts = drifts(&held.log, over);
            // What readings count from, of each column.
            let mut zeros = [0, 1].map(|_| GrowthZeros::new(held.log.zero));
            for (i, stretch) in held.log.stretches.iter().enumerate() {
                let u = drifts[i][0];
                for &[place, found] in &stretch.found {
                    let [alike, along] = &mut zeros;
                    let alike = alike.counted([place, found, u]);
                    let along = along.counted([place, found, u * place]);
                    if let (Some([_, found, a]), Some([_, _, b])) = (alike, along) {
                        rows.columns.push([a / deviation, b / deviation]);
                        rows.asked.push(found / deviation);
                        rows.fitted.push(i < held.fitted);
                    }
                }
            }
        }
        let deviance = rows.left();
        RivalDrift { over, deviance }
    };
    DriftOver::ALL.map(one).to_vec()
}

/// The best drifts of the friction.
pub(crate) fn of_friction(
    logs: &[HeldLog],
    fitted: &Fitted,
    deviations: Deviations,
) -> Vec<RivalDrift> {
    let usual = usual_duration(&fitted.followed);
    let one = |over: DriftOver| {
        let mut rows = Rows::<4>::new();
        for (held, followed) in logs.iter().zip(&fitted.followed) {
            let drifts = drifts(&held.log, over);
            for read in followed.powers() {
                let [dry, viscous] = held.log.stretches[read.stretch].duty.friction_power();
                let weight = (read.duration / usual).sqrt() / deviations.friction;
                let u = drifts[read.stretch][1];
                let columns = [dry, viscous, u * dry, u * viscous];
                rows.columns
                    .push(columns.map(|power| weight * power / read.found));
                rows.asked.push(weight);
                rows.fitted.push(read.stretch < held.fitted);
            }
        }
        let deviance = rows.left();
        RivalDrift { over, deviance }
    };
    DriftOver::ALL.map(one).to_vec()
}
