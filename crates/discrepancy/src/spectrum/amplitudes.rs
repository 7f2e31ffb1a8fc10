//! Amplitudes of the channels of a log.

use std::f64::consts::FRAC_1_SQRT_2;

use nalgebra::Complex;

use super::layout::Layout;
use super::transform::Transform;

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
