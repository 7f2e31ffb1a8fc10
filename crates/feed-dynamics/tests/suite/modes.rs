//! Natural modes against closed forms and against x.

use beam_fem::{CrossSection, Material};
use feed_dynamics::{DriveParameters, FeedDrive, NutCoupling};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use crate::reference::Reference;
use crate::{COUPLINGS, drive, paper, relative};

#[test]
fn stiff_chain_leaves_two_masses() {
    // Screw and couplings 10⁴ times as stiff: J on one side of the nut, m on
    // the other, ω² = k (1/m + r²/J). The chain's own compliance is then
    // 1e-5 of the nut's, the fixed-free wind-up included: 3.2e-6 as measured.
    let steel = Material::new(206e13, 0.3, 7850.0).unwrap();
    let drive = FeedDrive::new(DriveParameters {
        section: CrossSection::solid_circle(0.040, &steel).unwrap(),
        material: steel,
        motor_coupling_stiffness: 2800e4,
        screw_coupling_stiffness: 2800e4,
        ..paper()
    })
    .unwrap();
    let p = drive.parameters();
    let r = drive.travel_per_radian();
    let square = p.nut_stiffness * (1.0 / p.table_mass + r * r / drive.rotating_inertia());
    for coupling in COUPLINGS {
        for x in [0.05, 0.33, 0.68, 1.13, 1.45] {
            let first = drive.modes(x, coupling).unwrap().frequencies_rad_s[1];
            assert!(relative(first, square.sqrt()) < 2e-5, "{first} at {x}");
        }
    }
}

#[test]
fn free_chain_approaches_the_rod() {
    // With motor, sensor and table all but gone the chain is a free-free rod:
    // ω_n = n π / L √(G/ρ). Linear elements with consistent mass meet it from
    // above with a relative error of (n π / N)²/24: second order.
    let frequency = |elements| {
        let drive = FeedDrive::new(DriveParameters {
            elements,
            motor_inertia: 1e-12,
            sensor_inertia: 1e-12,
            table_mass: 1e-6,
            nut_stiffness: 1e-3,
            motor_coupling_stiffness: 1e2,
            screw_coupling_stiffness: 1e2,
            ..paper()
        })
        .unwrap();
        let modes = drive.modes(0.7, NutCoupling::ShapeFunctions).unwrap();
        // Below the rod's first lie the rigid motion and the table on its soft nut.
        modes.frequencies_rad_s[2]
    };
    let shear = 206e9 / 2.6;
    let exact = std::f64::consts::PI / 1.5 * (shear / 7850.0_f64).sqrt();
    let errors = [10, 20, 40].map(|n| frequency(n) / exact - 1.0);
    for (error, n) in errors.iter().zip([10.0, 20.0, 40.0]) {
        let expected = (std::f64::consts::PI / n).powi(2) / 24.0;
        // 1.2e-3 as measured: the next term of the series.
        assert!(
            relative(*error, expected) < 0.01,
            "N = {n}: {error:e} {expected:e}"
        );
    }
}

#[test]
fn shapes_are_mass_normalised() {
    let drive = drive();
    for coupling in COUPLINGS {
        let m = drive.matrices(0.43, coupling).unwrap();
        let modes = drive.modes(0.43, coupling).unwrap();
        let n = drive.coordinates();
        let mass = modes.shapes.transpose() * &m.mass * &modes.shapes;
        // 1.3e-15 and 1.1e-15 as measured.
        assert!((mass - DMatrix::identity(n, n)).abs().max() < 1e-14);
        let squares = DVector::from_iterator(n, modes.frequencies_rad_s.iter().map(|w| w * w));
        let energy = modes.shapes.transpose() * &m.stiffness * &modes.shapes;
        let largest = squares.max();
        assert!((energy - DMatrix::from_diagonal(&squares)).abs().max() < 1e-14 * largest);
        assert_eq!(modes.frequencies_rad_s[0], 0.0);
    }
}

#[test]
fn frequencies_and_damping_are_those_of_the_first_order_system() {
    // Roots −ζω ± iω√(1 − ζ²) of M λ² + βK λ + K, the matrices assembled here.
    for coupling in COUPLINGS {
        let [mass, stiffness] = Reference::at_rest(coupling, 0.43).dense();
        let n = mass.nrows();
        let inertance = mass.try_inverse().unwrap() * stiffness;
        let mut system = DMatrix::zeros(2 * n, 2 * n);
        system.view_mut((0, n), (n, n)).fill_with_identity();
        system.view_mut((n, 0), (n, n)).copy_from(&-&inertance);
        system
            .view_mut((n, n), (n, n))
            .copy_from(&(inertance * -1e-5));
        let mut roots: Vec<_> = system.complex_eigenvalues().iter().copied().collect();
        roots.retain(|root| root.im > 1.0);
        roots.sort_by(|a, b| a.norm().total_cmp(&b.norm()));

        let modes = drive().modes(0.43, coupling).unwrap();
        assert_eq!(roots.len(), n - 1);
        let mut most = [0.0_f64; 2];
        for (i, root) in roots.iter().enumerate() {
            let (w, zeta) = (root.norm(), -root.re / root.norm());
            most[0] = most[0].max(relative(modes.frequencies_rad_s[i + 1], w));
            most[1] = most[1].max(relative(modes.damping_ratios[i + 1], zeta));
        }
        println!("{coupling:?}: ω and ζ off by {most:?}");
        // 1.3e-6 and 4.2e-6: the unsymmetric matrix costs that many digits.
        assert!(most[0] < 1e-5 && most[1] < 3e-5, "{most:?}");
        assert_eq!(modes.damping_ratios[0], 0.0);
    }
}

proptest! {
    /// The nut's shape functions are continuous in x, so every mode is:
    /// ω² moves by less than (∂/∂x) of the nut's term, and a step of a
    /// micrometre anywhere, boundaries included, moves no ω by more than 1e-8.
    #[test]
    fn shape_functions_are_continuous_in_x(x in 0.0..1.5, boundary in 1..10_u32) {
        let drive = drive();
        for at in [x, f64::from(boundary) * 0.15] {
            let frequencies = |x: f64| drive.modes(x.clamp(0.0, 1.5), NutCoupling::ShapeFunctions)
                .unwrap().frequencies_rad_s;
            let (before, after) = (frequencies(at - 5e-7), frequencies(at + 5e-7));
            for (a, b) in before.iter().zip(&after).skip(1) {
                prop_assert!(relative(*a, *b) < 5e-8, "{a} {b} at {at}");
            }
        }
    }
}

#[test]
fn moving_node_jumps_only_where_the_mesh_does() {
    let drive = drive();
    let low = |x: f64, coupling| drive.modes(x, coupling).unwrap().frequencies_rad_s[1..4].to_vec();
    // Where the node is handed over, a thousandth of an element past each
    // boundary, an even mesh becomes one with a double element; the lowest
    // elastic modes feel that by their own discretisation error only.
    let mut largest = [0.0_f64; 3];
    for boundary in 1..9 {
        let at = 0.15 * (f64::from(boundary) + 1e-3);
        let (before, after) = (
            low(at - 1e-7, NutCoupling::MovingNode),
            low(at + 1e-7, NutCoupling::MovingNode),
        );
        for (i, (a, b)) in before.iter().zip(&after).enumerate() {
            largest[i] = largest[i].max(relative(*a, *b));
        }
    }
    println!("jumps of the first three elastic modes: {largest:?}");
    assert!(
        largest[0] < 1e-6 && largest[1] < 1e-4 && largest[2] < 1e-2,
        "{largest:?}"
    );

    // And the two couplings agree on them: 1.6e-4 as measured.
    for i in 0..=60 {
        let x = f64::from(i) * 0.025;
        let pair = COUPLINGS.map(|c| low(x, c));
        assert!(relative(pair[0][0], pair[1][0]) < 1e-3, "{pair:?} at {x}");
    }
}
