//! Waves by least squares in samples with gaps.

use std::f64::consts::TAU;

use nalgebra::{Matrix2, Vector2};

/// What a wave of each frequency takes of the power of a series about its mean, by least squares,
/// which needs no even samples (Lomb, Astrophys. Space Sci. 39 (1976) 447–462,
/// doi:10.1007/BF00648343): pairs of a frequency (Hz) and a share from 0 to 1.
///
/// Frequencies are the multiples of `1 / (length * period)` up to a quarter of the rate
/// `1 / period`; samples go to the nearest multiple of `period` (s), and `length`, 1 or more, of
/// these are as long as the series or longer. The sums over samples are
/// transforms of the series and of the instants that have one, so that the cost is that of two
/// transforms of `length` points (Press and Rybicki, Astrophys. J. 338 (1989) 277–280,
/// doi:10.1086/167197).
pub(crate) fn waves(
    times: &[f64],
    series: &[f64],
    period: f64,
    length: usize,
) -> impl Iterator<Item = (f64, f64)> {
    let count = series.len() as f64;
    let mean = series.iter().sum::<f64>() / count.max(1.0);
    let first = times.first().copied().unwrap_or(0.0);
    let (mut values, mut instants) = (vec![0.0; length], vec![0.0; length]);
    let mut power = 0.0;
    for (t, value) in times.iter().zip(series) {
        let slot = ((t - first) / period).round() as usize % length;
        values[slot] += value - mean;
        instants[slot] += 1.0;
        power += (value - mean).powi(2);
    }
    let fft = axis_fourier::forward(length);
    let transform = |mut samples: Vec<f64>| {
        let mut spectrum = fft.make_output_vec();
        // The lengths agree by construction, so the transform cannot fail.
        let done = fft.process(&mut samples, &mut spectrum);
        debug_assert!(done.is_ok());
        spectrum
    };
    let (values, instants) = (transform(values), transform(instants));
    (1..=length / 4).map(move |k| {
        // Sums of cos² ωt, cos ωt sin ωt and sin² ωt from those of cos 2ωt and sin 2ωt.
        let (cos, sin) = (instants[2 * k].re, -instants[2 * k].im);
        let normal = 0.5 * Matrix2::new(count + cos, sin, sin, count - cos);
        let right = Vector2::new(values[k].re, -values[k].im);
        let solution = normal.cholesky().map(|c| c.solve(&right));
        let share = solution.map_or(0.0, |x| x.dot(&right) / power.max(f64::MIN_POSITIVE));
        (k as f64 / (length as f64 * period), share)
    })
}

/// The same of one frequency (Hz), by its sums over the samples.
pub(crate) fn share_of_wave(times: &[f64], series: &[f64], frequency: f64) -> f64 {
    let mean = series.iter().sum::<f64>() / series.len().max(1) as f64;
    let (mut normal, mut right, mut power) = (Matrix2::zeros(), Vector2::zeros(), 0.0);
    for (t, value) in times.iter().zip(series) {
        let (sin, cos) = (TAU * frequency * t).sin_cos();
        let wave = Vector2::new(cos, sin);
        normal += wave * wave.transpose();
        right += wave * (value - mean);
        power += (value - mean).powi(2);
    }
    let solution = normal.cholesky().map(|c| c.solve(&right));
    solution.map_or(0.0, |x| x.dot(&right) / power.max(f64::MIN_POSITIVE))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use nalgebra::{DMatrix, DVector};

    use super::{share_of_wave, waves};

    /// Eight seconds at 100 Hz with three gaps of 0.6 s: a wave of 0.9 Hz beside a slower one.
    fn with_gaps() -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..800)
            .map(|k| 2.0 + 0.01 * f64::from(k + 60 * (k / 200)))
            .collect();
        let wave = |t: &f64| 2.0 * (TAU * 0.9 * t + 1.0).sin() + 0.7 * (TAU * 0.33 * t).cos();
        let series = times.iter().map(wave).collect();
        (times, series)
    }

    /// The same by a singular value decomposition of sines and cosines at the samples' own times.
    #[test]
    fn shares_are_those_of_least_squares_on_the_samples() {
        let (times, series) = with_gaps();
        let mean = series.iter().sum::<f64>() / series.len() as f64;
        let about_mean = DVector::from_iterator(series.len(), series.iter().map(|s| s - mean));
        for (frequency, share) in waves(&times, &series, 0.01, 1990).step_by(17) {
            let wave = |i: usize, j: usize| match j {
                0 => (TAU * frequency * times[i]).sin(),
                _ => (TAU * frequency * times[i]).cos(),
            };
            let columns = DMatrix::from_fn(times.len(), 2, wave);
            let solution = columns.clone().svd(true, true).solve(&about_mean, 1e-12);
            let left = &about_mean - &columns * solution.unwrap();
            let truth = 1.0 - left.norm_squared() / about_mean.norm_squared();
            assert!((share - truth).abs() < 1e-9, "{frequency}: {share} {truth}");
            let alone = share_of_wave(&times, &series, frequency);
            assert!((alone - truth).abs() < 1e-9, "{frequency}: {alone} {truth}");
        }
    }

    #[test]
    fn the_strongest_line_is_the_strongest_wave() {
        let (times, series) = with_gaps();
        let all = waves(&times, &series, 0.01, 1990);
        let (frequency, share) = all.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert!((frequency - 0.9).abs() < 0.03, "{frequency}");
        assert!((0.8..1.0).contains(&share), "{share}");
    }
}
