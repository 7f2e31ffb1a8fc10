//! The ball screw whose shaft and bearings give way along the axis.

use feed_dynamics::{
    AxialSupport, DriveError, DriveParameters, FeedDrive, ImplicitStepper, ModalStepper, Mounting,
    NutCoupling, Settled, TimeStepper,
};
use std::f64::consts::PI;

use crate::reference::{Acts, Reference};
use crate::stepping::{deviation, second_order, stepped};
use crate::{COUPLINGS, drive, paper, relative};

const BEARING: f64 = 3e8;
/// E A of 40 mm of steel, N.
const RIGIDITY: f64 = 206e9 * PI * 0.02 * 0.02;

fn on_bearings(mounting: Mounting) -> FeedDrive {
    let axial = Some(AxialSupport {
        bearing_stiffness: BEARING,
        mounting,
    });
    FeedDrive::new(DriveParameters { axial, ..paper() }).unwrap()
}

/// Compliance of bearings and shaft by hand, m/N.
fn soft(mounting: Mounting, x: f64) -> f64 {
    let driven = 1.0 / BEARING + x / RIGIDITY;
    match mounting {
        Mounting::FixedFree => driven,
        Mounting::FixedFixed => {
            let far = 1.0 / BEARING + (1.5 - x) / RIGIDITY;
            1.0 / (1.0 / driven + 1.0 / far)
        }
    }
}

const MOUNTINGS: [Mounting; 2] = [Mounting::FixedFree, Mounting::FixedFixed];

/// Wind-up and compression under a kilonewton as seen at the motor, m, which the steps
/// hold within `held` of itself.
fn deflection<S: TimeStepper>(stepper: &S, x: f64, held: f64) -> f64 {
    let motion = Settled {
        load: 1000.0,
        ..Settled::default()
    };
    let torque = stepper.settled_torque(x, &motion);
    let mut state = stepper.settled(x, &motion).unwrap();
    let angle = stepper.observe(&state).motor_angle;
    for _ in 0..200 {
        assert!(stepper.step(&mut state, torque, |_| 1000.0).load.converged);
    }
    let after = stepper.observe(&state).motor_angle;
    assert!(relative(angle, after) < held, "{angle} {after}");
    angle * stepper.travel_per_radian()
}

#[test]
fn the_static_deflection_is_the_load_over_the_stiffness() {
    for mounting in MOUNTINGS {
        let (soft_drive, rigid) = (on_bearings(mounting), drive());
        for x in [0.0, 0.43, 1.2] {
            let by_hand = 1000.0 * soft(mounting, x);
            // The load holds within 2.2e-12; with the shortest element beside the end,
            // rounding of its stiffness drives the axis off by 1.0e-10.
            let modal = |d| deflection(&ModalStepper::new(d, 1e-4).unwrap(), x, 1e-11);
            let off = relative(modal(&soft_drive) - modal(&rigid), by_hand);
            // 5.0e-13 of a sum over modes, 1.3e-15 of one over springs.
            assert!(off < 3e-12, "{mounting:?} {x}: {off:e}");
            for (coupling, held) in COUPLINGS.into_iter().zip([1e-11, 5e-10]) {
                let of = |d| deflection(&ImplicitStepper::new(d, coupling, 1e-4).unwrap(), x, held);
                let off = relative(of(&soft_drive) - of(&rigid), by_hand);
                assert!(off < 8e-15, "{mounting:?} {coupling:?} {x}: {off:e}");
            }
        }
    }
}

#[test]
fn the_stiffness_is_that_of_nut_shaft_and_bearings_in_series() {
    for mounting in MOUNTINGS {
        let drive = on_bearings(mounting);
        for x in [0.0, 0.2, 0.75, 1.5] {
            let k = 1.0 / (1.0 / 7.45e7 + soft(mounting, x));
            assert!(relative(drive.contact_stiffness(x), k) < 1e-15);
            for coupling in COUPLINGS {
                let m = drive.matrices(x, coupling).unwrap();
                let last = drive.coordinates() - 1;
                assert!(relative(m.stiffness[(last, last)], k) < 1e-15);
            }
        }
        // Beyond the screw, as at its end.
        assert_eq!(drive.contact_stiffness(1.7), drive.contact_stiffness(1.5));
    }
    assert_eq!(drive().contact_stiffness(0.3), 7.45e7);
}

/// As the pulse of the other steppers' tests.
fn pulse() -> Acts {
    Acts {
        torque: |t| {
            let pulse = (PI * t / 0.02).sin().powi(2);
            if t < 0.02 { 30.0 * pulse } else { 0.0 }
        },
        load: |_, speed| 3000.0 * speed,
        ..Acts::default()
    }
}

#[test]
fn second_order_to_the_obvious_integration() {
    let (acts, steps, drive) = (
        pulse(),
        [1e-4, 5e-5, 2.5e-5],
        on_bearings(Mounting::FixedFree),
    );
    let shape = NutCoupling::ShapeFunctions;
    let mut reference = Reference::at_rest(shape, 0.43);
    reference.nut = |x| 1.0 / (1.0 / 7.45e7 + 1.0 / BEARING + x / RIGIDITY);
    let truth = reference.run(&acts, 0.04, 20, 1e-6);
    let modal = steps.map(|h| {
        let stepper = ModalStepper::new(&drive, h).unwrap();
        deviation(&stepped(&stepper, 0.43, &acts, 0.04, 20), &truth)
    });
    // 3.0e-5, 2.0e-5, 1.3e-4 and 3.8e-4; 1.4e-4, 4.1e-5, 2.7e-4 and 6.7e-4.
    second_order("modal", modal, [1e-4, 8e-5, 5e-4, 1.5e-3]);
    let implicit = steps.map(|h| {
        let stepper = ImplicitStepper::new(&drive, shape, h).unwrap();
        deviation(&stepped(&stepper, 0.43, &acts, 0.04, 20), &truth)
    });
    second_order("implicit", implicit, [5e-4, 2e-4, 1e-3, 2e-3]);
}

#[test]
fn the_bearing_is_checked_by_name() {
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        let axial = Some(AxialSupport {
            bearing_stiffness: bad,
            mounting: Mounting::FixedFixed,
        });
        match FeedDrive::new(DriveParameters { axial, ..paper() }).unwrap_err() {
            DriveError::Parameter { name, .. } => assert_eq!(name, "bearing_stiffness"),
            other => panic!("{other}"),
        }
    }
}
