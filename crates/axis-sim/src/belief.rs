//! What a compensator may believe of an axis: its parts as a feed-forward sees them.

use compensator::{Along, Cascade, CompensatorError, DriveModel, Section};

use crate::axis::{Axis, LoadSensor};

impl Axis {
    /// Everything that a plan of this axis is made from, its effects left out.
    ///
    /// The loads are those at rest at each position. A control without a speed loop passes
    /// a learned shift of the position and the torque only.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] where no plan can be made from these parts.
    pub fn drive_model(&self) -> Result<DriveModel, CompensatorError> {
        let travel = self.travel_per_radian();
        let (drive, delay) = self.actuator.inverse(travel);
        let reach = self.mechanism.reach();
        let least = reach.map_or(self.stroke.minimum, |r| r.least.max(self.stroke.minimum));
        let most = reach.map_or(self.stroke.maximum, |r| r.most.min(self.stroke.maximum));
        let along = Along::new([least, most], |x| {
            let rotating = self.mechanism.rotating(x);
            Section {
                compliance: self.mechanism.compliance(x),
                rotating: rotating.iter().map(|[inertia, _]| inertia).sum(),
                lagging: rotating.iter().map(|[inertia, lag]| inertia * lag).sum(),
                load: self.load_at(x),
            }
        })?;
        let mut cascade = self.control.cascade(travel).unwrap_or(Cascade {
            position: 0.0,
            velocity_feedforward: 0.0,
            acceleration_feedforward: 0.0,
            speed: 0.0,
            speed_integral: 0.0,
            from_motor: false,
        });
        // A load without a sensor is where the motor says that it is.
        cascade.from_motor |= matches!(self.sensors.load, LoadSensor::Missing);
        Ok(DriveModel {
            travel,
            load_inertia: self.mechanism.load_inertia(),
            friction: self.friction.law,
            lever: self.friction.lever(travel),
            along,
            drive,
            delay,
            effort_limit: self.actuator.limit(),
            cascade,
            period: self.period,
        })
    }
}
