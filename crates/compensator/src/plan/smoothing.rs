//! A zero-phase Gaussian over a stream: value, rate and second rate at its middle.

use axis_scalar::Scalar;

use crate::gaussian::{bell, weighed_about};

/// Most control periods from the middle to either end.
pub(super) const MOST_HALF: usize = 192;
const WINDOW: usize = 2 * MOST_HALF + 1;

/// Weights of a window, and the window.
#[derive(Clone, Debug)]
pub(super) struct Smoothing<T> {
    half: usize,
    /// Of value, rate and second rate, oldest sample first.
    weights: [[T; WINDOW]; 3],
    /// The last samples, each written twice, so that a window is always in one piece.
    samples: [T; 2 * WINDOW],
    /// Where the next one goes.
    next: usize,
}

impl<T: Scalar> Smoothing<T> {
    /// Deviation `sigma` in periods of `period` seconds, `half` periods to either side.
    pub fn new(sigma: T, half: usize, period: T) -> Self {
        let half = half.clamp(1, MOST_HALF);
        let mut heights = [T::ZERO; WINDOW + 2];
        // One sample less than the window on either side: the rates are differences.
        for (i, at) in heights.iter_mut().enumerate().take(2 * half + 1).skip(2) {
            *at = if i == half + 1 {
                T::ONE
            } else {
                bell(T::of(i as f64 - half as f64 - 1.0) / sigma.max(T::MIN_POSITIVE))
            };
        }
        let sum: T = heights.iter().copied().sum();
        let mut weights = [[T::ZERO; WINDOW]; 3];
        for i in 0..=2 * half {
            // heights[i + 1] is that of sample i.
            let [before, at, after] = [heights[i], heights[i + 1], heights[i + 2]].map(|h| h / sum);
            weights[0][i] = at;
            weights[1][i] = (before - after) / (T::TWO * period);
            weights[2][i] = (before - T::TWO * at + after) / (period * period);
        }
        Self {
            half,
            weights,
            samples: [T::ZERO; 2 * WINDOW],
            next: 0,
        }
    }

    /// Of value, rate and second rate, oldest sample first.
    pub fn weights(&self) -> [&[T]; 3] {
        let length = 2 * self.half + 1;
        [0, 1, 2].map(|i| &self.weights[i][..length])
    }

    /// As if `value` had come for ever.
    pub fn settle(&mut self, value: T) {
        self.samples = [value; 2 * WINDOW];
    }

    /// Takes the newest sample; value, rate and second rate `half` samples ago.
    pub fn push(&mut self, sample: T) -> [T; 3] {
        let length = 2 * self.half + 1;
        self.samples[self.next] = sample;
        self.samples[self.next + length] = sample;
        self.next = (self.next + 1) % length;
        let window = &self.samples[self.next..self.next + length];
        // About the middle, so that the rates lose no digits to a standing value.
        let middle = window[self.half];
        let [value, rate, second] =
            [0, 1, 2].map(|i| weighed_about(middle, &self.weights[i][..length], window));
        [middle + value, rate, second]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A parabola keeps its rates, and its value but for σ² times its curvature.
    #[test]
    fn polynomials_pass_as_they_must() {
        let (period, sigma, half) = (1e-4, 20.0, 80);
        let mut smoothing = Smoothing::new(sigma, half, period);
        let at = |k: f64| 3.0 + 2.0 * k * period + 0.5 * 7.0 * (k * period).powi(2);
        let mut out = [0.0; 3];
        for k in 0..400 {
            out = smoothing.push(at(f64::from(k)));
        }
        let middle = 399.0 - half as f64;
        let spread = 0.5 * 7.0 * (sigma * period).powi(2);
        assert!((out[0] - at(middle) - spread).abs() < 0.01 * spread + 1e-12);
        assert!((out[1] - 2.0 - 7.0 * middle * period).abs() < 1e-9);
        assert!((out[2] - 7.0).abs() < 1e-6, "{out:?}");
    }
}
