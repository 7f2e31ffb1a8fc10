//! Uneven time stamps: of samples that are uneven too, and of even ones.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use axis_log::intake::{Done, Options, PreparedLog, prepare, prepare_channels};
use axis_log::{Channel, Log, Mapping};
use proptest::prelude::*;

use crate::reading::noise;

const PERIOD: f64 = 0.002;

/// Goes to and fro by 0.1 m at 0.7 Hz, with a wave of 9 Hz on it.
fn position(t: f64) -> f64 {
    0.1 * (TAU * 0.7 * t).sin() + 2e-4 * (TAU * 9.0 * t).sin()
}

/// Rows of stamp and value, from a file and as channels.
fn read(rows: impl Iterator<Item = (f64, f64)>) -> PreparedLog {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("polled.csv");
    let mut text = "t_s,position_m\n".to_owned();
    let (time, position): (Vec<f64>, Vec<f64>) = rows.unzip();
    let mut rows = time.iter().zip(&position);
    rows.try_for_each(|(t, x)| writeln!(text, "{t},{x}"))
        .unwrap();
    std::fs::write(&path, text).unwrap();
    let name = path.display().to_string();
    let prepared = prepare(&[path], &Mapping::default(), &[], Options::default()).unwrap();
    let channels = [("t_s", time), ("position_m", position)];
    let channels = channels.map(|(name, samples)| Channel::new(name, samples).unwrap());
    let same = prepare_channels(&name, channels.to_vec(), &[], Options::default());
    assert_eq!(same.unwrap(), prepared);
    prepared
}

fn worst(log: &Log, truth: impl Fn(usize, f64) -> f64) -> f64 {
    let samples = log.channel("position_m").unwrap().iter().zip(log.time());
    let off = samples
        .enumerate()
        .map(|(k, (x, &t))| (x - truth(k, t)).abs());
    off.fold(0.0, f64::max)
}

fn is_even(log: &Log) -> bool {
    let steps = log.time().windows(2).map(|w| w[1] - w[0]);
    let [least, most] = steps.fold([f64::MAX, 0.0], |[a, b]: [f64; 2], s| [a.min(s), b.max(s)]);
    most - least < 1e-9
}

/// Instants up to a share of a period off the grid.
fn stamps(seed: u64, share: f64, rows: usize) -> Vec<f64> {
    let mut noise = noise(seed);
    (0..rows)
        .map(|k| (k as f64 + share * noise()) * PERIOD)
        .collect()
}

proptest! {
    // Each case writes a file.
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn uneven_samples_are_interpolated_and_even_ones_kept(seed in 1..u64::MAX, share in 0.08..0.45f64) {
        let stamps = stamps(seed, share, 900);
        // A computer that asks when it comes to it.
        let found = read(stamps.iter().map(|&t| (t, position(t))));
        let told = matches!(&found.done[..], [Done::Interpolated { .. }]);
        prop_assert!(told, "{:?}", found.done);
        prop_assert!(is_even(&found.log));
        // (9/16) (h/2)⁴ of the fourth derivative, 2e-4 (2π 9)⁴ m/s⁴, with steps of up to 2 h; the
        // first and the last step have three points only.
        let off = worst(&found.log, |_, t| position(t));
        prop_assert!(off < 4e-7, "{off:e}");
        // A message that comes late, about a sample that does not.
        let at = |k: usize| position(k as f64 * PERIOD);
        let found = read(stamps.iter().enumerate().map(|(k, &t)| (t, at(k))));
        let told = matches!(&found.done[..], [Done::Evened { .. }]);
        prop_assert!(told, "{:?}", found.done);
        prop_assert!(is_even(&found.log));
        prop_assert_eq!(worst(&found.log, |k, _| at(k)), 0.0);
    }
}

#[test]
fn what_noise_covers_is_kept_as_it_is() {
    let mut noise = noise(5);
    let values: Vec<f64> = (0..900).map(|_| noise()).collect();
    let found = read(stamps(7, 0.3, 900).into_iter().zip(values.iter().copied()));
    assert!(
        matches!(&found.done[..], [Done::Evened { .. }]),
        "{:?}",
        found.done
    );
    assert_eq!(worst(&found.log, |k, _| values[k]), 0.0);
}

#[test]
fn nothing_is_put_into_a_pause() {
    let all = stamps(3, 0.4, 900);
    let kept = all
        .into_iter()
        .enumerate()
        .filter(|(k, _)| !(400..430).contains(k));
    let found = read(kept.map(|(_, t)| (t, position(t))));
    let holes = found.log.missing("position_m");
    assert_eq!(holes.len(), 1, "{holes:?}");
    assert!((28..=32).contains(&holes[0].len()), "{holes:?}");
    assert!((899..=901).contains(&found.log.len()));
    assert!(
        worst(&found.log, |k, t| match holes[0].contains(&k) {
            true => found.log.channel("position_m").unwrap()[k],
            false => position(t),
        }) < 4e-7
    );
}

#[test]
fn stamps_without_a_grid_are_left_alone() {
    let mut noise = noise(11);
    let mut t = 0.0;
    let wild: Vec<f64> = (0..900)
        .map(|_| {
            t -= PERIOD * (0.5 + 0.5 * noise()).max(1e-3).ln();
            t
        })
        .collect();
    let found = read(wild.iter().map(|&t| (t, position(t))));
    let evened = |d: &Done| matches!(d, Done::Interpolated { .. } | Done::Evened { .. });
    assert!(!found.done.iter().any(evened), "{:?}", found.done);
}

/// The wave that docs/logs.md gives, at 500 Hz.
#[test]
fn a_wave_of_20_hz_keeps_its_amplitude_to_a_thousandth() {
    let wave = |t: f64| (TAU * 20.0 * t).sin();
    let found = read(stamps(13, 0.45, 900).into_iter().map(|t| (t, wave(t))));
    assert!(matches!(&found.done[..], [Done::Interpolated { .. }]));
    let inside = 2..found.log.len() - 2;
    let off = worst(&found.log, |k, t| match inside.contains(&k) {
        true => wave(t),
        false => found.log.channel("position_m").unwrap()[k],
    });
    println!("{off:.1e}");
    assert!(off < 1e-3, "{off:e}");
}

/// A stamp that is far away is refused with its file, and takes no memory.
#[test]
fn a_stamp_that_is_far_away_is_refused() {
    for far in [1e6, 1e300] {
        let mut times = stamps(17, 0.4, 900);
        times[899] = far;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("far.csv");
        let mut text = "t_s,position_m\n".to_owned();
        times
            .iter()
            .for_each(|&t| writeln!(text, "{t},{}", position(t)).unwrap());
        std::fs::write(&path, text).unwrap();
        let read = prepare(&[path], &Mapping::default(), &[], Options::default());
        let refused = read.unwrap_err().to_string();
        assert!(refused.contains("most of it is missing"), "{refused}");
    }
}

#[test]
fn channels_may_have_holes_and_nothing_infinite() {
    let time: Vec<f64> = (0..200).map(|k| f64::from(k) * PERIOD).collect();
    let given = |at_100: f64| {
        let mut samples: Vec<f64> = time.iter().map(|&t| position(t)).collect();
        samples[100] = at_100;
        let channels = [("t_s", time.clone()), ("position_m", samples)];
        let channels = channels.map(|(name, samples)| Channel::new(name, samples).unwrap());
        let options = Options::default();
        prepare_channels("of a program", channels.to_vec(), &["position_m"], options)
    };
    let prepared = given(f64::NAN).unwrap();
    let missing = prepared.log.missing("position_m");
    assert!(
        missing.len() == 1 && missing[0] == (100..101),
        "{missing:?}"
    );
    assert!((prepared.log.channel("position_m").unwrap()[100] - position(time[100])).abs() < 1e-5);
    let message = given(f64::INFINITY).unwrap_err().to_string();
    assert!(
        message.contains(
            "of a program: channel \"position_m\", sample 100: inf is not a finite number"
        ),
        "{message}"
    );
    let none = prepare_channels("of a program", Vec::new(), &[], Options::default());
    assert!(none.unwrap_err().to_string().contains("the log is empty"));
}

/// A whole part of the rate, to the samples asked for; what is slow stays.
#[test]
fn a_log_that_is_too_long_is_resampled_to_a_part_of_its_rate() {
    let slow = |t: f64| 0.1 * (TAU * 0.7 * t).sin();
    let time: Vec<f64> = (0..5000).map(|k| f64::from(k) * PERIOD).collect();
    let samples = time.iter().map(|&t| slow(t)).collect();
    let channels = [("t_s", time), ("position_m", samples)];
    let channels = channels.map(|(name, samples)| Channel::new(name, samples).unwrap());
    let prepared = |most: usize| {
        let options = Options {
            most_samples: Some(most),
            ..Options::default()
        };
        prepare_channels("long", channels.to_vec(), &[], options).unwrap()
    };
    let whole = prepared(5000);
    assert!(whole.done.is_empty() && whole.log.len() == 5000);
    let part = prepared(1999);
    assert_eq!(part.log.len(), 1667);
    let told = part.done[0].to_string();
    assert!(
        told.starts_with("long: 5000 samples at 500.0000 Hz; resampled to 166.6667 Hz"),
        "{told}"
    );
    // The ends rest on fewer samples.
    let (time, position) = (part.log.time(), part.log.channel("position_m").unwrap());
    for k in 100..1567 {
        assert!((position[k] - slow(time[k])).abs() < 2e-5, "{k}");
    }
}
