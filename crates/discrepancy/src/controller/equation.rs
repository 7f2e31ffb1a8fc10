//! Equation error: the logged command beside that of a control shown the logged signals.

use axis_sim::Axis;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::law::Law;
use super::low_pass::low_pass;
use super::seen::{Seen, interpolated};

/// Blocks of the logs whose scores are compared for the intervals.
const BLOCKS: usize = 20;
/// Control cycles at both ends of a log that are not compared.
const ENDS: usize = 20;
/// Delays of a logged command that are accepted, control cycles.
const DELAYS: [f64; 2] = [-10.0, 50.0];

/// Logs whose commands are to be explained.
pub struct Equation<'a> {
    axis: &'a Axis,
    pub logs: Vec<Seen>,
    commands: Vec<Vec<f64>>,
}

/// Gains that were found.
pub struct Solved {
    /// The free values in SI units, and the delay in control cycles.
    pub at: Vec<f64>,
    /// Their half widths at 95 %.
    pub half_widths: Vec<f64>,
    /// Whether with instruments.
    pub instrumented: bool,
}

impl Solved {
    /// 95 % interval of a value.
    pub fn interval(&self, i: usize) -> [f64; 2] {
        [-1.0, 1.0].map(|sign| self.at[i] + sign * self.half_widths[i])
    }
}

impl<'a> Equation<'a> {
    pub fn new(axis: &'a Axis, logs: Vec<Seen>) -> Self {
        let mut equation = Self {
            axis,
            logs,
            commands: Vec::new(),
        };
        let pass = |log: &Seen| low_pass(&log.command, equation.cutoff(), axis.period);
        equation.commands = equation.logs.iter().map(pass).collect();
        equation
    }

    /// Corner of the low pass, Hz: a tenth of the slower of control and logs.
    pub fn cutoff(&self) -> f64 {
        let slowest = self.logs.iter().map(|log| log.log_period);
        0.1 / slowest.fold(self.axis.period, f64::max)
    }

    /// A series of a log as it is compared: without its ends and what was not measured, and
    /// without its mean where a constant is free.
    fn compared(&self, log: &Seen, has_constant: bool, mut series: Vec<f64>) -> Vec<f64> {
        let n = series.len();
        let counts = |k: usize| k >= ENDS && k + ENDS < n && !log.missing[k];
        let counted: Vec<f64> = (0..n).filter(|&k| counts(k)).map(|k| series[k]).collect();
        let mean = match has_constant {
            true => counted.iter().sum::<f64>() / counted.len().max(1) as f64,
            false => 0.0,
        };
        for (k, value) in series.iter_mut().enumerate() {
            *value = if counts(k) { *value - mean } else { 0.0 };
        }
        series
    }

    /// What the law commands on `shown`, as it is compared; none where it cannot.
    fn model(&self, law: &Law, at: &[f64], shown: &[Seen]) -> Option<Vec<f64>> {
        let delay = *at.last()?;
        let one = |log: &Seen| {
            let passed = low_pass(
                &law.command(self.axis, at, log)?,
                self.cutoff(),
                self.axis.period,
            );
            let late = (0..passed.len()).map(|k| interpolated(&passed, k as f64 - delay));
            Some(self.compared(log, law.has_constant, late.collect()))
        };
        let logs: Option<Vec<Vec<f64>>> = shown.par_iter().map(one).collect();
        Some(logs?.concat())
    }

    fn target(&self, has_constant: bool) -> Vec<f64> {
        let logs = self.logs.iter().zip(&self.commands);
        logs.flat_map(|(log, command)| self.compared(log, has_constant, command.clone()))
            .collect()
    }

    fn rest(&self, law: &Law, at: &[f64]) -> Option<DVector<f64>> {
        let model = self.model(law, at, &self.logs)?;
        let pairs = self.target(law.has_constant).into_iter().zip(model);
        Some(DVector::from_iterator(
            pairs.len(),
            pairs.map(|(u, model)| u - model),
        ))
    }

    /// Share of the command, in mean square about its mean, that the law leaves.
    pub fn left(&self, law: &Law, at: &[f64]) -> Option<f64> {
        let all: f64 = self.target(true).iter().map(|u| u * u).sum();
        let rest = self.rest(law, at)?.norm_squared();
        (all > 0.0).then(|| rest / all)
    }

    /// Derivatives of the command by what is free, on the signals `shown`.
    fn columns(
        &self,
        law: &Law,
        at: &[f64],
        scales: &[f64],
        shown: &[Seen],
    ) -> Option<DMatrix<f64>> {
        let column = |i: usize| {
            let step = 1e-3 * scales[i];
            let moved = |by: f64| {
                let mut at = at.to_vec();
                at[i] += by;
                self.model(law, &at, shown)
            };
            // A value at the edge of what its key takes has one side.
            let low = if i + 1 < at.len() && at[i] < step {
                0.0
            } else {
                -step
            };
            let (up, down) = (moved(step)?, moved(low)?);
            let quotient = up
                .iter()
                .zip(&down)
                .map(|(a, b)| (a - b) / (step - low) * scales[i]);
            Some(DVector::from_iterator(up.len(), quotient))
        };
        let columns: Option<Vec<DVector<f64>>> =
            (0..at.len()).into_par_iter().map(column).collect();
        Some(DMatrix::from_columns(&columns?))
    }

    /// Gauss–Newton from a start, by least squares, or with the derivatives on `instruments`
    /// in place of the logged signals'; none where nothing can be compared.
    pub fn solve(
        &self,
        law: &Law,
        start: &[f64],
        scales: &[f64],
        instruments: Option<&[Seen]>,
    ) -> Option<Solved> {
        let mut at = start.to_vec();
        let mut rest = self.rest(law, &at)?;
        let (mut normal, mut z) = self.normal(law, &at, scales, instruments)?;
        for _ in 0..20 {
            let step = normal.clone().lu().solve(&(z.tr_mul(&rest)))?;
            let trial = |length: f64| {
                let moved = moved(&at, &step, scales, length);
                let rest = self.rest(law, &moved)?;
                Some((moved, rest))
            };
            // With instruments the root of the score is sought, not the least square.
            let closer = |other: &DVector<f64>| match instruments {
                None => other.norm_squared() < rest.norm_squared(),
                Some(_) => z.tr_mul(other).norm() < z.tr_mul(&rest).norm(),
            };
            let lengths = [1.0, 0.5, 0.2, 0.05].into_iter();
            let Some((moved, left)) = lengths.filter_map(trial).find(|(_, left)| closer(left))
            else {
                break;
            };
            let change = moved
                .iter()
                .zip(&at)
                .zip(scales)
                .map(|((a, b), s)| ((a - b) / s).abs());
            let small = change.fold(0.0, f64::max) < 1e-8;
            (at, rest) = (moved, left);
            if small {
                break;
            }
            (normal, z) = self.normal(law, &at, scales, instruments)?;
        }
        let half_widths = half_widths(&normal, &z, &rest)?;
        Some(Solved {
            half_widths: half_widths.iter().zip(scales).map(|(w, s)| w * s).collect(),
            instrumented: instruments.is_some(),
            at,
        })
    }

    /// Zᵀ J with a ridge far below what data say, and Z.
    fn normal(
        &self,
        law: &Law,
        at: &[f64],
        scales: &[f64],
        instruments: Option<&[Seen]>,
    ) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        let columns = self.columns(law, at, scales, &self.logs)?;
        let z = match instruments {
            Some(shown) => self.columns(law, at, scales, shown)?,
            None => columns.clone(),
        };
        let mut normal = z.tr_mul(&columns);
        let largest = normal.diagonal().amax();
        for i in 0..normal.nrows() {
            normal[(i, i)] += 1e-12 * largest;
        }
        Some((normal, z))
    }
}

fn moved(at: &[f64], step: &DVector<f64>, scales: &[f64], length: f64) -> Vec<f64> {
    let delay = at.len() - 1;
    let one = |(i, value): (usize, &f64)| {
        // What moves far has left the range of its derivative.
        let by = (length * step[i]).clamp(-1.0, 1.0) * scales[i];
        match i == delay {
            true => (value + by).clamp(DELAYS[0], DELAYS[1]),
            false => (value + by).max(0.0),
        }
    };
    at.iter().enumerate().map(one).collect()
}

/// Half widths at 95 % from the scatter of the score over blocks.
fn half_widths(normal: &DMatrix<f64>, z: &DMatrix<f64>, rest: &DVector<f64>) -> Option<Vec<f64>> {
    let (n, parameters) = (rest.len(), normal.nrows());
    let length = n.div_ceil(BLOCKS).max(1);
    let mut scatter = DMatrix::zeros(parameters, parameters);
    for begin in (0..n).step_by(length) {
        let rows = length.min(n - begin);
        let score = z.rows(begin, rows).tr_mul(&rest.rows(begin, rows));
        scatter += &score * score.transpose();
    }
    let freedom = BLOCKS.saturating_sub(parameters).max(1) as f64;
    let inverse = normal.clone().try_inverse()?;
    let covariance = &inverse * scatter * inverse.transpose() * (BLOCKS as f64 / freedom);
    let t = StudentsT::new(0.0, 1.0, freedom).ok()?.inverse_cdf(0.975);
    Some(
        (0..parameters)
            .map(|i| t * covariance[(i, i)].max(0.0).sqrt())
            .collect(),
    )
}
