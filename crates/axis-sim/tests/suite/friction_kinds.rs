//! Kinds of friction beside LuGre, on the rigid machine, against a slow, obvious integration of
//! the equations as their papers print them.

use axis_sim::Axis;
use axis_sim::friction::FRICTIONS;
use axis_sim::part::{Part, Values, named};

use crate::rigid::{FRICTION, apart, controlled, level, machine, runge_kutta, runge_kutta_with};

const MASS: f64 = 95.0;

/// The machine with another friction: levels, Stribeck speed and viscous part of `FRICTION`.
fn with(kind: &str, numbers: &[(&'static str, f64)]) -> Axis {
    let mut axis = machine(MASS);
    let mut values = Values::default();
    let shared = [
        ("coulomb", FRICTION.coulomb),
        ("stiction", FRICTION.stiction),
        ("stribeck_speed", FRICTION.stribeck_speed),
        ("viscous", FRICTION.viscous),
    ];
    for (key, to) in shared.iter().chain(numbers) {
        values.set(key, *to);
    }
    axis.friction = Part::new(named(FRICTIONS, kind).unwrap(), values).unwrap();
    axis
}

/// With steps of 5 µs against those of 1 µs. Measured: 2.5e-9 to 3e-9 m, as of LuGre, which is
/// another motion by at least a hundred times that.
fn compare(mut axis: Axis, damping: f64, slip: impl Fn(f64, f64) -> f64) {
    axis.simulation.step = 5e-6;
    let truth = controlled(&axis, 1e-6, runge_kutta(MASS, damping, slip));
    close(&axis, &truth);
}

fn close(axis: &Axis, truth: &[f64]) {
    let mut plain = machine(MASS);
    plain.simulation.step = axis.simulation.step;
    let [found, otherwise] = [axis, &plain].map(|axis| apart(axis, truth));
    println!("{found:.2e} m, LuGre {otherwise:.2e} m");
    assert!(found < 9e-9 && otherwise > 2e-7, "{found:e} {otherwise:e}");
}

#[test]
fn dahl() {
    let axis = with("dahl", &[("bristle_stiffness", 2e6), ("exponent", 1.5)]);
    let slip = |v: f64, z: f64| {
        let left = 1.0 - 2e6 * z * v.signum() / level(v);
        v * left.abs().powf(1.5) * left.signum()
    };
    compare(axis, 0.0, slip);
}

#[test]
fn elasto_plastic() {
    let numbers = [
        ("bristle_stiffness", 2e6),
        ("bristle_damping", 2e4),
        ("elastic_share", 0.5),
    ];
    let slip = |v: f64, z: f64| {
        let (greatest, elastic) = (level(v) / 2e6, 0.5 * FRICTION.coulomb / 2e6);
        let alpha = if z * v <= 0.0 || z.abs() <= elastic {
            0.0
        } else if z.abs() >= greatest {
            1.0
        } else {
            let x = (z.abs() - 0.5 * (greatest + elastic)) / (greatest - elastic);
            0.5 + 0.5 * (std::f64::consts::PI * x).sin()
        };
        v * (1.0 - alpha * z.abs() / greatest)
    };
    compare(with("elasto-plastic", &numbers), 2e4, slip);
}

#[test]
fn bouc_wen() {
    let numbers = [
        ("bristle_stiffness", 2e6),
        ("exponent", 2.0),
        ("loading_share", 0.75),
    ];
    let slip = |v: f64, z: f64| {
        let y = 2e6 * z / level(v);
        v - 0.75 * v.abs() * y * y.abs() - 0.25 * v * y * y
    };
    compare(with("bouc-wen", &numbers), 0.0, slip);
}

/// Of one level, so that the elements are functions of displacement: each a spring that is cut at
/// its level. Moved by the symplectic Euler method.
#[test]
fn maxwell_slip() {
    let numbers = [
        ("stiction", FRICTION.coulomb),
        ("presliding", 4e-5),
        ("lag", 1e-3),
    ];
    let mut axis = with("maxwell-slip", &numbers);
    axis.simulation.step = 5e-6;
    let level = 0.25 * FRICTION.coulomb;
    let mut forces = [0.0_f64; 4];
    let truth = controlled(&axis, 2.5e-7, |[x, v], force, h| {
        for (f, share) in forces.iter_mut().zip([0.125, 0.25, 0.5, 1.0]) {
            *f = (*f + level / (share * 4e-5) * v * h).clamp(-level, level);
        }
        let rub = forces.iter().sum::<f64>() + FRICTION.viscous * v;
        let v = v + h * (force - rub) / MASS;
        [x + h * v, v]
    });
    close(&axis, &truth);
}

/// LuGre with one key of the curve more, against LuGre's equations with that curve.
fn compare_curve(
    numbers: &[(&'static str, f64)],
    curve: impl Fn(f64) -> f64,
    viscous: impl Fn(f64) -> f64,
) {
    let bristle = [
        ("bristle_stiffness", FRICTION.stiffness),
        ("bristle_damping", FRICTION.damping),
    ];
    let mut axis = with("lugre", &[&bristle, numbers].concat());
    axis.simulation.step = 5e-6;
    let slip = |v: f64, z: f64| v - FRICTION.stiffness * v.abs() * z / curve(v);
    let advance = runge_kutta_with(MASS, FRICTION.damping, slip, viscous);
    close(&axis, &controlled(&axis, 1e-6, advance));
}

fn linear(v: f64) -> f64 {
    FRICTION.viscous * v
}

/// Levels from the Coulomb level `coulomb` to `stiction`, with that exponent.
fn stribeck(v: f64, coulomb: f64, stiction: f64, exponent: f64) -> f64 {
    coulomb + (stiction - coulomb) * (-(v.abs() / FRICTION.stribeck_speed).powf(exponent)).exp()
}

#[test]
fn coulomb_level_backward() {
    let curve = |v: f64| stribeck(v, if v < 0.0 { 23.0 } else { 20.0 }, 25.0, 2.0);
    compare_curve(&[("coulomb_backward", 23.0)], curve, linear);
}

#[test]
fn break_away_backward() {
    let curve = |v: f64| stribeck(v, 20.0, if v < 0.0 { 32.0 } else { 25.0 }, 2.0);
    compare_curve(&[("stiction_backward", 32.0)], curve, linear);
}

#[test]
fn stribeck_exponent() {
    let curve = |v: f64| stribeck(v, 20.0, 25.0, 0.7);
    compare_curve(&[("stribeck_exponent", 0.7)], curve, linear);
}

#[test]
fn viscous_of_second_order() {
    let viscous = |v: f64| linear(v) + 400.0 * v * v.abs();
    compare_curve(&[("viscous_quadratic", 400.0)], level, viscous);
}

#[test]
fn viscous_of_third_order() {
    let viscous = |v: f64| linear(v) + 4000.0 * v.powi(3);
    compare_curve(&[("viscous_cubic", 4000.0)], level, viscous);
}

/// What a curve has beyond LuGre's may be off as its other numbers are: forces by default, the exponent where the file says so.
#[test]
fn numbers_beyond_lugre_may_be_off() {
    let file = std::fs::read_to_string(crate::data("liu2025.toml")).unwrap();
    let with = |friction: &str, tolerances: &str| {
        let (before, after) = file.split_once("\n[friction]").unwrap();
        let (head, after) = after.split_once('\n').unwrap();
        let text = format!("{before}\n[friction]{head}\n{friction}{after}");
        Axis::parse("axis.toml", &format!("{text}\n[tolerances]\n{tolerances}")).unwrap()
    };
    let beyond = ["stribeck_exponent", "viscous_quadratic", "viscous_cubic"];
    let known = |axis: &Axis| -> Vec<&str> {
        let all = axis.known();
        beyond
            .into_iter()
            .filter(|name| all.contains(name))
            .collect()
    };
    assert_eq!(known(&with("", "viscous = \"5 %\"\n")), [""; 0]);
    let more = "viscous_quadratic_n_m_s2_per_rad2 = 1e-6\nviscous_cubic_n_m_s3_per_rad3 = 1e-9\n";
    assert_eq!(known(&with(more, "viscous = \"5 %\"\n")), beyond[1..]);
    let named =
        "stribeck_exponent = \"20 %\"\nviscous_quadratic = \"unknown\"\nviscous_cubic = \"3 %\"\n";
    let axis = with(more, named);
    assert_eq!(known(&axis), beyond);
    let shares: Vec<f64> = (axis.known().iter())
        .map(|name| if beyond.contains(name) { 0.1 } else { 0.0 })
        .collect();
    let off = axis.with_known(&shares);
    for name in beyond {
        let [before, after] =
            [&axis, &off].map(|axis| axis.friction.values().number(name).unwrap());
        assert!((after / before - 1.1).abs() < 1e-12, "{name}");
    }
}
