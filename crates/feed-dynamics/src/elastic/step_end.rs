//! The end of a step of the elastic drive, as far as its load is known.

use super::average_acceleration::Course;
use super::prepared::{ElasticState, ElasticStepper};
use super::transmission::Share;
use crate::NutErrors;
use crate::stepper::Contact;

/// The end of a step as far as start and torque determine it; load and force are still unknown.
pub(super) struct Ahead<'a> {
    stepper: &'a ElasticStepper,
    errors: &'a NutErrors,
    share: Share,
    contact: Contact,
    /// y without the force and the load of the end.
    y: Course,
    /// δ likewise.
    compression: Course,
    /// What the motor adds to δ̈ at the end, m/s².
    driven: f64,
    /// Without a gap: the force without a load, and what a newton of load adds to it.
    closed: [f64; 2],
}

impl<'a> Ahead<'a> {
    #[inline]
    pub fn new(
        stepper: &'a ElasticStepper,
        start: &ElasticState,
        torque: f64,
        errors: &'a NutErrors,
        share: Share,
    ) -> Self {
        let h = stepper.step;
        let left_out = (1.0 - share.start) * start.force;
        let y = start.y.predicted(h);
        let y = y.accelerated(h, -stepper.load_mobility * left_out);
        let compression = start.compression.predicted(h);
        let driven = stepper.per_torque * torque;
        let compression = compression.accelerated(h, stepper.mobility * left_out + driven);
        let transmission = match stepper.constant {
            Some(transmission) => transmission,
            None => {
                let stiffness = &stepper.drive.parameters().stiffness;
                stepper.transmission(stiffness.at(start.origin + y.value))
            }
        };
        let (offset, rate) = (errors.offset(), errors.offset_rate());
        let pressed = transmission.stiffness * (compression.value + offset)
            + transmission.damping * (compression.rate + rate);
        Self {
            stepper,
            errors,
            share,
            contact: transmission.contact(stepper.mobility, share, 0.5 * errors.gap()),
            y,
            compression,
            driven,
            closed: [transmission.left * pressed, transmission.per_load],
        }
    }

    /// The compression that there would be without the force.
    #[inline]
    fn free(&self, load: f64) -> Course {
        let s = self.stepper;
        self.compression.accelerated(s.step, s.load_mobility * load)
    }

    /// The force: linear in the load, as the contact's end values are; with a gap piece
    /// by piece.
    #[inline]
    pub fn force(&self, load: f64) -> f64 {
        if self.contact.half_gap == 0.0 {
            return self.closed[0] + self.closed[1] * load;
        }
        self.contact_force(load)
    }

    #[inline]
    fn contact_force(&self, load: f64) -> f64 {
        let (free, errors) = (self.free(load), self.errors);
        let (offset, rate) = (errors.offset(), errors.offset_rate());
        self.contact.force(free.value + offset, free.rate + rate)
    }

    /// The load's own course under `force`.
    #[inline]
    pub fn load_course(&self, load: f64, force: f64) -> Course {
        let s = self.stepper;
        let push = s.load_mobility * force;
        let course = self.y.accelerated(s.step, -s.load_mobility * load);
        Course {
            acceleration: s.load_mobility * (force - load),
            ..course.pushed(self.share.travel * push, self.share.speed * push)
        }
    }

    /// Brings `state` to the end under `load`.
    #[inline]
    pub fn finish(&self, state: &mut ElasticState, load: f64) {
        let (free, errors, force) = (self.free(load), self.errors, self.force(load));
        let given = -self.stepper.mobility * force;
        state.y = self.load_course(load, force);
        state.compression = Course {
            acceleration: self.driven + self.stepper.load_mobility * load + given,
            ..free.pushed(self.share.travel * given, self.share.speed * given)
        };
        let (offset, rate) = (errors.offset(), errors.offset_rate());
        state.flank = if errors.gap() == 0.0 {
            0.0
        } else {
            self.contact.flank(free.value + offset, free.rate + rate)
        };
        state.errors = *errors;
        state.force = force;
        state.load_before = state.load;
        state.load = load;
    }
}
