//! Input that must be refused, by name and value.

use beam_fem::{Beam, BeamError, Material, Mesh, MovingNode, Section, natural_modes};
use nalgebra::DMatrix;

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
        let message = Section::solid_circle(bad, &steel())
            .unwrap_err()
            .to_string();
        assert!(message.starts_with("diameter = "), "{message}");
        let message = Section::new(1.0, 1.0, bad, 1.0, 1.0)
            .unwrap_err()
            .to_string();
        assert!(message.starts_with("second_moment_z = "), "{message}");
    }
    for bad in [-1.0, 0.51, f64::NAN] {
        let message = Material::new(206e9, bad, 7850.0).unwrap_err().to_string();
        assert!(message.contains("above -1 and at most 0.5"), "{message}");
    }
    // A diameter whose fourth power is lost makes no section.
    assert!(Section::solid_circle(1e-100, &steel()).is_err());
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
    let section = Section::solid_circle(0.04, &steel()).unwrap();
    let beam = Beam::new(section, steel(), Mesh::uniform(1.5, 2).unwrap());
    let m = beam.assemble();
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
