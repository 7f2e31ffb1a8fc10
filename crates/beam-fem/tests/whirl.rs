//! Whirl, critical speeds and unbalance against closed forms.

use std::f64::consts::PI;

use beam_fem::{
    BeamError, BeamModel, Bearing, CrossSection, Dof, LumpedMass, Material, Mesh, Shaft, Unbalance,
    Whirl, WhirlAnalysis, campbell,
};
use nalgebra::Complex;
use proptest::prelude::*;

use crate::rotors;

/// A thick simply supported shaft, L/D = 8, spinning.
struct Supported {
    model: BeamModel,
    /// EI, κGA, ρA, ρI.
    numbers: [f64; 4],
    length: f64,
}

fn supported(elements: usize) -> Supported {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let section = CrossSection::solid_circle(0.1, &steel).unwrap();
    let length = 0.8;
    let shaft = Shaft::on_mesh(&section, &steel, Mesh::uniform(length, elements).unwrap());
    let mut model = BeamModel::new(shaft);
    for node in [0, elements] {
        model.fix(node, Dof::V).unwrap();
        model.fix(node, Dof::W).unwrap();
    }
    model.lateral_only();
    let i = section.second_moment_y();
    let numbers = [
        206e9 * i,
        section.shear_coefficient() * steel.shear_modulus() * section.area(),
        7850.0 * section.area(),
        7850.0 * i,
    ];
    Supported {
        model,
        numbers,
        length,
    }
}

impl Supported {
    /// v + i w = U sin kx e^{iωt} and its rotation Φ cos kx: the determinant, scaled, at
    /// whirl ω (below zero against the spin) and spin Ω, under tension N.
    fn determinant(&self, n: usize, whirl: f64, spin: f64, tension: f64) -> f64 {
        let [ei, s, line, rotary] = self.numbers;
        let k = n as f64 * PI / self.length;
        let force = (s + tension) * k * k - line * whirl * whirl;
        let moment = ei * k * k + s - rotary * whirl * whirl + 2.0 * rotary * spin * whirl;
        force * moment / (s * k * s * k) - 1.0
    }

    /// The lowest root of it in |ω|, from an estimate.
    fn whirl(&self, n: usize, estimate: f64, spin_of: impl Fn(f64) -> f64, tension: f64) -> f64 {
        let f = |w: f64| self.determinant(n, w, spin_of(w), tension);
        let (mut a, mut b) = (0.97 * estimate, 1.03 * estimate);
        assert!(f(a) * f(b) < 0.0, "no root near {estimate}");
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if f(a) * f(middle) <= 0.0 {
                b = middle;
            } else {
                a = middle;
            }
        }
        0.5 * (a + b)
    }
}

#[test]
fn a_spinning_timoshenko_shaft_whirls_as_its_closed_form() {
    let spin = 3000.0;
    let errors = |elements: usize| {
        let shaft = supported(elements);
        let whirl = WhirlAnalysis::new(&shaft.model.matrices().unwrap()).unwrap();
        let spectrum = whirl.lowest(spin, 6).unwrap();
        assert!(spectrum.real.is_empty());
        let of = |(index, mode): (usize, &beam_fem::WhirlMode)| {
            let n = index / 2 + 1;
            let (sign, direction) = if index % 2 == 0 {
                (-1.0, Whirl::Backward)
            } else {
                (1.0, Whirl::Forward)
            };
            assert_eq!(mode.direction, direction);
            assert!((mode.whirl_index - sign).abs() < 1e-9);
            assert!(mode.damping_ratio().abs() < 1e-10);
            let found = sign * mode.frequency_rad_s();
            found / shaft.whirl(n, found, |_| spin, 0.0) - 1.0
        };
        spectrum
            .modes
            .iter()
            .enumerate()
            .map(of)
            .collect::<Vec<_>>()
    };
    let (coarse, fine) = (errors(16), errors(32));
    for (a, b) in coarse.iter().zip(&fine) {
        // Order 2, as without spin: the shear angle is constant in an element. At most
        // 6.9e-4 measured, of the third pair.
        assert!((a / b).log2() > 1.9 && b.abs() < 1e-3, "{a} {b}");
    }
}

#[test]
fn critical_speeds_of_a_timoshenko_shaft() {
    let shaft = supported(32);
    let whirl = WhirlAnalysis::new(&shaft.model.matrices().unwrap()).unwrap();
    let found = whirl.critical_speeds(1.0, 4).unwrap();
    for (index, critical) in found.iter().enumerate() {
        let forward = critical.mode.direction == Whirl::Forward;
        assert_eq!(forward, index % 2 == 1, "{:?}", critical.mode.direction);
        let sign = if forward { 1.0 } else { -1.0 };
        let exact = shaft.whirl(index / 2 + 1, sign * critical.spin, f64::abs, 0.0);
        // 1.1e-5 and 1.8e-4 measured.
        assert!((critical.spin / exact.abs() - 1.0).abs() < 3e-4);
    }
    // The same from the diagram, and at half the spin, on a coarse mesh.
    let whirl = WhirlAnalysis::new(&supported(8).model.matrices().unwrap()).unwrap();
    let spins: Vec<f64> = (0..=20).map(|i| 500.0 * f64::from(i)).collect();
    for ratio in [1.0, 0.5] {
        let direct = whirl.critical_speeds(ratio, 20).unwrap();
        let crossed = whirl.crossings(ratio, &spins).unwrap();
        assert!(crossed.len() > 3);
        for (a, b) in crossed.iter().zip(&direct) {
            assert!((a / b.spin - 1.0).abs() < 1e-9, "{a} {}", b.spin);
        }
    }
}

/// Two nodes on equal bearings that move as one body of `mass` kg: k, c and cross
/// stiffness q (k_yz = q, k_zy = −q) are sums of both.
fn body(k: f64, c: f64, q: f64) -> (BeamModel, f64) {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let section = CrossSection::solid_circle(0.05, &steel).unwrap();
    let own = 7850.0 * section.area() * 0.1;
    let shaft = Shaft::on_mesh(&section, &steel, Mesh::uniform(0.1, 1).unwrap());
    let mut model = BeamModel::new(shaft);
    for node in [0, 1] {
        let bearing = Bearing {
            stiffness: [[0.5 * k, 0.5 * q], [-0.5 * q, 0.5 * k]],
            damping: [[0.5 * c, 0.0], [0.0, 0.5 * c]],
        };
        model.add_bearing(node, bearing).unwrap();
        model.add_mass(node, LumpedMass::point(5.0)).unwrap();
    }
    model.fix_everywhere(Dof::ThetaY);
    model.fix_everywhere(Dof::ThetaZ);
    model.lateral_only();
    (model, 10.0 + own)
}

#[test]
fn cross_coupling_drives_forward_whirl() {
    // With u = v + iw: m λ² + c λ + k ∓ i q = 0, − for forward whirl.
    let (k, c, q) = (1e6, 300.0, 2e5);
    let (model, m) = body(k, c, q);
    let whirl = WhirlAnalysis::new(&model.matrices().unwrap()).unwrap();
    let spectrum = whirl.lowest(0.0, 2).unwrap();
    for direction in [Whirl::Forward, Whirl::Backward] {
        let cross = if direction == Whirl::Forward { -q } else { q };
        let root = (Complex::new(c * c - 4.0 * m * k, -4.0 * m * cross)).sqrt();
        let exact = (root - c) / (2.0 * m);
        let exact = if exact.im > 0.0 {
            exact
        } else {
            (-root - c) / (2.0 * m)
        };
        let found = spectrum
            .modes
            .iter()
            .find(|mode| mode.direction == direction);
        let found = found.unwrap().eigenvalue;
        assert!(
            (found - exact).norm() < 1e-9 * exact.norm(),
            "{found} {exact}"
        );
        // q > c ω: forward whirl grows.
        assert_eq!(found.re > 0.0, direction == Whirl::Forward);
    }
    // No undamped critical speed is claimed for such bearings.
    assert!(matches!(
        whirl.critical_speeds(1.0, 1),
        Err(BeamError::NotSymmetric { .. })
    ));
}

#[test]
fn overdamped_and_free_motions_are_real_eigenvalues() {
    let (k, c) = (1e6, 1e4);
    let (model, m) = body(k, c, 0.0);
    let spectrum = WhirlAnalysis::new(&model.matrices().unwrap())
        .unwrap()
        .at(0.0)
        .unwrap();
    let root = (c * c - 4.0 * m * k).sqrt();
    let exact = [(-c - root) / (2.0 * m), (-c + root) / (2.0 * m)];
    for value in exact {
        let near = spectrum
            .real
            .iter()
            .filter(|r| (*r / value - 1.0).abs() < 1e-9);
        assert_eq!(near.count(), 2, "{value} {:?}", spectrum.real);
    }
    // A free shaft: two rigid motions in each plane, of the double eigenvalue 0.
    let mut free = rotors::two_discs(6, Bearing::isotropic(0.0, 0.0), 0.0).unwrap();
    free.lateral_only();
    let whirl = WhirlAnalysis::new(&free.matrices().unwrap()).unwrap();
    let standstill = whirl.at(0.0).unwrap();
    assert_eq!(standstill.real, vec![0.0; 8]);
    assert!(matches!(
        whirl.critical_speeds(1.0, 1),
        Err(BeamError::Unsupported { .. })
    ));
}

#[test]
fn a_pedestal_is_a_second_mass() {
    let (k, foundation, pedestal) = (1e6, 3e6, 8.0);
    let (mut model, m) = body(0.0, 0.0, 0.0);
    for node in [0, 1] {
        let base = model.add_node();
        model
            .add_mass(base, LumpedMass::point(0.5 * pedestal))
            .unwrap();
        let bearing = Bearing::isotropic(0.5 * k, 0.0);
        model.add_bearing_between([node, base], bearing).unwrap();
        for dof in [Dof::V, Dof::W] {
            model
                .add_ground_spring(dof.at(base), 0.5 * foundation)
                .unwrap();
        }
        for dof in [Dof::U, Dof::ThetaX, Dof::ThetaY, Dof::ThetaZ] {
            model.fix(base, dof).unwrap();
        }
    }
    let modes = model.matrices().unwrap().natural_modes().unwrap();
    // m p λ² − (m (k + f) + p k) λ + k f = 0.
    let b = m * (k + foundation) + pedestal * k;
    let root = (b * b - 4.0 * m * pedestal * k * foundation).sqrt();
    for square in [
        (b - root) / (2.0 * m * pedestal),
        (b + root) / (2.0 * m * pedestal),
    ] {
        let near = |w: &&f64| (*w * *w / square - 1.0).abs() < 1e-9;
        assert_eq!(modes.frequencies_rad_s.iter().filter(near).count(), 2);
    }
}

#[test]
fn springs_and_dampers_are_bearings_by_their_directions() {
    let (k, c) = (3e6, 40.0);
    let build = |add: &dyn Fn(&mut BeamModel, usize) -> Result<(), BeamError>| {
        let (mut model, _) = body(1e6, 0.0, 0.0);
        let base = model.add_node();
        model.add_mass(
            base,
            LumpedMass {
                mass: 2.0,
                polar_inertia: 1.0,
                diametral_inertia: 1.0,
            },
        )?;
        add(&mut model, base)?;
        model.matrices()
    };
    let bearings = build(&|model, base| {
        model.add_bearing_between([1, base], Bearing::isotropic(k, c))?;
        model.add_bearing(base, Bearing::orthotropic([k, 2.0 * k], [c, 3.0 * c]))
    });
    let parts = build(&|model, base| {
        for (dof, factors) in [(Dof::V, [1.0, 1.0]), (Dof::W, [2.0, 3.0])] {
            let rows = [dof.at(1), dof.at(base)];
            model.add_spring(rows, k)?;
            model.add_damper(rows, c)?;
            model.add_ground_spring(dof.at(base), factors[0] * k)?;
            model.add_ground_damper(dof.at(base), factors[1] * c)?;
        }
        Ok(())
    });
    let (bearings, parts) = (bearings.unwrap(), parts.unwrap());
    assert_eq!(bearings, parts);
    // A node off the shaft does not spin, and 1 kg·m² there gives no moment.
    let base = bearings.row(Dof::ThetaY.at(2)).unwrap();
    assert_eq!(bearings.gyroscopic.row(base).amax(), 0.0);
    // The damper between two nodes acts on their difference.
    let (a, b) = (
        bearings.row(Dof::V.at(1)).unwrap(),
        bearings.row(Dof::V.at(2)).unwrap(),
    );
    assert_eq!(bearings.damping[(a, b)], -c);
    assert_eq!(
        (bearings.damping[(a, a)], bearings.damping[(b, b)]),
        (c, 2.0 * c)
    );
}

#[test]
fn unbalance_of_a_rigid_body() {
    let (k, c, moment, phase) = (1e6, 300.0, 1e-3, 0.7);
    let (model, m) = body(k, c, 0.0);
    let unbalance = |node| Unbalance {
        node,
        moment: 0.5 * moment,
        phase,
    };
    let spins = [50.0, 300.0, 2000.0];
    let system = model.matrices().unwrap();
    let found = system
        .unbalance_response(&[unbalance(0), unbalance(1)], &spins)
        .unwrap();
    for (response, spin) in found.iter().zip(spins) {
        let stiffness = Complex::new(k - m * spin * spin, c * spin);
        let exact = Complex::from_polar(moment * spin * spin, phase) / stiffness;
        let orbit = response.orbit(1);
        assert!((orbit.forward - exact).norm() < 1e-12 * exact.norm());
        assert!(orbit.backward.norm() < 1e-12 * exact.norm());
        assert!((orbit.major() - orbit.minor()).abs() < 1e-11 * orbit.major());
    }
}

#[test]
fn an_orbit_is_an_ellipse() {
    // v = 3 cos, w = 2 sin: with the spin, long axis along y; then turned by 30°.
    let (v, w) = (Complex::new(3.0, 0.0), Complex::new(0.0, -2.0));
    let orbit = beam_fem::Orbit::new(v, w);
    assert!((orbit.major() - 3.0).abs() < 1e-15 && (orbit.minor() - 2.0).abs() < 1e-15);
    assert!(orbit.inclination().abs() < 1e-15);
    let (sin, cos) = (PI / 6.0).sin_cos();
    let turned = beam_fem::Orbit::new(v * cos - w * sin, v * sin + w * cos);
    assert!((turned.inclination() - PI / 6.0).abs() < 1e-15);
    assert!((beam_fem::Orbit::new(v, -w).minor() + 2.0).abs() < 1e-15);
}

#[test]
fn speed_dependent_bearings_enter_at_their_speed() {
    let stiffness = |spin: f64| 1e6 + 500.0 * spin;
    let model = |spin: f64| rotors::two_discs(6, Bearing::isotropic(stiffness(spin), 10.0), 0.0);
    let spins = [0.0, 300.0];
    let all = campbell(&spins, 4, model).unwrap();
    for (spectrum, spin) in all.iter().zip(spins) {
        let whirl = WhirlAnalysis::new(&model(spin).unwrap().matrices().unwrap()).unwrap();
        assert_eq!(*spectrum, whirl.lowest(spin, 4).unwrap());
    }
}

#[test]
fn damped_crossings_lie_on_the_line() {
    let model = rotors::two_discs(6, Bearing::isotropic(1e6, 3e3), 0.0).unwrap();
    let whirl = WhirlAnalysis::new(&model.matrices().unwrap()).unwrap();
    let spins: Vec<f64> = (0..=10).map(|i| 40.0 * f64::from(i)).collect();
    let found = whirl.crossings(1.0, &spins).unwrap();
    assert_eq!(found.len(), 4);
    for spin in found {
        let modes = whirl.at(spin).unwrap().modes;
        let nearest = modes
            .iter()
            .map(|m| (m.frequency_rad_s() / spin - 1.0).abs());
        assert!(nearest.fold(f64::MAX, f64::min) < 1e-9);
    }
}

#[test]
fn few_modes_of_standstill_are_enough_for_low_whirl() {
    let model = rotors::two_discs(24, Bearing::isotropic(1e6, 100.0), 0.0).unwrap();
    let system = model.matrices().unwrap();
    let whole = WhirlAnalysis::new(&system)
        .unwrap()
        .lowest(400.0, 4)
        .unwrap();
    let part = WhirlAnalysis::reduced(&system, 24)
        .unwrap()
        .lowest(400.0, 4)
        .unwrap();
    for (a, b) in whole.modes.iter().zip(&part.modes) {
        let error = (a.eigenvalue - b.eigenvalue).norm() / a.eigenvalue.norm();
        // 1.1e-8 to 2.4e-7 measured.
        assert!(error < 1e-6);
    }
}

#[test]
fn damping_within_the_shaft_drives_whirl_above_a_critical_speed() {
    // For a mode of a uniform supported shaft, u = v + iw, and θ likewise:
    // m λ² + (c + β k) λ + k − iΩ β k = 0, which grows from Ω = ω (1 + c/(β k)) on, k the
    // modal stiffness (m = 1: ω²).
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let section = CrossSection::solid_circle(0.01, &steel).unwrap();
    let shaft = Shaft::on_mesh(&section, &steel, Mesh::uniform(1.5, 8).unwrap());
    let mut model = BeamModel::new(shaft);
    for node in [0, 8] {
        model.fix(node, Dof::V).unwrap();
        model.fix(node, Dof::W).unwrap();
    }
    model.lateral_only();
    let beta = 1e-4;
    model.set_rotating_damping(beta).unwrap();
    let alpha = 0.4;
    for outer in [0.0, alpha] {
        model
            .set_damping(beam_fem::Damping::Rayleigh {
                alpha: outer,
                beta: 0.0,
            })
            .unwrap();
        let system = model.matrices().unwrap();
        let whirl = WhirlAnalysis::new(&system).unwrap();
        let w = whirl.critical_speeds(1.0, 2).unwrap()[1].spin;
        let threshold = w * (1.0 + outer / (beta * w * w));
        let growth = |spin: f64| whirl.lowest(spin, 2).unwrap().modes[1].clone();
        let (below, above) = (growth(0.999 * threshold), growth(1.001 * threshold));
        assert!(
            below.eigenvalue.re < 0.0 && above.eigenvalue.re > 0.0,
            "{below:?}"
        );
        assert_eq!(above.direction, Whirl::Forward);
        // λ far above the threshold, with Rayleigh's gyroscopic term −2iεΩλ, ε = (I/A)(π/L)².
        let spin = 3.0 * threshold;
        let rest = system.natural_modes().unwrap().frequencies_rad_s[0];
        let share = 0.01_f64.powi(2) / 16.0 * (PI / 1.5).powi(2);
        let k = rest * rest;
        let b = Complex::new(outer + beta * k, -2.0 * share * spin);
        let root = (b * b - 4.0 * Complex::new(k, -spin * beta * k)).sqrt();
        let exact = (root - b) * 0.5;
        let exact = if exact.im > 0.0 {
            exact
        } else {
            (-root - b) * 0.5
        };
        let found = growth(spin).eigenvalue;
        println!("{:e}", (found - exact).norm() / exact.norm());
        assert!(
            (found - exact).norm() < 1e-7 * exact.norm(),
            "{found} {exact}"
        );
    }
    assert!(model.set_rotating_damping(-1.0).is_err());
}

#[test]
fn unbalance_in_isotropic_bearings_does_not_strain_a_damped_shaft() {
    // A circular synchronous orbit turns with the shaft, so that damping within it rests.
    let unbalance = Unbalance {
        node: 2,
        moment: 1e-3,
        phase: 0.3,
    };
    let mut model = rotors::two_discs(6, Bearing::isotropic(1e6, 3e3), 0.0).unwrap();
    let respond = |model: &BeamModel| {
        let system = model.matrices().unwrap();
        system
            .unbalance_response(&[unbalance], &[150.0, 700.0])
            .unwrap()
    };
    let without = respond(&model);
    model.set_rotating_damping(1e-3).unwrap();
    for (a, b) in respond(&model).iter().zip(&without) {
        let difference = (&a.amplitudes - &b.amplitudes).norm();
        assert!(difference < 1e-11 * b.amplitudes.norm(), "{difference:e}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Mirrored spin mirrors the whirl; without damping nothing grows or decays; every
    /// pair solves its quadratic equation.
    #[test]
    fn laws_of_whirl(
        spin in 0.0..2000.0_f64, stiffness in 1e5..1e8_f64, ratio in 0.3..1.0_f64, axial in -5e4..5e4_f64,
    ) {
        let bearing = Bearing::orthotropic([stiffness, ratio * stiffness], [0.0; 2]);
        let system = rotors::two_discs(6, bearing, axial).unwrap().matrices().unwrap();
        let whirl = WhirlAnalysis::new(&system).unwrap();
        let (with, against) = (whirl.lowest(spin, 6).unwrap(), whirl.lowest(-spin, 6).unwrap());
        let complex = |m: &nalgebra::DMatrix<f64>| m.map(|v| Complex::new(v, 0.0));
        for (a, b) in with.modes.iter().zip(&against.modes) {
            prop_assert!((a.eigenvalue / b.eigenvalue - 1.0).norm() < 1e-9);
            prop_assert!((a.whirl_index + b.whirl_index).abs() < 1e-5);
            prop_assert!(a.damping_ratio().abs() < 1e-9);
            let (l, q) = (a.eigenvalue, &a.shape);
            let inertia = complex(&system.mass) * q * (l * l);
            let gyroscopic = complex(&system.gyroscopic) * q * (l * spin);
            let spring = complex(&system.loaded_stiffness()) * q;
            let residual = (&inertia + &gyroscopic + &spring).norm();
            prop_assert!(residual < 1e-6 * spring.norm().max(inertia.norm()), "{residual}");
        }
    }
}
