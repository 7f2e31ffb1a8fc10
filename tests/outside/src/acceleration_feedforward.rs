//! `acceleration_feedforward`: the command that the known inertia asks for.

use axis_pipeline::strategies::{Build, ReportTable, StrategyKind};
use compensator::{Compensator, Correction, Sample};

/// Feed-forward of the reference's acceleration: J a / (r K), with J the inertia of all
/// that moves, seen at the motor (kg·m²), r the load's travel per radian (m/rad) and K
/// the motor's torque per unit of the actuator's command.
pub static ACCELERATION_FEEDFORWARD: StrategyKind = StrategyKind {
    name: "acceleration_feedforward",
    label: "acceleration feed-forward",
    heading: "Acceleration feed-forward, known inertia",
    summary: "the command that the axis file's inertia asks for",
    table: ReportTable::More,
    needs: &[],
    build: Build::Each(|predictors| {
        let axis = &predictors.axis;
        let per_torque = axis.travel_per_radian() * axis.torque_constant();
        Ok(Box::new(AccelerationFeedforward {
            per_acceleration: axis.mechanism.total_inertia() / per_torque,
        }))
    }),
};

#[derive(Debug)]
struct AccelerationFeedforward {
    per_acceleration: f64,
}

impl Compensator for AccelerationFeedforward {
    fn reset(&mut self) {}

    fn correct(&mut self, sample: &Sample) -> Correction {
        Correction {
            position: 0.0,
            command: self.per_acceleration * sample.reference.acceleration,
        }
    }
}
