//! The plan of a motion that is known to its end.

use lugre::Exponential;

use super::{HomedAt, PlanSettings, Planned, Planner, Standstill, Target};
use crate::model::DriveModel;
use crate::{Compensator, CompensatorError, Correction, Residual, ResidualModel, Sample};

/// A [`Planner`] that is fed from a motion, as far ahead as it needs.
#[derive(Clone, Debug)]
pub struct Plan<F, T = f64, R = ResidualModel<T>> {
    planner: Planner<T, R>,
    /// Target of a cycle, counted from the start of the motion; beyond its end, rest.
    targets: F,
    own: T,
    homed: Option<HomedAt<T>>,
    held: Option<T>,
    cycle: usize,
    planned: Planned<T>,
}

impl<T: Exponential, F: FnMut(usize) -> Target<T>> Plan<F, T> {
    /// For the motion whose set point of cycle k is `targets(k)`. It is asked for each
    /// cycle once, in order, and again from 0 on after a [`Compensator::reset`].
    ///
    /// # Errors
    /// As [`Planner::new`].
    pub fn new(
        model: &DriveModel<T>,
        settings: &PlanSettings<T>,
        targets: F,
    ) -> Result<Self, CompensatorError> {
        Ok(Self {
            planner: Planner::new(model, settings)?,
            targets,
            own: T::ZERO,
            homed: None,
            held: None,
            cycle: 0,
            planned: Planned::default(),
        })
    }

    /// With what was learned of torque and force that the model does not have.
    #[must_use]
    pub fn with_residual<R: Residual<T>>(self, residual: Option<R>) -> Plan<F, T, R> {
        Plan {
            planner: self.planner.with_residual(residual),
            targets: self.targets,
            own: self.own,
            homed: self.homed,
            held: self.held,
            cycle: self.cycle,
            planned: self.planned,
        }
    }
}

impl<T: Exponential, F: FnMut(usize) -> Target<T>, R: Residual<T>> Plan<F, T, R> {
    /// Says which part of the command, before this motion, was a compensator's: what is
    /// left is taken as held by the drive's integrator.
    #[must_use]
    pub fn after(mut self, own: &Correction<T>) -> Self {
        self.own = own.command;
        self
    }

    /// Says where the drive's position loop, closed at the motor, was homed, where that was
    /// before an earlier motion.
    #[must_use]
    pub fn homed(mut self, homed: HomedAt<T>) -> Self {
        self.homed = Some(homed);
        self
    }

    /// Says with what force friction holds the load, N: [`Planned::friction`] at the end of the
    /// motion before, where this one follows at once.
    #[must_use]
    pub fn held(mut self, friction: T) -> Self {
        self.held = Some(friction);
        self
    }

    /// What the plan says of the cycle that begins with `sample`.
    pub fn advance(&mut self, sample: &Sample<T>) -> Planned<T> {
        let ahead = self.planner.look_ahead();
        if self.cycle == 0 {
            let first = (self.targets)(0);
            self.planner.begin(
                first.reference.position,
                &Standstill {
                    effort: sample.last_command,
                    own: self.own,
                    motor_angle: sample.motor_angle,
                    homed: self.homed,
                    held: self.held,
                },
            );
            self.planner.push(first);
            for k in 1..ahead {
                self.planner.push((self.targets)(k));
            }
        }
        let newest = (self.targets)(self.cycle.saturating_add(ahead));
        if let Some(planned) = self.planner.push(newest) {
            self.planned = planned;
        }
        // Beyond the motion's end all cycles are at rest, so the count may stay where it is full.
        self.cycle = self.cycle.saturating_add(1);
        self.planned
    }

    /// What it said last.
    pub fn planned(&self) -> &Planned<T> {
        &self.planned
    }
}

impl<T: Exponential, F: FnMut(usize) -> Target<T>, R: Residual<T>> Compensator<T>
    for Plan<F, T, R>
{
    fn reset(&mut self) {
        self.cycle = 0;
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        self.advance(sample).correction
    }
}
