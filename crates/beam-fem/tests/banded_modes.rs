//! The banded solver against the dense one, and on its own.

use std::f64::consts::PI;

use beam_fem::{
    BandedMatrices, Beam, BeamError, CrossSection, Dof, Material, Mesh, SymmetricBanded,
    lowest_modes, natural_modes,
};
use nalgebra::DMatrix;
use proptest::prelude::*;

fn screw(elements: usize) -> Beam {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let section = CrossSection::solid_circle(0.04, &steel).unwrap();
    Beam::new(section, steel, Mesh::uniform(1.5, elements).unwrap())
}

/// Frequencies against the dense solver's; shapes by orthonormality and
/// residual, since equal frequencies leave their shapes a choice.
fn compare(matrices: &BandedMatrices, count: usize) -> Result<(), TestCaseError> {
    let (mass, stiffness) = (
        matrices.mass.to_dense().unwrap(),
        matrices.stiffness.to_dense().unwrap(),
    );
    let dense = natural_modes(&mass, &stiffness).unwrap();
    let banded = lowest_modes(matrices, count).unwrap();
    prop_assert_eq!(banded.frequencies_rad_s.len(), count);
    let largest = dense.frequencies_rad_s[dense.frequencies_rad_s.len() - 1].powi(2);
    for (b, d) in banded
        .frequencies_rad_s
        .iter()
        .zip(&dense.frequencies_rad_s)
    {
        // The dense solver's backward error, relative to the largest ω²: 4.8e-16
        // measured over 600 draws.
        prop_assert!((b * b - d * d).abs() < 5e-15 * largest, "{b} {d}");
    }
    let x = &banded.shapes;
    let gram = x.transpose() * &mass * x;
    // 2.1e-14 measured.
    prop_assert!((gram - DMatrix::identity(count, count)).amax() < 2e-13);
    let energy = x.transpose() * &stiffness * x;
    for i in 0..count {
        for j in 0..count {
            let square = if i == j {
                banded.frequencies_rad_s[i].powi(2)
            } else {
                0.0
            };
            let error = (energy[(i, j)] - square).abs();
            // Rounding of xᵀKx, relative to its largest terms: 1.0e-15 measured.
            prop_assert!(error < 1e-14 * largest, "{i} {j} {error}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn agrees_with_the_dense_solver(
        elements in 1..30usize, share in 0.0..1.0f64, clamp in 0..3usize,
    ) {
        let beam = screw(elements);
        let all: Vec<usize> = (0..6).chain(6 * elements..6 * elements + 6).collect();
        let free = beam.assemble_banded().fixed(&all[..6 * clamp]).unwrap();
        let order = free.mass.order();
        prop_assume!(order > 0);
        let count = 1 + (share * (order.min(20) - 1) as f64) as usize;
        compare(&free, count)?;
    }

    #[test]
    fn agrees_where_springs_couple_all_directions(
        elements in 14..26usize, node in 0..14usize, stiffness in 1e3..1e8f64, count in 1..12usize,
    ) {
        // One spring across all six directions of a node joins all parts, so
        // that the wide band, and six equal frequencies at 0, meet at once.
        let beam = screw(elements);
        let mut matrices = beam.assemble_banded();
        let direction = [1.0, 0.7, -0.4, 0.01, 0.02, -0.03];
        for (i, a) in direction.iter().enumerate() {
            for (j, b) in direction.iter().enumerate().take(i + 1) {
                let (row, column) = (6 * node + i, 6 * node + j);
                matrices.stiffness.add(row, column, stiffness * a * b).unwrap();
            }
        }
        compare(&matrices, count)?;
    }
}

#[test]
fn all_six_rigid_modes_and_all_pairs_of_a_long_mesh() {
    let beam = screw(1000);
    let modes = lowest_modes(&beam.assemble_banded(), 14).unwrap();
    let w = &modes.frequencies_rad_s;
    assert!(w[..6].iter().all(|w| *w == 0.0), "{w:?}");
    // Free bending comes in pairs, y and z alike.
    for pair in w[6..14].chunks(2) {
        assert!(
            // 2.3e-11 measured: the rounding of K, which N⁴ magnifies.
            pair[0] > 100.0 && (pair[1] / pair[0] - 1.0).abs() < 2e-10,
            "{w:?}"
        );
    }
    // Euler–Bernoulli bounds them from above; shear and rotary inertia lower
    // the first by about 0.3 % at L/D = 37.5.
    let i = PI * 0.04_f64.powi(4) / 64.0;
    let bound = (4.730_040_744_862_704 / 1.5_f64).powi(2)
        * (206e9 * i / (7850.0 * PI * 0.02_f64.powi(2))).sqrt();
    assert!(w[6] < bound && w[6] > 0.99 * bound, "{} {bound}", w[6]);
}

#[test]
fn a_simply_supported_long_mesh_meets_the_closed_form() {
    let beam = screw(1000);
    let pins = [
        Dof::U.at(0),
        Dof::ThetaX.at(0),
        Dof::V.at(0),
        Dof::W.at(0),
        Dof::V.at(1000),
        Dof::W.at(1000),
    ];
    let modes = lowest_modes(&beam.assemble_banded().fixed(&pins).unwrap(), 6).unwrap();
    let (s, m) = (&beam.section, &beam.material);
    let shear = s.shear_coefficient() * m.shear_modulus() * s.area();
    for n in 1..=3 {
        let k = n as f64 * PI / 1.5;
        let ei = m.youngs_modulus() * s.second_moment_z();
        let (line, rotary) = (m.density() * s.area(), m.density() * s.second_moment_z());
        let b = line * (ei * k * k + shear) + rotary * shear * k * k;
        let c = shear * ei * k.powi(4);
        let exact = (2.0 * c / (b + (b * b - 4.0 * line * rotary * c).sqrt())).sqrt();
        for found in &modes.frequencies_rad_s[2 * n - 2..2 * n] {
            // The error of the mesh, (nπ r/L)² of (l/L)²: 4.2e-8 of the third as
            // measured.
            assert!((found / exact - 1.0).abs() < 2e-7, "{found} {exact}");
        }
    }
}

#[test]
fn a_beam_turned_round_has_the_same_frequencies() {
    // Elements that grow from one end to the other, in either order: all rows
    // and all parts stand elsewhere, and the elimination runs the other way.
    let node = |i: usize| 1.5 * (i as f64 / 200.0).powf(1.3);
    let there: Vec<f64> = (0..=200).map(node).collect();
    let back = there.iter().rev().map(|x| 1.5 - x).collect();
    let of = |nodes: Vec<f64>| {
        let beam = screw(1);
        let mesh = Mesh::from_nodes(nodes).unwrap();
        let turned = Beam::new(beam.section, beam.material, mesh);
        lowest_modes(&turned.assemble_banded(), 14).unwrap()
    };
    let (a, b) = (of(there).frequencies_rad_s, of(back).frequencies_rad_s);
    assert_eq!(a[..6], b[..6]);
    let apart = a[6..].iter().zip(&b[6..]).map(|(a, b)| (a / b - 1.0).abs());
    let apart = apart.fold(0.0, f64::max);
    println!("turned round: {apart:.1e}");
    // 5.5e-12 as measured: rounding, times the ratio of highest to lowest ω².
    assert!(apart < 5e-11, "{apart:e}");
}

/// A band of half bandwidth `p` with unit masses, positive definite: the first
/// row's own frequency is a 16th of the highest of any row, so that K − μM has a
/// pivot of `tiny` where a search that starts at the top and goes down in steps
/// of 256 counts first.
fn with_a_pivot_of(tiny: f64, p: usize, seed: u32) -> BandedMatrices {
    let order = 90;
    let mut numbers = (1..).map(|i| (f64::from(seed * 7919 + i) * 0.618_033_988_7).fract());
    let mut number = || numbers.next().unwrap();
    let mut mass = SymmetricBanded::zeros(order, p).unwrap();
    let mut stiffness = mass.clone();
    for row in 0..order {
        mass.add(row, row, 1.0).unwrap();
        let own = match row {
            0 => 1.0 + tiny,
            1 => 256.0,
            _ => 64.0 + 191.0 * number(),
        };
        stiffness.add(row, row, own).unwrap();
        for near in 1..=p.min(order - 1 - row) {
            let size = if row == 0 { 0.5 } else { 16.0 / p as f64 };
            let value = size * (2.0 * number() - 1.0);
            stiffness.add(row + near, row, value).unwrap();
        }
    }
    BandedMatrices { mass, stiffness }
}

#[test]
fn no_mode_is_lost_where_a_pivot_vanishes() {
    for p in [2, 3, 4, 11] {
        for seed in 0..8 {
            for tiny in [0.0, 1e-15, -1e-15, 1e-12, -1e-10, 1e-8, -1e-6] {
                compare(&with_a_pivot_of(tiny, p, seed), 1 + seed as usize % 3).unwrap();
            }
        }
    }
}

#[test]
fn bad_questions_are_refused() {
    let mut matrices = screw(3).assemble_banded();
    for count in [0, 25] {
        let error = lowest_modes(&matrices, count).unwrap_err();
        assert_eq!(error, BeamError::ModeCount { count, order: 24 });
    }
    matrices.stiffness.add(0, 0, f64::NAN).unwrap();
    let error = lowest_modes(&matrices, 1).unwrap_err();
    assert_eq!(error, BeamError::NotFinite { field: "stiffness" });
    assert!(matrices.stiffness.add(0, 12, 1.0).is_err());

    let mut massless = screw(3).assemble_banded();
    massless.mass.add(3, 3, -1.0).unwrap();
    assert_eq!(
        lowest_modes(&massless, 1),
        Err(BeamError::MassNotPositiveDefinite)
    );

    for elements in [3, 40] {
        let mut pushed = screw(elements).assemble_banded();
        pushed.stiffness.add(3, 3, -1e9).unwrap();
        assert_eq!(lowest_modes(&pushed, 2), Err(BeamError::StiffnessNegative));
    }
}
