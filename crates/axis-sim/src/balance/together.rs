//! How much of an effort goes with the acceleration of a measured motion.

use super::spectrum::Source;

/// Powers of acceleration and effort, and of both together, up to each frequency.
#[derive(Clone, Debug)]
pub(super) struct Together {
    /// Hz.
    bin: f64,
    /// Up to each bin: of a², a T and T², T being the effort about its mean.
    sums: Vec<[f64; 3]>,
}

impl Together {
    /// Of a motion's samples and an effort's, a `period` (s) apart. Both are windowed alike.
    pub fn of(motion: &[f64], source: Source, effort: &[f64], period: f64) -> Self {
        let order = source.order();
        // Differences whose middles lie on, or between, the effort's samples.
        let mut differences = motion.to_vec();
        let mut effort = effort.to_vec();
        for _ in 0..order {
            differences = differences.windows(2).map(|w| w[1] - w[0]).collect();
            effort = effort.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
        }
        let mean = effort.iter().sum::<f64>() / effort.len().max(1) as f64;
        effort.iter_mut().for_each(|value| *value -= mean);
        let n = differences.len().min(effort.len()).max(1);
        let window = |k: usize| {
            (std::f64::consts::PI * (k as f64 + 0.5) / n as f64)
                .sin()
                .powi(2)
        };
        let power: f64 = (0..n).map(|k| window(k).powi(2)).sum();
        let fft = axis_fourier::forward(n);
        let transform = |series: &[f64]| {
            let mut windowed: Vec<f64> = series
                .iter()
                .enumerate()
                .map(|(k, v)| window(k) * v)
                .collect();
            windowed.resize(n, 0.0);
            let mut spectrum = fft.make_output_vec();
            // The lengths agree by construction, so the transform cannot fail.
            let _ = fft.process(&mut windowed, &mut spectrum);
            spectrum
        };
        let (differences, effort) = (transform(&differences), transform(&effort));
        let bin = 1.0 / (n as f64 * period);
        let scale = 2.0 / (n as f64 * power.max(f64::MIN_POSITIVE));
        let mut sum = [0.0; 3];
        let pairs = differences.iter().zip(&effort).enumerate();
        let sums = pairs.map(|(k, (difference, effort))| {
            let omega = std::f64::consts::TAU * k as f64 * bin;
            let half = 0.5 * omega * period;
            // A difference is 2 sin(ωh/2)/ω of a derivative, a mean of neighbours cos(ωh/2) of the series.
            let (per_difference, per_mean) = (omega / (2.0 * half.sin()), 1.0 / half.cos());
            // At zero frequency nothing is known, and of half the rate a mean shows nothing.
            if k > 0 && half.cos() > 1e-6 {
                let acceleration = *difference * per_difference.powi(order);
                let effort = *effort * per_mean.powi(order);
                sum[0] += scale * acceleration.norm_sqr();
                sum[1] += scale * (acceleration * effort.conj()).re;
                sum[2] += scale * effort.norm_sqr();
            }
            sum
        });
        Self {
            bin,
            sums: sums.collect(),
        }
    }

    /// Mean squares up to a frequency (Hz) of acceleration and effort, and the mean of their product
    /// between them.
    pub fn up_to(&self, frequency: f64) -> [f64; 3] {
        let last = self.sums.len().saturating_sub(1);
        let at = ((frequency / self.bin) as usize).min(last);
        self.sums.get(at).copied().unwrap_or([0.0; 3])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{Source, Together};

    /// T = J a + c with waves of 3 and 40 Hz, of which a cut between sees the first alone.
    #[test]
    fn an_effort_of_inertia_goes_with_the_acceleration() {
        const INERTIA: f64 = 0.7;
        let parts = [(0.5, 3.0), (0.01, 40.0)];
        let sum = |power: i32, sign: f64| -> Vec<f64> {
            let at = |k: usize| {
                let part = |(size, f): &(f64, f64)| {
                    sign * size * (TAU * f).powi(power) * (TAU * f * k as f64 * 1e-3).sin()
                };
                parts.iter().map(part).sum()
            };
            (0..8000).map(at).collect()
        };
        let effort: Vec<f64> = sum(2, -1.0).iter().map(|a| INERTIA * a + 9.0).collect();
        let speed: Vec<f64> = {
            let at = |k: usize| {
                let part =
                    |(size, f): &(f64, f64)| size * TAU * f * (TAU * f * k as f64 * 1e-3).cos();
                parts.iter().map(part).sum()
            };
            (0..8000).map(at).collect()
        };
        for (motion, source) in [(sum(0, 1.0), Source::Position), (speed, Source::Speed)] {
            let both = Together::of(&motion, source, &effort, 1e-3);
            for (frequency, (size, f)) in [(20.0, parts[0]), (60.0, parts[1])] {
                let [a, at, t] = both.up_to(frequency);
                let before = match frequency < 30.0 {
                    true => 0.0,
                    false => both.up_to(20.0)[0],
                };
                let wanted = 0.5 * (size * (TAU * f).powi(2)).powi(2);
                assert!(((a - before) / wanted - 1.0).abs() < 0.01, "{a} {wanted}");
                assert!((at / a / INERTIA - 1.0).abs() < 1e-3, "{}", at / a);
                assert!((t / a / INERTIA.powi(2) - 1.0).abs() < 2e-3, "{}", t / a);
            }
        }
    }
}
