//! The banded solver against the dense one, and on its own.

use std::f64::consts::PI;

use beam_fem::{
    BandedMatrices, Beam, BeamError, Dof, Material, Mesh, Section, lowest_modes, natural_modes,
};
use nalgebra::DMatrix;
use proptest::prelude::*;

fn screw(elements: usize) -> Beam {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let section = Section::solid_circle(0.04, &steel).unwrap();
    Beam::new(section, steel, Mesh::uniform(1.5, elements).unwrap())
}

/// Frequencies against the dense solver's; shapes by orthonormality and
/// residual, since equal frequencies leave their shapes a choice.
fn compare(matrices: &BandedMatrices, count: usize) -> Result<(), TestCaseError> {
    let (mass, stiffness) = (matrices.mass.to_dense(), matrices.stiffness.to_dense());
    let dense = natural_modes(&mass, &stiffness).unwrap();
    let banded = lowest_modes(matrices, count).unwrap();
    prop_assert_eq!(banded.frequencies_rad_s.len(), count);
    let largest = dense.frequencies_rad_s[dense.frequencies_rad_s.len() - 1].powi(2);
    for (b, d) in banded
        .frequencies_rad_s
        .iter()
        .zip(&dense.frequencies_rad_s)
    {
        // The dense solver's backward error, relative to the largest ω².
        prop_assert!(
            (b * b - d * d).abs() < 1e-13 * largest + 1e-10 * d * d,
            "{b} {d}"
        );
    }
    let x = &banded.shapes;
    let gram = x.transpose() * &mass * x;
    prop_assert!((gram - DMatrix::identity(count, count)).amax() < 1e-8);
    let energy = x.transpose() * &stiffness * x;
    let top = banded.frequencies_rad_s[count - 1].powi(2);
    for i in 0..count {
        for j in 0..count {
            let square = if i == j {
                banded.frequencies_rad_s[i].powi(2)
            } else {
                0.0
            };
            let error = (energy[(i, j)] - square).abs();
            prop_assert!(error < 1e-8 * top + 1e-12 * largest, "{i} {j} {error}");
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
            pair[0] > 100.0 && (pair[1] / pair[0] - 1.0).abs() < 1e-9,
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
    let shear = s.shear_coefficient * m.shear_modulus() * s.area;
    for n in 1..=3 {
        let k = n as f64 * PI / 1.5;
        let ei = m.youngs_modulus * s.second_moment_z;
        let (line, rotary) = (m.density * s.area, m.density * s.second_moment_z);
        let b = line * (ei * k * k + shear) + rotary * shear * k * k;
        let c = shear * ei * k.powi(4);
        let exact = (2.0 * c / (b + (b * b - 4.0 * line * rotary * c).sqrt())).sqrt();
        for found in &modes.frequencies_rad_s[2 * n - 2..2 * n] {
            // Rounding in K, magnified by N⁴, leaves seven digits at N = 1000.
            assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
        }
    }
}

#[test]
fn the_same_bits_every_time() {
    let matrices = screw(200).assemble_banded();
    assert_eq!(lowest_modes(&matrices, 10), lowest_modes(&matrices, 10));
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
