//! What a duty asks of an axis: torque, speed and forces over time, from cycles of a simulation or from a log.
//!
//! The force through the transmission is what the motor gives less what its own side takes, seen at the load, with r the
//! travel per radian and J_m the inertia of all that turns with the motor,
//!
//! ```text
//! F = (T − J_m a/r)/r
//! ```
//!
//! with a/r the acceleration of the motor: of its speed from cycle to cycle, in a log of its angle, or of the position where
//! there is none. All friction is thus taken as that of the load's side: where some of it is the motor's or the bearings',
//! F is too large by that.

use std::f64::consts::TAU;

use axis_rating::preload::preloaded_n;
use axis_rating::{
    MeanLoad, MotorDuty, MotorVoltage, PowerCourse, Rating, Regeneration, RollingElement, motor,
};

use super::{CheckError, Sheets};
use crate::axis::Axis;
use crate::cycle::Cycle;

/// A stretch of a duty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DutyStretch {
    /// Its duration, s.
    pub duration: f64,
    /// Speed of the load, m/s or rad/s.
    pub speed: f64,
    /// Acceleration of the motor, seen at the load, m/s² or rad/s².
    pub acceleration: f64,
    /// Torque of the motor, N·m; force, N, of one that moves along a line.
    pub torque: f64,
    /// Currents, A (d, q), if the actuator has some.
    pub current: [f64; 2],
}

/// Loads of two preloaded contacts over travel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contacts {
    pub sides: [MeanLoad; 2],
    pub greatest: f64,
}

impl Contacts {
    fn new(element: RollingElement) -> Self {
        Self {
            sides: [MeanLoad::new(element.exponent()); 2],
            greatest: 0.0,
        }
    }

    fn push(&mut self, travel: f64, loads: [f64; 2]) {
        for (side, load) in self.sides.iter_mut().zip(loads) {
            side.push(travel, load);
            self.greatest = self.greatest.max(load);
        }
    }
}

/// A duty of an axis, as far as it has been added.
#[derive(Clone, Debug)]
pub struct AxisDuty {
    pub(super) sheets: Sheets,
    pub(super) motor: MotorDuty,
    pub(super) peak: Option<Rating>,
    pub(super) voltage: Option<Rating>,
    pub(super) losses: PowerCourse,
    pub(super) regeneration: Regeneration,
    pub(super) nut: Contacts,
    pub(super) bearing: Contacts,
    /// Greatest force through the transmission, N.
    pub(super) greatest_force: f64,
    /// Travel of the load, m or rad.
    pub(super) travel: f64,
    /// Travel of the load per radian of the motor.
    radius: f64,
    /// Inertia of all that turns with the motor.
    rotating: f64,
    period: f64,
    /// Speed of the motor in the cycle before.
    before: Option<f64>,
}

impl AxisDuty {
    /// An empty one.
    ///
    /// # Errors
    /// [`CheckError`] if `[rating]` contradicts itself, or effects leave no valid axis.
    pub fn of(axis: &Axis) -> Result<Self, CheckError> {
        let sheets = Sheets::of(axis)?;
        let mechanism = axis.planned_mechanism()?;
        let radius = mechanism.travel_per_radian();
        let load = mechanism.load_inertia() * radius * radius;
        Ok(Self {
            motor: MotorDuty::default(),
            peak: None,
            voltage: None,
            losses: PowerCourse::default(),
            regeneration: Regeneration::with_capacitor(sheets.capacitor_j.unwrap_or(0.0)),
            nut: Contacts::new(RollingElement::Ball),
            bearing: Contacts::new(sheets.bearing_element),
            greatest_force: 0.0,
            travel: 0.0,
            radius,
            rotating: (mechanism.total_inertia() - load).max(0.0),
            period: axis.period,
            before: None,
            sheets,
        })
    }

    /// Adds a stretch.
    ///
    /// # Errors
    /// [`CheckError`] of numbers that are not finite.
    pub fn push(&mut self, stretch: &DutyStretch) -> Result<(), CheckError> {
        let DutyStretch {
            duration,
            speed,
            acceleration,
            torque,
            current,
        } = *stretch;
        let motor_speed = speed / self.radius;
        self.motor.push(duration, torque, motor_speed);
        if let Some(curve) = &self.sheets.peak {
            let now = motor::peak(torque, motor_speed, curve, self.sheets.torque_unit);
            self.peak = Some(self.peak.map_or(now, |before| before.worse(now)));
        }
        if let Some(voltage) = &self.sheets.voltage {
            let now = voltage.rating(current, motor_speed)?;
            self.voltage = Some(self.voltage.map_or(now, |before| before.worse(now)));
        }
        let loss = self.sheets.loss_w(torque, current);
        self.losses.push(duration, loss);
        self.regeneration.push(duration, torque * motor_speed, loss);
        let travel = duration * speed.abs();
        self.travel += travel;
        let force = (torque - self.rotating * acceleration / self.radius) / self.radius;
        self.greatest_force = self.greatest_force.max(force.abs());
        if self.sheets.has_screw {
            let turns = travel / self.radius / TAU;
            let nut = self.loads(force, self.sheets.nut_preload, RollingElement::Ball)?;
            let element = self.sheets.bearing_element;
            let bearing = self.loads(force, self.sheets.bearing_preload, element)?;
            self.nut.push(turns, nut);
            self.bearing.push(turns, bearing);
        }
        Ok(())
    }

    /// Without a preload one contact is taken to carry every load: makers' catalogues do not tell the flanks apart.
    fn loads(
        &self,
        force: f64,
        preload: f64,
        element: RollingElement,
    ) -> Result<[f64; 2], CheckError> {
        match preload > 0.0 {
            true => Ok(preloaded_n(force, preload, element)?),
            false => Ok([force.abs(), 0.0]),
        }
    }

    /// Adds a control cycle as it was simulated, after the one that was added before.
    ///
    /// # Errors
    /// As [`AxisDuty::push`].
    pub fn add_cycle(&mut self, cycle: &Cycle) -> Result<(), CheckError> {
        let change = self.before.map_or(0.0, |before| cycle.motor_speed - before);
        self.before = Some(cycle.motor_speed);
        self.push(&DutyStretch {
            duration: self.period,
            speed: cycle.load_speed,
            acceleration: change / self.period * self.radius,
            torque: cycle.torque,
            current: [cycle.current.d, cycle.current.q],
        })
    }

    /// Duration of what was added, s.
    pub fn duration(&self) -> f64 {
        self.motor.duration_s()
    }

    /// Voltage of the motor at its limits, if the actuator has one.
    pub(super) fn motor_voltage(&self) -> Option<&MotorVoltage> {
        self.sheets.voltage.as_ref()
    }
}
