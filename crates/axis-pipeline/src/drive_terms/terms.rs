//! The numbers by name.

use axis_sim::Axis;
use axis_sim::mechanism::Freedom;
use compensator::DriveTerms;

use super::gains::gains;
use super::parameters::parameters;
use super::term::{Line, Term};
use super::units::Units;

/// Every number, in SI units and in those that drives use, and the gains and filters of the axis file's
/// own drive. What is no number on this axis (a ratio to an inertia of 0) is left out.
pub fn terms(axis: &Axis, of: &DriveTerms) -> Vec<Term> {
    let u = Units::of(axis);
    let parts = [
        inertias(&u, of),
        sliding(&u, of),
        reversal(&u, of),
        mid_stroke(&u, of),
    ];
    let lines = parts.into_iter().flatten().map(Term::from);
    let all = lines.chain(gains(axis));
    placed(axis, all.filter(|t| t.drive_value.is_finite()))
}

/// The unit `a` per `b`.
fn per(a: &str, b: &str) -> String {
    match b.contains('/') {
        true => format!("{a}/({b})"),
        false => format!("{a}/{b}"),
    }
}

/// A unit that drives use too.
fn same(unit: &str) -> (f64, String) {
    (1.0, unit.to_owned())
}

/// A factor, and the unit of drives that it leads to.
fn scaled((factor, unit): (f64, &str)) -> (f64, String) {
    (factor, unit.to_owned())
}

/// What the references' speed and acceleration need: lever, torque constant, inertias, feed-forward.
fn inertias(u: &Units, of: &DriveTerms) -> Vec<Line> {
    let feeding = per(u.effort, &u.per_time("s²"));
    let share = (100.0, "%".to_owned());
    vec![
        (
            "travel_per_motor_angle",
            of.travel,
            per(u.load, u.angle),
            scaled(u.turn),
            "travel of the load per angle of the motor",
        ),
        (
            "torque_constant",
            of.torque_constant,
            per(u.torque, u.effort),
            same(&per(u.torque, u.effort)),
            "torque of the motor per command",
        ),
        (
            "inertia_total",
            of.inertia,
            u.inertia.into(),
            scaled(u.drive_inertia),
            "total moving inertia, referred to the motor, for torque feed-forward",
        ),
        (
            "inertia_rotating",
            of.rotating,
            u.inertia.into(),
            scaled(u.drive_inertia),
            "the part of it that turns with the motor",
        ),
        (
            "inertia_ratio",
            of.inertia / of.rotating,
            "1".into(),
            same("1"),
            "total inertia over the inertia that turns with the motor",
        ),
        (
            "acceleration_feedforward",
            of.effort_per_acceleration,
            feeding.clone(),
            same(&feeding),
            "command per acceleration of the load, total",
        ),
        (
            "acceleration_feedforward_to_add",
            lacking(of.effort_per_acceleration, of.own_effort_per_acceleration()),
            feeding.clone(),
            same(&feeding),
            "the part of it that the axis file's drive does not have yet",
        ),
        (
            "velocity_feedforward",
            of.velocity_feedforward,
            "1".into(),
            share.clone(),
            "share of the reference's speed that is fed forward, total",
        ),
        (
            "velocity_feedforward_to_add",
            lacking(of.velocity_feedforward, of.own_velocity_feedforward()),
            "1".into(),
            share,
            "the part of it that the axis file's drive does not have yet",
        ),
    ]
}

/// Friction while the axis slides.
fn sliding(u: &Units, of: &DriveTerms) -> Vec<Line> {
    let (r, k) = (of.travel, of.torque_constant);
    vec![
        (
            "viscous_friction",
            of.viscous,
            per(u.torque, &u.motor_speed()),
            scaled(u.viscous),
            "friction torque per speed of the motor",
        ),
        (
            "viscous_command",
            of.viscous / (r * k),
            per(u.effort, &u.per_time("s")),
            (1.0 / u.feed.0, per(u.effort, u.feed.1)),
            "command per speed of the load",
        ),
        (
            "coulomb_friction",
            of.coulomb,
            u.torque.into(),
            same(u.torque),
            "friction torque at any speed, with the sign of the motion",
        ),
        (
            "coulomb_command",
            of.coulomb / k,
            u.effort.into(),
            same(u.effort),
            "command for it",
        ),
    ]
}

/// What friction does after a start or a change of direction.
fn reversal(u: &Units, of: &DriveTerms) -> Vec<Line> {
    let (r, k) = (of.travel, of.torque_constant);
    let ms = (1e3, "ms".to_owned());
    let speed = u.motor_speed();
    vec![
        (
            "reversal_delay",
            of.pulse.delay,
            "s".into(),
            ms.clone(),
            "time from a change of direction to the new friction level and its pulse",
        ),
        (
            "reversal_pulse",
            of.pulse.amplitude,
            u.torque.into(),
            same(u.torque),
            "height of the torque pulse after a start with relaxed friction; twice this after a reversal",
        ),
        (
            "reversal_pulse_command",
            of.pulse.amplitude / k,
            u.effort.into(),
            same(u.effort),
            "command for it",
        ),
        (
            "reversal_decay",
            of.pulse.decay,
            "s".into(),
            ms,
            "time in which the pulse falls to 37 %",
        ),
        (
            "reversal_speed_injection",
            of.speed_injection(),
            speed.clone(),
            (r * u.feed.0, u.feed.1.into()),
            "the same pulse on the speed reference instead, for the drive's speed controller to make the torque of; speed of the motor, and of the load in the drive's unit",
        ),
        (
            "reversal_winding_speed",
            of.winding_speed(),
            speed.clone(),
            scaled(u.speed),
            "pulse on the motor's speed that winds the transmission up while friction rises to the new level, after a start, with the same decay; for a position loop closed at the load",
        ),
    ]
}

/// What differs along the stroke, in its middle: constant loads, wind-up, lost motion.
fn mid_stroke(u: &Units, of: &DriveTerms) -> Vec<Line> {
    let k = of.torque_constant;
    let [least, most] = of.along.ends();
    let row = of.row(0.5 * (least + most));
    let [acceleration, jerk] = ["s²", "s³"].map(|s| u.per_time(s));
    let speed = u.motor_speed();
    let micro = format!("µ{}", u.load);
    vec![
        (
            "standing_load",
            of.standing,
            u.torque.into(),
            same(u.torque),
            "torque of the axis' own loads at mid-stroke",
        ),
        (
            "standing_load_command",
            of.standing / k,
            u.effort.into(),
            same(u.effort),
            "command for it",
        ),
        (
            "wind_up_per_acceleration",
            row.position_per_acceleration,
            per(u.load, &acceleration),
            (1e6, per(&micro, &acceleration)),
            "offset of the position per acceleration at mid-stroke; for a position loop closed at the motor",
        ),
        (
            "speed_per_jerk",
            row.speed_per_jerk,
            per(&speed, &jerk),
            (u.speed.0, per(u.speed.1, &jerk)),
            "offset of the motor's speed per jerk at mid-stroke; for a position loop closed at the load",
        ),
        (
            "lost_motion",
            row.lost_motion,
            u.load.into(),
            (1e6, micro),
            "travel lost to wind-up by friction from one direction to the other, at mid-stroke; for a position loop closed at the motor",
        ),
    ]
}

/// Gains and filters of the axis file's own drive alone.
pub fn gain_terms(axis: &Axis) -> Vec<Term> {
    placed(axis, gains(axis).into_iter())
}

/// With the parameters of drives.
fn placed(axis: &Axis, terms: impl Iterator<Item = Term>) -> Vec<Term> {
    let is_rotary = axis.mechanism.motor_freedom() == Freedom::Rotary;
    let one = |term: Term| Term {
        parameters: parameters(term.name, term.drive_value, is_rotary),
        ..term
    };
    terms.map(one).collect()
}

/// Greatest error of a number that was rounded to six digits, as axis files are written (`SixDigits`), as a share of it: half of
/// the last digit of 1.00000.
const ROUNDING: f64 = 5e-6;

/// What `own` lacks of `total`: nothing within the rounding of a file's numbers.
fn lacking(total: f64, own: f64) -> f64 {
    let lacking = total - own;
    match lacking.abs() <= ROUNDING * total.abs() {
        true => 0.0,
        false => lacking,
    }
}
