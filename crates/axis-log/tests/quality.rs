//! Which logs are fit to draw conclusions from.

use std::f64::consts::{PI, TAU};

use axis_log::quality::{SamplingError, check_sampling, constant_channels, unit_slip};
use axis_log::{Channel, Log};
use proptest::prelude::*;

fn timed(time: Vec<f64>) -> Log {
    Log::new(vec![Channel::new("t_s", time).unwrap()]).unwrap()
}

fn even(samples: usize, start: f64, period: f64) -> Vec<f64> {
    (0..samples).map(|k| start + k as f64 * period).collect()
}

fn refusal(time: Vec<f64>) -> String {
    check_sampling(&timed(time)).unwrap_err().to_string()
}

#[test]
fn an_even_log_has_its_period_and_no_jitter() {
    let found = check_sampling(&timed(even(30_000, 1.7e3, 1e-3))).unwrap();
    // The stamps near 1.7e3 are rounded to 2.3e-13 s: 1e-10 of a period each.
    assert!((found.period / 1e-3 - 1.0).abs() < 1e-12, "{found:?}");
    assert!((found.rate - 1e3).abs() < 1e-9, "{found:?}");
    assert!(found.jitter < 1e-9, "{found:?}");
}

#[test]
fn stamps_rounded_to_microseconds_are_even() {
    // 3 kHz: steps of 333 and 334 µs. A grid of the median step would be a whole
    // period off after 1000 samples; the true one stays within half a
    // microsecond, 0.15 % of a period.
    let time: Vec<f64> = (0..9000)
        .map(|k| (f64::from(k) / 3e3 * 1e6).round() / 1e6)
        .collect();
    let found = check_sampling(&timed(time)).unwrap();
    assert!((found.rate - 3e3).abs() < 1e-3, "{found:?}");
    assert!((0.0005..0.0016).contains(&found.jitter), "{found:?}");
}

#[test]
fn short_logs_are_refused() {
    assert!(check_sampling(&timed(even(100, 0.0, 1e-3))).is_ok());
    assert_eq!(
        refusal(even(99, 0.0, 1e-3)),
        "99 samples: at least 100 are needed"
    );
}

#[test]
fn rates_out_of_range_are_named() {
    for period in [5e-2 * 1.0009, 5e-2, 1.0 / 93.4, 5e-5, 5e-5 / 1.0009] {
        assert!(check_sampling(&timed(even(200, 0.0, period))).is_ok());
    }
    for period in [5e-2 * 1.0011, 5e-5 / 1.0011] {
        assert!(matches!(
            check_sampling(&timed(even(200, 0.0, period))),
            Err(SamplingError::Rate { .. })
        ));
    }
    let slow = refusal(even(200, 0.0, 0.1));
    assert!(
        slow.starts_with("the sample rate is 10.000000 Hz: it must lie between 20 and 20000 Hz"),
        "{slow}"
    );
    // 1 kHz stamped in milliseconds.
    let slip = refusal(even(200, 0.0, 1.0));
    assert!(slip.ends_with("the time may be in milliseconds"), "{slip}");
    let slip = refusal(even(200, 0.0, 1000.0));
    assert!(slip.ends_with("the time may be in microseconds"), "{slip}");
    let slip = refusal(even(200, 1.5e18, 1e6));
    assert!(slip.contains("the sample rate is 1.00000e-6 Hz"), "{slip}");
    assert!(slip.ends_with("the time may be in nanoseconds"), "{slip}");
}

#[test]
fn a_gap_is_told_with_its_time_and_length() {
    let mut time = even(1000, 0.0, 1e-3);
    time.drain(501..504);
    time.drain(800..801);
    let found = refusal(time);
    assert!(
        found.starts_with(
            "a gap of 0.004000 s after t_s = 0.500000 s, 4.0 periods of 1.000e-3 s (2 such"
        ),
        "{found}"
    );
}

#[test]
fn jitter_is_told_with_its_worst_time() {
    let mut time = even(1000, 0.0, 1e-3);
    time[300] += 0.04e-3;
    let found = check_sampling(&timed(time.clone())).unwrap();
    // One late sample of a thousand moves the line by about its share, 4e-5.
    assert!((found.jitter - 0.04).abs() < 1e-4, "{found:?}");
    time[700] -= 0.06e-3;
    let found = refusal(time);
    assert!(
        found.starts_with("the instant t_s = 0.699940 s is 6.0 % of a period (1.000e-3 s) off"),
        "{found}"
    );
}

#[test]
fn constant_channels_are_listed_but_not_the_time() {
    let channel = |name: &str, samples: &[f64]| Channel::new(name, samples.to_vec()).unwrap();
    let log = Log::new(vec![
        channel("t_s", &[0.0, 1.0, 2.0]),
        channel("iq_a", &[0.0, -0.0, 0.0]),
        channel("position_m", &[1.0, 1.0, 1.0 + f64::EPSILON]),
        channel("ud_v", &[3.0, 3.0, 3.0]),
    ])
    .unwrap();
    assert_eq!(constant_channels(&log), ["iq_a", "ud_v"]);
}

fn motion(samples: usize) -> Vec<f64> {
    let at = |k| 0.6 + 0.1 * (TAU * k as f64 / 500.0).sin();
    (0..samples).map(at).collect()
}

#[test]
fn unit_slips_are_named_both_ways() {
    let reference = motion(1000);
    for (factor, words) in [
        (1e3, "millimetres read as metres"),
        (1e6, "micrometres read as metres"),
        (1.0 / 25.4e-3, "inches read as metres"),
        (60.0 / TAU, "revolutions per minute read as rad/s"),
        (180.0 / PI, "degrees read as radians"),
        (60.0, "m/min read as m/s"),
        (60e3, "mm/min read as m/s"),
    ] {
        // A lag of 4 samples of 500 leaves a correlation of cos(4/500 · 2π) = 0.9987.
        let late: Vec<f64> = reference.iter().map(|v| factor * v + 7.0).collect();
        let slip = unit_slip(&reference[4..], &late[..996]).expect(words);
        assert_eq!(slip.guess, words);
        assert_eq!(slip.exact, factor);
        // The two windows are shifted by under a hundredth of a period.
        assert!((slip.factor / factor - 1.0).abs() < 1e-2, "{slip:?}");
        let back = unit_slip(&late, &reference).expect(words);
        assert_eq!(back.guess, format!("the reference is in {words}"));
    }
}

#[test]
fn no_slip_is_found_where_there_is_none() {
    let reference = motion(1000);
    let times = |factor: f64| reference.iter().map(|v| factor * v).collect::<Vec<f64>>();
    for factor in [1.0, 1.1, 0.9, 100.0, 500.0, -1e3] {
        assert_eq!(unit_slip(&reference, &times(factor)), None, "{factor}");
    }
    // A quarter period apart the two do not follow each other.
    assert_eq!(unit_slip(&reference[125..625], &times(1e3)[..500]), None);
    assert_eq!(unit_slip(&[], &[]), None);
    assert_eq!(unit_slip(&reference, &reference[1..]), None);
    assert_eq!(unit_slip(&[1.0, 1.0], &[1.0, 2.0]), None);
    assert_eq!(unit_slip(&[1.0, f64::NAN], &[1.0, 2.0]), None);
}

proptest! {
    #[test]
    fn a_slip_survives_noise_and_offset(
        noise in prop::collection::vec(-1.0..1.0f64, 600), offset in -1e3..1e3f64, share in 0.0..0.01f64,
    ) {
        let reference = motion(600);
        let measured: Vec<f64> = reference.iter().zip(&noise)
            .map(|(r, n)| 1e3 * (r + 0.1 * share * n) + offset)
            .collect();
        let slip = unit_slip(&reference, &measured).unwrap();
        prop_assert_eq!(slip.exact, 1e3);
        prop_assert_eq!(unit_slip(&reference, &reference), None);
    }

    #[test]
    fn jitter_is_at_most_what_was_put_in(
        shifts in prop::collection::vec(-1.0..1.0f64, 100..400), rate in 1e3..20e3f64, start in -1e3..1e3f64,
    ) {
        // Shifts of up to 2 % of a period, and the line follows them by at most as much.
        let time: Vec<f64> = shifts.iter().enumerate()
            .map(|(k, s)| start + (k as f64 + 0.02 * s) / rate)
            .collect();
        let found = check_sampling(&timed(time)).unwrap();
        prop_assert!(found.jitter <= 0.04, "{:?}", found);
        // The slope of 100 or more instants shifts by at most 0.02 · 3/n of itself.
        prop_assert!((found.rate / rate - 1.0).abs() < 1e-3, "{:?}", found);
    }

    #[test]
    fn any_missing_sample_is_a_gap_there(missing in 1..199usize, rate in 1e3..20e3f64) {
        let mut time = even(200, 0.0, 1.0 / rate);
        let before = time[missing - 1];
        time.remove(missing);
        let found = check_sampling(&timed(time));
        let is_there = matches!(found, Err(SamplingError::Gap { time, count: 1, .. }) if time == before);
        prop_assert!(is_there, "{:?}", found);
    }
}
