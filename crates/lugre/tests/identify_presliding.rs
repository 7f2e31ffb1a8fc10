//! σ0 and σ1 from small motions, simulated twenty times finer than sampled.
#![cfg(feature = "identify")]

use crate::rig;
use std::f64::consts::PI;

use crate::rig::{Noise, PAPER};
use lugre::Parameters;
use lugre::identify::{
    FrictionIdentifyError, MeasuredMotion, ParameterEstimate, PreslidingRecord, StaticKnowledge,
    StaticParameters, identify_presliding,
};
use proptest::prelude::*;

const STATICS: StaticParameters = StaticParameters {
    coulomb: PAPER.coulomb,
    stiction: PAPER.stiction,
    stribeck_speed: PAPER.stribeck_speed,
    viscous: PAPER.viscous,
};

const STEP: f64 = 1e-3;

struct Test {
    displacement: Vec<f64>,
    speed: Vec<f64>,
    torque: Vec<f64>,
}

/// 2 s of two sines that swing across the break-away deflection of 0.05 rad,
/// and noise of 1 % of T_C on the torque.
fn sines(z0: f64, offset: f64, seed: u64) -> Test {
    let law = rig::paper();
    let position = |t: f64| 0.04 * (2.0 * PI * 2.0 * t).sin() + 0.02 * (2.0 * PI * 7.0 * t).sin();
    let speed =
        |t: f64| 0.16 * PI * (2.0 * PI * 2.0 * t).cos() + 0.28 * PI * (2.0 * PI * 7.0 * t).cos();
    let mut noise = Noise::new(seed);
    let mut test = Test {
        displacement: Vec::new(),
        speed: Vec::new(),
        torque: Vec::new(),
    };
    let (fine, mut z) = (STEP / 20.0, z0);
    for i in 0..2000 * 20 {
        let t = f64::from(i) * fine;
        if i % 20 == 0 {
            test.displacement.push(position(t));
            test.speed.push(speed(t));
            let torque = law.torque(z, speed(t)) + offset;
            test.torque
                .push(torque + 0.01 * PAPER.coulomb * noise.normal());
        }
        z = law.step(z, speed(t), speed(t + fine), fine);
    }
    test
}

impl Test {
    fn by_speed(&self) -> PreslidingRecord<'_> {
        PreslidingRecord {
            time_step: STEP,
            motion: MeasuredMotion::Speed(&self.speed),
            torque: &self.torque,
        }
    }

    fn by_displacement(&self) -> PreslidingRecord<'_> {
        PreslidingRecord {
            motion: MeasuredMotion::Displacement(&self.displacement),
            ..self.by_speed()
        }
    }
}

fn within(estimate: ParameterEstimate, truth: f64, tolerance: f64) -> bool {
    (estimate.value / truth - 1.0).abs() < tolerance
}

#[test]
fn stiffness_and_damping_with_errors_that_cover_them() {
    let seeds = 100;
    let (mut stiffness_hits, mut damping_hits) = (0, 0);
    for seed in 0..seeds {
        let z0 = 0.04 * (seed as f64 / 50.0 - 1.0);
        let test = sines(z0, 0.05, seed);
        let fit = identify_presliding(STATICS, &test.by_speed()).expect("a good test");
        assert!(
            within(fit.stiffness, PAPER.stiffness, 0.05),
            "{:?}",
            fit.stiffness
        );
        assert!(
            within(fit.damping, PAPER.damping, 0.15),
            "{:?}",
            fit.damping
        );
        // 4.5 standard errors: 100 seeds leave a chance of 1 in 1500.
        let bristle_torque = PAPER.stiffness * z0;
        assert!(fit.initial_bristle_torque.covers(bristle_torque, 4.5));
        assert!(fit.torque_offset.covers(0.05, 4.5));
        // White residuals: 4.5/√2000.
        assert!(fit.residual_correlation.abs() < 0.1);
        stiffness_hits += u32::from(fit.stiffness.covers(PAPER.stiffness, 2.0));
        damping_hits += u32::from(fit.damping.covers(PAPER.damping, 2.0));
    }
    // Binomial(100, 0.954): mean 95.4, standard deviation 2.1; ±3 of them.
    for hits in [stiffness_hits, damping_hits] {
        assert!(
            (89..=100).contains(&hits),
            "{stiffness_hits} {damping_hits}"
        );
    }
    // Not far too large either: both hitting always has a chance of 1 in 10^4.
    assert!(stiffness_hits + damping_hits < 200);
}

#[test]
fn displacement_serves_as_well() {
    let test = sines(0.0, -0.02, 5);
    let fit = identify_presliding(STATICS, &test.by_displacement()).expect("a good test");
    assert!(
        within(fit.stiffness, PAPER.stiffness, 0.05),
        "{:?}",
        fit.stiffness
    );
    assert!(
        within(fit.damping, PAPER.damping, 0.15),
        "{:?}",
        fit.damping
    );
    let law = fit.law().expect("a law");
    assert_eq!(law.parameters().coulomb, PAPER.coulomb);
}

#[test]
fn uncertain_statics_widen_the_errors_and_still_cover() {
    // Statics drawn with 0.5 % errors; the standard errors must carry them.
    let sd = [
        0.005 * STATICS.coulomb,
        0.005 * STATICS.stiction,
        0.02 * STATICS.stribeck_speed,
        0.01 * STATICS.viscous,
    ];
    let covariance = core::array::from_fn(|i| {
        core::array::from_fn(|j| if i == j { sd[i] * sd[i] } else { 0.0 })
    });
    let (mut with, mut without) = (0, 0);
    for seed in 0..60 {
        let test = sines(0.02, 0.0, seed);
        let mut noise = Noise::new(500 + seed);
        let parameters = StaticParameters {
            coulomb: STATICS.coulomb + sd[0] * noise.normal(),
            stiction: STATICS.stiction + sd[1] * noise.normal(),
            stribeck_speed: STATICS.stribeck_speed + sd[2] * noise.normal(),
            viscous: STATICS.viscous + sd[3] * noise.normal(),
        };
        let uncertain = StaticKnowledge {
            parameters,
            covariance,
        };
        let known = identify_presliding(parameters, &test.by_speed()).expect("good");
        let fit = identify_presliding(uncertain, &test.by_speed()).expect("good");
        assert!(fit.stiffness.standard_error > known.stiffness.standard_error);
        with += u32::from(fit.stiffness.covers(PAPER.stiffness, 2.0));
        without += u32::from(known.stiffness.covers(PAPER.stiffness, 2.0));
    }
    // Binomial(60, 0.954): 57.2 ± 1.6, three of them below.
    assert!(with >= 52, "{with} of 60");
    assert!(without < with, "the statics' share matters: {without}");
}

#[test]
fn a_record_far_below_break_away_is_enough() {
    // ±0.005 rad, a tenth of break-away: the hysteresis is faint, and start and
    // offset can only be told apart by it.
    let law = rig::paper();
    let speed: Vec<f64> = (0..2000)
        .map(|i| 0.005 * 20.0 * (20.0 * f64::from(i) * STEP).cos())
        .collect();
    let mut noise = Noise::new(3);
    let mut z = 0.0;
    let torque: Vec<f64> = (0..2000)
        .map(|i| {
            if i > 0 {
                z = law.step(z, speed[i - 1], speed[i], STEP);
            }
            law.torque(z, speed[i]) + 0.01 * PAPER.coulomb * noise.normal()
        })
        .collect();
    let record = PreslidingRecord {
        time_step: STEP,
        motion: MeasuredMotion::Speed(&speed),
        torque: &torque,
    };
    let fit = identify_presliding(STATICS, &record).unwrap_or_else(|e| panic!("{e}"));
    assert!(
        within(fit.stiffness, PAPER.stiffness, 0.05),
        "{:?}",
        fit.stiffness
    );
    assert!(
        within(fit.damping, PAPER.damping, 0.15),
        "{:?}",
        fit.damping
    );
    assert!(fit.initial_bristle_torque.covers(0.0, 4.5));
    assert!(fit.torque_offset.covers(0.0, 4.5));
}

/// Equations (1) to (3) as printed, by classical Runge–Kutta in steps of 1/50
/// of a sample: shares nothing with the crate's step.
fn simulate(p: &Parameters, z0: f64, speed: impl Fn(f64) -> f64, samples: usize) -> Vec<f64> {
    let level =
        |w: f64| p.coulomb + (p.stiction - p.coulomb) * (-(w / p.stribeck_speed).powi(2)).exp();
    let rate = |t: f64, z: f64| {
        let w = speed(t);
        w - p.stiffness * w.abs() * z / level(w)
    };
    let h = STEP / 50.0;
    let mut z = z0;
    let mut torque = Vec::new();
    for i in 0..samples * 50 {
        let t = i as f64 * h;
        if i % 50 == 0 {
            let w = speed(t);
            torque.push(p.stiffness * z + p.damping * rate(t, z) + p.viscous * w);
        }
        let k1 = rate(t, z);
        let k2 = rate(t + h / 2.0, z + h / 2.0 * k1);
        let k3 = rate(t + h / 2.0, z + h / 2.0 * k2);
        let k4 = rate(t + h, z + h * k3);
        z += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    torque
}

prop_compose! {
    /// Laws from a small stage to a mill: levels over three decades, stiffness
    /// from a hundredth to a hundred times the paper's, break-away deflections
    /// between. σ1/σ0 is between 5 and 200 ms, the time over which the test's
    /// motions change.
    fn drawn_law()(
        coulomb in (0.03f64.ln()..30f64.ln()).prop_map(f64::exp),
        rise in 0.0f64..0.6,
        stiffness in (0.01f64.ln()..100f64.ln()).prop_map(|x| PAPER.stiffness * x.exp()),
        stribeck in (0.3f64.ln()..100f64.ln()).prop_map(f64::exp),
        lag in (5e-3f64.ln()..0.2f64.ln()).prop_map(f64::exp),
        drag in 0.0f64..0.1,
    ) -> Parameters {
        let deflection = coulomb / stiffness;
        // rad/s: the speed that crosses the break-away deflection in 50 ms.
        let fast = 20.0 * deflection;
        Parameters {
            coulomb,
            stiction: coulomb * (1.0 + rise),
            stribeck_speed: stribeck * fast,
            stiffness,
            damping: lag * stiffness,
            viscous: drag * coulomb / fast,
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Motions of a third to three times the break-away deflection, from any
    /// bristle torque, under 1 % noise.
    #[test]
    fn any_law_is_found(
        truth in drawn_law(), size in (0.3f64.ln()..3f64.ln()).prop_map(f64::exp),
        start in -0.8f64..0.8, offset in -0.2f64..0.2, seed in 0u64..1000,
    ) {
        let deflection = truth.coulomb / truth.stiffness;
        let amplitude = size * deflection;
        let speed = |t: f64| {
            let (slow, fast) = (2.0 * PI * 2.0, 2.0 * PI * 7.0);
            amplitude * (0.7 * slow * (slow * t).cos() + 0.3 * fast * (fast * t).cos())
        };
        let mut noise = Noise::new(seed);
        let speeds: Vec<f64> = (0..2000).map(|i| speed(f64::from(i) * STEP)).collect();
        let torque: Vec<f64> = simulate(&truth, start * deflection, speed, 2000)
            .iter()
            .map(|t| t + (offset + 0.01 * noise.normal()) * truth.coulomb)
            .collect();
        let statics = StaticParameters {
            coulomb: truth.coulomb,
            stiction: truth.stiction,
            stribeck_speed: truth.stribeck_speed,
            viscous: truth.viscous,
        };
        let record = PreslidingRecord {
            time_step: STEP,
            motion: MeasuredMotion::Speed(&speeds),
            torque: &torque,
        };
        let fit = identify_presliding(statics, &record).unwrap_or_else(|e| panic!("{e}"));
        // 5.5 standard errors: 40 laws leave a chance of 1 in 10^5.
        for (estimate, truth) in [
            (fit.stiffness, truth.stiffness),
            (fit.damping, truth.damping),
            (fit.initial_bristle_torque, start * truth.coulomb),
            (fit.torque_offset, offset * truth.coulomb),
        ] {
            prop_assert!(estimate.covers(truth, 5.5), "{:?} {}", estimate, truth);
        }
        // Standard errors of at most 0.22 % and 0.5 % measured.
        prop_assert!(within(fit.stiffness, truth.stiffness, 0.015), "{:?}", fit.stiffness);
        prop_assert!(within(fit.damping, truth.damping, 0.03), "{:?}", fit.damping);
    }
}

/// An axis that stands still shows nothing of its bristles, whatever its
/// sensor makes of that.
#[test]
fn a_standstill_is_no_presliding_test() {
    for seed in 0..12 {
        let mut noise = Noise::new(seed);
        let n = 2000;
        let white: Vec<f64> = (0..n).map(|_| 0.01 * noise.normal()).collect();
        let position: Vec<f64> = (0..=n).map(|_| 1e-5 * noise.normal()).collect();
        let differenced: Vec<f64> = position.windows(2).map(|p| (p[1] - p[0]) / STEP).collect();
        let quantised: Vec<f64> = white.iter().map(|w| 0.02 * (w / 0.02).round()).collect();
        let mut state = 0.0;
        let filtered: Vec<f64> = white
            .iter()
            .map(|w| {
                state = 0.9 * state + 0.3 * w;
                state
            })
            .collect();
        let torque: Vec<f64> = (0..n).map(|_| 0.3 + 0.007 * noise.normal()).collect();
        for (kind, speeds) in [white, differenced, quantised, filtered].iter().enumerate() {
            let record = PreslidingRecord {
                time_step: STEP,
                motion: MeasuredMotion::Speed(speeds),
                torque: &torque,
            };
            let error = identify_presliding(STATICS, &record).expect_err("nothing moves");
            let open = matches!(
                error,
                FrictionIdentifyError::NotIdentifiable { .. }
                    | FrictionIdentifyError::NoPreslidingMotion { .. }
            );
            assert!(open, "noise {kind}, seed {seed}: {error}");
        }
    }
}

#[test]
fn errors_say_what_is_missing() {
    let test = sines(0.0, 0.0, 1);
    let n = test.speed.len();
    let still = vec![0.0; n];
    let record = PreslidingRecord {
        motion: MeasuredMotion::Speed(&still),
        ..test.by_speed()
    };
    assert_eq!(
        identify_presliding(STATICS, &record),
        Err(FrictionIdentifyError::NoMotion)
    );

    // Sliding at one speed from a steady start: nothing shows the bristles.
    let law = rig::paper();
    let sliding = vec![20.0; n];
    let mut noise = Noise::new(2);
    let torque: Vec<f64> = (0..n)
        .map(|_| law.steady_state(20.0) + 0.007 * noise.normal())
        .collect();
    let record = PreslidingRecord {
        time_step: STEP,
        motion: MeasuredMotion::Speed(&sliding),
        torque: &torque,
    };
    let error = identify_presliding(STATICS, &record).expect_err("no pre-sliding");
    assert!(
        matches!(
            error,
            FrictionIdentifyError::NoPreslidingMotion { .. }
                | FrictionIdentifyError::NotIdentifiable { .. }
        ),
        "{error}"
    );

    let record = PreslidingRecord {
        time_step: 0.0,
        ..test.by_speed()
    };
    let error = identify_presliding(STATICS, &record).expect_err("no time");
    assert!(error.to_string().contains("time_step"), "{error}");
    let swapped = StaticParameters {
        stiction: 0.1,
        ..STATICS
    };
    let error = identify_presliding(swapped, &test.by_speed()).expect_err("no law");
    assert!(matches!(error, FrictionIdentifyError::Law(_)), "{error}");
}
