//! Torque balance along the motion of the motor alone: where the load is behind the wind-up.

use axis_sim::{Axis, LoadSensor, Sensors};
use trajectories::{Limits, Program, Step};

use crate::axis;
use crate::balance::{back_and_forth, exact_joint, simulated_on, unbalanced, without};

/// Without a sensor at the load, a log's position is the motor's times the travel per radian, and the
/// load swings behind it. The joint's gear has no error here: driven through the gear's resonance, that takes
/// torque of its own, of which motion behind a low-pass knows nothing.
#[test]
fn a_position_without_a_sensor_at_the_load_is_the_motors() {
    for (mut axis, most) in [(exact_joint(), 4e-4), (axis("belt.toml"), 4e-4)] {
        axis.sensors = Sensors {
            load: LoadSensor::Missing,
            motor: None,
        };
        let log = simulated_on(&axis, &back_and_forth(&axis));
        let log = without(&log, &["motor_angle_rad"]);
        let right = unbalanced(&axis, &log);
        // Taken for the load's:
        axis.sensors.load = LoadSensor::Perfect;
        let wrong = unbalanced(&axis, &log);
        println!(
            "{}: {right:.2e}, {wrong:.2e} if it were the load's",
            axis.name
        );
        assert!(right < most && right < 0.5 * wrong);
    }
}

/// A motor's angle that was homed on the load where the log begins lacks the wind-up there, 2 mrad at the
/// load under gravity: 0.2 rad of the motor, and twice that of an error that repeats twice a turn.
#[test]
fn the_wind_up_at_the_start_is_in_an_angle_that_was_homed() {
    let text = crate::text("joint.toml");
    let large = text.replace("kinematic_error_arcmin = 0.5", "kinematic_error_arcmin = 5");
    assert_ne!(large, text);
    let mut axis = Axis::parse("joint.toml", &large).unwrap();
    axis.sensors = Sensors {
        load: LoadSensor::Missing,
        motor: None,
    };
    let log = simulated_on(&axis, &slowly(&axis));
    let share = unbalanced(&axis, &without(&log, &["motor_angle_rad"]));
    println!("{share:.2e}");
    // Measured 1.9e-4; 5.3e-2 from a wind-up that is off by a tenth.
    assert!(share < 4e-4, "{share}");
}

/// So slow that what repeats with the motor's turn passes the balance's low-pass of 7 Hz, and lies below
/// the gear's resonance.
fn slowly(axis: &Axis) -> Program {
    let from = axis.stroke.start;
    let limits = Limits::new(0.02, 0.5, 20.0).unwrap();
    let to = |to: f64| Step::Move { to, limits };
    let rest = Step::Dwell { duration: 0.2 };
    let steps = vec![rest, to(from + 0.05), rest, to(from), rest];
    Program::new(from, steps).unwrap()
}

/// The motor's own angle holds that wind-up, so the phase of what repeats with its turn is the one of the angle: cogging of
/// order 6 would otherwise be shifted by a radian.
#[test]
fn the_motors_own_angle_has_no_further_wind_up() {
    let cogging =
        "\n[[effects]]\nname = \"cogging-torque\"\namplitude = 0.02\norder = 6\nphase = 0.3\n";
    let mut axis = Axis::parse("joint.toml", &(crate::text("joint.toml") + cogging)).unwrap();
    axis.sensors = Sensors {
        load: LoadSensor::Missing,
        motor: None,
    };
    let log = simulated_on(&axis, &slowly(&axis));
    // Measured 1.8e-4 along the angle, and 3.3e-2 with the wind-up added to it; 4.7e-3 along the position that was homed.
    for (other, most) in [("position_rad", 3e-4), ("motor_angle_rad", 5e-3)] {
        let share = unbalanced(&axis, &without(&log, &[other]));
        println!("without {other}: {share:.2e}");
        assert!(share < most, "without {other}: {share}");
    }
}
