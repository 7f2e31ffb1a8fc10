//! The tables over the position and over a turn of the motor.

use std::f64::consts::TAU;

use axis_sim::{Axis, PositionErrors};
use compensator::DriveTerms;

use super::units::Units;

/// A table over the position or over the motor's turn.
#[derive(Clone, Debug, PartialEq)]
pub struct TermTable {
    /// Headings, each ending in its unit.
    pub headings: Vec<String>,
    /// Rows of as many values.
    pub rows: Vec<Vec<f64>>,
}

/// The table over the position: wind-up, lost motion, load and inertia at the sections of
/// the model, and the lead error of the axis file's effects.
pub fn over_position(axis: &Axis, of: &DriveTerms, errors: &PositionErrors) -> TermTable {
    let u = Units::of(axis);
    let (l, t, a) = (u.load, u.torque, u.angle);
    let headings = vec![
        format!("position ({l})"),
        format!("lead error ({l})"),
        format!("wind-up per acceleration ({l}/({l}/s²))"),
        format!("motor speed per jerk ({a}/s/({l}/s³))"),
        format!("lost motion ({l})"),
        format!("load ({t})"),
        format!("inertia ({})", u.inertia),
    ];
    let row = |row: compensator::DriveTermsRow| {
        vec![
            row.position,
            errors.lead(row.position),
            row.position_per_acceleration,
            row.speed_per_jerk,
            row.lost_motion,
            row.load,
            row.inertia,
        ]
    };
    TermTable {
        headings,
        rows: of.table().map(row).collect(),
    }
}

/// Angles of the table over a turn.
const IN_TURN: u32 = 128;

/// The table over one turn of the motor: cogging torque, and what of the lead error repeats
/// with the turn. None if the axis file has neither.
pub fn over_turn(axis: &Axis, errors: &PositionErrors) -> Option<TermTable> {
    let u = Units::of(axis);
    let at = |i: u32| {
        let angle = TAU * f64::from(i) / f64::from(IN_TURN);
        vec![angle, errors.cogging(angle), errors.lead_in_turn(angle)]
    };
    let rows: Vec<Vec<f64>> = (0..IN_TURN).map(at).collect();
    // A straight lead error leaves nothing in a turn but roundings.
    let shows = |row: &Vec<f64>| row[1] != 0.0 || row[2].abs() > 1e-12;
    rows.iter().any(shows).then(|| TermTable {
        headings: vec![
            format!("motor angle ({})", u.angle),
            format!("cogging ({})", u.torque),
            format!("periodic lead error ({})", u.load),
        ],
        rows,
    })
}
