//! The nut's offset, its rate and its gap, in both steppers, against the obvious
//! integration and against what they must not do.

use feed_dynamics::{
    DriveParameters, FeedDrive, ImplicitStepper, ModalStepper, NutCoupling, NutErrors, Observation,
    Settled, TableMotion, TimeStepper,
};
use std::f64::consts::TAU;

use crate::reference::{Acts, Reference, Seen};
use crate::stepping::{deviation, implicit, modal, stepped, within};
use crate::{COUPLINGS, drive, paper};

/// ± 10 µm at 40 Hz, from a smooth start; `rated` with the rate that goes with it.
fn wobble(rated: bool) -> Acts {
    Acts {
        offset: if rated {
            |t| {
                let w = TAU * 40.0;
                [5e-6 * (1.0 - (w * t).cos()), 5e-6 * w * (w * t).sin()]
            }
        } else {
            |t| [5e-6 * (1.0 - (TAU * 40.0 * t).cos()), 0.0]
        },
        load: |_, speed| 3000.0 * speed,
        ..Acts::default()
    }
}

#[test]
fn an_offset_and_its_rate_drive_the_table() {
    // β ten times the paper's, so that the rate counts.
    let beta = 1e-4;
    let soft = FeedDrive::new(DriveParameters {
        stiffness_damping: beta,
        ..paper()
    })
    .unwrap();
    for rated in [true, false] {
        let acts = wobble(rated);
        let truth = |coupling| {
            let mut drive = Reference::at_rest(coupling, 0.68);
            drive.beta = beta;
            drive.run(&acts, 0.05, 25, 5e-7)
        };
        let shape = truth(NutCoupling::ShapeFunctions);
        let by_modal = stepped(
            &ModalStepper::new(&soft, 2e-5).unwrap(),
            0.68,
            &acts,
            0.05,
            25,
        );
        let off = deviation(&by_modal, &shape);
        println!("offset, rated {rated}: modal {off:?}");
        // 1.2e-5, 6.0e-6, 1.1e-5 and 1.5e-5; implicit 3.1e-5, 1.3e-5, 2.5e-5
        // and 3.3e-5.
        within(&off, [5e-5, 2e-5, 5e-5, 5e-5]);
        for coupling in COUPLINGS {
            let stepper = ImplicitStepper::new(&soft, coupling, 2e-5).unwrap();
            let off = deviation(&stepped(&stepper, 0.68, &acts, 0.05, 25), &truth(coupling));
            println!("offset, rated {rated}: implicit, {coupling:?} {off:?}");
            within(&off, [1e-4, 5e-5, 1e-4, 1e-4]);
        }
    }
    // The rate is seen: βk times 1.3 mm/s.
    let run = |rated| {
        stepped(
            &ModalStepper::new(&soft, 2e-5).unwrap(),
            0.68,
            &wobble(rated),
            0.05,
            25,
        )
    };
    let apart = deviation(&run(true), &run(false));
    println!("with and without the rate {apart:?}");
    assert!(apart[3] > 0.01, "{apart:?}");
}

/// To and fro at 15 Hz with 12 N·m through a gap of 20 µm, against some drag.
fn rattle() -> Acts {
    Acts {
        torque: |t| 12.0 * (TAU * 15.0 * t).sin(),
        load: |_, speed| 2000.0 * speed,
        gap: 20e-6,
        ..Acts::default()
    }
}

#[test]
fn a_gap_is_crossed_as_in_the_obvious_integration() {
    let (acts, duration, count) = (rattle(), 0.2, 100);
    for coupling in COUPLINGS {
        let truth = Reference::at_rest(coupling, 0.68).run(&acts, duration, count, 1e-6);
        let open = truth.iter().filter(|s| s[3] == 0.0).count();
        assert!(
            (2..50).contains(&open),
            "in the gap {open} times of {count}"
        );
        let mut runs: Vec<(&str, Vec<Seen>)> = vec![(
            "implicit",
            stepped(&implicit(5e-6, coupling), 0.68, &acts, duration, count),
        )];
        if coupling == NutCoupling::ShapeFunctions {
            let seen = stepped(&modal(5e-6), 0.68, &acts, duration, count);
            runs.push(("modal", seen));
            let apart = deviation(&runs[0].1, &runs[1].1);
            println!("gap: steppers apart {apart:?}");
            // 8.8e-7, 3.4e-8, 1.2e-6 and 5.7e-6.
            within(&apart, [5e-6, 2e-7, 5e-6, 3e-5]);
        }
        for (name, seen) in runs {
            let off = deviation(&seen, &truth);
            println!("gap, {coupling:?}, {name}: {off:?}");
            // At most 1.3e-6, 1.1e-7, 3.0e-6 and 1.4e-5.
            within(&off, [5e-6, 5e-7, 1e-5, 5e-5]);
        }
    }
}

/// Under a constant load an offset carries the table along, and half the gap
/// lets it back.
#[test]
fn a_constant_shift_moves_the_motor_by_as_much() {
    fn end<S: TimeStepper>(s: &S, errors: NutErrors) -> Observation {
        let motion = Settled {
            load: 800.0,
            ..Settled::default()
        };
        let mut state = s.settled(0.68, &motion).unwrap();
        // Held by the torque that the load needs, and damped to rest.
        for _ in 0..40_000 {
            let angle = s.observe(&state).motor_angle;
            let speed = s.observe(&state).motor_speed;
            let torque = motion.motor_torque(&drive()) - 200.0 * angle - 2.0 * speed;
            let load = |m: TableMotion| 800.0 + 2e4 * m.speed;
            let _ = s.step_through(&mut state, torque, &errors, load);
        }
        s.observe(&state)
    }
    fn check<S: TimeStepper>(s: &S) {
        let none = end(s, NutErrors::default());
        // The load presses the flank on which the screw pushes.
        for (errors, shift) in [
            (NutErrors::new(3e-6, 0.0, 0.0).unwrap(), 3e-6),
            (NutErrors::new(0.0, 0.0, 8e-6).unwrap(), -4e-6),
            (NutErrors::new(3e-6, 0.0, 8e-6).unwrap(), -1e-6),
        ] {
            let with = end(s, errors);
            let moved = with.displacement - none.displacement;
            println!(
                "{errors:?}: {:.1e} {:.1e}",
                moved - shift,
                with.transmission_force - 800.0
            );
            // The wind-up grows with x, by 1e-7 of the shift; 5e-13 m and 3e-11 N
            // as measured.
            assert!((moved - shift).abs() < 4e-12, "{errors:?}: {moved:e}");
            assert!((with.transmission_force - 800.0).abs() < 2e-10, "{with:?}");
        }
    }
    check(&modal(1e-4));
    for coupling in COUPLINGS {
        check(&implicit(1e-4, coupling));
    }
}
