//! What the spectrum of a measured motion says: its noise, and up to which frequency its
//! acceleration can be had.

use std::f64::consts::{LN_2, PI, TAU};

/// How a motion was measured: what is differentiated how often to an acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// A position, m or rad.
    Position,
    /// A speed, m/s or rad/s.
    Speed,
}

impl Source {
    /// Derivatives to the acceleration.
    fn order(self) -> i32 {
        match self {
            Self::Position => 2,
            Self::Speed => 1,
        }
    }
}

/// ∫ f^p / (1 + (f/f_c)⁸)² df from 0 on: what the low-pass of a balance leaves of a density
/// that rises with f^p, p = 0, 2 or 4. With a = (p + 1)/8 it is
/// f_c^(p+1) (1 − a) π / (8 sin πa).
pub(super) fn passed(power: i32, cutoff: f64) -> f64 {
    let a = f64::from(power + 1) / 8.0;
    cutoff.powi(power + 1) * (1.0 - a) * PI / (8.0 * (PI * a).sin())
}

/// ∫ H² cos 2πfτ df / ∫ H² df with the low-pass H of a balance, by the midpoint rule up to four
/// times the cut-off, of which 2e-10 passes: the autocorrelation of white noise behind H.
pub(super) fn correlation(cutoff: f64, over: f64) -> f64 {
    const STEPS: u32 = 400;
    let sum = |of: &dyn Fn(f64) -> f64| -> f64 {
        let places = (0..STEPS).map(|k| 4.0 * (f64::from(k) + 0.5) / f64::from(STEPS));
        places.map(|x| of(x) / (1.0 + x.powi(8)).powi(2)).sum()
    };
    sum(&|x| (TAU * x * cutoff * over).cos()) / sum(&|_| 1.0)
}

/// Power spectral density of a series' differences, one-sided, and what divides it to give
/// that of the series.
struct Differences {
    /// Hz.
    bin: f64,
    /// Unit² of the differences / Hz.
    density: Vec<f64>,
    order: i32,
    period: f64,
}

impl Differences {
    /// Of the differences of that order: of a slow large motion the transform of the series
    /// itself would show its ends at all frequencies.
    fn of(series: &[f64], order: i32, period: f64) -> Self {
        let mut differences = series.to_vec();
        for _ in 0..order {
            differences = differences.windows(2).map(|w| w[1] - w[0]).collect();
        }
        let n = differences.len();
        let window = |k: usize| (0.5 * TAU * (k as f64 + 0.5) / n as f64).sin().powi(2);
        let power: f64 = (0..n).map(|k| window(k).powi(2)).sum();
        for (k, value) in differences.iter_mut().enumerate() {
            *value *= window(k);
        }
        let fft = axis_fourier::forward(n.max(1));
        let mut spectrum = fft.make_output_vec();
        differences.resize(n.max(1), 0.0);
        // The lengths agree by construction, so the transform cannot fail.
        let _ = fft.process(&mut differences, &mut spectrum);
        let scale = 2.0 * period / power.max(f64::MIN_POSITIVE);
        Self {
            bin: 1.0 / (n.max(1) as f64 * period),
            density: spectrum.iter().map(|c| scale * c.norm_sqr()).collect(),
            order,
            period,
        }
    }

    /// |1 − e^(−iωh)|² to the power of the order.
    fn gain(&self, frequency: f64) -> f64 {
        let half = 0.5 * TAU * frequency * self.period;
        (2.0 * half.sin()).powi(2 * self.order)
    }

    /// Density of the series where it is flat: medians in the upper part of the spectrum,
    /// least and greatest of three ranges.
    fn floor(&self) -> [f64; 2] {
        let ranges = [[0.1, 0.2], [0.2, 0.3], [0.3, 0.45]];
        let medians = ranges.map(|range| {
            let [from, to] = range.map(|share: f64| share / (self.period * self.bin));
            let bins = self.density.iter().enumerate();
            let inside = bins.skip(from as usize).take((to - from) as usize);
            let mut levels: Vec<f64> = inside
                .map(|(k, density)| density / self.gain(k as f64 * self.bin))
                .collect();
            levels.sort_by(f64::total_cmp);
            // The median of a periodogram is ln 2 of its mean.
            levels.get(levels.len() / 2).copied().unwrap_or(0.0) / LN_2
        });
        let least = medians.iter().copied().fold(f64::INFINITY, f64::min);
        [least, medians.iter().copied().fold(0.0, f64::max)]
    }
}

/// Density of the noise of a channel that is not differentiated, least of what its upper
/// spectrum shows, unit²/Hz.
pub(super) fn least_noise(series: &[f64], period: f64) -> f64 {
    Differences::of(series, 2, period).floor()[0]
}

/// The same, the greatest: a sensor's own filter takes away of its upper spectrum.
pub(super) fn most_noise(series: &[f64], period: f64) -> f64 {
    Differences::of(series, 2, period).floor()[1]
}

/// The noise of a measured motion, and the power of its acceleration.
#[derive(Clone, Debug)]
pub(super) struct Noise {
    source: Source,
    /// Density of the source's noise, least and greatest estimate, unit²/Hz.
    density: [f64; 2],
    /// Hz.
    bin: f64,
    /// Mean square of the acceleration below each bin's upper edge, noise included.
    power: Vec<f64>,
}

impl Noise {
    /// Of a source sampled every `period` seconds.
    ///
    /// The density is that of the upper spectrum, where no machine moves, and never less
    /// than that of rounding to the channel's smallest step q, q²/12 in variance.
    pub fn of(series: &[f64], source: Source, period: f64) -> Self {
        let differences = Differences::of(series, source.order(), period);
        let [least, most] = differences.floor();
        let steps = series.windows(2).map(|w| (w[1] - w[0]).abs());
        let step = steps.filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min);
        let rounding = match step.is_finite() {
            true => step * step / 12.0 * 2.0 * period,
            false => 0.0,
        };
        let bin = differences.bin;
        let mut sum = 0.0;
        let power = |(k, density): (usize, &f64)| {
            let frequency = k as f64 * bin;
            let omega = (TAU * frequency).powi(2 * source.order());
            // At zero frequency both vanish.
            let gain = differences.gain(frequency);
            sum += bin * density * if k == 0 { 0.0 } else { omega / gain };
            sum
        };
        Self {
            source,
            density: [least.max(rounding), most.max(rounding)],
            bin,
            power: differences.density.iter().enumerate().map(power).collect(),
        }
    }

    /// Mean square of the acceleration's noise behind a low-pass, of a density.
    fn acceleration(&self, cutoff: f64, density: f64) -> f64 {
        let order = self.source.order();
        density * TAU.powi(2 * order) * passed(2 * order, cutoff)
    }

    /// The source's own noise from sample to sample, RMS, least estimate.
    pub fn deviation(&self, period: f64) -> f64 {
        (0.5 * self.density[0] / period).sqrt()
    }

    /// Least estimate of the acceleration's noise behind a low-pass, RMS, m/s² or rad/s².
    pub fn least_acceleration(&self, frequency: f64) -> f64 {
        self.acceleration(frequency, self.density[0]).sqrt()
    }

    /// Noise of the speed behind a low-pass, RMS, m/s or rad/s.
    pub fn speed(&self, frequency: f64) -> f64 {
        let order = self.source.order() - 1;
        let density = self.density[1] * TAU.powi(2 * order);
        (density * passed(2 * order, frequency)).sqrt()
    }

    /// Share by which noise of the acceleration draws an inertia towards zero, where all
    /// below a frequency is compared: E[n²] / E[a²].
    pub fn attenuation(&self, frequency: f64) -> f64 {
        let total = self.acceleration_below(frequency).powi(2);
        let noise = self.acceleration(frequency, self.density[1]);
        match noise < total {
            true => noise / total,
            false => 1.0,
        }
    }

    /// The highest frequency up to `most` below which noise takes no more than `share` of
    /// the acceleration's power; if there is none, that where it takes least.
    ///
    /// Higher where that is of no weight: noise draws an inertia by the share that it takes, and
    /// leaves that share of what the acceleration is for certain, that is below the frequency
    /// found first. With less than `error` (RMS, m/s² or rad/s²) left, it may take any share.
    pub fn cutoff(&self, most: f64, share: f64, error: f64) -> f64 {
        const STEPS: i32 = 200;
        // From the highest down, to a thousandth of it.
        let tried = (0..=STEPS).map(|k| most * 1e-3_f64.powf(f64::from(k) / f64::from(STEPS)));
        let tried: Vec<[f64; 2]> = tried.map(|f| [f, self.attenuation(f)]).collect();
        let within = |share: f64| tried.iter().find(|[_, taken]| *taken <= share);
        let least = || tried.iter().min_by(|a, b| a[1].total_cmp(&b[1]));
        let Some([found, _]) = within(share).or_else(least) else {
            return most;
        };
        let certain = self.acceleration_below(*found);
        let higher = within(error / certain.max(f64::MIN_POSITIVE));
        higher.map_or(*found, |[frequency, _]| frequency.max(*found))
    }

    /// The acceleration below a frequency, its noise included, RMS, m/s² or rad/s².
    fn acceleration_below(&self, frequency: f64) -> f64 {
        let last = self.power.len().saturating_sub(1);
        let bin = ((frequency / self.bin) as usize).min(last);
        self.power.get(bin).copied().unwrap_or(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::super::filter::LowPass;
    use super::{correlation, passed};

    /// Of 2·10⁵ numbers some 2·10⁴ are independent behind the filter: 0.02 is three deviations.
    #[test]
    fn white_noise_behind_the_filter_is_correlated_as_predicted() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let white = (0..200_000).map(|_| random.random::<f64>() - 0.5);
        let shown = LowPass::new(0.04).apply(&white.collect::<Vec<f64>>());
        let product = |lag: usize| -> f64 {
            let pairs = shown.iter().zip(&shown[lag..]);
            pairs.map(|(a, b)| a * b).sum()
        };
        for lag in [3, 9, 14, 25] {
            let found = product(lag) / product(0);
            let foretold = correlation(40.0, lag as f64 * 1e-3);
            assert!((found - foretold).abs() < 0.02, "{lag}: {found} {foretold}");
        }
    }

    #[test]
    fn what_passes_is_the_integral() {
        for power in [0, 2, 4] {
            let step = 1e-4;
            let at = |k: u32| {
                let x = (f64::from(k) + 0.5) * step;
                x.powi(power) / (1.0 + x.powi(8)).powi(2) * step
            };
            let sum: f64 = (0..100_000).map(at).sum();
            let ratio = passed(power, 3.0) / (3.0_f64.powi(power + 1) * sum);
            assert!((ratio - 1.0).abs() < 1e-6, "{power}: {ratio}");
        }
    }
}
