//! Static parameters from constant-speed records, with and without a table
//! that vibrates by itself.
#![cfg(feature = "identify")]

use crate::rig;
use crate::rig::{Noise, PAPER, QUIET_MM_S, RAD_PER_M, SAMPLE_RATE};
use lugre::identify::{
    ConstantSpeedRun, FrictionIdentifyError, Reason, StaticFit, identify_static,
    identify_static_within,
};
use lugre::{LuGre, Parameters};

/// Runs on the curve itself, both directions, `samples` each, 1 % noise.
fn quiet_runs(speeds_mm_s: &[f64], samples: usize, seed: u64) -> Vec<ConstantSpeedRun> {
    quiet_runs_of(&rig::paper(), speeds_mm_s, samples, seed)
}

fn quiet_runs_of(
    law: &LuGre,
    speeds_mm_s: &[f64],
    samples: usize,
    seed: u64,
) -> Vec<ConstantSpeedRun> {
    let mut noise = Noise::new(seed);
    let mut runs = Vec::new();
    for &v in speeds_mm_s {
        for direction in [1.0, -1.0] {
            let w = direction * v * 1e-3 * RAD_PER_M;
            let torques = rig::with_noise(&vec![law.steady_state(w); samples], 0.01, &mut noise);
            let run = ConstantSpeedRun::from_record(&vec![w; samples], &torques, SAMPLE_RATE);
            runs.push(run.expect("a good record"));
        }
    }
    runs
}

fn assert_accurate(fit: &StaticFit) {
    assert_accurate_for(fit, PAPER.viscous);
}

fn assert_accurate_for(fit: &StaticFit, viscous: f64) {
    let cases = [
        ("T_C", fit.coulomb.value, PAPER.coulomb, 0.02),
        ("T_S", fit.stiction.value, PAPER.stiction, 0.05),
        ("Ω_S", fit.stribeck_speed.value, PAPER.stribeck_speed, 0.05),
        ("σ2", fit.viscous.value, viscous, 0.02),
    ];
    for (name, value, truth, tolerance) in cases {
        assert!(
            (value / truth - 1.0).abs() < tolerance,
            "{name}: {value} for {truth}"
        );
    }
}

#[test]
fn exact_data_give_the_exact_parameters() {
    let law = rig::paper();
    let runs: Vec<_> = QUIET_MM_S
        .iter()
        .flat_map(|v| [v * 1e-3 * RAD_PER_M, -v * 1e-3 * RAD_PER_M])
        .map(|speed| ConstantSpeedRun {
            speed,
            speed_standard_error: None,
            torque: law.steady_state(speed) + 0.013,
            torque_standard_error: None,
            vibration: 0.0,
            vibration_frequency: 0.0,
        })
        .collect();
    let fit = identify_static(&runs).expect("enough runs");
    // Torques of 0.7 to 1.2 N·m to rounding; Ω_S is the least determined.
    // Measured: 0, 0, 4.4e-15, 1.3e-18 and 6.9e-18.
    assert!((fit.coulomb.value - PAPER.coulomb).abs() < 1e-15);
    assert!((fit.stiction.value - PAPER.stiction).abs() < 1e-15);
    assert!((fit.stribeck_speed.value - PAPER.stribeck_speed).abs() < 4e-14);
    assert!((fit.viscous.value - PAPER.viscous).abs() < 1e-17);
    assert!((fit.torque_offset.value - 0.013).abs() < 6e-17);
}

#[test]
fn standard_errors_cover_the_truth() {
    let seeds = 150;
    let mut hits = [0u32; 4];
    for seed in 0..seeds {
        let runs = quiet_runs(&QUIET_MM_S, 1000, seed);
        let fit = identify_static(&runs).expect("enough runs");
        assert_eq!(fit.used.len(), runs.len(), "noise is no vibration");
        assert_accurate(&fit);
        let pairs = [
            (fit.coulomb, PAPER.coulomb),
            (fit.stiction, PAPER.stiction),
            (fit.stribeck_speed, PAPER.stribeck_speed),
            (fit.viscous, PAPER.viscous),
        ];
        for (hit, (estimate, truth)) in hits.iter_mut().zip(pairs) {
            *hit += u32::from(estimate.covers(truth, 2.0));
        }
    }
    // Binomial(150, 0.954): mean 143.2, standard deviation 2.6; ±3 of them,
    // and no more than all.
    for (hit, name) in hits.iter().zip(["T_C", "T_S", "Ω_S", "σ2"]) {
        assert!((136..=150).contains(hit), "{name}: {hit} of 150");
    }
    // All four together: too-large errors would show here. 600 cases, of which
    // 27.6 ± 5.1 lie outside were they independent; the four are correlated,
    // which widens this by up to 2.
    let outside = 600 - hits.iter().sum::<u32>();
    assert!(outside >= 5, "{hits:?}: standard errors too large");
}

/// Ten times the viscous friction: the curve no longer falls anywhere, yet its
/// shape still shows the Stribeck effect.
#[test]
fn strong_viscous_friction() {
    let viscous = 0.00312 * 30.0 / std::f64::consts::PI; // 0.00312 N·m/rpm
    let law = LuGre::new(Parameters { viscous, ..PAPER }).expect("valid");
    for seed in 0..30 {
        let runs = quiet_runs_of(&law, &QUIET_MM_S, 1000, 10_000 + seed);
        let fit = identify_static(&runs).expect("enough runs");
        assert_accurate_for(&fit, viscous);
        // 4.5 standard errors: 30 seeds leave a chance of 1 in 5000.
        assert!(fit.stribeck_speed.covers(PAPER.stribeck_speed, 4.5));
        assert!(fit.viscous.covers(viscous, 4.5));
    }
}

/// Runs of the drawn table, vibrating where it does.
fn drawn_runs(law: &LuGre, noise: &mut Noise) -> Vec<ConstantSpeedRun> {
    let mut speeds = QUIET_MM_S.to_vec();
    speeds.extend([3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 6.5]);
    let mut runs = Vec::new();
    for v in speeds {
        for direction in [1.0, -1.0] {
            let record = rig::drawn_table(law, direction * v * 1e-3 * RAD_PER_M, 1.5);
            let torques = rig::with_noise(&record.torques, 0.01, noise);
            let run = ConstantSpeedRun::from_record(&record.speeds, &torques, SAMPLE_RATE);
            runs.push(run.expect("a good record"));
        }
    }
    runs
}

#[test]
fn a_table_that_vibrates_by_itself() {
    let law = rig::paper();
    let runs = drawn_runs(&law, &mut Noise::new(7));
    let fit = identify_static(&runs).expect("enough quiet runs");
    assert!(fit.left_out.len() >= 8, "{:?}", fit.left_out);
    for left in &fit.left_out {
        let v = runs[left.run].speed.abs() / RAD_PER_M * 1e3;
        assert!(
            (2.0..9.0).contains(&v),
            "{v} mm/s left out: {}",
            left.reason
        );
        let Reason::Vibrates {
            amplitude,
            frequency,
        } = left.reason
        else {
            panic!("{:?}", left.reason);
        };
        // The spring's 62 Hz, raised by the bristles in stick phases or
        // lowered by sticking.
        assert!(
            amplitude > 0.1 && (40.0..80.0).contains(&frequency),
            "{}",
            left.reason
        );
    }
    assert_accurate(&fit);
    for (estimate, truth) in [
        (fit.coulomb, PAPER.coulomb),
        (fit.stiction, PAPER.stiction),
        (fit.stribeck_speed, PAPER.stribeck_speed),
        (fit.viscous, PAPER.viscous),
    ] {
        // Four estimates at once: 4 standard errors leave 1 in 4000.
        assert!(estimate.covers(truth, 4.0), "{estimate:?} {truth}");
    }
    // And what a plain fit of the mean torques, all alike, would have found.
    let means: Vec<_> = runs
        .iter()
        .map(|r| ConstantSpeedRun {
            torque_standard_error: None,
            ..*r
        })
        .collect();
    let plain = identify_static_within(&means, f64::INFINITY).expect("fits something");
    let bias = (plain.stribeck_speed.value / PAPER.stribeck_speed - 1.0).abs();
    assert!(bias > 0.05, "the trap is no trap: {bias}");
}

/// A run vibrates where the law's negative damping beats the drive's.
#[test]
fn vibration_starts_where_the_linearised_law_says() {
    let law = rig::paper();
    let expected = |w: f64| {
        law.vibration_damping(w, 2.0 * std::f64::consts::PI * 62.0) + rig::DRIVE_DAMPING < 0.0
    };
    for v in [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0] {
        let w = v * 1e-3 * RAD_PER_M;
        let record = rig::drawn_table(&law, w, 1.5);
        let run = ConstantSpeedRun::from_record(&record.speeds, &record.torques, SAMPLE_RATE)
            .expect("a good record");
        assert_eq!(run.vibration > 0.1, expected(w), "{v} mm/s: {run:?}");
    }
}

#[test]
fn standard_error_of_a_mean_of_correlated_samples() {
    // First-order autoregression, ρ = 0.8: variance of the mean is that of
    // white noise times (1 + ρ)/(1 − ρ) = 9.
    let (n, rho) = (4000, 0.8_f64);
    let mut ratio = 0.0;
    for seed in 0..40 {
        let mut noise = Noise::new(1000 + seed);
        let mut state = noise.normal();
        let torques: Vec<f64> = (0..n)
            .map(|_| {
                state = rho * state + (1.0 - rho * rho).sqrt() * noise.normal();
                5.0 + state
            })
            .collect();
        let run = ConstantSpeedRun::from_record(&vec![1.0; n], &torques, 1e3).expect("good");
        let error = run.torque_standard_error.expect("noise");
        ratio += error / (9.0 / n as f64).sqrt() / 40.0;
    }
    // The window of 5 τ leaves out e^{−5·…} of the sum; the scatter of τ is
    // about √(2(2·45+1)/4000) = 0.2 a record, 3 % over 40 of them.
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

/// Every third run says nothing of its own noise, which is ten times that of
/// the others.
#[test]
fn an_unknown_standard_error_gains_no_weight() {
    let law = rig::paper();
    let (known, unknown) = (1e-3, 1e-2);
    let mut errors: Vec<f64> = Vec::new();
    for seed in 0..20 {
        let mut noise = Noise::new(seed);
        let runs: Vec<_> = QUIET_MM_S
            .iter()
            .flat_map(|v| [v * 1e-3 * RAD_PER_M, -v * 1e-3 * RAD_PER_M])
            .enumerate()
            .map(|(i, speed)| {
                let says = i % 3 != 0;
                let sd = if says { known } else { unknown };
                ConstantSpeedRun {
                    speed,
                    speed_standard_error: None,
                    torque: law.steady_state(speed) + sd * noise.normal(),
                    torque_standard_error: says.then_some(known),
                    vibration: 0.0,
                    vibration_frequency: 0.0,
                }
            })
            .collect();
        let fit = identify_static(&runs).expect("enough runs");
        // As good as the known runs alone, whose 24 determine five parameters.
        for (estimate, truth) in [
            (fit.coulomb, PAPER.coulomb),
            (fit.stiction, PAPER.stiction),
            (fit.stribeck_speed, PAPER.stribeck_speed),
            (fit.viscous, PAPER.viscous),
        ] {
            // 80 estimates: 4.5 standard errors leave 1 in 1800.
            assert!(
                estimate.covers(truth, 4.5),
                "seed {seed}: {estimate:?} {truth}"
            );
        }
        let alone: Vec<_> = runs
            .iter()
            .filter(|r| r.torque_standard_error.is_some())
            .copied()
            .collect();
        let alone = identify_static(&alone).expect("enough runs");
        errors.push(fit.stribeck_speed.standard_error / alone.stribeck_speed.standard_error);
    }
    let (low, high) = errors
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(l, h), e| (l.min(*e), h.max(*e)));
    // A hundredth of the weight each: 0.990 to 1.003 measured.
    assert!(low > 0.95 && high < 1.03, "{low} {high}");
}

/// Zero is not a standard error: a fit would assume that run alone.
#[test]
fn a_standard_error_of_zero_is_refused() {
    let mut runs = quiet_runs(&QUIET_MM_S, 100, 1);
    runs[2].torque_standard_error = Some(0.0);
    let error = identify_static(&runs).expect_err("no standard error");
    let text = "`torque_standard_error` of entry 2 is 0";
    assert!(error.to_string().contains(text), "{error}");
    // Samples that a coarse sensor shows all equal give none.
    let flat = ConstantSpeedRun::from_record(&[0.1; 300], &[0.7; 300], SAMPLE_RATE);
    assert_eq!(flat.expect("good").torque_standard_error, None);
}

#[test]
fn errors_say_what_is_missing() {
    let few = quiet_runs(&[0.5, 1.0, 10.0, 100.0], 200, 1);
    assert!(matches!(
        identify_static(&few),
        Err(FrictionIdentifyError::TooFewSpeeds {
            found: 4,
            needed: 6,
            left_out: 0
        })
    ));
    let fast = quiet_runs(&[8.0, 10.0, 20.0, 40.0, 80.0, 150.0, 300.0], 1000, 1);
    let error = identify_static(&fast).expect_err("nothing below Ω_S");
    assert!(
        matches!(
            error,
            FrictionIdentifyError::NoStribeckEffect { .. }
                | FrictionIdentifyError::OneSideOfStribeckSpeed { side: "below", .. }
        ),
        "{error}"
    );
    let slow = quiet_runs(&[0.2, 0.5, 0.8, 1.1, 1.4, 1.7, 2.0], 1000, 1);
    let error = identify_static(&slow).expect_err("nothing above Ω_S");
    assert!(
        matches!(
            error,
            FrictionIdentifyError::NoStribeckEffect { .. }
                | FrictionIdentifyError::OneSideOfStribeckSpeed { side: "above", .. }
        ),
        "{error}"
    );
    let mut bad = quiet_runs(&QUIET_MM_S, 100, 1);
    bad[3].torque = f64::NAN;
    let error = identify_static(&bad).expect_err("NaN");
    assert!(
        error.to_string().contains("`torque` of entry 3 is NaN"),
        "{error}"
    );
    let short = ConstantSpeedRun::from_record(&[1.0; 10], &[1.0; 10], 1e3);
    assert_eq!(
        short,
        Err(FrictionIdentifyError::TooFewSamples {
            found: 10,
            needed: 64
        })
    );
    let uneven = ConstantSpeedRun::from_record(&[1.0; 100], &[1.0; 90], 1e3);
    assert_eq!(
        uneven,
        Err(FrictionIdentifyError::LengthMismatch {
            motion: 100,
            torque: 90
        })
    );
}

#[test]
fn without_viscous_friction_the_bound_holds() {
    let law = LuGre::new(Parameters {
        viscous: 0.0,
        ..PAPER
    })
    .expect("valid");
    for seed in 0..20 {
        let mut noise = Noise::new(seed);
        let runs: Vec<_> = QUIET_MM_S
            .iter()
            .flat_map(|v| [v * 1e-3 * RAD_PER_M, -v * 1e-3 * RAD_PER_M])
            .map(|speed| ConstantSpeedRun {
                speed,
                speed_standard_error: None,
                torque: law.steady_state(speed) + 2e-4 * noise.normal(),
                torque_standard_error: Some(2e-4),
                vibration: 0.0,
                vibration_frequency: 0.0,
            })
            .collect();
        let fit = identify_static(&runs).expect("enough runs");
        assert!(fit.viscous.value >= 0.0);
        assert!(fit.viscous.covers(0.0, 4.0), "{:?}", fit.viscous);
        // Half of the seeds lie on the bound; the others must stay right.
        assert!((fit.coulomb.value / PAPER.coulomb - 1.0).abs() < 0.002);
    }
}
