//! What has a negative energy is refused, what is rigid is a null vector, and what
//! rounding hides is refused and never a mode of 0 Hz: whatever number of modes is asked
//! for, by either solver.

use beam_fem::{
    BandedMatrices, Beam, BeamError, CrossSection, Dof, Material, Mesh, Modes, lowest_modes,
    natural_modes,
};
use nalgebra::DMatrix;
use std::f64::consts::PI;

fn steel(modulus: f64) -> Material {
    Material::new(modulus, 0.3, 7850.0).unwrap()
}

/// 40 mm × 1.5 m.
fn screw(elements: usize) -> Beam {
    let section = CrossSection::solid_circle(0.04, &steel(206e9)).unwrap();
    let mesh = Mesh::uniform(1.5, elements).unwrap();
    Beam::new(section, steel(206e9), mesh)
}

/// 20 mm × 1 m.
fn rod(nodes: &[f64]) -> Result<Beam, BeamError> {
    let section = CrossSection::solid_circle(0.02, &steel(210e9))?;
    Ok(Beam::new(
        section,
        steel(210e9),
        Mesh::from_nodes(nodes.to_vec())?,
    ))
}

fn held(beam: &Beam) -> BandedMatrices {
    let first = Dof::ALL.map(|dof| dof.at(0));
    beam.assemble_banded().fixed(&first).unwrap()
}

fn dense(m: &BandedMatrices) -> Result<Modes, BeamError> {
    natural_modes(&m.mass.to_dense()?, &m.stiffness.to_dense()?)
}

/// First frequency of a slender cantilever of 20 mm × 1 m, Hz: β = 1.8751 of Euler and
/// Bernoulli; shear and rotary inertia take 1e-3 of it.
fn cantilever_hz() -> f64 {
    let stiff = 210e9 * 0.005_f64.powi(2) / 7850.0;
    1.875_104_068_711_961_f64.powi(2) * stiff.sqrt() / (2.0 * PI)
}

#[test]
fn a_negative_stiffness_is_refused_whatever_number_of_modes_is_asked_for() {
    for elements in [1, 3, 10, 100, 1000] {
        for (node, dof) in [(0, Dof::ThetaX), (elements / 2, Dof::U), (elements, Dof::V)] {
            // In N·m/rad and N/m: as soft as a hair beside the screw.
            for push in [-5.0, -1e4] {
                let mut pushed = screw(elements).assemble_banded();
                pushed
                    .stiffness
                    .add(dof.at(node), dof.at(node), push)
                    .unwrap();
                for count in [1, 2, 3, 6, 7, 8, 12] {
                    let refused = lowest_modes(&pushed, count);
                    let case = format!("N = {elements}, {dof:?} {push}, {count} modes");
                    assert_eq!(refused, Err(BeamError::StiffnessNegative), "{case}");
                }
                if elements <= 10 {
                    assert_eq!(dense(&pushed), Err(BeamError::StiffnessNegative));
                }
            }
        }
    }
    // A support makes up for it.
    let mut stable = held(&screw(100));
    stable.stiffness.add(3, 3, -5.0).unwrap();
    assert!(lowest_modes(&stable, 2).unwrap().frequencies_rad_s[0] > 70.0);
}

/// Largest |Kφ|_i beside Σ_j |K_ij| |φ_j| of the modes of 0 Hz, and their number.
fn null_vectors(m: &BandedMatrices, modes: &Modes) -> (usize, f64) {
    let stiffness = m.stiffness.to_dense().unwrap();
    let size = stiffness.map(f64::abs);
    let rigid = modes
        .frequencies_rad_s
        .iter()
        .filter(|w| **w == 0.0)
        .count();
    let shapes = modes.shapes.columns(0, rigid).into_owned();
    let (force, terms) = (&stiffness * &shapes, size * shapes.map(f64::abs));
    // Against the largest terms of each direction, as some nodes of a shape stand still.
    let worst = |mode: usize, dof: usize| {
        let rows = || (dof..force.nrows()).step_by(6);
        let most = rows().map(|row| terms[(row, mode)]).fold(0.0, f64::max);
        let left = rows()
            .map(|row| force[(row, mode)].abs())
            .fold(0.0, f64::max);
        if most > 0.0 { left / most } else { 0.0 }
    };
    let all = (0..rigid).flat_map(|mode| (0..6).map(move |dof| worst(mode, dof)));
    (rigid, all.fold(0.0, f64::max))
}

#[test]
fn rigid_modes_are_null_vectors() {
    for elements in [2, 10, 100, 400] {
        let free = screw(elements).assemble_banded();
        for count in [1, 6, 7, 8, 14] {
            let modes = lowest_modes(&free, count).unwrap();
            let (rigid, left) = null_vectors(&free, &modes);
            assert_eq!(rigid, count.min(6), "N = {elements}, {count} modes");
            println!("banded, N = {elements}, {count} modes: {left:.1e}");
            // 2.2e-12 measured, of a Krylov space; 3e-16 of a small part.
            assert!(left < 2e-11, "N = {elements}, {count} modes: {left:e}");
        }
        if elements <= 10 {
            let (rigid, left) = null_vectors(&free, &dense(&free).unwrap());
            println!("dense, N = {elements}: {left:.1e}");
            assert_eq!(rigid, 6);
            // 9.0e-14 measured: the highest mode is that much stiffer than the lowest.
            assert!(left < 1e-12, "{left:e}");
        }
    }
}

#[test]
fn nodes_apart_by_rounding_are_refused_by_name() {
    let text = rod(&[0.0, 0.3, 0.1 + 0.2, 1.0]).unwrap_err().to_string();
    assert!(
        text.starts_with("nodes 1 and 2, at 0.3 m and 0.30000000000000004 m"),
        "{text}"
    );
    assert!(text.contains("at least 0.0000000001 m apart"), "{text}");
    assert!(Mesh::from_nodes(vec![0.0, 1e-3, 2e-3]).is_ok());
    assert!(Mesh::from_nodes(vec![0.0, 1e-11, 1.0]).is_err());
    assert!(beam_fem::MovingNode::at(1.5, 10, 0.7, 1e-10).is_err());
    let least = beam_fem::MovingNode::at(1.5, 10, 1.5, 2e-9).unwrap();
    assert!(least.mesh().lengths().all(|length| length > 1.5e-10));
}

/// Two nodes closer and closer: the frequency of the beam, or a refusal, and nothing
/// else, by either solver and for any number of modes.
#[test]
fn a_short_element_hides_no_mode() {
    let exact = cantilever_hz();
    let mut answers = 0;
    for step in 0..40 {
        let gap = 0.1 * 10_f64.powf(-0.25 * f64::from(step));
        let Ok(beam) = rod(&[0.0, 0.3, 0.3 + gap, 1.0]) else {
            assert!(gap < 1e-10);
            continue;
        };
        let matrices = held(&beam);
        let asked = [1, 2, 6, 18].map(|count| lowest_modes(&matrices, count));
        for modes in asked.into_iter().chain([dense(&matrices)]) {
            match modes {
                Ok(modes) => {
                    let hz = modes.frequencies_hz();
                    println!("{gap:.1e}: {:.6} of {}", hz[0], hz.len());
                    let first = hz[0];
                    // 0.05 to 0.17 % above, as two elements are; what rounding does is 1e-5.
                    assert!(
                        first > 0.998 * exact && first < 1.005 * exact,
                        "{gap:e}: {hz:?}"
                    );
                    answers += 1;
                }
                Err(BeamError::Unresolved { stiffness, .. }) => {
                    assert!(gap < 1e-6, "{gap:e}");
                    assert!(stiffness > 1e10, "{stiffness:e}");
                }
                Err(other) => panic!("{gap:e}: {other}"),
            }
        }
    }
    assert!(answers > 80, "{answers}");
}

/// Supports made of springs far stiffer than the beam are supports: a spring of 1e12 is
/// soft by 3.8e-7 of the second frequency, a stiffer one by as much less.
#[test]
fn stiff_springs_hold_as_supports_do() {
    let fixed = held(&screw(40));
    let exact = lowest_modes(&fixed, 4).unwrap().frequencies_hz();
    for spring in [1e12, 1e15, 1e18, 1e21] {
        // Rounding: 1e-11 measured.
        let most = 5e-7 * 1e12 / spring + 1e-10;
        let mut sprung = screw(40).assemble_banded();
        for dof in Dof::ALL {
            sprung.stiffness.add(dof.at(0), dof.at(0), spring).unwrap();
        }
        for count in [1, 4, 12, 60] {
            let found = lowest_modes(&sprung, count).unwrap().frequencies_hz();
            for (f, e) in found.iter().zip(&exact) {
                println!("{spring:e} {count}: {:.1e}", f / e - 1.0);
                assert!(
                    (f / e - 1.0).abs() < 1e-5,
                    "{spring:e} {count}: {found:?} {exact:?}"
                );
            }
        }
        let found = dense(&sprung).unwrap().frequencies_hz();
        for (f, e) in found.iter().zip(&exact) {
            println!("{spring:e} dense: {:.1e}", f / e - 1.0);
            assert!((f / e - 1.0).abs() < most, "{spring:e} dense: {found:?}");
        }
    }
}

/// A spring of `size` on a free shaft makes of one rigid motion a mode √(size/inertia).
/// Softer ones are refused and, where they are rounding, none: 1e-4 of the shaft's first
/// frequency, 510 rad/s.
#[test]
fn a_soft_spring_is_a_mode_until_it_is_refused() {
    let inertia = 7850.0 * PI * 0.02_f64.powi(2) * 1.5;
    let mut refused = 0;
    for exponent in -12..6 {
        let spring = 10_f64.powi(exponent);
        let mut sprung = screw(100).assemble_banded();
        sprung
            .stiffness
            .add(Dof::U.at(50), Dof::U.at(50), spring)
            .unwrap();
        match lowest_modes(&sprung, 6) {
            Err(BeamError::Unresolved { .. }) => refused += 1,
            Err(other) => panic!("{other}"),
            Ok(modes) => {
                let found = modes.frequencies_rad_s[5];
                let exact = (spring / inertia).sqrt();
                println!("{spring:e}: {:.1e}", found / exact - 1.0);
                let hidden = found == 0.0 && exact < 0.05;
                assert!(
                    hidden || (found / exact - 1.0).abs() < 5e-3,
                    "{spring:e}: {found}"
                );
            }
        }
    }
    assert!(refused > 0);
}

/// Elements so many that they hide the beam: as the closed form, or refused.
#[test]
fn a_mesh_too_fine_is_refused() {
    for elements in [1000, 4000, 16_000, 64_000] {
        let pins = [
            Dof::U.at(0),
            Dof::ThetaX.at(0),
            Dof::V.at(0),
            Dof::W.at(0),
            Dof::V.at(elements),
            Dof::W.at(elements),
        ];
        // As slender as a wire, whose elements are longer than it is thick.
        for diameter in [0.04, 1e-4] {
            let section = CrossSection::solid_circle(diameter, &steel(206e9)).unwrap();
            let mesh = Mesh::uniform(1.5, elements).unwrap();
            let wire = Beam::new(section, steel(206e9), mesh);
            let matrices = wire.assemble_banded().fixed(&pins).unwrap();
            let bending = (PI / 1.5).powi(2) * 0.25 * diameter * (206e9 / 7850.0_f64).sqrt();
            match lowest_modes(&matrices, 2) {
                Err(BeamError::Unresolved { .. }) => println!("{elements}, {diameter}: refused"),
                Err(other) => panic!("{other}"),
                Ok(modes) => {
                    let off = modes.frequencies_rad_s[0] / bending - 1.0;
                    println!("{elements}, {diameter}: {off:.2e}");
                    // Shear and rotary inertia take 2.2e-3 of the thick one.
                    assert!(off.abs() < 4e-3, "{elements}, {diameter}: {off:e}");
                }
            }
        }
    }
}

/// The lowest modes do not depend on how many others are asked for.
#[test]
fn more_modes_change_none() {
    let beam = rod(&[0.0, 0.3, 0.3 + 1e-5, 0.6, 1.0]).unwrap();
    let matrices = held(&beam);
    let all = lowest_modes(&matrices, 24).unwrap();
    let by_dense = dense(&matrices).unwrap();
    for count in 1..24 {
        let some = lowest_modes(&matrices, count).unwrap();
        let pairs = some.frequencies_rad_s.iter().zip(&all.frequencies_rad_s);
        for ((a, b), c) in pairs.zip(&by_dense.frequencies_rad_s) {
            assert!((a / b - 1.0).abs() < 1e-6, "{count}: {a} {b}");
            assert!((a / c - 1.0).abs() < 1e-6, "{count}: {a} {c}");
        }
    }
    let gram = all.shapes.transpose() * matrices.mass.to_dense().unwrap() * &all.shapes;
    let off = (gram - DMatrix::identity(24, 24)).amax();
    println!("orthonormal to {off:.1e}");
    assert!(off < 1e-6, "{off:e}");
}
