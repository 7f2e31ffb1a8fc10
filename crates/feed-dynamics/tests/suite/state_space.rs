//! State space, mobility, accelerance, and left-handed screws.

use std::sync::Arc;

use beam_fem::natural_modes;
use feed_dynamics::{
    BeltStrands, Coordinate, DriveError, ElasticDrive, ElasticDriveParameters, FeedDrive,
    ImplicitStepper, ModalStepper, NutCoupling, NutErrors, Quantity, Settled, Side, TimeStepper,
};
use nalgebra::{Complex, DMatrix};
use proptest::prelude::*;

use crate::{COUPLINGS, drive};

const QUANTITIES: [Quantity; 3] = [
    Quantity::Displacement,
    Quantity::Speed,
    Quantity::Acceleration,
];

fn belt() -> ElasticDrive {
    ElasticDrive::new(ElasticDriveParameters {
        motor_inertia: 2e-4,
        load_inertia: 12.0,
        travel_per_radian: 0.02,
        stiffness: Arc::new(BeltStrands::new(3e5, 0.15, 1.2).unwrap()),
        stiffness_damping: 2e-5,
    })
    .unwrap()
}

/// What a receptance becomes, from the definitions.
fn expected(receptance: Complex<f64>, quantity: Quantity, w: f64) -> Complex<f64> {
    let rate = Complex::new(0.0, w);
    match quantity {
        Quantity::Displacement => receptance,
        Quantity::Speed => rate * receptance,
        Quantity::Acceleration => rate * rate * receptance,
    }
}

#[test]
fn its_transfer_function_is_the_receptance() {
    // Two routes: the receptance solves n equations with the rigid motion split off, the
    // state space 2n without; what rounding of K costs the latter at 50 rad/s and more.
    let (drive, x) = (drive(), 0.6);
    let places = [Coordinate::Motor, Coordinate::Screw(4), Coordinate::Table];
    let outputs: Vec<_> = places
        .into_iter()
        .flat_map(|place| QUANTITIES.map(|quantity| (place, quantity)))
        .collect();
    let mut worst = 0.0_f64;
    for coupling in COUPLINGS {
        let space = drive.state_space(x, coupling, &places, &outputs).unwrap();
        for w in [50.0, 300.0, 700.0, 2000.0, -300.0] {
            let transfer = space.transfer(w).unwrap();
            for (column, input) in places.into_iter().enumerate() {
                for (row, (output, quantity)) in outputs.iter().enumerate() {
                    let h = drive
                        .receptance(x, coupling, [input, *output], &[w])
                        .unwrap()[0];
                    let exact = expected(h, *quantity, w);
                    worst = worst.max((transfer[(row, column)] - exact).norm() / exact.norm());
                }
            }
        }
    }
    // 3.0e-10 measured.
    assert!(worst < 1e-9, "{worst}");
}

#[test]
fn an_elastic_drive_has_the_same() {
    let (drive, x) = (belt(), 0.3);
    let sides = [Side::Motor, Side::Load];
    let outputs: Vec<_> = sides
        .into_iter()
        .flat_map(|side| QUANTITIES.map(|quantity| (side, quantity)))
        .collect();
    let space = drive.state_space(x, &sides, &outputs).unwrap();
    for w in [1.0, 100.0, 1000.0] {
        let transfer = space.transfer(w).unwrap();
        for (column, input) in sides.into_iter().enumerate() {
            for (row, (output, quantity)) in outputs.iter().enumerate() {
                // In closed form.
                let h = drive.receptance(x, [input, *output], &[w]).unwrap()[0];
                let exact = expected(h, *quantity, w);
                assert!((transfer[(row, column)] - exact).norm() < 1e-9 * exact.norm());
            }
            let load = drive.mobility(x, [input, Side::Load], &[w]).unwrap()[0];
            let h = drive.receptance(x, [input, Side::Load], &[w]).unwrap()[0];
            assert_eq!(load, h * Complex::new(0.0, w));
            let load = drive.accelerance(x, [input, Side::Load], &[w]).unwrap()[0];
            assert_eq!(load, h * Complex::new(-w * w, 0.0));
        }
    }
    assert!(drive.state_space(f64::NAN, &sides, &outputs).is_err());
}

#[test]
fn its_eigenvalues_are_the_damped_modes() {
    // C = βK: λ = −ζω ± iω√(1 − ζ²) with ζ = βω/2, here below 1 for the first modes.
    let drive = drive();
    let coupling = NutCoupling::ShapeFunctions;
    let space = drive.state_space(0.6, coupling, &[], &[]).unwrap();
    // Rates over 10⁴ rad/s in place of rates: the blocks of A, 1 and ω², come closer in
    // size, and the eigenvalues lose less to rounding.
    let n = drive.coordinates();
    let scaled = DMatrix::from_fn(2 * n, 2 * n, |i, j| {
        let scale = |k: usize| if k < n { 1e4 } else { 1.0 };
        space.a[(i, j)] * scale(i) / scale(j)
    });
    let found = scaled.complex_eigenvalues();
    let m = drive.matrices(0.6, coupling).unwrap();
    let modes = natural_modes(&m.mass, &m.stiffness).unwrap();
    for w in &modes.frequencies_rad_s[1..6] {
        let ratio = 0.5 * 1e-5 * w;
        let exact = Complex::new(-ratio * w, w * (1.0 - ratio * ratio).sqrt());
        let nearest = found
            .iter()
            .map(|l| (l - exact).norm())
            .fold(f64::MAX, f64::min);
        // 2.3e-12 measured.
        assert!(nearest < 1e-11 * w, "{w} {nearest}");
    }
    assert_eq!((space.b.ncols(), space.c.nrows()), (0, 0));
}

#[test]
fn mobility_and_accelerance_at_the_ends_of_the_scale() {
    // Low: the whole inertia. Far above all modes: the motor's own.
    let drive = drive();
    let motor = Coordinate::Motor;
    let coupling = NutCoupling::ShapeFunctions;
    let low = drive
        .accelerance(0.6, coupling, [motor, motor], &[1.0])
        .unwrap()[0];
    assert!((low * drive.total_inertia() - 1.0).norm() < 1e-5);
    let slow = drive
        .mobility(0.6, coupling, [motor, motor], &[1.0])
        .unwrap()[0];
    assert!((slow - low / Complex::new(0.0, 1.0)).norm() < 1e-15 * slow.norm());
    let table = Coordinate::Table;
    let high = drive
        .accelerance(0.6, coupling, [table, table], &[1e8])
        .unwrap()[0];
    assert!((high * 515.0 - 1.0).norm() < 1e-4);
}

#[test]
fn bad_questions_are_named() {
    let drive = drive();
    let coupling = NutCoupling::ShapeFunctions;
    let node = drive.state_space(0.6, coupling, &[Coordinate::Screw(11)], &[]);
    assert!(matches!(
        node,
        Err(DriveError::Parameter {
            name: "screw node",
            ..
        })
    ));
    assert!(drive.state_space(1.6, coupling, &[], &[]).is_err());
    let space = drive
        .state_space(
            0.6,
            coupling,
            &[Coordinate::Motor],
            &[(Coordinate::Table, Quantity::Speed)],
        )
        .unwrap();
    assert!(matches!(
        space.transfer(f64::NAN),
        Err(DriveError::Parameter { .. })
    ));
}

/// Table and rotations over 60 steps of 20 µs under a torque and drag.
fn run<S: TimeStepper>(stepper: &S, sign: f64, speed: f64) -> Vec<[f64; 4]> {
    let settled = Settled {
        speed,
        acceleration: 0.0,
        load: 300.0,
    };
    let mut state = stepper.settled(0.6, &settled).unwrap();
    let errors = NutErrors::new(1e-6, 1e-4, 2e-6).unwrap();
    let mut out = Vec::new();
    for step in 0..60 {
        let torque = sign * (3.0 + 10.0 * (0.2 * f64::from(step)).sin());
        let report = stepper.step_through(&mut state, torque, &errors, |t| 300.0 + 500.0 * t.speed);
        assert!(report.load.converged);
        let o = stepper.observe(&state);
        out.push([o.motor_speed, o.displacement, o.speed, o.transmission_force]);
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// A left-handed screw with all torques turned round moves the table as before, the
    /// rotations turned round, to the last bit.
    #[test]
    fn a_left_handed_screw_is_the_mirror(speed in -0.2..0.2_f64) {
        let (right, left): (FeedDrive, _) = (drive(), drive().left_handed());
        prop_assert!(left.is_left_handed() && !right.is_left_handed());
        prop_assert_eq!(left.travel_per_radian(), -right.travel_per_radian());
        prop_assert_eq!(left.total_inertia(), right.total_inertia());
        for coupling in COUPLINGS {
            let pair = |d: &FeedDrive| ImplicitStepper::new(d, coupling, 2e-5).unwrap();
            let (a, b) = (run(&pair(&right), 1.0, speed), run(&pair(&left), -1.0, speed));
            for (x, y) in a.iter().zip(&b) {
                prop_assert_eq!(*x, [-y[0], y[1], y[2], y[3]]);
            }
        }
        let pair = |d: &FeedDrive| ModalStepper::new(d, 2e-5).unwrap();
        let (a, b) = (run(&pair(&right), 1.0, speed), run(&pair(&left), -1.0, speed));
        for (x, y) in a.iter().zip(&b) {
            prop_assert_eq!(*x, [-y[0], y[1], y[2], y[3]]);
        }
    }
}
