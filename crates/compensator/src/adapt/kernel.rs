//! A zero-phase Gaussian over a series: value, rate and second rate.

use std::vec::Vec;

use crate::gaussian::{bell, weighed_about};

/// Weights of a Gaussian and of its differences.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    half: usize,
    weights: [Vec<f64>; 3],
}

impl Kernel {
    /// Deviation `sigma` in samples, `period` s apart.
    pub fn new(sigma: f64, period: f64) -> Self {
        // The differences below need one sample more on either side.
        let reach = (4.0 * sigma).ceil() as usize;
        let half = reach + 1;
        let height = |i: isize| match i.unsigned_abs() > reach {
            true => 0.0,
            false => bell(i as f64 / sigma.max(1e-9)),
        };
        let span = -(half as isize)..=half as isize;
        let sum: f64 = span.clone().map(height).sum();
        let of = |f: &dyn Fn(isize) -> f64| span.clone().map(|i| f(i) / sum).collect();
        let value = of(&height);
        let rate = of(&|i| (height(i - 1) - height(i + 1)) / (2.0 * period));
        let second = of(&|i| (height(i - 1) - 2.0 * height(i) + height(i + 1)) / (period * period));
        Self {
            half,
            weights: [value, rate, second],
        }
    }

    /// Samples to either side.
    pub fn half(&self) -> usize {
        self.half
    }

    /// `series` with `half` samples more before and after it: its image through the end
    /// points, so that one in motion goes on moving. Where it rests at its start, the mean
    /// of its first `rest` samples comes before it.
    pub fn pad(&self, series: &[f64], rest: Option<usize>) -> Vec<f64> {
        let (Some(first), Some(last)) = (series.first(), series.last()) else {
            return Vec::new();
        };
        let at = |i: usize| series[i.min(series.len() - 1)];
        let from_end = |i: usize| at((series.len() - 1).saturating_sub(i));
        let rest = rest.map(|count| mean(&series[..count.clamp(1, series.len())]));
        let images = (1..=self.half).rev().map(|i| 2.0 * first - at(i));
        let before = images.map(|image| rest.unwrap_or(image));
        let after = (1..=self.half).map(|i| 2.0 * last - from_end(i));
        before.chain(series.iter().copied()).chain(after).collect()
    }

    /// Value (0), rate (1) or second rate (2) of a series padded by `half`, at the sample
    /// `at` of the series itself.
    pub fn of(&self, which: usize, padded: &[f64], at: usize) -> f64 {
        let window = &padded[at..at + 2 * self.half + 1];
        // About the middle, so that the rates lose no digits to a standing value.
        let middle = window[self.half];
        let sum = weighed_about(middle, &self.weights[which], window);
        if which == 0 { middle + sum } else { sum }
    }
}

/// Mean of values.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
