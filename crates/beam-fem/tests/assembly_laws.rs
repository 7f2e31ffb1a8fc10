//! Laws that hold for any beam and any mesh.

use beam_fem::{Beam, CrossSection, Dof, Material, Mesh, MovingNode, natural_modes};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

fn material() -> impl Strategy<Value = Material> {
    (50e9..400e9f64, 0.0..0.45f64, 1000.0..20_000.0f64)
        .prop_map(|(e, nu, rho)| Material::new(e, nu, rho).unwrap())
}

/// Sections with unequal I_y and I_z, radii of gyration 2 to 60 mm.
fn section() -> impl Strategy<Value = CrossSection> {
    (1e-4..1e-2f64, 2e-3..6e-2f64, 2e-3..6e-2f64, 0.3..1.0f64).prop_map(|(a, ry, rz, kappa)| {
        let (iy, iz) = (a * ry * ry, a * rz * rz);
        CrossSection::new(a, iy, iz, 0.7 * (iy + iz), kappa).unwrap()
    })
}

/// One to eight elements whose lengths differ by up to a factor of 20.
fn mesh() -> impl Strategy<Value = Mesh> {
    prop::collection::vec(0.05..1.0f64, 1..9).prop_map(|lengths| {
        let mut nodes = vec![0.0];
        for l in lengths {
            nodes.push(nodes[nodes.len() - 1] + 0.3 * l);
        }
        Mesh::from_nodes(nodes).unwrap()
    })
}

fn beam() -> impl Strategy<Value = Beam> {
    (section(), material(), mesh()).prop_map(|(s, m, mesh)| Beam::new(s, m, mesh))
}

/// Translation along, or small rotation about, axis x, y or z (0, 1, 2).
fn rigid_body(mesh: &Mesh) -> [DVector<f64>; 6] {
    let mut motions: [_; 6] = std::array::from_fn(|_| DVector::zeros(6 * mesh.nodes().len()));
    for (node, &x) in mesh.nodes().iter().enumerate() {
        for (motion, dof) in Dof::ALL.into_iter().enumerate() {
            motions[motion][dof.at(node)] = 1.0;
        }
        motions[4][Dof::W.at(node)] = -x;
        motions[5][Dof::V.at(node)] = x;
    }
    motions
}

/// The rigid body's own 6 × 6 mass matrix about the driven end.
fn rigid_mass(beam: &Beam) -> [f64; 6] {
    let (s, l) = (&beam.section, beam.mesh.length());
    let line = beam.material.density() * s.area() * l;
    let about = |i: f64| line * l * l / 3.0 + beam.material.density() * i * l;
    let polar = beam.material.density() * (s.second_moment_y() + s.second_moment_z()) * l;
    let (y, z) = (about(s.second_moment_y()), about(s.second_moment_z()));
    [line, line, line, polar, y, z]
}

fn check_rigid_body(beam: &Beam) -> Result<(), TestCaseError> {
    let m = beam.assemble().unwrap();
    let (size, expected) = (m.stiffness.map(f64::abs), rigid_mass(beam));
    let motions = rigid_body(&beam.mesh);
    for (motion, exact) in motions.iter().zip(expected) {
        let inertia = motion.dot(&(&m.mass * motion));
        // Rounding of a sum of some hundred terms of like size: 6.7e-16 measured.
        prop_assert!((inertia / exact - 1.0).abs() < 5e-15);
        let absolute = motion.map(f64::abs);
        let energy = motion.dot(&(&m.stiffness * motion)).abs();
        // Zero to rounding of the terms that cancel: 9.7e-17 measured.
        let terms = absolute.dot(&(&size * &absolute));
        prop_assert!(energy <= 1e-15 * terms, "{energy} of {terms}");
    }
    // The coupling of sliding and turning: the first moment of the mass.
    let moment = motions[1].dot(&(&m.mass * &motions[5]));
    let exact = 0.5 * expected[0] * beam.mesh.length();
    // 5.6e-16 measured.
    prop_assert!((moment / exact - 1.0).abs() < 5e-15);
    Ok(())
}

/// Scaled to unit diagonal, so that metres and radians do not set the
/// eigenvalues.
fn scaled(m: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| {
        m[(i, j)] / (m[(i, i)] * m[(j, j)]).sqrt()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn symmetric_with_definite_mass_and_six_rigid_motions(beam in beam()) {
        let m = beam.assemble().unwrap();
        prop_assert_eq!(&m.mass, &m.mass.transpose());
        prop_assert_eq!(&m.stiffness, &m.stiffness.transpose());
        // 0.039 is the least measured.
        prop_assert!(scaled(&m.mass).symmetric_eigenvalues().min() > 0.02);
        let mut k: Vec<f64> = scaled(&m.stiffness).symmetric_eigenvalues().iter().copied().collect();
        k.sort_by(f64::total_cmp);
        // Unit diagonal and some 50 rows: rounding is 1.8e-15 as measured over 600
        // draws, the softest elastic shape 3.8e-4.
        prop_assert!(k[..6].iter().all(|v| v.abs() < 1e-14), "{:?}", &k[..7]);
        prop_assert!(k[6] > 5e-5, "{:?}", &k[..7]);
        let modes = natural_modes(&m.mass, &m.stiffness).unwrap();
        let rigid = modes.frequencies_rad_s.iter().filter(|w| **w == 0.0).count();
        prop_assert_eq!(rigid, 6);
    }

    #[test]
    fn mass_and_rotary_inertia_do_not_depend_on_the_mesh(beam in beam()) {
        check_rigid_body(&beam)?;
    }

    #[test]
    fn nor_on_where_the_nut_is(
        s in section(), mat in material(), elements in 2..9usize, at in 0.0..=1.0f64,
    ) {
        let mesh = MovingNode::at(1.5, elements, 1.5 * at, MovingNode::MIN_FRACTION).unwrap().mesh().clone();
        check_rigid_body(&Beam::new(s, mat, mesh))?;
    }

    #[test]
    fn torsion_and_banded_equal_the_full_matrices(beam in beam()) {
        let full = beam.assemble().unwrap();
        let (mass, stiffness) = beam.torsion();
        for (t, m) in [(&mass, &full.mass), (&stiffness, &full.stiffness)] {
            for i in 0..beam.mesh.nodes().len() {
                let row = Dof::ThetaX.at(i);
                prop_assert_eq!(t.diagonal[i], m[(row, row)]);
                if i < beam.mesh.elements() {
                    prop_assert_eq!(t.off_diagonal[i], m[(row, Dof::ThetaX.at(i + 1))]);
                }
            }
        }
        let mut banded = beam.assemble_banded();
        prop_assert_eq!(&banded.mass.to_dense().unwrap(), &full.mass);
        prop_assert_eq!(&banded.stiffness.to_dense().unwrap(), &full.stiffness);
        let before = banded.clone();
        beam.assemble_banded_into(&mut banded).unwrap();
        prop_assert_eq!(before, banded);
    }

    #[test]
    fn shapes_are_mass_normalised_and_solve_the_problem(beam in beam()) {
        let m = beam.assemble().unwrap();
        let modes = natural_modes(&m.mass, &m.stiffness).unwrap();
        let identity = modes.shapes.transpose() * &m.mass * &modes.shapes;
        let order = beam.order();
        // 5.1e-15 measured.
        prop_assert!((identity - DMatrix::identity(order, order)).amax() < 5e-14);
        let squares = DVector::from_iterator(order, modes.frequencies_rad_s.iter().map(|w| w * w));
        let energy = modes.shapes.transpose() * &m.stiffness * &modes.shapes;
        let off = energy - DMatrix::from_diagonal(&squares);
        // Relative to the highest eigenvalue, the backward error of a dense solver:
        // 3.3e-15 measured.
        prop_assert!(off.amax() < 3e-14 * squares.max());
    }
}
