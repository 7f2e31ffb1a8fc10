//! Input that must be refused, by name and value.

use beam_fem::{
    BandedMatrices, Beam, BeamError, BeamMatrices, CrossSection, Dof, Material, Mesh, MovingNode,
    SymmetricBanded, element, lowest_modes, natural_modes,
};
use nalgebra::DMatrix;
use proptest::prelude::*;

fn steel() -> Material {
    Material::new(206e9, 0.3, 7850.0).unwrap()
}

#[test]
fn materials_and_sections_name_the_field() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let message = Material::new(bad, 0.3, 7850.0).unwrap_err().to_string();
        assert!(message.starts_with("youngs_modulus = "), "{message}");
        let message = Material::new(206e9, 0.3, bad).unwrap_err().to_string();
        assert!(message.starts_with("density = "), "{message}");
        let message = CrossSection::solid_circle(bad, &steel())
            .unwrap_err()
            .to_string();
        assert!(message.starts_with("diameter = "), "{message}");
        let message = CrossSection::new(1.0, 1.0, bad, 1.0, 1.0)
            .unwrap_err()
            .to_string();
        assert!(message.starts_with("second_moment_z = "), "{message}");
    }
    for bad in [-1.0, 0.51, f64::NAN] {
        let message = Material::new(206e9, bad, 7850.0).unwrap_err().to_string();
        assert!(message.contains("above -1 and at most 0.5"), "{message}");
    }
    // A diameter whose fourth power is lost makes no section.
    assert!(CrossSection::solid_circle(1e-100, &steel()).is_err());
}

#[test]
fn meshes_name_the_node() {
    assert!(matches!(
        Mesh::uniform(1.0, 0),
        Err(BeamError::Elements { elements: 0, .. })
    ));
    assert!(Mesh::uniform(1.0, usize::MAX).is_err());
    assert!(Mesh::uniform(f64::NAN, 3).is_err());
    let bad: [(&[f64], usize); 4] = [
        (&[0.1, 0.2], 0),
        (&[0.0, 0.2, 0.2], 2),
        (&[0.0, f64::NAN], 1),
        (&[0.0, 1.0, f64::INFINITY], 2),
    ];
    for (nodes, place) in bad {
        match Mesh::from_nodes(nodes.to_vec()) {
            Err(BeamError::Node { index, .. }) => assert_eq!(index, place),
            other => panic!("{other:?}"),
        }
    }
    assert!(Mesh::from_nodes(vec![0.0]).is_err());
    assert!(Mesh::from_nodes(Vec::new()).is_err());
}

#[test]
fn moving_nodes_stay_on_the_beam() {
    for x in [-1e-9, 1.6, f64::NAN] {
        let message = MovingNode::at(1.5, 10, x, 1e-3).unwrap_err().to_string();
        assert!(message.starts_with("x = "), "{message}");
    }
    assert!(MovingNode::at(1.5, 1, 0.5, 1e-3).is_err());
    for fraction in [0.0, 0.6, f64::NAN] {
        assert!(MovingNode::at(1.5, 10, 0.5, fraction).is_err());
    }
}

#[test]
fn matrices_must_fit() {
    let section = CrossSection::solid_circle(0.04, &steel()).unwrap();
    let beam = Beam::new(section, steel(), Mesh::uniform(1.5, 2).unwrap());
    let m = beam.assemble().unwrap();
    assert!(m.fixed(&[18]).is_err());
    assert!(beam.assemble_banded().fixed(&[18]).is_err());
    assert!(beam.torsional_compliance_at_node(3).is_err());
    assert!(natural_modes(&m.mass, &DMatrix::zeros(3, 3)).is_err());
    assert!(natural_modes(&DMatrix::zeros(3, 2), &DMatrix::zeros(3, 3)).is_err());
    assert_eq!(
        natural_modes(&DMatrix::zeros(18, 18), &m.stiffness),
        Err(BeamError::MassNotPositiveDefinite)
    );
    assert_eq!(
        natural_modes(&m.mass, &-&m.stiffness),
        Err(BeamError::StiffnessNegative)
    );
    let mut other = Beam {
        mesh: Mesh::uniform(1.5, 3).unwrap(),
        ..beam.clone()
    }
    .assemble_banded();
    assert!(beam.assemble_banded_into(&mut other).is_err());
}

fn screw(elements: usize) -> Beam {
    let section = CrossSection::solid_circle(0.04, &steel()).unwrap();
    Beam::new(section, steel(), Mesh::uniform(1.5, elements).unwrap())
}

#[test]
fn matrices_of_two_orders_are_not_fixed() {
    let (small, large) = (screw(1).assemble().unwrap(), screw(2).assemble().unwrap());
    for (mass, stiffness) in [
        (large.mass.clone(), small.stiffness.clone()),
        (small.mass.clone(), large.stiffness.clone()),
        (DMatrix::zeros(3, 2), DMatrix::zeros(3, 3)),
        (DMatrix::zeros(0, 0), DMatrix::zeros(1, 1)),
    ] {
        let error = BeamMatrices { mass, stiffness }.fixed(&[0]).unwrap_err();
        assert!(matches!(error, BeamError::Shape { .. }), "{error}");
    }
    let (small, large) = (screw(1).assemble_banded(), screw(2).assemble_banded());
    for (mass, stiffness) in [
        (&large.mass, &small.stiffness),
        (&small.mass, &large.stiffness),
    ] {
        let (mass, stiffness) = (mass.clone(), stiffness.clone());
        let matrices = BandedMatrices { mass, stiffness };
        for error in [
            matrices.fixed(&[0]).unwrap_err(),
            lowest_modes(&matrices, 1).unwrap_err(),
        ] {
            let text = error.to_string();
            assert!(text.starts_with("stiffness is "), "{text}");
        }
    }
}

#[test]
fn matrices_too_large_to_store_are_refused_by_their_size() {
    let huge = usize::MAX;
    let too_large = |result: Result<(), BeamError>| {
        let text = result.unwrap_err().to_string();
        assert!(text.contains("at most 134217728"), "{text}");
    };
    too_large(SymmetricBanded::zeros(huge, 1).map(|_| ()));
    too_large(SymmetricBanded::zeros(2, huge).map(|_| ()));
    too_large(BandedMatrices::zeros(huge).map(|_| ()));
    too_large(SymmetricBanded::zeros(0, huge).map(|_| ()));
    // Dense, a million elements would need 288 TB.
    let long = screw(Mesh::MAX_ELEMENTS);
    too_large(long.assemble().map(|_| ()));
    let band = SymmetricBanded::zeros(20_000, 1).unwrap();
    too_large(band.to_dense().map(|_| ()));
    let (mass, stiffness) = (band.clone(), band);
    let matrices = BandedMatrices { mass, stiffness };
    too_large(lowest_modes(&matrices, 20_000).map(|_| ()));
}

#[test]
fn entries_that_do_not_exist_are_none() {
    let mut band = SymmetricBanded::zeros(4, 1).unwrap();
    assert_eq!(band.get(3, 2), Some(0.0));
    assert_eq!(band.get(0, 3), Some(0.0));
    assert_eq!(band.get(4, 0), None);
    assert_eq!(band.get(usize::MAX, usize::MAX), None);
    assert!(band.add(usize::MAX, usize::MAX, 1.0).is_err());
    assert!(band.add(0, usize::MAX, 1.0).is_err());
    let empty = SymmetricBanded::zeros(0, 3).unwrap();
    assert_eq!(empty.get(0, 0), None);
    assert_eq!(empty.to_dense().unwrap().len(), 0);
    // A node beyond all meshes has a row beyond all matrices.
    let row = Dof::ThetaZ.at(usize::MAX);
    assert!(screw(1).assemble_banded().fixed(&[row]).is_err());
}

#[test]
fn pencils_without_rows_or_beyond_f64_are_refused() {
    let nothing = BandedMatrices::zeros(0).unwrap();
    let (count, order) = (1, 0);
    let error = BeamError::ModeCount { count, order };
    assert_eq!(lowest_modes(&nothing, 1), Err(error));
    assert!(natural_modes(&DMatrix::zeros(0, 0), &DMatrix::zeros(0, 0)).is_err());
    // Every degree of freedom held.
    let held: Vec<usize> = (0..12).collect();
    let none = screw(1).assemble().unwrap().fixed(&held).unwrap();
    assert!(natural_modes(&none.mass, &none.stiffness).is_err());

    let mut matrices = BandedMatrices::zeros(60).unwrap();
    for row in 0..60 {
        matrices.mass.add(row, row, 1e-300).unwrap();
        matrices.stiffness.add(row, row, 1e300).unwrap();
    }
    assert!(lowest_modes(&matrices, 2).is_err());
    let dense = |m: &SymmetricBanded| m.to_dense().unwrap();
    assert!(natural_modes(&dense(&matrices.mass), &dense(&matrices.stiffness)).is_err());
    for bad in [f64::NAN, f64::INFINITY] {
        let mut m = screw(1).assemble().unwrap();
        m.mass[(0, 0)] = bad;
        let error = natural_modes(&m.mass, &m.stiffness).unwrap_err();
        assert_eq!(error, BeamError::NotFinite { field: "mass" });
    }
}

#[test]
fn places_and_lengths_that_are_no_numbers_give_none() {
    let beam = screw(3);
    assert_eq!(beam.mesh.locate(f64::INFINITY), (2, 1.0));
    assert_eq!(beam.mesh.locate(f64::NEG_INFINITY), (0, 0.0));
    assert!(beam.mesh.locate(f64::NAN).1.is_nan());
    assert!(beam.torsional_compliance_at(f64::NAN).is_nan());
    assert!(beam.shape_function_deficit(f64::NAN).is_nan());
    for length in [0.0, f64::NAN] {
        let k = element::stiffness(&beam.section, &steel(), length);
        let m = element::mass(&beam.section, &steel(), length);
        assert!(k.iter().chain(&m).any(|v| !v.is_finite()), "{length}");
    }
    assert!(element::shear_parameter(&beam.section, &steel(), f64::NAN, 1.0).is_nan());
}

proptest! {
    #[test]
    fn moving_nodes_of_any_length_end_in_a_mesh_or_an_error(
        bits in prop_oneof![1..40_u64, 0..=u64::MAX],
        elements in prop_oneof![Just(0), Just(usize::MAX), 1..60_usize],
        at in 0.0..=1.0_f64,
        fraction in prop_oneof![Just(0.5), Just(f64::MIN_POSITIVE), 1e-6..0.5_f64],
    ) {
        let length = f64::from_bits(bits);
        if let Ok(nut) = MovingNode::at(length, elements, at * length, fraction) {
            prop_assert!((1..elements).contains(&nut.node()));
            prop_assert_eq!(nut.mesh().elements(), elements);
        }
        if let Ok((node, position)) = MovingNode::place(length, elements, at * length, fraction) {
            prop_assert!((1..elements).contains(&node) && (0.0..=length).contains(&position));
        }
    }

    #[test]
    fn pencils_of_any_numbers_end_in_modes_or_an_error(
        numbers in prop::collection::vec((-1..=1_i32, -300..300_i32), 60),
        count in 1..8_usize,
    ) {
        let mut matrices = BandedMatrices::zeros(50).unwrap();
        for (i, (sign, exponent)) in numbers.iter().enumerate() {
            let value = f64::from(*sign) * 10_f64.powi(*exponent);
            let (row, column) = ((i * 7) % 50, (i * 7 + i % 5) % 50);
            if row.abs_diff(column) < 12 {
                matrices.stiffness.add(row, column, value).unwrap();
            }
            matrices.mass.add(i % 50, i % 50, value.abs() + 1e-200).unwrap();
        }
        if let Ok(modes) = lowest_modes(&matrices, count) {
            prop_assert_eq!(modes.frequencies_rad_s.len(), count);
            prop_assert!(modes.frequencies_rad_s.iter().all(|w| w.is_finite()));
        }
    }
}
