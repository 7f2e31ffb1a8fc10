//! The nut on its way along the screw.

use beam_fem::{
    Beam, CrossSection, Material, Mesh, MovingNode, Tridiagonal, lowest_modes, natural_modes,
};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const LENGTH: f64 = 1.5;
const FRACTION: f64 = MovingNode::MIN_FRACTION;

fn screw(mesh: Mesh) -> Beam {
    let steel = Material::new(206e9, 0.3, 7850.0).unwrap();
    let section = CrossSection::solid_circle(0.04, &steel).unwrap();
    Beam::new(section, steel, mesh)
}

/// G J of the screw, N·m².
fn twist_stiffness() -> f64 {
    206e9 / 2.6 * std::f64::consts::PI * 0.04_f64.powi(4) / 32.0
}

fn moving(elements: usize, x: f64) -> MovingNode {
    MovingNode::at(LENGTH, elements, x, FRACTION).unwrap()
}

#[test]
fn the_papers_example_inside_an_element() {
    // x = 0.60 + 0.05 in the fifth of ten: x_R = 50 mm, the next 250 mm.
    let nut = moving(10, 0.65);
    assert_eq!(nut.node(), 5);
    let lengths: Vec<f64> = nut.mesh().lengths().collect();
    for (i, expected) in [(3, 0.15), (4, 0.05), (5, 0.25), (6, 0.15)] {
        assert!((lengths[i] - expected).abs() < 5e-16, "{i} {}", lengths[i]);
    }
    // Last element: node N − 1 moves, the end stays.
    let nut = moving(10, 1.40);
    assert_eq!(nut.node(), 9);
    let lengths: Vec<f64> = nut.mesh().lengths().collect();
    assert!((lengths[8] - 0.20).abs() < 5e-16 && (lengths[9] - 0.10).abs() < 5e-16);
    // The hand-over waits until the new element has its shortest length.
    let wait = FRACTION * 0.15;
    assert_eq!(moving(10, 0.60).node(), 4);
    assert_eq!(moving(10, 0.60 + 0.9 * wait).node(), 4);
    assert_eq!(moving(10, 0.60 + 1.1 * wait).node(), 5);
}

proptest! {
    #[test]
    fn any_position_gives_a_mesh_with_the_nut_on_a_node(
        elements in 2..40usize, at in 0.0..=1.0f64, fraction in 1e-6..0.5f64,
    ) {
        let x = LENGTH * at;
        let nut = MovingNode::at(LENGTH, elements, x, fraction).unwrap();
        let h = LENGTH / elements as f64;
        prop_assert_eq!(nut.mesh().elements(), elements);
        prop_assert_eq!(nut.mesh().length(), LENGTH);
        prop_assert!((1..elements).contains(&nut.node()));
        let shortest = nut.mesh().lengths().fold(f64::INFINITY, f64::min);
        // But for the rounding of two coordinates and of their difference.
        let rounding = 2.0 * f64::EPSILON * LENGTH;
        prop_assert!(shortest >= fraction * h - rounding);
        let end = fraction * h;
        if (end..=LENGTH - end).contains(&x) {
            prop_assert_eq!(nut.position(), x);
        } else {
            prop_assert!((nut.position() - x).abs() <= end + rounding);
        }
    }

    #[test]
    fn static_compliance_at_the_moving_node_is_exact(elements in 2..30usize, at in 0.001..0.999f64) {
        let x = LENGTH * at;
        let nut = moving(elements, x);
        let compliance = screw(nut.mesh().clone()).torsional_compliance_at_node(nut.node()).unwrap();
        // x / GJ: hence continuous in x, boundaries included. A short element
        // is 10³ times stiffer than the others, and so is its rounding beside
        // them: 10³ × 2⁻⁵² × N is 7e-12 at most, 1.2e-13 as measured.
        let exact = nut.position() / twist_stiffness();
        prop_assert!((compliance / exact - 1.0).abs() < 2e-12);
    }

    #[test]
    fn shape_functions_lack_what_is_stated(elements in 1..30usize, at in 0.001..1.0f64) {
        let beam = screw(Mesh::uniform(LENGTH, elements).unwrap());
        let x = LENGTH * at;
        let found = beam.torsional_compliance_at(x) + beam.shape_function_deficit(x);
        // 2.5e-14 measured: rounding of a sum of N terms.
        prop_assert!((found * twist_stiffness() / x - 1.0).abs() < 2e-13);
    }

    #[test]
    fn locating_is_continuous_and_inverts(elements in 1..30usize, at in -0.1..1.1f64) {
        let mesh = Mesh::uniform(LENGTH, elements).unwrap();
        let x = LENGTH * at;
        let (element, xi) = mesh.locate(x);
        let (a, b) = (mesh.nodes()[element], mesh.nodes()[element + 1]);
        prop_assert!((a + xi * (b - a) - x.clamp(0.0, LENGTH)).abs() < f64::EPSILON * LENGTH);
    }
}

#[test]
fn compliance_has_no_jump_at_any_boundary() {
    let step = 1e-9;
    for boundary in 1..10 {
        // Both at the boundary itself and where the moving node hands over.
        for shift in [0.0, FRACTION] {
            let x = LENGTH * (boundary as f64 + shift) / 10.0;
            if x > LENGTH * (1.0 - FRACTION / 10.0) {
                continue;
            }
            let on_node = |x: f64| {
                let nut = moving(10, x);
                screw(nut.mesh().clone())
                    .torsional_compliance_at_node(nut.node())
                    .unwrap()
            };
            let fixed = screw(Mesh::uniform(LENGTH, 10).unwrap());
            let on_shape = |x: f64| fixed.torsional_compliance_at(x);
            for compliance in [&on_node as &dyn Fn(f64) -> f64, &on_shape] {
                let jump = (compliance(x + step) - compliance(x - step)).abs();
                // Over two steps at a slope of 1/GJ: 2.00009 steps as measured.
                assert!(jump < 2.001 * step / twist_stiffness(), "{x} {jump}");
            }
        }
    }
}

/// Elastic frequencies of a free screw on a mesh, rad/s.
type Frequencies = fn(Mesh) -> Vec<f64>;

fn dense(t: &Tridiagonal) -> DMatrix<f64> {
    DMatrix::from_fn(t.diagonal.len(), t.diagonal.len(), |i, j| {
        match i.abs_diff(j) {
            0 => t.diagonal[i],
            1 => t.off_diagonal[i.min(j)],
            _ => 0.0,
        }
    })
}

/// Lowest six elastic frequencies of the free screw.
fn all_directions(mesh: Mesh) -> Vec<f64> {
    let modes = lowest_modes(&screw(mesh).assemble_banded(), 12).unwrap();
    modes.frequencies_rad_s[6..].to_vec()
}

/// Lowest three elastic frequencies of twist.
fn twist(mesh: Mesh) -> Vec<f64> {
    let (mass, stiffness) = screw(mesh).torsion();
    let modes = natural_modes(&dense(&mass), &dense(&stiffness)).unwrap();
    modes.frequencies_rad_s[1..4].to_vec()
}

/// Largest relative change of frequencies where the moving node hands over,
/// near x = 0.6 m.
fn frequency_jump(elements: usize, frequencies: Frequencies) -> f64 {
    let x = 0.6 + FRACTION * LENGTH / elements as f64;
    let [before, after] = [x - 1e-9, x + 1e-9].map(|x| moving(elements, x));
    assert_ne!(before.node(), after.node());
    let (before, after) = (
        frequencies(before.mesh().clone()),
        frequencies(after.mesh().clone()),
    );
    let changes = before.iter().zip(&after).map(|(b, a)| (a / b - 1.0).abs());
    changes.fold(0.0, f64::max)
}

#[test]
fn frequencies_jump_by_less_than_the_mesh_error_and_less_with_every_refinement() {
    // The mesh differs on the two sides of a hand-over, so frequencies agree
    // to the discretisation error only: h² at worst, a ratio of 4 per halving
    // (3.5 for meshes that are not yet fine). The bound at N = 10 is the error
    // of a mesh whose elements are all as long as the longest here, 2h:
    // (βh)⁴/1440 of the third bending mode, (nπ/N)²/24 of the third in twist.
    let bending = (10.9956_f64 / 5.0).powi(4) / 1440.0;
    let twisting = (3.0 * std::f64::consts::PI / 5.0).powi(2) / 24.0;
    let kinds: [(Frequencies, f64); 2] = [(all_directions, bending), (twist, twisting)];
    for (frequencies, bound) in kinds {
        let jumps = [10, 20, 40].map(|elements| frequency_jump(elements, frequencies));
        assert!(jumps[0] < bound, "{jumps:?} {bound}");
        assert!(
            jumps[0] / jumps[1] > 3.5 && jumps[1] / jumps[2] > 3.5,
            "{jumps:?}"
        );
    }
}

#[test]
fn with_shape_functions_frequencies_have_no_jump_at_all() {
    // The twisting screw with a nut's spring on it, of 100 N·m/rad to
    // 10⁵ N·m/rad, on a fixed mesh.
    let beam = screw(Mesh::uniform(LENGTH, 10).unwrap());
    let (mass, stiffness) = beam.torsion();
    let at = |x: f64, spring: f64| {
        let (element, xi) = beam.mesh.locate(x);
        let mut n = DVector::zeros(11);
        n[element] = 1.0 - xi;
        n[element + 1] = xi;
        let held = dense(&stiffness) + spring * &n * n.transpose();
        natural_modes(&dense(&mass), &held)
            .unwrap()
            .frequencies_rad_s
    };
    for boundary in 1..10 {
        let x = LENGTH * f64::from(boundary) / 10.0;
        for spring in [1e2, 1e5] {
            // 2 nm apart: the nut moves by 1.3e-8 elements; 2.2e-9 measured.
            for (a, b) in at(x - 1e-9, spring).iter().zip(at(x + 1e-9, spring)) {
                assert!((a / b - 1.0).abs() < 1e-8, "{x} {a} {b}");
            }
        }
    }
}

#[test]
fn within_an_element_frequencies_move_smoothly_with_the_node() {
    // A change of 2 nm in x changes no frequency by more than some 2e-9 / h, 1.3e-8:
    // 1.7e-10 measured.
    let at = |x: f64| {
        let modes =
            lowest_modes(&screw(moving(10, x).mesh().clone()).assemble_banded(), 12).unwrap();
        modes.frequencies_rad_s[6..].to_vec()
    };
    for x in [0.2, 0.6, 0.61, 0.74, 0.75, 1.35, 1.42] {
        for (a, b) in at(x - 1e-9).iter().zip(at(x + 1e-9)) {
            assert!((a / b - 1.0).abs() < 1e-9, "{x}");
        }
    }
}
