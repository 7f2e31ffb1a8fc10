//! What channels of a log should be of each other, and whether they are.

use axis_log::quality::{CrossCheckVerdict, Finding, Relation, RelationLaw, cross_check};
use axis_log::{Log, unit_of};
use axis_sim::Axis;
use axis_sim::mechanism::Freedom;

use super::error::LogSetError;

/// Checks of a log's channels against each other, by what this axis has them be.
pub fn cross_checks(log: &Log, machine: &Axis) -> Vec<Finding> {
    cross_check(log, &machine.log, &relations(log, machine))
}

/// What channels of a log should be of each other on this axis.
pub fn relations(log: &Log, machine: &Axis) -> Vec<Relation> {
    let (position, reference) = (machine.position_channel(), machine.reference_channel());
    let speed = match machine.freedom() {
        Freedom::Linear => "velocity_m_s",
        Freedom::Rotary => "velocity_rad_s",
    };
    let travel = machine.travel_per_radian();
    let mut all = vec![
        Relation::new(position, reference, RelationLaw::Same),
        Relation::new(
            position,
            "motor_angle_rad",
            RelationLaw::Scaled { factor: travel },
        ),
        Relation::new(
            "motor_angle_rad",
            "motor_speed_rad_s",
            RelationLaw::Integral { factor: 1.0 },
        ),
        Relation::new(
            position,
            "motor_speed_rad_s",
            RelationLaw::Integral { factor: travel },
        ),
        Relation::new(position, speed, RelationLaw::Integral { factor: 1.0 }),
        Relation::new("iq_a", "iq_ref_a", RelationLaw::Follows),
    ];
    // Whatever torque there is beside the current.
    let factor = machine.torque_constant();
    if factor.is_finite() && factor != 0.0 && log.has("iq_a") {
        let torque = |name: &str| name.contains("torque") && unit_of(name) == Some("N·m");
        let torques = log.channels().iter().filter(|c| torque(&c.name));
        let about = RelationLaw::About {
            factor,
            within: 2.0,
        };
        all.extend(torques.map(|c| Relation::new(&c.name, "iq_a", about)));
    }
    all
}

/// Refuses a log whose channels say that one of them is in another unit, turned, or from
/// another zero.
pub(super) fn agree(file: &str, log: &Log, machine: &Axis) -> Result<(), LogSetError> {
    let found = cross_checks(log, machine);
    let wrong = |f: &&Finding| f.verdict == CrossCheckVerdict::Contradicts;
    match found.iter().find(wrong) {
        None => Ok(()),
        Some(finding) => Err(LogSetError::Mapping {
            file: file.to_owned(),
            what: finding.to_string(),
            lines: finding.lines().unwrap_or_default(),
        }),
    }
}
