//! The exponential step against closed forms, itself, and a plain integrator.

use lugre::{LuGre, Parameters};
use proptest::prelude::*;

const PAPER: Parameters = Parameters::LIU_2025;

fn paper() -> LuGre {
    LuGre::new(PAPER).expect("valid")
}

/// Classical Runge–Kutta on equation (1), as printed.
fn runge_kutta(law: &LuGre, z0: f64, speed: impl Fn(f64) -> f64, end: f64, steps: u32) -> f64 {
    let p = law.parameters();
    let f = |t: f64, z: f64| {
        let w = speed(t);
        w - p.stiffness * w.abs() * z / law.level(w)
    };
    let h = end / f64::from(steps);
    (0..steps).fold(z0, |z, i| {
        let t = f64::from(i) * h;
        let k1 = f(t, z);
        let k2 = f(t + h / 2.0, z + h / 2.0 * k1);
        let k3 = f(t + h / 2.0, z + h / 2.0 * k2);
        let k4 = f(t + h, z + h * k3);
        z + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    })
}

fn march(law: &LuGre, z0: f64, speed: impl Fn(f64) -> f64, end: f64, steps: u32) -> f64 {
    let h = end / f64::from(steps);
    (0..steps).fold(z0, |z, i| {
        let t = f64::from(i) * h;
        law.step(z, speed(t), speed(t + h), h)
    })
}

#[test]
fn second_order_through_reversals() {
    // 4.3 reversals, amplitude across Ω_S, so that every term is at work; the
    // step counts put zero crossings at arbitrary places within steps.
    let law = paper();
    let speed = |t: f64| 5.0 * (2.0 * std::f64::consts::PI * 3.1 * t + 0.4).sin();
    let end = 0.71;
    let exact = runge_kutta(&law, 0.01, speed, end, 400_000);
    let error = |steps| (march(&law, 0.01, speed, end, steps) - exact).abs();
    let errors = [error(200), error(400), error(800), error(1600)];
    for pair in errors.windows(2) {
        // Ratio 4 for second order; the crossing's place within its step moves
        // the constant a little.
        let ratio = pair[0] / pair[1];
        assert!((3.3..4.8).contains(&ratio), "{errors:?}");
    }
    assert!(errors[3] < 5e-8, "{errors:?}"); // 7.3e-9 rad measured
}

#[test]
fn one_linear_reversal_is_second_order() {
    // A single crossing, at 1/3 of the record: without the split the kink of
    // |ω| would leave an error that jumps about with the step count.
    let law = paper();
    let speed = |t: f64| -1.0 + 3.0 * t;
    let exact = runge_kutta(&law, -0.03, speed, 1.0, 300_000);
    let error = |steps| (march(&law, -0.03, speed, 1.0, steps) - exact).abs();
    // 3 does not divide the step counts: the crossing is inside a step.
    for (coarse, fine) in [(50, 100), (100, 200), (200, 400)] {
        let ratio = error(coarse) / error(fine);
        assert!((3.7..4.3).contains(&ratio), "{coarse}: {ratio}");
    }
}

#[test]
fn the_steady_state_is_reached_in_one_huge_step() {
    let law = paper();
    for w in [-300.0, -2.7, 0.1, 40.0] {
        let (z, torque) = law.step_torque(-0.05_f64.copysign(w), w, w, 1e6);
        // One rounding of z0 + (z_ss − z0).
        assert!((z / law.steady_bristle(w) - 1.0).abs() <= 2.0 * f64::EPSILON);
        assert!((torque - law.steady_state(w)).abs() < 5e-13); // 7.1e-14 measured
    }
}

#[test]
fn nan_is_not_swallowed() {
    let law = paper();
    for (z, w0, w1) in [
        (f64::NAN, 1.0, 1.0),
        (0.0, f64::NAN, 1.0),
        (0.0, 1.0, f64::NAN),
    ] {
        assert!(law.step(z, w0, w1, 1e-4).is_nan());
        assert!(law.step_impulse(z, w0, w1, 1e-4).1.is_nan());
    }
}

prop_compose! {
    /// Across twelve decades of stiffness: a from 0 to far beyond saturation.
    fn any_law()(
        coulomb in 1e-2f64..1e2, rise in 0.0f64..1.0, stribeck in 1e-2f64..1e2,
        log_stiffness in -2.0f64..10.0,
    ) -> LuGre {
        LuGre::new(Parameters {
            coulomb, stiction: coulomb * (1.0 + rise), stribeck_speed: stribeck,
            stiffness: 10f64.powf(log_stiffness), damping: 0.3, viscous: 0.01,
        }).expect("in range")
    }
}

proptest! {
    /// Exact in floating point, not to a tolerance.
    #[test]
    fn never_beyond_the_bound(
        law in any_law(), share in -3.0f64..3.0,
        w0 in -100.0f64..100.0, w1 in -100.0f64..100.0, log_h in -9.0f64..3.0,
    ) {
        let z0 = share * law.bristle_limit();
        let z1 = law.step(z0, w0, w1, 10f64.powf(log_h));
        prop_assert!(z1.abs() <= z0.abs().max(law.bristle_limit()));
    }

    #[test]
    fn exact_for_constant_speed(
        law in any_law(), share in -1.0f64..1.0, w in -100.0f64..100.0, log_h in -9.0f64..3.0,
    ) {
        let h = 10f64.powf(log_h);
        let p = law.parameters();
        let (z0, steady) = (share * law.bristle_limit(), law.steady_bristle(w));
        let m = -libm::expm1(-p.stiffness * w.abs() * h / law.level(w));
        let exact = z0 + (steady - z0) * m;
        // A few roundings of numbers of the size of the bound.
        let tolerance = 16.0 * f64::EPSILON * law.bristle_limit();
        prop_assert!((law.step(z0, w, w, h) - exact).abs() <= tolerance);
    }

    /// Two half steps are one step: the flow property of the exact solution,
    /// for the state and for the impulse.
    #[test]
    fn halves_make_a_whole(
        law in any_law(), share in -1.0f64..1.0, w in -100.0f64..100.0, log_h in -9.0f64..3.0,
    ) {
        let h = 10f64.powf(log_h);
        let z0 = share * law.bristle_limit();
        let (whole, impulse) = law.step_impulse(z0, w, w, h);
        let (half, first) = law.step_impulse(z0, w, w, 0.5 * h);
        let (two, second) = law.step_impulse(half, w, w, 0.5 * h);
        let p = law.parameters();
        prop_assert!((whole - two).abs() <= 16.0 * f64::EPSILON * law.bristle_limit());
        prop_assert_eq!(whole, law.step(z0, w, w, h));
        let scale = (p.stiction + p.viscous * w.abs()) * h
            + p.damping * law.bristle_limit();
        prop_assert!((impulse - first - second).abs() <= 64.0 * f64::EPSILON * scale);
    }

    /// The impulse is the integral of the torque: compared with Simpson's rule
    /// on the exact solution, over steps short enough for it.
    #[test]
    fn impulse_is_the_integral_of_torque(share in -1.0f64..1.0, w in -20.0f64..20.0) {
        let law = paper();
        let h = 2e-3; // a ≤ 0.9
        let z0 = share * law.bristle_limit();
        let (_, impulse) = law.step_impulse(z0, w, w, h);
        let torque = |t: f64| law.torque(law.step(z0, w, w, t), w);
        let n = 64;
        let sum: f64 = (0..n)
            .map(|i| {
                let (a, b) = (f64::from(i) / 64.0 * h, f64::from(i + 1) / 64.0 * h);
                (b - a) / 6.0 * (torque(a) + 4.0 * torque(0.5 * (a + b)) + torque(b))
            })
            .sum();
        // Simpson's error: h_i^4/2880 · (a/h)^4 T ≈ 1e-11 of the integral of the
        // largest torque, σ1 · 20 rad/s = 60 N·m.
        prop_assert!((impulse - sum).abs() < 1e-10 * 60.0 * h);
    }
}

proptest! {
    /// Slopes of the end torque over the end speed, through zero speed too and from
    /// bristles anywhere within their limit.
    #[test]
    fn no_end_torque_is_steeper_than_said(
        rise in 1.0..3.0_f64,
        stribeck_speed in -3.0..1.0_f64,
        presliding in -6.0..-2.0_f64,
        damping in 0.0..10.0_f64,
        share in -1.0..1.0_f64,
        speeds in (-3.0..3.0_f64, -3.0..3.0_f64),
        scale in -4.0..2.0_f64,
        h in -6.0..-2.0_f64,
    ) {
        let coulomb = 2.0;
        let law = LuGre::new(Parameters {
            coulomb,
            stiction: rise * coulomb,
            stribeck_speed: 10_f64.powf(stribeck_speed),
            stiffness: coulomb / 10_f64.powf(presliding),
            damping,
            viscous: 0.3,
        }).expect("valid");
        let (h, scale) = (10_f64.powf(h), 10_f64.powf(scale));
        let (z0, w0) = (share * law.bristle_limit(), scale * speeds.0);
        let torque = |w1: f64| law.step_torque(z0, w0, w1, h).1;
        let most = law.steepness(h);
        for i in -50..50 {
            let w1 = scale * (speeds.1 + 0.02 * f64::from(i));
            let by = 1e-3 * scale;
            let rounding = 1e-13 * (torque(w1).abs() + 10.0 + damping * scale);
            let change = (torque(w1 + by) - torque(w1)).abs();
            prop_assert!(change <= most * by + rounding, "{change} {}", most * by);
        }
    }
}
