//! Whether an axis stands, by what was measured of it.
//!
//! Where its reference has stopped an axis goes on, for as long as its loop takes. What a standstill looks
//! like in a log, with its sensors' noise, what the loop makes of that, and their steps, shows while the
//! reference rests, most of the time.

use std::ops::Range;

use axis_log::Log;
use axis_sim::{Axis, position_in, reference_in};

use crate::answers::INEXACT;

/// Times the lower quartile of the spreads of all rests up to which an axis stands: that of a slow wave, of
/// which a stretch shows a part, is at most 2.6 times its quartile.
const AS_STILL: f64 = 3.0;

/// A log in which standstill is looked for.
pub(super) struct Standstill<'a> {
    /// What shows a way, and how far it spreads at most while the axis stands, RMS about its mean.
    ways: Vec<(&'a [f64], f64)>,
    window: usize,
}

impl<'a> Standstill<'a> {
    /// Of stretches of so many samples, two or more.
    pub fn new(log: &'a Log, machine: &Axis, window: usize) -> Self {
        let window = window.clamp(2, log.len().max(2));
        // By as much a simulation may be off anyway.
        let dynamics = (reference_in(log).ok().zip(position_in(log).ok())).map_or(0.0, |(r, p)| {
            let squares = r.iter().zip(p).map(|(r, p)| (r - p).powi(2));
            (squares.sum::<f64>() / r.len().max(1) as f64).sqrt()
        });
        let at_the_load = INEXACT * dynamics;
        let channels = [
            (machine.position_channel(), at_the_load),
            ("motor_angle_rad", at_the_load / machine.travel_per_radian()),
        ];
        let reference = reference_in(log).unwrap_or_default();
        let rests = |from: &usize| {
            reference.get(*from..from + window).is_none_or(|r| {
                let longest = r.windows(2).map(|w| (w[1] - w[0]).abs());
                longest.fold(0.0, f64::max) <= STILL * span(reference)
            })
        };
        let last = log.len().saturating_sub(window);
        let stretches = (0..=last).step_by((window / 4).max(1));
        let rests: Vec<usize> = stretches.filter(rests).collect();
        let way = |(name, inexact): (&str, f64)| {
            let samples = log.channel(name).ok()?;
            let spreads = rests.iter().map(|&k| spread(&samples[k..k + window]));
            let mut spreads: Vec<f64> = spreads.collect();
            spreads.sort_by(f64::total_cmp);
            // Of a reference that never rests nothing is known.
            let usual = spreads.get(spreads.len() / 4).copied();
            let usual = usual.unwrap_or(f64::INFINITY);
            Some((
                samples,
                (AS_STILL * usual + step(samples)).max(inexact.abs()),
            ))
        };
        Self {
            ways: channels.into_iter().filter_map(way).collect(),
            window,
        }
    }

    /// Samples of a stretch.
    pub fn window(&self) -> usize {
        self.window
    }

    /// Whether the axis stands in the stretch about a sample.
    pub fn about(&self, at: usize) -> bool {
        let from = at.saturating_sub(self.window / 2);
        self.within(from..from + self.window)
    }

    /// Whether it stands in the stretch that begins with a sample.
    pub fn from(&self, at: usize) -> bool {
        self.within(at..at + self.window)
    }

    fn within(&self, samples: Range<usize>) -> bool {
        let stands = |(way, most): &(&[f64], f64)| {
            let end = samples.end.min(way.len());
            let from = samples.start.min(end.saturating_sub(self.window));
            spread(&way[from..end]) <= *most
        };
        self.ways.iter().all(stands)
    }
}

/// Share of its way by which a reference moves from sample to sample at most while it rests: of files, and
/// of the end of a curve.
const STILL: f64 = 1e-7;

/// From the least to the greatest.
fn span(samples: &[f64]) -> f64 {
    let ends = samples.iter();
    let [low, high] = ends.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(*x), b.max(*x)]);
    (high - low).max(0.0)
}

/// RMS about the mean.
fn spread(window: &[f64]) -> f64 {
    let count = window.len().max(1) as f64;
    let mean = window.iter().sum::<f64>() / count;
    (window.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Smallest step of a sensor; 0 where hardly two samples are the same.
fn step(samples: &[f64]) -> f64 {
    let changes = samples.windows(2).map(|w| (w[1] - w[0]).abs());
    let (mut same, mut least) = (0usize, f64::INFINITY);
    for change in changes {
        match change > 0.0 {
            true => least = least.min(change),
            false => same += 1,
        }
    }
    match 20 * same > samples.len() && least.is_finite() {
        true => least,
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use axis_log::{Channel, Log};
    use axis_sim::Axis;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::Standstill;

    /// A reference that goes 0.1 m in the second second, and an axis that follows within 50 ms, with noise
    /// of 0.1 µm, or in steps of 1 µm.
    #[test]
    fn an_axis_stands_some_time_after_its_reference() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/rack.toml");
        let machine = Axis::read(file.as_ref()).unwrap();
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let reference: Vec<f64> = (0..4000)
            .map(|k| 0.1 * ((f64::from(k) - 1000.0) / 1000.0).clamp(0.0, 1.0))
            .collect();
        let mut at = 0.0;
        let follow = |to: &f64| {
            at += (to - at) / 50.0;
            at
        };
        let followed: Vec<f64> = reference.iter().map(follow).collect();
        let noisy = |x: &f64| {
            let noise: f64 = StandardNormal.sample(&mut random);
            x + 1e-7 * noise
        };
        let stepped = |x: &f64| 1e-6 * (x / 1e-6).round();
        let shown: [Vec<f64>; 2] = [
            followed.iter().map(noisy).collect(),
            followed.iter().map(stepped).collect(),
        ];
        for position in shown {
            let time = (0..4000).map(|k| 1e-3 * f64::from(k)).collect();
            let log = Log::new(vec![
                Channel::new("t_s", time).unwrap(),
                Channel::new("position_ref_m", reference.clone()).unwrap(),
                Channel::new("position_m", position).unwrap(),
            ])
            .unwrap();
            let stands = Standstill::new(&log, &machine, 100);
            assert!(stands.from(0) && stands.about(900) && stands.about(3500));
            // 5 mm from its place when the reference stops, and 30 µm a quarter of a second later.
            for k in [1500, 2000, 2100, 2250] {
                assert!(!stands.about(k), "{k}");
            }
        }
    }
}
