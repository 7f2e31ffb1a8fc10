//! Closed-form deflections and frequencies.

use std::f64::consts::PI;

use beam_fem::{Beam, CrossSection, Dof, Material, Mesh, lowest_modes};
use nalgebra::DVector;

fn round(diameter: f64, length: f64, elements: usize) -> Beam {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let section = CrossSection::solid_circle(diameter, &steel).unwrap();
    Beam::new(section, steel, Mesh::uniform(length, elements).unwrap())
}

/// A section whose shear and rotary inertia are negligible: what is left is
/// Euler and Bernoulli's beam. (κ = 10⁹, r/L = 10⁻⁶.)
fn slender(length: f64, elements: usize) -> Beam {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let (area, i) = (1e-2, 1e-2 * (length / 1e6).powi(2));
    let section = CrossSection::new(area, i, i, 2.0 * i, 1e9).unwrap();
    Beam::new(section, steel, Mesh::uniform(length, elements).unwrap())
}

const CLAMPED: [usize; 6] = [0, 1, 2, 3, 4, 5];

/// All motion but bending in x–y held.
fn plane_only(beam: &Beam, also: &[usize]) -> Vec<usize> {
    let others = [Dof::U, Dof::W, Dof::ThetaX, Dof::ThetaY];
    let nodes = 0..beam.mesh.nodes().len();
    let held = nodes.flat_map(|node| others.map(|dof| dof.at(node)));
    held.chain(also.iter().copied()).collect()
}

fn frequencies(beam: &Beam, fixed: &[usize], count: usize) -> Vec<f64> {
    let free = beam.assemble_banded().fixed(fixed).unwrap();
    lowest_modes(&free, count).unwrap().frequencies_rad_s
}

/// Order of convergence from the errors on two meshes, the second twice as
/// fine.
fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

/// Angular frequency of mode n of a simply supported Timoshenko beam: the
/// lower root of the 2 × 2 problem for v = V sin kx, θ = Θ cos kx.
fn simply_supported(beam: &Beam, n: usize) -> f64 {
    let (s, m) = (&beam.section, &beam.material);
    let k = n as f64 * PI / beam.mesh.length();
    let (ei, shear) = (
        m.youngs_modulus() * s.second_moment_z(),
        s.shear_coefficient() * m.shear_modulus() * s.area(),
    );
    let (line, rotary) = (m.density() * s.area(), m.density() * s.second_moment_z());
    // line·rotary λ² − (line (EI k² + κGA) + rotary κGA k²) λ + κGA EI k⁴ = 0
    let b = line * (ei * k * k + shear) + rotary * shear * k * k;
    let c = shear * ei * k.powi(4);
    (2.0 * c / (b + (b * b - 4.0 * line * rotary * c).sqrt())).sqrt()
}

#[test]
fn a_cantilever_bends_exactly_at_its_nodes() {
    for (diameter, length, elements) in [(0.04, 1.5, 1), (0.04, 1.5, 10), (0.3, 0.5, 7)] {
        let beam = round(diameter, length, elements);
        let free = beam.assemble().unwrap().fixed(&CLAMPED).unwrap();
        let tip = 6 * (elements - 1);
        let cholesky = free.stiffness.clone().cholesky().unwrap();
        let (s, m) = (&beam.section, &beam.material);
        let (e, g, i) = (m.youngs_modulus(), m.shear_modulus(), s.second_moment_z());
        let bend = length.powi(3) / (3.0 * e * i) + length / (s.shear_coefficient() * g * s.area());
        let cases = [
            (Dof::U, length / (e * s.area())),
            (Dof::V, bend),
            (Dof::W, bend),
            (Dof::ThetaX, length / (g * s.torsion_constant())),
            (Dof::ThetaY, length / (e * i)),
            (Dof::ThetaZ, length / (e * i)),
        ];
        for (dof, exact) in cases {
            let row = tip + dof as usize;
            let mut load = DVector::zeros(free.stiffness.nrows());
            load[row] = 1.0;
            let found = cholesky.solve(&load)[row];
            // Exact in theory; the condition number of K, some 10⁵, is what
            // rounding costs: 7.5e-13 measured.
            assert!(
                (found / exact - 1.0).abs() < 7e-12,
                "{dof:?} {found} {exact}"
            );
        }
        // A force in y also turns the tip: P L² / 2EI, and w turns it the other way.
        for (force, turn, sign) in [(Dof::V, Dof::ThetaZ, 1.0), (Dof::W, Dof::ThetaY, -1.0)] {
            let mut load = DVector::zeros(free.stiffness.nrows());
            load[tip + force as usize] = 1.0;
            let found = cholesky.solve(&load)[tip + turn as usize];
            let exact = sign * length * length / (2.0 * e * i);
            // 6.9e-13 measured.
            assert!((found / exact - 1.0).abs() < 7e-12);
        }
    }
}

#[test]
fn euler_bernoulli_cantilever_at_fourth_order() {
    // β L of a cantilever: roots of cos βL cosh βL = −1.
    let roots = [
        1.875_104_068_711_961,
        4.694_091_132_974_175,
        7.854_757_438_237_613,
    ];
    let length = 3.0;
    for (mode, root) in roots.into_iter().enumerate() {
        let error = |elements: usize| {
            let beam = slender(length, elements);
            let (s, m) = (&beam.section, &beam.material);
            let stiff = m.youngs_modulus() * s.second_moment_z() / (m.density() * s.area());
            let exact = (root / length).powi(2) * stiff.sqrt();
            let fixed = plane_only(&beam, &CLAMPED);
            frequencies(&beam, &fixed, 3)[mode] / exact - 1.0
        };
        let (coarse, fine) = (error(8), error(16));
        // Above, since a consistent mass never lowers a frequency. The next
        // term is of relative size (βh)² / 10, a few per cent for mode 3.
        assert!((order(coarse, fine) - 4.0).abs() < 0.1, "{coarse} {fine}");
        // Leading term of cubic elements: (βh)⁴ / 1440. The third mode's next term is
        // 1.4 % of it.
        let expected = (root / 16.0).powi(4) / 1440.0;
        assert!((fine / expected - 1.0).abs() < 0.03, "{fine} {expected}");
    }
}

#[test]
fn timoshenko_simply_supported_at_its_order() {
    // Thick: L/D = 5. Between nodes the shear angle is constant, so the
    // order falls from 4 to 2 once elements are shorter than they are thick.
    let length = 0.5;
    for n in 1..=3 {
        let error = |elements: usize| {
            let beam = round(0.1, length, elements);
            let ends = [Dof::V.at(0), Dof::V.at(elements)];
            let fixed = plane_only(&beam, &ends);
            frequencies(&beam, &fixed, 3)[n - 1] / simply_supported(&beam, n) - 1.0
        };
        let (coarse, fine) = (error(32), error(64));
        assert!(fine > 0.0);
        // 2.002 and 3.1e-4 measured.
        assert!((order(coarse, fine) - 2.0).abs() < 0.01, "{coarse} {fine}");
        assert!(fine < 5e-4, "{fine}");
    }
}

#[test]
fn slender_screws_converge_at_fourth_order_until_elements_are_short() {
    // L/D = 37.5, the default screw: elements of 75 to 150 mm are still long
    // beside its 40 mm, and bending sets the error.
    let error = |elements: usize| {
        let beam = round(0.04, 1.5, elements);
        let fixed = plane_only(&beam, &[Dof::V.at(0), Dof::V.at(elements)]);
        frequencies(&beam, &fixed, 3)[2] / simply_supported(&beam, 3) - 1.0
    };
    let (coarse, fine) = (error(5), error(10));
    assert!(order(coarse, fine) > 3.3, "{coarse} {fine}");
}

#[test]
fn rods_at_second_order() {
    // Free–free: ω = n π c / L, with c = √(G/ρ) in twist and √(E/ρ) in stretch.
    let length = 1.5;
    for (dof, modulus) in [(Dof::ThetaX, 206e9 / 2.6), (Dof::U, 206e9)] {
        for n in 1..=3 {
            let error = |elements: usize| {
                let beam = round(0.04, length, elements);
                let nodes = 0..=elements;
                let others = Dof::ALL.into_iter().filter(|d| *d != dof);
                let fixed: Vec<usize> = nodes
                    .flat_map(|node| others.clone().map(move |d| d.at(node)))
                    .collect();
                let exact = n as f64 * PI / length * (modulus / 7850.0_f64).sqrt();
                frequencies(&beam, &fixed, 4)[n] / exact - 1.0
            };
            let (coarse, fine) = (error(20), error(40));
            // Known: ω_h/ω − 1 = (n π / N)² / 24, with a next term of 7e-4 of it.
            let expected = (n as f64 * PI / 40.0).powi(2) / 24.0;
            assert!((fine / expected - 1.0).abs() < 0.002, "{fine} {expected}");
            assert!((order(coarse, fine) - 2.0).abs() < 0.01, "{coarse} {fine}");
        }
    }
}
