use axis_fourier::Complex;
use frequency_response::{
    Averaging, Estimator, Excitation, FitSettings, FrequencyResponse, ModalFit, Prbs, Record,
    ResponseLine,
};

use crate::machine::{Machine, closed};

fn response(
    machine: Machine,
    noise: f64,
    seed: u64,
    averaging: Averaging,
    register: u32,
) -> FrequencyResponse {
    let prbs = Prbs {
        amplitude: 1.0,
        register,
        clock: 1,
        seed,
    };
    let r = Excitation::Prbs(prbs).samples(1e3, 12_000).unwrap();
    let [u, y] = closed(machine, &r, noise, seed + 11);
    let record = Record {
        period_s: 1e-3,
        excitation: Some(&r),
        input: &u,
        output: &y,
        differenced: false,
    };
    FrequencyResponse::of(&record, Estimator::ThreeSignals, averaging).unwrap()
}

pub fn fit_without_noise(machine: Machine) -> ModalFit {
    let periods = Averaging::Periods {
        period: 1023,
        skip: 6,
    };
    let found = response(machine, 0.0, 1, periods, 10);
    let settings = FitSettings {
        most_poles: 5,
        most_delay_s: 4e-3,
        ..FitSettings::default()
    };
    ModalFit::of(&found, &settings).unwrap()
}

/// Without noise the mode, its damping, its residue and the delay come out as they are. Found: to rounding,
/// 1e-14 Hz and 1e-13 of the damping; bounds are a thousand times that, for other processors.
#[test]
fn a_response_without_noise_is_found() {
    let machine = Machine::default();
    let fit = fit_without_noise(machine);
    let mode = fit.modes[0];
    assert_eq!(fit.modes.len(), 1);
    assert!((mode.frequency_hz.value - 63.0).abs() < 1e-10);
    assert!((mode.damping.value - 0.03).abs() < 1e-10);
    // 60 s/(s² + …) has 30 (1 + jζ/√(1 − ζ²)) at its pole.
    let part = 0.03 / (1.0f64 - 0.03 * 0.03).sqrt();
    assert!((mode.residue.re - 30.0).abs() < 1e-9 && (mode.residue.im - 30.0 * part).abs() < 1e-9);
    assert!((fit.delay_s.value - 2e-3).abs() < 1e-12);
    let rigid = fit.poles[0];
    assert!(rigid.rate.value.abs() < 1e-9 && (rigid.residue.value - 90.0).abs() < 1e-9);
    for hz in [1.0, 40.0, 63.0, 300.0] {
        let truth = machine.response(hz);
        assert!((fit.at(hz) - truth).norm() < 1e-11 * truth.norm(), "{hz}");
    }
}

/// With noise, over 30 records each: errors are as large as the deviations say. Means of (error/deviation)²
/// found: 0.57 to 1.40; those of 30 normal numbers are 1 ± 0.52 (2 deviations).
#[test]
fn deviations_of_modes_are_what_the_errors_are() {
    let machine = Machine::default();
    for (averaging, register) in [
        (
            Averaging::Periods {
                period: 1023,
                skip: 1,
            },
            10,
        ),
        (Averaging::Welch { segment: 2000 }, 18),
    ] {
        let mut squares = [0.0; 3];
        let records = 30;
        for seed in 0..records {
            let found = response(machine, 0.3, 1 + 1013 * seed, averaging, register);
            let settings = FitSettings {
                most_poles: 3,
                most_delay_s: 4e-3,
                coherence: 0.5,
                band_hz: [10.0, 400.0],
                ..FitSettings::default()
            };
            let fit = ModalFit::of(&found, &settings).unwrap();
            let mode = fit.modes[0];
            let over = [
                (mode.frequency_hz.value - 63.0) / mode.frequency_hz.deviation,
                (mode.damping.value - 0.03) / mode.damping.deviation,
                (fit.delay_s.value - 2e-3) / fit.delay_s.deviation,
            ];
            for (sum, over) in squares.iter_mut().zip(over) {
                *sum += over * over / records as f64;
            }
        }
        assert!(
            squares.iter().all(|s| (0.35..1.9).contains(s)),
            "{averaging:?} {squares:?}"
        );
    }
}

/// A machine whose input is not held and reaches the output by a thousandth at once: no pole of the fit does that, but one far
/// above the lines does nearly, together with a delay, and residues with one and the other are not known then (the mode's
/// deviation was 15 000 of 52 on a rack). The mode is known to a per cent.
#[test]
fn a_pole_above_the_lines_does_not_take_the_place_of_the_delay() {
    // Knuth's MMIX generator, twelve uniform numbers added.
    let mut state = 7_u64;
    let mut normal = || {
        (0..12).fold(-6.0, |sum, _| {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            sum + (state >> 11) as f64 / (1u64 << 53) as f64
        })
    };
    let pole = Complex::new(-5.62, 730.1);
    let truth = |hz: f64| {
        let s = Complex::new(0.0, std::f64::consts::TAU * hz);
        let mode = (s - pole).inv() * 51.9 + (s - pole.conj()).inv() * 51.9;
        (s + 0.43).inv() * 140.0 + mode - Complex::new(0.013, 0.0)
    };
    let line = |k: u32| {
        let frequency_hz = f64::from(k);
        let value = truth(frequency_hz);
        let deviation = 4e-3 * value.norm();
        let error = Complex::new(normal(), normal()) * deviation;
        ResponseLine {
            frequency_hz,
            value: value + error,
            deviation,
            coherence: 0.99,
        }
    };
    let found = FrequencyResponse {
        lines: (2..=450).map(line).collect(),
        averages: 6.0,
        step_hz: 1.0,
        period_s: 125e-6,
        correlation: 1.0,
    };
    let settings = FitSettings {
        held: false,
        most_poles: 10,
        most_delay_s: 1e-3,
        ..FitSettings::default()
    };
    let fit = ModalFit::of(&found, &settings).unwrap();
    println!("{fit:?}");
    let mode = fit
        .modes
        .iter()
        .find(|m| (m.frequency_hz.value - 116.2).abs() < 0.1);
    let mode = mode.unwrap();
    assert!(mode.residue_deviation < 0.5, "{mode:?}");
    assert!((mode.residue.re - 51.9).abs() < 1.0, "{mode:?}");
}
