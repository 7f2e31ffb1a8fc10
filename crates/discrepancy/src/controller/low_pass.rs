//! The low pass through which commands are compared: no delay, the same for both.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// A second-order Butterworth low pass with its corner at `cutoff` (Hz) on samples `period`
/// seconds apart, run forward and back: fourth order without phase. It begins at rest at the
/// first and the last sample. As it is where the corner is no longer below 0.45 of the rate.
pub fn low_pass(samples: &[f64], cutoff: f64, period: f64) -> Vec<f64> {
    if cutoff * period >= 0.45 || samples.is_empty() {
        return samples.to_vec();
    }
    // Bilinear transform with its corner set right.
    let k = (PI * cutoff * period).tan();
    let norm = 1.0 / (1.0 + k / FRAC_1_SQRT_2 + k * k);
    let b = k * k * norm;
    let a = [
        2.0 * (k * k - 1.0) * norm,
        (1.0 - k / FRAC_1_SQRT_2 + k * k) * norm,
    ];
    let pass = |samples: &mut Vec<f64>| {
        let (mut x, mut y) = ([samples[0]; 2], [samples[0]; 2]);
        for sample in samples.iter_mut() {
            let out = b * (*sample + 2.0 * x[0] + x[1]) - a[0] * y[0] - a[1] * y[1];
            (x, y) = ([*sample, x[0]], [out, y[0]]);
            *sample = out;
        }
        samples.reverse();
    };
    let mut passed = samples.to_vec();
    pass(&mut passed);
    pass(&mut passed);
    passed
}

#[cfg(test)]
mod tests {
    use super::low_pass;

    #[test]
    fn a_constant_stays_and_a_wave_at_the_corner_is_halved_without_delay() {
        assert!(
            low_pass(&[3.0; 50], 10.0, 1e-3)
                .iter()
                .all(|y| (y - 3.0).abs() < 1e-12)
        );
        let wave: Vec<f64> = (0..4000)
            .map(|k| (0.02 * std::f64::consts::PI * f64::from(k)).sin())
            .collect();
        let passed = low_pass(&wave, 10.0, 1e-3);
        for k in 1500..2500 {
            assert!((passed[k] - 0.5 * wave[k]).abs() < 1e-6, "{k}");
        }
    }
}
