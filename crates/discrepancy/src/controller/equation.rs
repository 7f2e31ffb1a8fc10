//! Equation error: the logged command beside that of a control shown the logged signals.

use axis_sim::Axis;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::law::Law;
use super::low_pass::low_pass;
use super::seen::Seen;

/// Samples at both ends of a log that are not compared: the low pass begins there.
const ENDS: usize = 20;

/// Parts into which logs are cut to see by how much chance moves what is found.
pub const BLOCKS: usize = 20;

/// Logs whose commands are to be explained.
pub struct Equation<'a> {
    pub axis: &'a Axis,
    pub logs: Vec<Seen>,
}

impl<'a> Equation<'a> {
    pub fn new(axis: &'a Axis, logs: Vec<Seen>) -> Self {
        Self { axis, logs }
    }

    /// Corner of the low pass of a log, Hz: a tenth of the slower of control and log.
    fn cutoff(&self, log: &Seen) -> f64 {
        0.1 / log.log_period.max(self.axis.period)
    }

    /// A series at a log's instants as it is compared: through the low pass and the law's
    /// high pass, without its ends and what was not measured, and without its mean where a
    /// constant is free.
    fn compared_by(&self, log: &Seen, law: &Law, series: &[f64]) -> Vec<f64> {
        let passed = low_pass(series, self.cutoff(log), log.log_period);
        let passed = high_pass(&passed, law.washout * log.log_period);
        Self::counted(log, law.has_constant, passed)
    }

    /// The same through the low pass alone.
    pub fn compared(&self, log: &Seen, has_constant: bool, series: &[f64]) -> Vec<f64> {
        let passed = low_pass(series, self.cutoff(log), log.log_period);
        Self::counted(log, has_constant, passed)
    }

    fn counted(log: &Seen, has_constant: bool, mut series: Vec<f64>) -> Vec<f64> {
        let n = series.len();
        let counts = |k: usize| k >= ENDS && k + ENDS < n && !log.missing[k];
        let mean = match has_constant {
            true => {
                let sum: f64 = (0..n).filter(|&k| counts(k)).map(|k| series[k]).sum();
                sum / (0..n).filter(|&k| counts(k)).count().max(1) as f64
            }
            false => 0.0,
        };
        for (k, value) in series.iter_mut().enumerate() {
            *value = if counts(k) { *value - mean } else { 0.0 };
        }
        series
    }

    /// What the law commands on the signals `shown` in the place of the logged ones; none
    /// if it cannot.
    fn model(&self, law: &Law, at: &[f64], shown: &[Seen]) -> Option<DVector<f64>> {
        let delay = *at.last()?;
        let one = |(log, shown): (&Seen, &Seen)| {
            let command = law.command(self.axis, at, shown)?;
            let instants = (0..log.command.len()).map(|k| k as f64 * log.log_period - delay);
            let late: Vec<f64> = instants
                .map(|t| interpolated(&command, t / self.axis.period))
                .collect();
            Some(self.compared_by(log, law, &late))
        };
        let logs: Option<Vec<Vec<f64>>> = self.logs.par_iter().zip(shown).map(one).collect();
        Some(DVector::from_vec(logs?.concat()))
    }

    /// What the law leaves of the logged commands.
    pub fn rest(&self, law: &Law, at: &[f64]) -> Option<DVector<f64>> {
        let target = |log: &Seen| self.compared_by(log, law, &log.command);
        let target = DVector::from_vec(self.logs.iter().flat_map(target).collect());
        Some(target - self.model(law, at, &self.logs)?)
    }

    /// Share of the command, in mean square about its mean, that the law leaves.
    pub fn left(&self, law: &Law, at: &[f64]) -> Option<f64> {
        let own = |log: &Seen| self.compared(log, true, &log.command);
        let all: f64 = self.logs.iter().flat_map(own).map(|u| u * u).sum();
        let rest = self.rest(&law.plain(), at)?.norm_squared();
        (all > 0.0).then(|| rest / all)
    }

    /// What the law leaves of the logs' commands, in parts of equal length: sums of squares.
    pub fn losses(&self, law: &Law, at: &[f64]) -> Option<Vec<f64>> {
        let rest = self.rest(&law.plain(), at)?;
        let length = rest.len().div_ceil(BLOCKS).max(1);
        let parts = rest.as_slice().chunks(length);
        Some(parts.map(|part| part.iter().map(|r| r * r).sum()).collect())
    }

    /// Derivatives of the command by what is free, times its scale, on the signals `shown`.
    pub fn columns(&self, law: &Law, at: &[f64], shown: &[Seen]) -> Option<DMatrix<f64>> {
        let column = |i: usize| {
            let free = &law.free[i];
            let step = 1e-3 * free.scale;
            let [low, high] = free.room;
            let steps = [(high - at[i]).min(step), (low - at[i]).max(-step)];
            let moved = |by: f64| {
                let mut at = at.to_vec();
                at[i] += by;
                self.model(law, &at, shown)
            };
            let difference = moved(steps[0])? - moved(steps[1])?;
            Some(difference * (free.scale / (steps[0] - steps[1])))
        };
        let columns: Option<Vec<DVector<f64>>> =
            (0..at.len()).into_par_iter().map(column).collect();
        Some(DMatrix::from_columns(&columns?))
    }
}

/// A first-order high pass with its corner at `corner` rad a sample, at rest at the first
/// one; as it is where the corner is 0.
fn high_pass(samples: &[f64], corner: f64) -> Vec<f64> {
    if corner <= 0.0 || samples.is_empty() {
        return samples.to_vec();
    }
    let pole = (-corner).exp();
    let (mut before, mut out) = (samples[0], 0.0);
    let pass = |sample: &f64| {
        out = pole * out + sample - before;
        before = *sample;
        out
    };
    samples.iter().map(pass).collect()
}

/// Linear between samples; the sample itself at its instant.
pub fn interpolated(samples: &[f64], along: f64) -> f64 {
    let Some(last) = samples.len().checked_sub(1) else {
        return 0.0;
    };
    let along = along.clamp(0.0, last as f64);
    let near = along.round();
    if (along - near).abs() < 1e-6 {
        return samples[near as usize];
    }
    let (i, part) = (along as usize, along.fract());
    (1.0 - part) * samples[i] + part * samples[(i + 1).min(last)]
}

#[cfg(test)]
mod tests {
    use super::high_pass;

    /// What wanders as the integral of a constant error does, a ramp, ends at its slope
    /// over the corner; a constant is gone.
    #[test]
    fn a_high_pass_takes_a_constant_and_holds_a_ramp() {
        assert!(high_pass(&[3.0; 40], 0.1).iter().all(|y| *y == 0.0));
        let ramp: Vec<f64> = (0..400).map(|k| 0.5 * f64::from(k)).collect();
        let end = high_pass(&ramp, 0.1)[399];
        let exact = 0.5 / (1.0 - (-0.1_f64).exp());
        assert!((end / exact - 1.0).abs() < 1e-12, "{end}");
        assert_eq!(high_pass(&ramp, 0.0), ramp);
    }
}
