use frequency_response::{
    Averaging, Estimator, Excitation, FitSettings, FrequencyResponse, ModalFit, Prbs, Record,
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
