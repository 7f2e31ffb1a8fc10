use std::f64::consts::TAU;

use frequency_response::{ChirpExcitation, ChirpSweep, Excitation, Multisine, Prbs, period_of};

/// Every register runs through all of its states, has one value more of one sign, and an autocorrelation
/// of two values: N, and −1 elsewhere (S. W. Golomb, Shift Register Sequences, 1967).
#[test]
fn binary_sequences_are_of_the_greatest_length() {
    for register in 5..=20 {
        let prbs = Prbs {
            register,
            clock: 1,
            amplitude: 1.0,
            seed: 3,
        };
        let n = (1usize << register) - 1;
        assert_eq!(prbs.period(), n);
        let x = Excitation::Prbs(prbs).samples(1.0, 2 * n).unwrap();
        assert_eq!(period_of(&x), Some(n), "{register}");
        assert_eq!(x[..n].iter().sum::<f64>().abs(), 1.0);
        for shift in [1, 2, 7, n / 2, n - 1] {
            let sum: f64 = (0..n).map(|k| x[k] * x[k + shift]).sum();
            assert_eq!(sum, -1.0, "{register} {shift}");
        }
    }
}

#[test]
fn a_clock_holds_each_value() {
    let prbs = Prbs {
        register: 6,
        clock: 5,
        amplitude: 2.5,
        seed: 0,
    };
    let x = Excitation::Prbs(prbs).samples(1.0, 63 * 5).unwrap();
    assert!(x.iter().all(|v| v.abs() == 2.5));
    assert!(x.chunks(5).all(|part| part.iter().all(|v| *v == part[0])));
}

/// Times at which the sine passes zero are where the integral of the frequency is a half number.
#[test]
fn chirps_sweep_as_they_say() {
    let (rate, n) = (1e4, 20_000);
    for sweep in [ChirpSweep::Linear, ChirpSweep::Logarithmic] {
        let chirp = ChirpExcitation {
            amplitude: 3.0,
            from_hz: 5.0,
            to_hz: 500.0,
            sweep,
        };
        let x = Excitation::Chirp(chirp).samples(rate, n).unwrap();
        let crossings = x
            .windows(2)
            .filter(|w| (w[0] < 0.0) != (w[1] < 0.0))
            .count() as f64;
        let cycles = match sweep {
            ChirpSweep::Linear => 0.5 * (5.0 + 500.0) * 2.0,
            ChirpSweep::Logarithmic => 495.0 / 100f64.ln() * 2.0,
        };
        assert!(
            (crossings - 2.0 * cycles).abs() <= 2.0,
            "{sweep:?} {crossings} {cycles}"
        );
        // At half the time: 252.5 Hz, or 50 Hz.
        let middle = &x[n / 2 - 500..n / 2 + 500];
        let count = middle
            .windows(2)
            .filter(|w| (w[0] < 0.0) != (w[1] < 0.0))
            .count() as f64;
        let expected = match sweep {
            ChirpSweep::Linear => 252.5 * 0.2,
            ChirpSweep::Logarithmic => 50.0 * 0.2,
        };
        assert!(
            (count - expected).abs() <= 1.0,
            "{sweep:?} {count} {expected}"
        );
    }
}

/// Equal sines on the lines and nothing beside them, by the sum itself; a crest factor near that of one
/// sine (1.414). Found: 1.39 of all lines, 1.93 of the 25 sparse ones; random phases have 3 and more.
#[test]
fn multisines_are_flat_and_low() {
    for (ratio, most) in [(1.0, 1.5), (1.1, 2.1)] {
        let sines = Multisine {
            amplitude: 2.0,
            period: 1000,
            from_hz: 4.0,
            to_hz: 200.0,
            ratio,
            seed: 5,
        };
        let lines = sines.lines(1000.0).unwrap();
        assert_eq!(lines[0], 4);
        let x = Excitation::Multisine(sines).samples(1000.0, 2000).unwrap();
        assert_eq!(x[..1000], x[1000..]);
        let peak = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let rms = (x.iter().map(|v| v * v).sum::<f64>() / 2000.0).sqrt();
        assert!((peak - 2.0).abs() < 1e-12);
        assert!(peak / rms < most, "{}", peak / rms);
        let size = |line: usize| {
            let at = |k: usize| TAU * (line * k % 1000) as f64 / 1000.0;
            let c: f64 = (0..1000).map(|k| x[k] * at(k).cos()).sum();
            let s: f64 = (0..1000).map(|k| x[k] * at(k).sin()).sum();
            c.hypot(s) / 500.0
        };
        let expected = size(lines[0]);
        for line in 0..500 {
            let wanted = if lines.contains(&line) { expected } else { 0.0 };
            assert!((size(line) - wanted).abs() < 1e-9 * expected, "{line}");
        }
    }
}

#[test]
fn periods_are_found_where_there_are_any() {
    assert_eq!(period_of(&[1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 1.0]), Some(3));
    assert_eq!(period_of(&[1.0, 2.0, 3.0, 1.0]), None);
    assert_eq!(period_of(&[1.0; 8]), None);
    assert_eq!(period_of(&[]), None);
    assert_eq!(period_of(&[f64::NAN; 8]), None);
}
