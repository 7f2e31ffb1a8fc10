//! Field weakening of a motor above its base speed.

use axis_sim::{Axis, ClosedLoop, Cycle};
use compensator::NoCompensation;
use trajectories::{Limits, SCurve};

use crate::text;

/// The rotary table on a DC link of 150 V, 86.6 V a phase: its motor induces 12/1.5 V per
/// rad/s, all of that at 620 deg/s.
fn cycles(extra: &str, speed: f64) -> Result<Vec<Cycle>, String> {
    let file = text("rotary-table.toml")
        .replace("dc_link_v = 540", &format!("dc_link_v = 150\n{extra}"))
        .replace(
            "following_error_limit_deg = 1",
            "following_error_limit_deg = 90",
        )
        .replace("maximum_deg = 360", "maximum_deg = 1200");
    let axis = Axis::parse("table.toml", &file).map_err(|e| e.to_string())?;
    let limits = Limits::new(speed.to_radians(), 5.0, 50.0).unwrap();
    let motion = SCurve::plan(-6.0, 20.0, &limits).unwrap();
    let mut cycles = Vec::new();
    ClosedLoop::new(&axis)
        .unwrap()
        .run(&motion, &mut NoCompensation, |c| cycles.push(*c))
        .completed()
        .map_err(|e| e.to_string())?;
    Ok(cycles)
}

const ON: &str = "field_weakening_gain_a_per_v_s = 20\nfield_weakening_current_a = 15";

fn largest(cycles: &[Cycle], of: impl Fn(&Cycle) -> f64) -> f64 {
    cycles.iter().map(|c| of(c).abs()).fold(0.0, f64::max)
}

#[test]
fn above_base_speed_it_keeps_the_table_at_its_reference() {
    let speed = 700.0;
    let (without, with) = (cycles("", speed).unwrap(), cycles(ON, speed).unwrap());
    let errors = [&without, &with].map(|c| largest(c, Cycle::error).to_degrees());
    let current = largest(&with, |c| c.current.d);
    println!("off by {errors:?} deg, d current {current:.2} A");
    // Without it the link's voltage holds the speed back.
    assert!(errors[0] > 10.0 * errors[1], "{errors:?}");
    assert!(largest(&without, |c| c.current.d) < 0.2 * current);
    assert!((1.0..=25.5).contains(&current), "{current}");
    // At rest again there is none left.
    let last = with.last().unwrap();
    assert!(last.current.d.abs() < 0.05, "{last:?}");
}

#[test]
fn below_base_speed_it_changes_nothing() {
    let speed = 60.0;
    let (without, with) = (cycles("", speed).unwrap(), cycles(ON, speed).unwrap());
    let position = |c: &[Cycle]| -> Vec<f64> { c.iter().map(|c| c.position).collect() };
    assert_eq!(position(&without), position(&with));
}

#[test]
fn a_current_that_leaves_none_for_torque_is_refused() {
    let most = "field_weakening_gain_a_per_v_s = 60\nfield_weakening_current_a = 30";
    let error = cycles(most, 60.0).unwrap_err();
    assert!(error.contains("field_weakening_current_a"), "{error}");
    assert!(error.contains("below the current limit of 30 A"), "{error}");
    let half = "field_weakening_gain_a_per_v_s = 60";
    let error = cycles(half, 60.0).unwrap_err();
    assert!(error.contains("field_weakening_current"), "{error}");
}
