//! The two axis files and what they mean.

use std::f64::consts::TAU;

use axis_sim::mechanism::SolutionMethod;
use axis_sim::{Axis, AxisFileError};

use crate::{MACHINE, PRINTED, axis, data, number, text};

const RPM: f64 = TAU / 60.0;

#[test]
fn printed_values_in_si() {
    // Liu et al. 2025 (doi:10.3390/machines13050433), Tables 1 to 5 and 12.
    let axis = axis(PRINTED);
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-15 * b.abs(), "{a} {b}");
    let d = |key| number(&axis.mechanism, key);
    near(d("length"), 1.5);
    near(d("lead"), 0.010);
    near(axis.travel_per_radian(), 0.010 / TAU);
    near(d("nut_stiffness"), 7.45e7);
    near(axis.mechanism.stiffness().unwrap(), 7.45e7);
    near(d("table_mass"), 515.0);
    near(d("motor_inertia"), 0.0053);
    assert_eq!(axis.mechanism.values().count("elements"), Ok(10));
    let f = axis.friction.law.parameters();
    near(f.coulomb, 0.6757);
    near(f.stribeck_speed, 25.9147 * RPM);
    near(f.stiffness, 1.5875 / RPM);
    assert!((f.stiffness - 15.1595).abs() < 5e-5); // N·m/rad
    near(f.damping, 0.1593 / RPM);
    near(f.viscous, 0.0003 / RPM);
    near(axis.torque_constant(), 1.641);
    assert_eq!(axis.actuator.pole_pairs(), Some(4.0));
    near(number(&axis.actuator, "inductance_q"), 0.0132);
    let g = |key| number(&axis.control, key);
    near(g("position_gain"), 280.2 * RPM * 1e3);
    near(
        axis.control
            .velocity_gain(axis.travel_per_radian())
            .unwrap(),
        280.2 * RPM * 1e3 * 0.010 / TAU,
    );
    near(g("speed_proportional"), 0.0678 / RPM);
    near(g("speed_integral"), 0.7122 / RPM);
    near(number(&axis.actuator, "dc_link"), 540.0);
    near(axis.actuator.limit(), 15.0);
    near(axis.period, 1e-4);
    near(axis.stroke.start, 0.6);
    let samples = axis.samples.unwrap();
    near(samples.speed.least, -0.333);
    near(samples.acceleration.most, 1.0);
    near(samples.effort.most, 15.0);
    assert_eq!(axis.simulation.method, SolutionMethod::Fast);
    assert_eq!(axis.trajectories.len(), 6);
    near(axis.trajectories[4].displacement, 0.3);
    assert_eq!(axis.name, "liu2025");
}

#[test]
fn files_named_in_a_file_lie_beside_it() {
    let experiment = axis(PRINTED).experiment.unwrap();
    assert!(Axis::read(&experiment.machine).is_ok());
    assert!(
        experiment
            .paper_tables
            .unwrap()
            .join("table14_prediction.csv")
            .exists()
    );
    assert!(axis(MACHINE).experiment.is_none());
}

#[test]
fn the_machine_differs_in_its_viscous_friction_only() {
    let (printed, machine) = (axis(PRINTED), axis(MACHINE));
    let (mut a, b) = (
        printed.friction.law.parameters(),
        machine.friction.law.parameters(),
    );
    assert!((b.viscous - 0.00312 / RPM).abs() < 1e-15);
    assert_ne!(a.viscous, b.viscous);
    a.viscous = b.viscous;
    assert_eq!(format!("{a:?}"), format!("{b:?}"));
    // Everything else prints the same, but for names and what it is compared with.
    let rest = |mut axis: Axis| {
        axis.friction = machine.friction.clone();
        axis.name.clear();
        axis.description.clear();
        axis.fingerprint.clear();
        axis.experiment = None;
        format!("{axis:?}")
    };
    assert_eq!(rest(printed), rest(axis(MACHINE)));
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let missing = data("no-such-axis.toml");
    let error = Axis::read(&missing).unwrap_err();
    assert!(matches!(error, AxisFileError::Read { .. }));
    assert!(error.to_string().contains("no-such-axis.toml"));
    // A folder and bytes that are not UTF-8 are refused likewise.
    assert!(Axis::read(&data(".")).is_err());
}

#[test]
fn digits_may_be_grouped_and_units_chosen() {
    let grouped = text(PRINTED)
        .replace("length_mm = 1500 ", "length_mm = 1_500.0 ")
        .replace("frequency_khz = 10", "frequency_hz = 1e4");
    let axis = Axis::parse("grouped", &grouped).unwrap();
    assert_eq!(number(&axis.mechanism, "length"), 1.5);
    assert_eq!(axis.period, 1e-4);
}
