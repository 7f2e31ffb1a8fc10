//! Bad parameters are refused by name.

use feed_dynamics::{
    Coordinate, DriveError, DriveParameters, FeedDrive, ImplicitStepper, ModalStepper, NutCoupling,
    NutErrors, Settled, TimeStepper,
};

use crate::{COUPLINGS, drive, paper};

#[test]
fn each_field_is_checked_by_name() {
    type Set = fn(&mut DriveParameters, f64);
    let fields: [(&str, Set); 9] = [
        ("screw_length", |p, v| p.screw_length = v),
        ("lead", |p, v| p.lead = v),
        ("motor_inertia", |p, v| p.motor_inertia = v),
        ("sensor_inertia", |p, v| p.sensor_inertia = v),
        ("motor_coupling_stiffness", |p, v| {
            p.motor_coupling_stiffness = v
        }),
        ("screw_coupling_stiffness", |p, v| {
            p.screw_coupling_stiffness = v
        }),
        ("table_mass", |p, v| p.table_mass = v),
        ("nut_stiffness", |p, v| p.nut_stiffness = v),
        ("stiffness_damping", |p, v| p.stiffness_damping = v),
    ];
    for (field, set) in fields {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0] {
            let mut p = paper();
            set(&mut p, bad);
            match FeedDrive::new(p).unwrap_err() {
                DriveError::Parameter { name, value, valid } => {
                    assert_eq!(name, field);
                    assert!(value.to_bits() == bad.to_bits() && valid.contains("finite"));
                }
                other => panic!("{other}"),
            }
        }
        // Zero is a value for the damping only.
        let mut p = paper();
        set(&mut p, 0.0);
        assert_eq!(FeedDrive::new(p).is_ok(), field == "stiffness_damping");
    }
}

#[test]
fn the_number_of_elements_has_bounds() {
    for (elements, valid) in [
        (0, false),
        (1, false),
        (2, true),
        (1000, true),
        (1001, false),
    ] {
        let made = FeedDrive::new(DriveParameters {
            elements,
            ..paper()
        });
        assert_eq!(made.is_ok(), valid, "{elements}");
        if let Err(error) = made {
            let text = error.to_string();
            assert!(text.contains("elements") && text.contains("between 2 and 1000"));
        }
    }
}

#[test]
fn positions_off_the_screw_are_refused() {
    for x in [-1e-9, 1.5 + 1e-9, f64::NAN, f64::INFINITY] {
        for coupling in COUPLINGS {
            assert!(matches!(
                drive().matrices(x, coupling),
                Err(DriveError::OffScrew { .. })
            ));
            assert!(drive().modes(x, coupling).is_err());
            let at = [Coordinate::Motor, Coordinate::Table];
            assert!(drive().receptance(x, coupling, at, &[1.0]).is_err());
            let stepper = ImplicitStepper::new(&drive(), coupling, 1e-4).unwrap();
            let error = stepper.settled(x, &Settled::default()).unwrap_err();
            assert!(matches!(error, DriveError::OffScrew { .. }), "{error}");
        }
        let modal = ModalStepper::new(&drive(), 1e-4).unwrap();
        let error = modal.settled(x, &Settled::default()).unwrap_err();
        assert!(matches!(error, DriveError::OffScrew { .. }), "{error}");
        assert!(drive().check_position(x).is_err());
    }
    for x in [0.0, 0.75, 1.5] {
        assert!(drive().check_position(x).is_ok());
    }
}

#[test]
fn settled_motion_must_be_finite() {
    type Set = fn(&mut Settled, f64);
    let fields: [(&str, Set); 3] = [
        ("speed", |m, v| m.speed = v),
        ("acceleration", |m, v| m.acceleration = v),
        ("load", |m, v| m.load = v),
    ];
    let modal = ModalStepper::new(&drive(), 1e-4).unwrap();
    let implicit = ImplicitStepper::new(&drive(), NutCoupling::MovingNode, 1e-4).unwrap();
    for (field, set) in fields {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut motion = Settled::default();
            set(&mut motion, bad);
            for text in [
                modal.settled(0.6, &motion).unwrap_err().to_string(),
                implicit.settled(0.6, &motion).unwrap_err().to_string(),
            ] {
                assert!(text.starts_with(&format!("{field} = ")), "{text}");
            }
        }
    }
}

/// Runs off the end and back, and says of each step whether it is on the screw.
fn over_the_end<S: TimeStepper>(stepper: &S, end: f64) {
    let out = if end > 0.0 { 1.0 } else { -1.0 };
    let motion = Settled {
        speed: 0.1 * out,
        ..Settled::default()
    };
    let mut state = stepper.settled(end - 1e-3 * out, &motion).unwrap();
    let mut off = 0;
    for _ in 0..400 {
        // From 1 mm before the end: beyond it after 10 ms, back before 40 ms.
        let report = stepper.step(&mut state, -3.0 * out, |_| 0.0);
        let at = end - 1e-3 * out + stepper.observe(&state).displacement;
        assert!(report.load.converged && stepper.observe(&state).transmission_force.is_finite());
        assert_eq!(report.on_screw, (0.0..=1.5).contains(&at), "{at}");
        off += usize::from(!report.on_screw);
    }
    assert!((100..390).contains(&off), "{off}");
}

#[test]
fn steps_beyond_the_screw_say_so() {
    for end in [0.0, 1.5] {
        over_the_end(&ModalStepper::new(&drive(), 1e-4).unwrap(), end);
        for coupling in COUPLINGS {
            let implicit = ImplicitStepper::new(&drive(), coupling, 1e-4).unwrap();
            over_the_end(&implicit, end);
        }
    }
}

#[test]
fn what_is_no_number_is_reported_and_does_not_panic() {
    fn check<S: TimeStepper>(stepper: &S) {
        let start = stepper.settled(0.6, &Settled::default()).unwrap();
        for bad in [f64::NAN, f64::INFINITY] {
            let mut state = start.clone();
            assert!(!stepper.step(&mut state, 0.0, |_| bad).load.converged);
            let gap = NutErrors::new(0.0, 0.0, 1e-6).unwrap();
            for errors in [NutErrors::default(), gap] {
                let mut state = start.clone();
                let _ = stepper.step_through(&mut state, bad, &errors, |m| m.speed);
                let report = stepper.step_through(&mut state, 0.0, &errors, |m| m.speed);
                assert!(!report.load.converged && !report.on_screw, "{report:?}");
            }
        }
    }
    check(&ModalStepper::new(&drive(), 1e-4).unwrap());
    for coupling in COUPLINGS {
        check(&ImplicitStepper::new(&drive(), coupling, 1e-4).unwrap());
    }
}

#[test]
fn steps_are_checked() {
    for step in [0.0, -1e-4, f64::NAN, f64::INFINITY] {
        let modal = ModalStepper::new(&drive(), step).unwrap_err().to_string();
        let implicit = ImplicitStepper::new(&drive(), NutCoupling::MovingNode, step);
        for text in [modal, implicit.unwrap_err().to_string()] {
            assert!(
                text.starts_with("step = ") && text.contains("above zero"),
                "{text}"
            );
        }
    }
}

#[test]
fn steps_of_no_sensible_length_are_refused() {
    let (drive, coupling) = (drive(), NutCoupling::ShapeFunctions);
    for step in [0.0, -1e-4, 1.0 + 1e-12, 1e200, f64::INFINITY, f64::NAN] {
        let both = [
            ModalStepper::new(&drive, step).err(),
            ImplicitStepper::new(&drive, coupling, step).err(),
        ];
        for error in both {
            let message = error.unwrap().to_string();
            assert!(message.contains("at most 1 s"), "{step}: {message}");
        }
    }
    for step in [5e-324, 1.0] {
        assert!(ModalStepper::new(&drive, step).is_ok(), "{step}");
    }
}
