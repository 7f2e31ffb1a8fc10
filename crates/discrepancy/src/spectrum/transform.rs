//! From samples to amplitudes.

use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt;
use std::sync::Arc;

use axis_fourier::RealToComplex;
use nalgebra::Complex;

use super::layout::{Layout, RAMP};

/// What the averages of a log are transformed with: a search does so thousands of times.
#[derive(Clone)]
pub(super) struct Transform {
    fft: Arc<dyn RealToComplex<f64>>,
    taper: Arc<[f64]>,
}

impl fmt::Debug for Transform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Transform")
            .field("length", &self.taper.len())
            .finish_non_exhaustive()
    }
}

impl Transform {
    /// Of `n` averages, `period` seconds apart, that count from `begin` on, s.
    pub(super) fn new(n: usize, period: f64, begin: f64) -> Self {
        Self {
            fft: axis_fourier::forward(n),
            taper: taper(n, period, begin),
        }
    }
}

impl Layout {
    /// Transforms the channels of one log, scaled so that of white noise of unit
    /// variance in its samples each real number in the amplitudes has the variance 1/2
    /// at low frequency; the imaginary part at zero frequency is 0.
    ///
    /// Channels that are `free` count from no zero of their own: their mean is
    /// taken out.
    pub fn transform(&self, log: usize, series: &[Vec<f64>], free: &[bool]) -> Vec<Complex<f64>> {
        let bins = self.bands[log].len();
        let block = self.logs[log].0;
        let Transform { fft, taper } = &self.transforms[log];
        let mut out = vec![Complex::new(0.0, 0.0); bins * self.channels];
        let mut spectrum = fft.make_output_vec();
        let mut input = fft.make_input_vec();
        let mut scratch = fft.make_scratch_vec();
        let power: f64 = taper.iter().map(|w| w * w).sum();
        let scale = (block as f64 / power).sqrt();
        for (c, samples) in series.iter().enumerate() {
            let mean = |block: &[f64]| block.iter().sum::<f64>() / block.len() as f64;
            let averages: Vec<f64> = samples.chunks_exact(block).map(mean).collect();
            let weighed = averages.iter().zip(taper.iter()).map(|(x, w)| x * w);
            let zero = if free[c] {
                weighed.sum::<f64>() / taper.iter().sum::<f64>()
            } else {
                0.0
            };
            let pairs = averages.iter().zip(taper.iter());
            for (into, (x, w)) in input.iter_mut().zip(pairs) {
                *into = (x - zero) * w;
            }
            // The lengths agree by construction, so the transform cannot fail.
            let done = fft.process_with_scratch(&mut input, &mut spectrum, &mut scratch);
            if done.is_ok() {
                for (k, value) in spectrum.iter().take(bins).enumerate() {
                    let share = if k == 0 { FRAC_1_SQRT_2 } else { 1.0 };
                    out[k * self.channels + c] = value * (scale * share);
                }
            }
        }
        out
    }
}

/// Cosine ramps at both ends of a log. Noise that has gone round the loop
/// wanders, and ends elsewhere than it began; a transform takes that for a
/// step, which something that happens at the start would explain. Nothing
/// counts before the log's beginning.
fn taper(n: usize, period: f64, begin: f64) -> Arc<[f64]> {
    let ramp = (RAMP / period).min(0.05 * n as f64).max(1.0);
    let first = ((begin / period) as usize).min(n.saturating_sub(1));
    let at = |k: usize| {
        let Some(after) = k.checked_sub(first) else {
            return 0.0;
        };
        let edge = (after.min(n - 1 - k) as f64 + 0.5) / ramp;
        0.5 - 0.5 * (std::f64::consts::PI * edge.min(1.0)).cos()
    };
    (0..n).map(at).collect()
}
