//! The law in `f32` is that in `f64`, to a stated multiple of what `f32` rounds.
//!
//! Both take the same numbers: parameters, speeds and steps are `f32`, and `f64` takes them exactly.

use lugre::{LuGre, Parameters};

/// Seconds a step.
const H: f32 = 1e-4;

fn laws() -> (LuGre<f32>, LuGre) {
    let parameters = Parameters::LIU_2025.cast::<f32>();
    let wide = LuGre::new(parameters.cast()).expect("valid");
    (LuGre::new(parameters).expect("valid"), wide)
}

/// Greatest deviation of deflection and torque along a motion, in `f32::EPSILON` of
/// their sizes: of the deflection its limit `T_S/σ0`, of the torque all that is
/// added up in it, `T_S + (σ1 + σ2) |ω|`.
fn deviation(speed: impl Fn(f64) -> f64, duration: f64) -> [f64; 2] {
    let (single, double) = laws();
    let p = double.parameters();
    let (mut z32, mut z64, mut w0) = (0.0_f32, 0.0, speed(0.0) as f32);
    let steps = (duration / f64::from(H)) as u32;
    let mut worst = [0.0_f64; 2];
    for k in 1..=steps {
        let w1 = speed(f64::from(k) * f64::from(H)) as f32;
        let (wide0, wide1) = (f64::from(w0), f64::from(w1));
        let (next32, torque32) = single.step_torque(z32, w0, w1, H);
        let (next64, torque64) = double.step_torque(z64, wide0, wide1, f64::from(H));
        let torque = p.stiction + (p.damping + p.viscous) * wide1.abs();
        let off = [
            (f64::from(next32) - next64).abs() / double.bristle_limit(),
            (f64::from(torque32) - torque64).abs() / torque,
        ];
        let unit = f64::from(f32::EPSILON);
        worst = std::array::from_fn(|i| worst[i].max(off[i] / unit));
        (z32, z64, w0) = (next32, next64, w1);
    }
    println!("deflection {:.2}, torque {:.2}", worst[0], worst[1]);
    worst
}

#[test]
fn sliding() {
    // From rest to 60 rad/s in 20 000 steps and on at that speed: the first, slow ones
    // add their roundings up, relaxation forgets them afterwards.
    let [deflection, torque] = deviation(|t| (30.0 * t).min(60.0), 3.0);
    assert!(deflection < 40.0 && torque < 40.0); // 13.3, 14.1 measured
}

#[test]
fn reversing() {
    // Twelve reversals with amplitudes across the Stribeck speed.
    let [deflection, torque] = deviation(|t| 5.0 * (19.0 * t).sin(), 2.0);
    assert!(deflection < 20.0 && torque < 20.0); // 5.4, 4.7 measured
}

#[test]
fn presliding() {
    // A fifth of the break-away deflection to and fro: 20 000 steps hardly relax, and
    // their roundings, half a unit of at most a fifth each, add up as a random walk.
    let [deflection, torque] = deviation(|t| 0.1 * (10.0 * t).sin(), 2.0);
    assert!(deflection < 20.0 && torque < 20.0); // 5.4, 4.9 measured
}

#[test]
fn curve_and_closed_forms() {
    let (single, double) = laws();
    let p = double.parameters();
    let unit = f64::from(f32::EPSILON);
    let near = |a: f32, b: f64, size: f64, units: f64| {
        assert!((f64::from(a) - b).abs() <= units * unit * size, "{a} {b}");
    };
    for k in -2000..=2000 {
        let w = k as f32 * 0.05;
        let wide = f64::from(w);
        near(single.level(w), double.level(wide), p.stiction, 2.0);
        let size = p.stiction + p.viscous * wide.abs();
        near(single.steady_state(w), double.steady_state(wide), size, 2.0);
        let limit = double.bristle_limit();
        near(
            single.steady_bristle(w),
            double.steady_bristle(wide),
            limit,
            2.0,
        );
        let damping = p.damping * (1.0 + p.damping * wide.abs() / p.coulomb);
        let (a, b) = (
            single.vibration_damping(w, 390.0),
            double.vibration_damping(wide, 390.0),
        );
        near(a, b, damping, 2.0);
    }
    let u = ((p.stiction - p.coulomb) / p.coulomb).ln() + 25.0 * std::f64::consts::LN_2;
    let flat = p.stribeck_speed * u.sqrt();
    // The margin for rounding is 1e-4 of u, and a little.
    near(
        single.flat_above(),
        flat,
        flat * 1e-4 / (2.0 * u),
        1.1 / unit,
    );
    near(
        single.passivity_margin(),
        double.passivity_margin(),
        p.damping,
        2.0,
    );
    near(
        single.passive_below(),
        double.passive_below(),
        double.passive_below(),
        4.0,
    );
}

/// The curve is flat from where the formula itself rounds to `T_C`, in `f32` earlier.
#[test]
fn skipping_the_exponential_is_exact() {
    let (law, p) = (laws().0, laws().0.parameters());
    for k in 0..100_000 {
        let w = law.flat_above() * (1.0 + k as f32 * 1e-5);
        let x = f64::from(w / p.stribeck_speed);
        let term = (p.stiction - p.coulomb) * (-x * x).exp() as f32;
        assert_eq!(p.coulomb + term, p.coulomb);
        assert_eq!(law.level(w), p.coulomb);
    }
}

/// The impulse of a step in `f32` balances as in `f64`.
#[test]
fn impulse() {
    let (single, double) = laws();
    let p = double.parameters();
    for k in 1..=4000 {
        let w = (k - 2000) as f32 * 0.03;
        let (z, h) = (0.02_f32, k as f32 * 1e-5);
        let (z1, impulse) = single.step_impulse(z, w, w, h);
        let (wide, time) = (f64::from(w), f64::from(h));
        let (expected, exact) = double.step_impulse(f64::from(z), wide, wide, time);
        let unit = f64::from(f32::EPSILON);
        let limit = double.bristle_limit();
        assert!((f64::from(z1) - expected).abs() <= 2.0 * unit * limit);
        let size = (p.stiction + p.viscous * wide.abs()) * time + p.damping * limit;
        assert!((f64::from(impulse) - exact).abs() <= 2.0 * unit * size);
    }
}

#[test]
fn parameters_outside_are_refused_with_the_range_of_the_scalar() {
    let soft = Parameters {
        stiffness: 1e-20,
        ..Parameters::LIU_2025
    };
    assert!(LuGre::new(soft).is_ok());
    let message = LuGre::new(soft.cast::<f32>())
        .expect_err("a deflection of 1e20")
        .to_string();
    assert!(message.contains("between 1e-18 and 1e18 rad"), "{message}");
    let subnormal = Parameters {
        damping: 1e-40,
        ..Parameters::LIU_2025
    };
    assert!(LuGre::new(subnormal.cast::<f32>()).is_err());
}
