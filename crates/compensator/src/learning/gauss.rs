//! A zero-phase Gaussian over a whole record.

use alloc::vec::Vec;

use axis_scalar::Scalar;

use crate::gaussian::bell;

/// A Gaussian of a deviation in samples, cut off at four of them. Beyond the record's ends
/// its first and last values go on.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauss {
    /// Weight at the middle and to one side, their sum over both sides 1.
    weights: Vec<f64>,
}

impl Gauss {
    /// Of a deviation in samples; 0 or less passes everything.
    #[must_use]
    pub fn new(sigma: f64) -> Self {
        let half = if sigma > 0.0 {
            Scalar::ceil(4.0 * sigma).min(1e6) as usize
        } else {
            0
        };
        let height = |m: usize| match m {
            0 => 1.0,
            _ => bell(m as f64 / sigma),
        };
        let mut weights: Vec<f64> = (0..=half).map(height).collect();
        let sum = 2.0 * weights.iter().sum::<f64>() - 1.0;
        weights.iter_mut().for_each(|w| *w /= sum);
        Self { weights }
    }

    /// The record behind it.
    #[must_use]
    pub fn pass(&self, record: &[f64]) -> Vec<f64> {
        let last = record.len().saturating_sub(1);
        let one = |k: usize| {
            let mut sum = self.weights[0] * record[k];
            for (m, weight) in self.weights.iter().enumerate().skip(1) {
                sum += weight * (record[k.saturating_sub(m)] + record[(k + m).min(last)]);
            }
            sum
        };
        (0..record.len()).map(one).collect()
    }

    /// Deviation behind it of white noise of deviation 1.
    #[must_use]
    pub fn noise_gain(&self) -> f64 {
        let middle = self.weights[0] * self.weights[0];
        let sides: f64 = self.weights.iter().skip(1).map(|w| w * w).sum();
        Scalar::sqrt(middle + 2.0 * sides)
    }
}
