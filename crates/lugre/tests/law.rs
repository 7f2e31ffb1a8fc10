//! The law itself: closed forms, symmetry, bounds, limits.

use lugre::{LuGre, LugreError, Parameters};
use proptest::prelude::*;

const PAPER: Parameters = Parameters::LIU_2025;

fn paper() -> LuGre {
    LuGre::new(PAPER).expect("valid")
}

prop_compose! {
    fn any_law()(
        coulomb in 1e-3f64..1e3, rise in 0.0f64..2.0, stribeck in 1e-3f64..1e2,
        stiffness in 1e-1f64..1e6, damping in 0.0f64..1e3, viscous in 0.0f64..10.0,
    ) -> LuGre {
        LuGre::new(Parameters {
            coulomb, stiction: coulomb * (1.0 + rise), stribeck_speed: stribeck,
            stiffness, damping, viscous,
        }).expect("in range")
    }
}

/// Table 1 of the paper as printed, speeds in rpm; 1 rpm is 2π/60 rad/s.
#[test]
fn the_papers_numbers() {
    let per_rpm = 60.0 / (2.0 * std::f64::consts::PI);
    let p = Parameters::LIU_2025;
    let pairs = [
        (p.coulomb, 0.6757, 0.6757),
        (p.stiction, 0.7653, 0.7653),
        (p.stribeck_speed, 25.9147 / per_rpm, 2.713781),
        (p.stiffness, 1.5875 * per_rpm, 15.159508),
        (p.damping, 0.1593 * per_rpm, 1.521203),
        (p.viscous, 0.0003 * per_rpm, 0.002865),
    ];
    for (value, converted, by_hand) in pairs {
        assert!((value / converted - 1.0).abs() < 1e-15, "{value}");
        // By hand to six decimals.
        assert!((value - by_hand).abs() <= 5e-7, "{value}");
    }
}

#[test]
fn the_papers_curve() {
    let law = paper();
    // Equation (2) by hand: at Ω_S a share 1/e of T_S − T_C is left.
    assert_eq!(law.level(0.0), 0.7653);
    let at_stribeck = 0.6757 + 0.0896 * (-1.0f64).exp();
    assert!((law.level(PAPER.stribeck_speed) - at_stribeck).abs() < 1e-15);
    assert_eq!(law.level(100.0), 0.6757);
    // 600 rpm.
    let traverse = law.steady_state(20.0 * std::f64::consts::PI);
    assert!((traverse - (0.6757 + 0.0003 * 600.0)).abs() < 1e-14);
    // Break-away deflection of the paper's bristles: 0.05 rad of screw.
    assert!((law.bristle_limit() - 0.050483).abs() < 1e-6);
}

#[test]
fn rest_is_steady_anywhere() {
    let law = paper();
    assert_eq!(law.steady_state(0.0), 0.0);
    assert_eq!(law.steady_bristle(0.0), 0.0);
    assert_eq!(law.rate(0.03, 0.0), 0.0);
    assert_eq!(law.torque(0.03, 0.0), PAPER.stiffness * 0.03);
}

#[test]
fn presliding_starts_with_the_bristle_stiffness_and_softens() {
    // Slow motion from the relaxed state: T = σ0 z, and dT/dx = σ0 (1 − σ0 z/G)
    // falls from σ0 monotonically (the hysteresis of Dahl's model).
    let law = LuGre::new(Parameters {
        damping: 0.0,
        viscous: 0.0,
        ..PAPER
    })
    .expect("valid");
    let (speed, dx) = (1e-6, 1e-4);
    let mut z = 0.0;
    let mut last_slope = f64::INFINITY;
    for i in 0..500 {
        let z1 = law.step(z, speed, speed, dx / speed);
        let slope = (law.torque(z1, 0.0) - law.torque(z, 0.0)) / dx;
        if i == 0 {
            // After dx the mean slope is σ0 (1 − dx σ0 / 2 T_S + …): −0.1 %.
            assert!((slope / PAPER.stiffness - 1.0).abs() < 1.1e-3);
        }
        assert!(slope < last_slope && slope > 0.0);
        last_slope = slope;
        z = z1;
    }
}

#[test]
fn null_friction_is_exactly_nothing() {
    for stiffness in [0.0, 15.0] {
        let law = LuGre::new(Parameters {
            coulomb: 0.0,
            stiction: 0.0,
            stiffness,
            viscous: 0.0,
            ..PAPER
        })
        .expect("null friction is a law");
        for w in [-3.0, -1e-300, 0.0, 1.0, 1e9] {
            let (z, torque) = law.step_torque(0.0, w, 2.0 * w, 1e-4);
            assert_eq!((z, torque), (0.0, 0.0));
            assert_eq!(law.step_impulse(0.0, w, 2.0 * w, 1e-4).1, 0.0);
            assert_eq!(law.steady_state(w), 0.0);
            assert_eq!(law.level(w), 0.0);
        }
    }
}

#[test]
fn viscous_friction_alone() {
    let law = LuGre::new(Parameters {
        coulomb: 0.0,
        stiction: 0.0,
        ..PAPER
    })
    .expect("valid");
    let torque = PAPER.viscous * 7.0;
    assert_eq!(law.step_torque(0.0, 5.0, 7.0, 1e-3), (0.0, torque));
    assert_eq!(law.steady_state(-7.0), -torque);
}

#[test]
fn bad_parameters_are_named() {
    type Spoil = fn(&mut Parameters);
    let cases: [(Spoil, &str); 8] = [
        (|p| p.coulomb = f64::NAN, "coulomb"),
        (|p| p.coulomb = 0.0, "coulomb"),
        (|p| p.stiction = f64::INFINITY, "stiction"),
        (|p| p.stribeck_speed = 0.0, "stribeck_speed"),
        (|p| p.stiffness = 0.0, "stiffness"),
        (|p| p.stiffness = 1e-310, "stiffness"),
        (|p| p.damping = -1.0, "damping"),
        (|p| p.viscous = -1e-9, "viscous"),
    ];
    for (spoil, expected) in cases {
        let mut parameters = PAPER;
        spoil(&mut parameters);
        match LuGre::new(parameters) {
            Err(LugreError::Invalid { field, .. }) => assert_eq!(field, expected),
            other => panic!("{expected}: {other:?}"),
        }
    }
    // A deflection that is no number would make every step NaN.
    let soft = Parameters {
        coulomb: 1e-200,
        stiction: 1e-200,
        stiffness: 1e200,
        ..PAPER
    };
    let error = LuGre::new(soft).expect_err("T_C/σ0 underflows");
    assert!(error.to_string().contains("`stiffness` is 1"), "{error}");
    let swapped = Parameters {
        stiction: 0.5,
        ..PAPER
    };
    let error = LuGre::new(swapped).expect_err("T_S < T_C");
    assert_eq!(
        error.to_string(),
        "LuGre parameter `stiction` is 0.5, but must be at least `coulomb` = 0.6757"
    );
}

proptest! {
    #[test]
    fn level_lies_between_coulomb_and_stiction_and_falls(
        law in any_law(), w in -200.0f64..200.0, more in 1.0f64..2.0,
    ) {
        let p = law.parameters();
        let g = law.level(w);
        prop_assert!(g >= p.coulomb && g <= p.stiction);
        // Monotone up to the last bit of the exponential.
        prop_assert!(law.level(w * more) <= g * (1.0 + 1e-15));
    }

    /// Leaving the exponential out changes no bit: from `flat_above` on the
    /// formula itself rounds to T_C.
    #[test]
    fn skipping_the_exponential_is_exact(law in any_law(), factor in 1.0f64..3.0) {
        let p = law.parameters();
        let w = law.flat_above() * factor;
        let term = (p.stiction - p.coulomb) * (-(w / p.stribeck_speed).powi(2)).exp();
        prop_assert_eq!(p.coulomb + term, p.coulomb);
        prop_assert_eq!(law.level(w), p.coulomb);
    }

    #[test]
    fn odd_symmetry_to_the_bit(
        law in any_law(), z in -1.0f64..1.0, w0 in -50.0f64..50.0, w1 in -50.0f64..50.0,
    ) {
        prop_assert_eq!(law.steady_state(-w0), -law.steady_state(w0));
        prop_assert_eq!(law.steady_bristle(-w0), -law.steady_bristle(w0));
        prop_assert_eq!(law.rate(-z, -w0), -law.rate(z, w0));
        prop_assert_eq!(law.torque(-z, -w0), -law.torque(z, w0));
        let (z1, t1) = law.step_torque(z, w0, w1, 1e-3);
        prop_assert_eq!(law.step_torque(-z, -w0, -w1, 1e-3), (-z1, -t1));
    }

    /// The steady deflection is a zero of the rate, and its torque the curve.
    #[test]
    fn steady_state_solves_the_law(law in any_law(), w in -100.0f64..100.0) {
        let z = law.steady_bristle(w);
        let p = law.parameters();
        prop_assert!(law.rate(z, w).abs() <= 4.0 * f64::EPSILON * w.abs());
        let scale = p.stiction + (p.damping + p.viscous) * w.abs();
        prop_assert!((law.torque(z, w) - law.steady_state(w)).abs() <= 8.0 * f64::EPSILON * scale);
    }

    /// The rate is equation (1) as printed.
    #[test]
    fn rate_is_equation_one(law in any_law(), z in -1.0f64..1.0, w in -50.0f64..50.0) {
        let p = law.parameters();
        let relaxation = p.stiffness * w.abs() * z / law.level(w);
        let scale = w.abs() + relaxation.abs();
        prop_assert!((law.rate(z, w) - (w - relaxation)).abs() <= 8.0 * f64::EPSILON * scale);
    }
}

#[cfg(feature = "serde")]
#[test]
fn serde_validates() {
    use serde::Deserialize;
    use serde::de::value::{Error, MapDeserializer};
    let fields = |stiction: f64| {
        [
            ("coulomb", PAPER.coulomb),
            ("stiction", stiction),
            ("stribeck_speed", PAPER.stribeck_speed),
            ("stiffness", PAPER.stiffness),
            ("damping", PAPER.damping),
            ("viscous", PAPER.viscous),
        ]
    };
    let read = |stiction| {
        LuGre::deserialize(MapDeserializer::<_, Error>::new(
            fields(stiction).into_iter(),
        ))
    };
    assert_eq!(read(0.7653).expect("valid"), paper());
    let message = read(0.1).expect_err("T_S < T_C").to_string();
    assert!(message.contains("stiction"), "{message}");
}

#[test]
fn vibration_damping_is_the_in_phase_torque_of_a_small_oscillation() {
    use std::f64::consts::TAU;
    let law = paper();
    for (speed, hertz) in [
        (1.3, 62.0),
        (2.7, 62.0),
        (2.7, 5.0),
        (-4.4, 20.0),
        (30.0, 62.0),
    ] {
        // One period, measured after twenty relaxation times.
        let amplitude = 1e-4;
        let n = 4000;
        let h = 1.0 / hertz / f64::from(n);
        let w = |k: i32| speed + amplitude * (TAU * f64::from(k % n) / f64::from(n)).sin();
        let mut z = law.steady_bristle(speed);
        // 1/τ = σ0 |ω| / G; whole periods for at least 20 τ.
        let tau = law.level(speed) / (PAPER.stiffness * speed.abs());
        let settle = ((20.0 * tau * hertz).ceil() as i32) * n;
        for k in 0..settle {
            z = law.step(z, w(k), w(k + 1), h);
        }
        let mut in_phase = 0.0;
        for k in 0..n {
            in_phase += law.torque(z, w(k)) * (w(k) - speed);
            z = law.step(z, w(k), w(k + 1), h);
        }
        let measured = 2.0 * in_phase / (f64::from(n) * amplitude * amplitude);
        let expected = law.vibration_damping(speed, TAU * hertz);
        // Transients of e^−20, terms of the order of the amplitude squared and
        // h² remain: 3.7e-8 measured.
        assert!(
            (measured - expected).abs() < 3e-7,
            "{speed} {hertz}: {measured} {expected}"
        );
    }
    // The falling of the curve counts σ1 |ω|/G times in fast oscillations:
    // less than once for slow sliding, more than once for fast.
    for (speed, more) in [(0.2, false), (2.7, true)] {
        let slow = law.vibration_damping(speed, 0.0) - PAPER.viscous;
        let fast = law.vibration_damping(speed, 1e9) - PAPER.viscous;
        let factor = PAPER.damping * speed / law.level(speed);
        assert!((fast / slow / factor - 1.0).abs() < 2e-14); // 2.8e-15 measured
        assert_eq!(fast < slow, more, "{speed}: {fast} {slow}");
        assert_eq!(
            law.vibration_damping(speed, f64::MAX),
            law.vibration_damping(speed, 1e200)
        );
        let gap = law.vibration_damping(speed, f64::MAX) - PAPER.viscous - fast;
        assert!(gap.abs() < 1e-15, "{gap}");
    }
    // At zero frequency: the slope of the curve, by a central difference.
    for speed in [0.5, 2.0, 3.0, 50.0] {
        let d = 1e-5;
        let slope = (law.steady_state(speed + d) - law.steady_state(speed - d)) / (2.0 * d);
        // 2.6e-12 measured.
        assert!((law.vibration_damping(speed, 0.0) - slope).abs() < 2e-11);
    }
}
