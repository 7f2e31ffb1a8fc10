//! Bad parameters are refused by name.

use feed_dynamics::{
    DriveError, DriveParameters, FeedDrive, ImplicitStepper, ModalStepper, NutCoupling,
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
        }
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
