//! Buckling and frequencies under axial load; damping; frequency response.

use std::f64::consts::PI;

use beam_fem::{
    BeamError, BeamModel, Bearing, CrossSection, Damping, Dof, Material, Mesh, Receptance,
    SectionProperties, Shaft, Unbalance, WhirlAnalysis,
};
use nalgebra::{Complex, DVector};
use proptest::prelude::*;

use crate::rotors;

const LENGTH: f64 = 2.0;

/// A column without stretch, twist and motion in x–z. Slender (no shear, no rotary
/// inertia) unless `kappa` is small. Also its EI and κGA.
fn column(elements: usize, kappa: f64, radius: f64) -> (BeamModel, f64, f64) {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let (area, i) = (1e-3, 1e-3 * radius * radius);
    let section = CrossSection::new(area, i, i, 2.0 * i, kappa).unwrap();
    let shaft = Shaft::on_mesh(&section, &steel, Mesh::uniform(LENGTH, elements).unwrap());
    let mut model = BeamModel::new(shaft);
    model.lateral_only();
    model.fix_everywhere(Dof::W);
    model.fix_everywhere(Dof::ThetaY);
    (model, 206e9 * i, kappa * steel.shear_modulus() * area)
}

fn slender(elements: usize) -> (BeamModel, f64) {
    let (model, ei, _) = column(elements, 1e9, 1e-5);
    (model, ei)
}

fn hold(model: &mut BeamModel, held: &[(usize, Dof)]) {
    for (node, dof) in held {
        model.fix(*node, *dof).unwrap();
    }
}

#[test]
fn euler_columns_with_four_ends() {
    use Dof::{ThetaZ, V};
    let last = 16;
    // P L²/EI: (π/2)², π², the root of tan x = x squared, 4π².
    let cases: [(&[(usize, Dof)], f64); 4] = [
        (&[(0, V), (0, ThetaZ)], 0.25 * PI * PI),
        (&[(0, V), (last, V)], PI * PI),
        (
            &[(0, V), (0, ThetaZ), (last, V)],
            4.493_409_457_909_064_f64.powi(2),
        ),
        (
            &[(0, V), (0, ThetaZ), (last, V), (last, ThetaZ)],
            4.0 * PI * PI,
        ),
    ];
    for (held, factor) in cases {
        let (mut model, ei) = slender(last);
        hold(&mut model, held);
        model.set_axial_force(-1.0).unwrap();
        let found = model.matrices().unwrap().buckling(2).unwrap();
        assert_eq!(found.shapes.ncols(), 2);
        let error = found.factors[0] / (factor * ei / LENGTH.powi(2)) - 1.0;
        // Cubic elements err by (kl)⁴/720, k² = P/EI, l the element; 0.8 % off measured.
        let expected = (factor.sqrt() / last as f64).powi(4) / 720.0;
        assert!((error / expected - 1.0).abs() < 0.01, "{error} {expected}");
        // In tension nothing buckles.
        model.set_axial_force(1.0).unwrap();
        assert!(
            model
                .matrices()
                .unwrap()
                .buckling(2)
                .unwrap()
                .factors
                .is_empty()
        );
    }
}

#[test]
fn a_column_weak_in_shear_buckles_at_engessers_load() {
    let (mut model, ei, shear) = column(64, 0.01, 0.2);
    hold(&mut model, &[(0, Dof::V), (64, Dof::V)]);
    model.set_axial_force(-1.0).unwrap();
    let euler = PI * PI * ei / (LENGTH * LENGTH);
    let exact = euler / (1.0 + euler / shear);
    assert!(exact < 0.2 * euler);
    let found = model.matrices().unwrap().buckling(1).unwrap().factors[0];
    // 7.2e-6 measured.
    assert!((found / exact - 1.0).abs() < 2e-5);
}

#[test]
fn each_plane_buckles_with_its_own_shear_coefficient() {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let section = CrossSection::general(SectionProperties {
        area: 1e-3,
        second_moment_y: 3e-5,
        second_moment_z: 4e-5,
        torsion_constant: 7e-5,
        shear_coefficient_y: 0.01,
        shear_coefficient_z: 0.03,
    })
    .unwrap();
    let shaft = Shaft::on_mesh(&section, &steel, Mesh::uniform(LENGTH, 64).unwrap());
    let mut model = BeamModel::new(shaft);
    model.lateral_only();
    let ends = [(0, Dof::V), (0, Dof::W), (64, Dof::V), (64, Dof::W)];
    hold(&mut model, &ends);
    model.set_axial_force(-1.0).unwrap();
    let found = model.matrices().unwrap().buckling(400).unwrap().factors;
    for (i, kappa) in [(4e-5, 0.01), (3e-5, 0.03)] {
        let euler = PI * PI * 206e9 * i / (LENGTH * LENGTH);
        let exact = euler / (1.0 + euler / (kappa * steel.shear_modulus() * 1e-3));
        let nearest = found.iter().map(|p| (p / exact - 1.0).abs());
        let nearest = nearest.fold(f64::MAX, f64::min);
        // 7.2e-6 and 2.3e-5 measured.
        assert!(nearest < 5e-5, "{exact} {nearest:e}");
    }
}

#[test]
fn tension_raises_and_compression_lowers_frequencies() {
    let (mut model, ei) = slender(24);
    hold(&mut model, &[(0, Dof::V), (24, Dof::V)]);
    let euler = PI * PI * ei / (LENGTH * LENGTH);
    for share in [-0.99, -0.5, 0.0, 3.0, 100.0] {
        model.set_axial_force(share * euler).unwrap();
        let found = model
            .matrices()
            .unwrap()
            .natural_modes()
            .unwrap()
            .frequencies_rad_s;
        for n in 1..=3 {
            let k = n as f64 * PI / LENGTH;
            // ω² = k⁴ EI/ρA (1 + N/(EI k²)).
            let square = k.powi(4) * ei / 7.85 * (1.0 + share * euler / (ei * k * k));
            let error = found[n - 1] / square.sqrt() - 1.0;
            // 2.0e-5 measured, next to buckling.
            assert!(error.abs() < 3e-5, "{share} {n} {error:e}");
        }
    }
    // Beyond buckling there is no frequency but a growing motion, at √−ω².
    model.set_axial_force(-2.0 * euler).unwrap();
    let system = model.matrices().unwrap();
    assert_eq!(system.natural_modes(), Err(BeamError::StiffnessNegative));
    let spectrum = WhirlAnalysis::new(&system).unwrap().at(0.0).unwrap();
    let growth = (PI / LENGTH).powi(2) * (ei / 7.85).sqrt();
    assert_eq!(spectrum.real.len(), 2);
    assert!((spectrum.real[1] / growth - 1.0).abs() < 1e-4);
}

#[test]
fn forces_of_elements_add() {
    let (mut model, _) = slender(4);
    model.set_axial_forces(&[1.0, 2.0, 3.0, 4.0]).unwrap();
    let uneven = model.matrices().unwrap().geometric;
    model.set_axial_forces(&[4.0, 3.0, 2.0, 1.0]).unwrap();
    let mirrored = model.matrices().unwrap().geometric;
    model.set_axial_force(5.0).unwrap();
    let even = model.matrices().unwrap().geometric;
    assert!((uneven + mirrored - &even).amax() < 1e-14 * even.amax());
    assert!(model.set_axial_forces(&[1.0]).is_err());
    assert!(model.set_axial_forces(&[1.0, 1.0, 1.0, f64::NAN]).is_err());
}

#[test]
fn rayleigh_and_modal_damping_have_their_ratios() {
    let mut model = rotors::two_discs(6, Bearing::isotropic(1e6, 0.0), 0.0).unwrap();
    let undamped = model
        .matrices()
        .unwrap()
        .natural_modes()
        .unwrap()
        .frequencies_rad_s;
    let rayleigh = Damping::rayleigh_at([(undamped[0], 0.01), (undamped[4], 0.03)]).unwrap();
    let Damping::Rayleigh { alpha, beta } = rayleigh else {
        panic!("not Rayleigh's");
    };
    let modal = Damping::Modal(vec![0.01, 0.01, 0.2, 0.2, 0.05, 0.05]);
    for damping in [rayleigh, modal] {
        model.set_damping(damping.clone()).unwrap();
        let whirl = WhirlAnalysis::new(&model.matrices().unwrap()).unwrap();
        for (index, mode) in whirl.lowest(0.0, 6).unwrap().modes.iter().enumerate() {
            let w = undamped[index];
            let ratio = match &damping {
                Damping::Modal(ratios) => ratios[index],
                _ => 0.5 * (alpha / w + beta * w),
            };
            assert!((mode.damping_ratio() - ratio).abs() < 1e-8, "{index}");
            assert!((mode.natural_rad_s() / w - 1.0).abs() < 1e-8);
            let decrement = 2.0 * PI * ratio / (1.0 - ratio * ratio).sqrt();
            assert!((mode.log_decrement() / decrement - 1.0).abs() < 1e-6);
        }
    }
    assert!(Damping::rayleigh_at([(1.0, 0.1), (1.0, 0.2)]).is_err());
    assert!(model.set_damping(Damping::Modal(vec![-0.1])).is_err());
    model.set_damping(Damping::Modal(vec![0.1; 1000])).unwrap();
    assert!(matches!(model.matrices(), Err(BeamError::ModeCount { .. })));
}

#[test]
fn receptance_is_the_sum_over_modes() {
    let mut model = rotors::two_discs(6, Bearing::isotropic(1e6, 0.0), 0.0).unwrap();
    model.set_damping(Damping::Modal(vec![0.02; 28])).unwrap();
    let system = model.matrices().unwrap();
    let modes = system.natural_modes().unwrap();
    let rows = Receptance {
        from: Dof::V.at(2),
        to: Dof::ThetaZ.at(5),
    };
    let frequencies = [0.0, 50.0, 86.66, 400.0, 5000.0];
    let found = system.receptance(0.0, rows, &frequencies).unwrap();
    let (from, to) = (system.row(rows.from).unwrap(), system.row(rows.to).unwrap());
    for (value, w) in found.iter().zip(frequencies) {
        let term = |k: usize| {
            let n = modes.frequencies_rad_s[k];
            let shape = modes.shapes[(from, k)] * modes.shapes[(to, k)];
            Complex::new(shape, 0.0) / Complex::new(n * n - w * w, 2.0 * 0.02 * n * w)
        };
        let sum: Complex<f64> = (0..system.order()).map(term).sum();
        assert!(
            (value - sum).norm() < 1e-8 * sum.norm(),
            "{w} {value} {sum}"
        );
    }
}

#[test]
fn bad_rows_nodes_and_values_are_named() {
    let mut model = rotors::overhung().unwrap();
    let nan = f64::NAN;
    assert!(model.add_mass(7, beam_fem::LumpedMass::point(1.0)).is_err());
    assert!(
        model
            .add_mass(0, beam_fem::LumpedMass::point(-1.0))
            .is_err()
    );
    assert!(model.add_ground_spring(42, 1.0).is_err());
    assert!(model.add_ground_damper(usize::MAX, 1.0).is_err());
    assert!(model.add_spring([0, 1], nan).is_err());
    assert!(model.add_damper([0, 42], 1.0).is_err());
    assert!(model.add_bearing(usize::MAX, Bearing::default()).is_err());
    assert!(model.add_bearing(0, Bearing::isotropic(nan, 0.0)).is_err());
    assert!(model.fix(9, Dof::U).is_err() && model.clamp(9).is_err());
    assert!(model.set_axial_force(f64::INFINITY).is_err());
    let system = model.matrices().unwrap();
    let held = Receptance {
        from: Dof::U.at(0),
        to: Dof::V.at(0),
    };
    let message = system
        .receptance(0.0, held, &[1.0])
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("from = 0 (node 0, U) is held"),
        "{message}"
    );
    assert!(
        system
            .steady_response(0.0, 1.0, &DVector::zeros(3))
            .is_err()
    );
    assert!(
        system
            .steady_response(nan, 1.0, &DVector::zeros(28))
            .is_err()
    );
    let unbalance = |node, moment| Unbalance {
        node,
        moment,
        phase: 0.0,
    };
    assert!(
        system
            .unbalance_response(&[unbalance(99, 1.0)], &[1.0])
            .is_err()
    );
    assert!(
        system
            .unbalance_response(&[unbalance(usize::MAX, 1.0)], &[1.0])
            .is_err()
    );
    assert!(
        system
            .unbalance_response(&[unbalance(1, nan)], &[1.0])
            .is_err()
    );
    assert!(
        system
            .unbalance_response(&[unbalance(1, 1.0)], &[nan])
            .is_err()
    );
    let whirl = WhirlAnalysis::new(&system).unwrap();
    assert!(whirl.at(nan).is_err() && whirl.critical_speeds(0.0, 1).is_err());
    assert!(whirl.crossings(1.0, &[1.0, 1.0]).is_err());
    assert!(WhirlAnalysis::reduced(&system, 0).is_err());
    let mut still = model.clone();
    (0..7).for_each(|node| still.clamp(node).unwrap());
    assert!(matches!(still.matrices(), Err(BeamError::ModeCount { .. })));
    // A node without mass cannot be solved for.
    model.add_node();
    let light = model.matrices().unwrap();
    assert!(WhirlAnalysis::new(&light).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Reciprocity with the spin turned round (G is antisymmetric), and the static
    /// limit.
    #[test]
    fn receptance_is_reciprocal(
        spin in -500.0..500.0_f64, frequency in 1.0..2000.0_f64, from in 0..28_usize, to in 0..28_usize,
        damping in 1.0..1e4_f64,
    ) {
        let model = rotors::two_discs(6, Bearing::isotropic(1e6, damping), 0.0).unwrap();
        let system = model.matrices().unwrap();
        let (from, to) = (system.free()[from], system.free()[to]);
        let one = system.receptance(spin, Receptance { from, to }, &[frequency]).unwrap()[0];
        let other = Receptance { from: to, to: from };
        let two = system.receptance(-spin, other, &[frequency]).unwrap()[0];
        let own = |row| system.receptance(spin, Receptance { from: row, to: row }, &[frequency]);
        let size = (own(from).unwrap()[0].norm() * own(to).unwrap()[0].norm()).sqrt();
        prop_assert!((one - two).norm() < 1e-8 * size);
    }

    /// No input of numbers panics.
    #[test]
    fn nothing_panics(values in prop::collection::vec(prop::num::f64::ANY, 12), node in 0..9_usize) {
        let Ok(mut model) = rotors::overhung() else { return Ok(()) };
        let v = |i: usize| values[i];
        let bearing = Bearing { stiffness: [[v(0), v(1)], [v(2), v(3)]], damping: [[v(4), v(5)], [v(6), 0.0]] };
        let _ = model.add_bearing(node, bearing);
        let _ = model.add_mass(node, beam_fem::LumpedMass { mass: v(7), polar_inertia: v(8), diametral_inertia: v(9) });
        let _ = model.set_axial_force(v(10));
        let _ = model.set_damping(Damping::Rayleigh { alpha: v(11), beta: v(7) });
        if let Ok(system) = model.matrices() {
            let _ = system.buckling(2);
            let _ = system.unbalance_response(&[Unbalance { node, moment: v(8), phase: v(9) }], &[v(10), 100.0]);
            if let Ok(whirl) = WhirlAnalysis::new(&system) {
                let _ = whirl.lowest(v(11), 3);
                let _ = whirl.critical_speeds(1.0, 3);
                let _ = whirl.crossings(1.0, &[0.0, 200.0]);
            }
        }
    }
}
