//! Stamps that are more even than the samples.
//!
//! A logger that writes the instants it meant to sample at, and samples a little off them, shows every
//! channel y with noise of the size σ dy/dt: none while the axis stands, and twice as much at twice the speed.
//! That of one row is the same instant in all channels. This is the one place where σ is estimated.

use axis_log::Log;
use axis_sim::{Axis, position_in, reference_in};

/// By how much samples lie off their stamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Jitter {
    /// Standard deviation, s.
    pub deviation: f64,
    /// Whether the reference was taken at these instants too.
    pub of_reference: bool,
}

/// Binomials of the fourth difference, which sees nothing of a motion, and the sum of their squares.
const BINOMIALS: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
const SQUARES: f64 = 70.0;

/// Correlation of fourth differences of white noise with the next, −56/70, and how far a measured one may be
/// off; and correlation some samples on, where there is none: a pattern that repeats is no jitter.
const NEXT: f64 = -0.8;
const OFF: f64 = 0.12;
const LATER: [usize; 4] = [5, 6, 7, 8];
const LEFT: f64 = 0.25;

/// Shares of the fastest speed that are slow, and from which on it is fast.
const SLOW: [f64; 2] = [0.1, 0.45];
const FAST: f64 = 0.75;

/// Fewest samples of either.
const FEW: usize = 60;

/// Share of the fast samples' differences that has to go with the square of the speed.
const MOSTLY: f64 = 0.5;

/// Least and greatest jitter that is told, as shares of the period.
const RANGE: [f64; 2] = [2e-3, 0.3];

/// Median of the square of a normal number, as a share of its mean.
const MEDIAN: f64 = 0.4549;

/// That of a log, by its reference or else by what shows the motion; `None` where it has none.
pub(crate) fn jitter(log: &Log, period: f64, machine: &Axis) -> Option<Jitter> {
    let of_reference = reference_in(log).ok().and_then(|r| off_stamps(r, period));
    if let Some(deviation) = of_reference {
        return Some(Jitter {
            deviation,
            of_reference: true,
        });
    }
    let angle = log.channel("motor_angle_rad").ok();
    let ways = position_in(log).ok().into_iter().chain(angle);
    // Of two, what both show; noise of a sensor's own that goes with its speed is no jitter.
    let each: Option<Vec<f64>> = ways.map(|way| off_stamps(way, period)).collect();
    let least = each?.into_iter().fold(f64::INFINITY, f64::min);
    let has_control = machine.has_control();
    (least.is_finite() && has_control).then_some(Jitter {
        deviation: least,
        of_reference: false,
    })
}

/// Standard deviation of the instants of a moving channel, s: by fourth differences at slow and at fast
/// speeds, medians, so that corners of the motion do not count.
fn off_stamps(way: &[f64], period: f64) -> Option<f64> {
    let speeds: Vec<f64> = way
        .windows(5)
        .map(|w| (w[4] - w[0]) / (4.0 * period))
        .collect();
    let bends = way.windows(5).map(|w| -> f64 {
        let pairs = w.iter().zip(BINOMIALS);
        pairs.map(|(x, b)| x * b).sum()
    });
    let bends: Vec<f64> = bends.collect();
    let fastest = speeds.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let group = |from: f64, to: f64| -> Option<[f64; 2]> {
        let pairs = speeds.iter().zip(&bends);
        let inside = pairs.filter(|(v, _)| (from * fastest..to * fastest).contains(&v.abs()));
        let (speeds, mut bends): (Vec<f64>, Vec<f64>) = inside.map(|(v, e)| (v * v, e * e)).unzip();
        if bends.len() < FEW {
            return None;
        }
        bends.sort_by(f64::total_cmp);
        let speed = speeds.iter().sum::<f64>() / speeds.len() as f64;
        Some([speed, bends[bends.len() / 2] / MEDIAN])
    };
    let (slow, fast) = (group(SLOW[0], SLOW[1])?, group(FAST, f64::INFINITY)?);
    let per_square = (fast[1] - slow[1]) / (fast[0] - slow[0]);
    let deviation = (per_square / SQUARES).max(0.0).sqrt();
    let goes_with_speed = per_square * fast[0] >= MOSTLY * fast[1];
    let in_range = (RANGE[0] * period..=RANGE[1] * period).contains(&deviation);
    let is_fast = |k: usize| speeds[k].abs() >= FAST * fastest;
    (goes_with_speed && in_range && is_white(&speeds, &bends, is_fast)).then_some(deviation)
}

/// Whether instants, which fourth differences over speeds show, are off by chance.
fn is_white(speeds: &[f64], bends: &[f64], counts: impl Fn(usize) -> bool) -> bool {
    let instant = |k: usize| bends[k] / speeds[k];
    let product = |lag: usize| {
        let all = 0..bends.len().saturating_sub(lag);
        let both = all.filter(|&k| counts(k) && counts(k + lag));
        let products = both.map(|k| instant(k) * instant(k + lag));
        let (sum, count) = products.fold((0.0, 0.0), |(sum, n), p| (sum + p, n + 1.0));
        sum / f64::max(count, 1.0)
    };
    let power = product(0);
    let correlation = |lag: usize| product(lag) / power.max(f64::MIN_POSITIVE);
    (correlation(1) - NEXT).abs() < OFF && LATER.iter().all(|&lag| correlation(lag).abs() < LEFT)
}

impl Jitter {
    /// What must be known of it.
    pub(crate) fn note(&self, name: &str, period: f64) -> String {
        let who = match self.of_reference {
            true => "all channels, the reference among them,",
            false => "the measured channels",
        };
        format!(
            "{name}: its stamps are even, but {who} were sampled {:.1} µs or {:.1} % of a period off them, RMS: noise that goes with the speed is taken for that, and the floors hold it; log with a better clock, or the stamps as they were",
            1e6 * self.deviation,
            100.0 * self.deviation / period
        )
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::off_stamps;

    const PERIOD: f64 = 1e-3;

    /// A way there and back with slow and fast parts, at instants that are off, with noise of its sensor.
    fn found(jitter: f64, noise: f64, held: usize) -> Option<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        let at = |k: usize| {
            let t = (k - k % held) as f64 * PERIOD + jitter * normal();
            0.1 * (1.5 * t).sin() + 0.03 * (4.0 * t).sin() + noise * normal()
        };
        off_stamps(&(0..6000).map(at).collect::<Vec<f64>>(), PERIOD)
    }

    #[test]
    fn jitter_is_told_from_a_sensors_noise_and_from_a_held_channel() {
        for jitter in [1e-5, 3e-5, 1e-4] {
            let told = found(jitter, 1e-7, 1).unwrap();
            assert!((told / jitter - 1.0).abs() < 0.1, "{told}");
        }
        let told = found(3e-5, 3e-6, 1).unwrap();
        assert!((told / 3e-5 - 1.0).abs() < 0.2, "{told}");
        assert_eq!(found(0.0, 1e-7, 1), None);
        assert_eq!(found(0.0, 3e-6, 1), None);
        // A reference that is made every fourth sample.
        assert_eq!(found(0.0, 0.0, 4), None);
        assert_eq!(found(0.0, 0.0, 1), None);
    }
}
