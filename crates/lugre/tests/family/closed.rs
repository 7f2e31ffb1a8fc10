//! Steps at constant speed against closed forms and quadratures, however long the step.

use super::*;
use lugre::FrictionLaw;
use std::f64::consts::{E, FRAC_PI_4};

/// Deflections over the steady one of a law of one level, after a displacement of `xi` steady
/// ones from `y`; in one step.
fn moved<O: Onset<f64>>(onset: O, y: f64, xi: f64) -> f64 {
    let law = bristle(SteadyState::coulomb(60.0), 0.0, onset);
    let reach = 60.0 / STIFFNESS;
    let z = law.step(y * reach, 0.02, 0.02, xi * reach / 0.02);
    z / reach
}

const DISPLACEMENTS: [f64; 8] = [1e-9, 1e-3, 0.1, 0.37, 1.0, 1.9, 5.0, 300.0];
const STARTS: [f64; 5] = [-1.0, -0.6, 0.0, 0.3, 0.95];

/// F(x) of P. R. Dahl, by powers; measured within 4e-16.
#[test]
fn dahl_is_its_closed_form() {
    for exponent in [0.0, 0.5, 0.999, 1.0, 1.5, 2.0, 3.0] {
        for y in STARTS {
            for xi in DISPLACEMENTS {
                let m: f64 = 1.0 - y;
                let left = if exponent == 1.0 {
                    m * (-xi).exp()
                } else {
                    let base: f64 = m.powf(1.0 - exponent) - (1.0 - exponent) * xi;
                    base.max(0.0).powf(1.0 / (1.0 - exponent))
                };
                let found = moved(DahlOnset { exponent }, y, xi);
                // The power's rounding at an exponent of 1000 is the truth's.
                let most = if exponent == 0.999 { 1e-12 } else { 1e-15 };
                assert!(
                    (found - (1.0 - left)).abs() < most,
                    "{exponent} {y} {xi}: {found} {}",
                    1.0 - left
                );
            }
        }
    }
}

/// n = 1: exponentials; n = 2: tangents. Measured: 4.5e-8.
#[test]
fn bouc_wen_is_its_closed_form_where_there_is_one() {
    let mut worst = 0.0_f64;
    for extra in [0.0, 0.6, 3.0_f64] {
        for y in STARTS {
            for xi in DISPLACEMENTS {
                let root = extra.sqrt();
                // Displacement until the force is 0, and the deflection before and after.
                let (to_zero, before) = if y >= 0.0 {
                    (0.0, [0.0; 2])
                } else if extra == 0.0 {
                    (-y, [y + xi; 2])
                } else {
                    let (u, a) = (-y, (root * -y).atan());
                    let linear = ((1.0 + extra * u) * (-extra * xi).exp() - 1.0) / extra;
                    (f64::NAN, [-linear, -(a - root * xi).tan() / root])
                };
                for n in [1, 2_usize] {
                    let (u, a) = (-y, (root * -y).atan());
                    let needed = match n {
                        _ if y >= 0.0 || extra == 0.0 => to_zero,
                        1 => (1.0 + extra * u).ln() / extra,
                        _ => a / root,
                    };
                    let from = y.max(0.0);
                    let expected = if xi < needed {
                        before[n - 1]
                    } else if n == 1 {
                        1.0 - (1.0 - from) * (needed - xi).exp()
                    } else {
                        ((xi - needed) + from.atanh()).tanh()
                    };
                    let onset = BoucWenOnset {
                        exponent: n as f64,
                        loading_share: 0.5 * (extra + 1.0),
                    };
                    let off = (moved(onset, y, xi) - expected).abs();
                    worst = worst.max(off);
                }
            }
        }
    }
    assert!(worst < 1.3e-7, "{worst}");
}

/// ∫ dy/Y from `a` to `b` by Simpson's rule.
fn displacement(slope: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    const PARTS: usize = 200_000;
    let h = (b - a) / PARTS as f64;
    let at = |k: usize| 1.0 / slope(a + h * k as f64);
    let inner: f64 = (1..PARTS).map(|k| at(k) * [2.0, 4.0][k % 2]).sum();
    h / 3.0 * (at(0) + inner + at(PARTS))
}

/// The displacement that a deflection needs is a quadrature; a step of it must come there. Measured:
/// 1.7e-8 and 2.7e-6, the latter of n = 1.3.
#[test]
fn long_steps_follow_the_quadrature() {
    let mut worst = [0.0_f64; 2];
    for share in [0.0, 0.4, 0.9, 0.98] {
        let slope = |y: f64| {
            if y <= share {
                return 1.0;
            }
            let x = (y - 0.5 * (1.0 + share)) / (1.0 - share);
            1.0 - y * (0.5 + 0.5 * (std::f64::consts::PI * x).sin())
        };
        for end in [0.5, 0.9, 0.99, 0.999].into_iter().filter(|y| *y > share) {
            let onset = ElastoPlasticOnset {
                elastic_share: share,
            };
            let xi = share + 0.7 + displacement(slope, share, end);
            worst[0] = worst[0].max((moved(onset, -0.7, xi) - end).abs());
        }
    }
    for (n, share) in [(1.3, 0.5), (3.5, 0.8), (12.0, 4.0)] {
        let slope = |y: f64| 1.0 - (share * y.signum() + 1.0 - share) * y.abs().powf(n);
        for end in [-0.4, -0.01, 0.5, 0.9, 0.999_f64] {
            let onset = BoucWenOnset {
                exponent: n,
                loading_share: share,
            };
            let xi =
                displacement(slope, -1.0, end.min(0.0)) + displacement(slope, 0.0, end.max(0.0));
            worst[1] = worst[1].max((moved(onset, -1.0, xi) - end).abs());
        }
    }
    assert!(worst[0] < 5e-8 && worst[1] < 8e-6, "{worst:?}");
}

/// Exact at constant speed: many steps are one.
#[test]
fn parts_of_a_step_make_the_whole() {
    fn parts<L: FrictionLaw<f64>>(law: &L, most: f64) {
        for speed in [3e-3, -8e-3] {
            let begin = law.settled(-speed);
            let whole = law.step(begin, speed, speed, 0.01);
            let mut state = begin;
            for _ in 0..100 {
                state = law.step(state, speed, speed, 1e-4);
            }
            let off = (law.spring_force(&whole) - law.spring_force(&state)).abs();
            assert!(off < most, "{off}");
        }
    }
    // Measured: 1.1e-13 N of rounding; 2e-6 N of the fourth-order solutions.
    parts(&general(CURVE, 0.0), 4e-13);
    parts(&dahl(CURVE, 2.0), 4e-13);
    parts(&maxwell(CURVE), 4e-13);
    parts(&elasto_plastic(CURVE, 0.0, 0.5), 6e-6);
    parts(&bouc_wen(CURVE, 4.0, 0.9), 6e-6);
}

#[test]
fn the_curve_is_what_its_page_says() {
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * b.abs(), "{a} {b}");
    close(CURVE.level(4e-3), 60.0 + 25.0 / E);
    close(CURVE.level(-4e-3), 70.0 + 10.0 / E);
    close(CURVE.force(2.0), 60.0 + 600.0 + 800.0 + 400.0);
    close(CURVE.force(-2.0), -(70.0 + 600.0 + 800.0 + 400.0));
    assert_eq!(CURVE.force(0.0), 0.0);
    let tanh = without_memory(Regularisation::Tanh);
    let arctan = without_memory(Regularisation::Arctan);
    // tanh(ln 2) = 3/5, arctan 1 = π/4.
    let v = 1e-3 * 2_f64.ln();
    close(
        tanh.force(&(), v),
        0.6 * CURVE.level(v) + CURVE.viscous_force(v),
    );
    let v = -1e-3;
    let sign = FRAC_PI_4 * 2.0 / std::f64::consts::PI;
    close(
        arctan.force(&(), v),
        -sign * CURVE.level(v) + CURVE.viscous_force(v),
    );
    close(tanh.force_at_load(&(), v, 0.0), CURVE.viscous_force(v));
}

/// LuGre itself, where the curve is Gaussian and the same in both directions.
#[test]
fn the_general_law_is_lugre_on_its_curve() {
    let p = lugre::Parameters {
        coulomb: 60.0,
        stiction: 85.0,
        stribeck_speed: 4e-3,
        stiffness: STIFFNESS,
        damping: 900.0,
        viscous: 300.0,
    };
    let level = FrictionLevel {
        coulomb: p.coulomb,
        stiction: p.stiction,
    };
    let steady = SteadyState {
        forward: level,
        backward: level,
        stribeck_speed: p.stribeck_speed,
        viscous: p.viscous,
        ..SteadyState::coulomb(60.0)
    };
    let (special, general) = (lugre::LuGre::new(p).unwrap(), general(steady, 900.0));
    assert_eq!(special.is_passive(), general.is_passive());
    let (mut a, mut b, mut worst) = (0.0, 0.0, 0.0_f64);
    for k in 0..4000 {
        let speed = |k: i32| 0.01 * (f64::from(k) * 0.013).sin();
        a = FrictionLaw::step(&special, a, speed(k), speed(k + 1), 1e-4);
        b = general.step(b, speed(k), speed(k + 1), 1e-4);
        let off = special.force(&a, speed(k + 1)) - general.force(&b, speed(k + 1));
        worst = worst.max(off.abs());
    }
    // Measured 1e-13 N.
    assert!(worst < 4e-13, "{worst}");
}

/// Bouc and Wen's own parameters: ζ as they write it, by Euler's method.
/// Measured: 1.1e-3 N of 39 N.
#[test]
fn classic_parameters_are_the_same_law() {
    let classic = lugre::ClassicBoucWen {
        scale: 30.0,
        a: 2e5,
        beta: 9e4,
        gamma: 3e4,
        exponent: 2.0,
    };
    let law = BoucWen::new(classic.bristle().unwrap()).unwrap();
    let (mut z, mut zeta, mut worst) = (0.0, 0.0_f64, 0.0_f64);
    let h = 1e-6;
    for k in 0..400_000 {
        let v = 1e-3 * (40.0 * h * (f64::from(k) + 0.5)).cos();
        z = law.step(z, v, v, h);
        let slope = 2e5 * v - 9e4 * v.abs() * zeta.abs() * zeta - 3e4 * v * zeta * zeta;
        zeta += h * slope;
        worst = worst.max((law.force(&z, v) - 30.0 * zeta).abs());
    }
    assert!(worst < 3e-3, "{worst}");
}
