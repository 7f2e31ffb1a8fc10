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

    /// At knots of the frequency, Hz, the share of the power about each that is above noise of this density, 0 to 1, while the
    /// machine moves: for the share `moving` of the time.
    fn above(&self, noise: f64, moving: f64) -> Vec<[f64; 2]> {
        let n = self.density.len();
        let mut knots = Vec::new();
        let mut k = 0;
        while k < n {
            let side = SIDE.max((WIDTH * k as f64) as usize);
            let about = k.saturating_sub(side)..(k + side + 1).min(n);
            // Of a mean of so many, each with a deviation of its own size.
            let clear = 1.0 + CLEAR / (about.len() as f64).sqrt();
            let of_noise = |k: usize| noise * self.gain(k as f64 * self.bin);
            let of_noise: f64 = about.clone().map(of_noise).sum();
            let measured: f64 = self.density[about].iter().sum();
            // What moves does so in a part of the time, in which it has more than its mean.
            let motion = measured - of_noise;
            let share = match measured > clear * of_noise {
                true => motion / (motion + moving * of_noise),
                false => 0.0,
            };
            knots.push([k as f64 * self.bin, share]);
            k += 1 + side / 8;
        }
        knots
    }
}

/// The step in which a channel counts, of which its differences, and the differences of these, are multiples; 0 if it
/// has none.
fn resolution(series: &[f64]) -> f64 {
    let steps: Vec<f64> = series.windows(2).map(|w| w[1] - w[0]).collect();
    let greatest = steps.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
    let second = steps.windows(2).map(|w| w[1] - w[0]);
    let all = steps.iter().copied().chain(second).map(f64::abs);
    // Without rounding of the numbers themselves.
    let all: Vec<f64> = all.filter(|d| *d > ROUNDING * greatest).collect();
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    // Of a channel that has none the share is a fifth.
    let is_multiple = |step: &&f64| ((*step / least).fract() - 0.5).abs() > 0.4;
    let multiples = all.iter().filter(is_multiple).count();
    // Steps that are all alike, as those of a speed without noise, say nothing.
    let differ = all.iter().any(|step| *step > 1.5 * least) || all.len() < steps.len();
    match multiples as f64 >= 0.9 * all.len() as f64 && least.is_finite() && differ {
        true => least,
        false => 0.0,
    }
}

/// Share of a channel's greatest step below which a difference is rounding of its numbers.
const ROUNDING: f64 = 1e-7;

/// Share of a log's time in which it moves: in which a channel goes further within 32 samples, or is greater in their mean, than
/// six deviations of its noise.
fn moving_share(series: &[f64], source: Source, deviation: f64) -> f64 {
    const BLOCK: usize = 32;
    let moves = |block: &&[f64]| match source {
        Source::Position => (block[BLOCK - 1] - block[0]).abs() > 6.0 * deviation,
        Source::Speed => {
            let mean = block.iter().sum::<f64>() / BLOCK as f64;
            mean.abs() > 6.0 * deviation / (BLOCK as f64).sqrt()
        }
    };
    let blocks = series.chunks_exact(BLOCK);
    let all = blocks.len();
    let moving = blocks.filter(moves).count();
    moving.max(1) as f64 / all.max(1) as f64
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
    /// Knots of the frequency, Hz, and the share of the power about each that is motion and not noise while the machine moves,
    /// 0 to 1.
    motion: Vec<[f64; 2]>,
}

/// Bins to either side over which the power is averaged at least before it is compared with that of noise: a mean of
/// 31 scatters by 18 %.
const SIDE: usize = 15;

/// The same as a share of the frequency: a filter whose gain changes by the octave rings for some periods only.
const WIDTH: f64 = 0.3;

/// Deviations by which a mean power must be above that of noise to be taken for motion: less would let a share of the noise
/// pass wherever the mean scatters upward.
const CLEAR: f64 = 3.0;

impl Noise {
    /// Of a source sampled every `period` seconds.
    ///
    /// The density is that of the upper spectrum, where no machine moves, and never less
    /// than that of rounding to the channel's resolution q, q²/12 in variance.
    pub fn of(series: &[f64], source: Source, period: f64) -> Self {
        let differences = Differences::of(series, source.order(), period);
        let [least, most] = differences.floor();
        let rounding = resolution(series).powi(2) / 12.0 * 2.0 * period;
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
        let density = [least.max(rounding), most.max(rounding)];
        let moving = moving_share(series, source, (0.5 * density[1] / period).sqrt());
        Self {
            source,
            density,
            bin,
            power: differences.density.iter().enumerate().map(power).collect(),
            motion: differences.above(density[1], moving),
        }
    }

    /// What an acceleration, as it was measured, is expected to be without its noise: at each frequency times the
    /// share of the power there that is motion, which is Wiener's filter without phase. An inertia that is
    /// fitted to it is not drawn towards zero (regression calibration: Carroll, Ruppert, Stefanski, Crainiceanu,
    /// Measurement Error in Nonlinear Models, 2nd ed., 2006, chapter 4).
    pub fn expected(&self, acceleration: &[f64], period: f64) -> Vec<f64> {
        let n = acceleration.len();
        // Continued by its mirror image, so that its ends do not meet in a step.
        let mut all: Vec<f64> = (acceleration.iter())
            .chain(acceleration.iter().rev())
            .copied()
            .collect();
        let size = all.len().max(1);
        let forward = axis_fourier::forward(size);
        let mut amplitudes = forward.make_output_vec();
        // The lengths agree by construction, so neither transform can fail.
        let _ = forward.process(&mut all, &mut amplitudes);
        let bin = 1.0 / (size as f64 * period);
        for (k, amplitude) in amplitudes.iter_mut().enumerate() {
            *amplitude *= self.motion_at(k as f64 * bin) / size as f64;
        }
        let _ = axis_fourier::inverse(size).process(&mut amplitudes, &mut all);
        all.truncate(n);
        all
    }

    /// Share of the power at a frequency that is motion, between the knots by a straight line.
    fn motion_at(&self, frequency: f64) -> f64 {
        let next = self.motion.partition_point(|[f, _]| *f <= frequency);
        match (
            next.checked_sub(1).and_then(|k| self.motion.get(k)),
            self.motion.get(next),
        ) {
            (Some([from, a]), Some([to, b])) => a + (b - a) * (frequency - from) / (to - from),
            (Some([_, last]), None) => *last,
            _ => 1.0,
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

    /// Least estimate of what noise leaves uncertain of the expected acceleration behind a low-pass, RMS, m/s² or
    /// rad/s²: at each frequency the noise times the share of the power that is motion.
    pub fn least_acceleration(&self, frequency: f64) -> f64 {
        let order = 2 * self.source.order();
        let sum: f64 = (1..self.power.len())
            .map(|k| {
                let f = k as f64 * self.bin;
                let passed = (1.0 + (f / frequency).powi(8)).powi(-2);
                self.motion_at(f) * (TAU * f).powi(order) * passed
            })
            .sum();
        (self.density[0] * self.bin * sum).sqrt()
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
    /// Higher where that is of no weight: by the share that noise takes, the expected acceleration is made of its spectrum
    /// instead of measured, as a share of what it is for certain, that is below the frequency
    /// found first. With less than `error` (RMS, m/s² or rad/s²) of that, it may take any share.
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
    use super::{correlation, passed, resolution};

    #[test]
    fn a_resolution_is_what_all_steps_are_multiples_of() {
        let motion: Vec<f64> = (0..2000).map(|k| (0.01 * f64::from(k)).sin()).collect();
        assert!(resolution(&motion).abs() < f64::MIN_POSITIVE);
        let counted: Vec<f64> = motion.iter().map(|x| (x / 1e-4).round() * 1e-4).collect();
        assert!((resolution(&counted) - 1e-4).abs() < 1e-12);
        assert!(resolution(&[1.0; 10]).abs() < f64::MIN_POSITIVE);
        // A constant speed, as it is, with a ripple, and counted.
        let line: Vec<f64> = (0..2000).map(|k| 0.01 * f64::from(k)).collect();
        assert!(resolution(&line).abs() < f64::MIN_POSITIVE);
        let ripple: Vec<f64> = line.iter().map(|x| x + 1e-4 * x.sin()).collect();
        assert!(resolution(&ripple).abs() < f64::MIN_POSITIVE);
        let counted: Vec<f64> = line.iter().map(|x| (x / 7e-3).round() * 7e-3).collect();
        assert!((resolution(&counted) - 7e-3).abs() < 1e-9);
    }

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
