//! The end of a step of the elastic drive, as far as its load is known.

use super::course::Course;
use super::stepper::{ElasticState, ElasticStepper};
use crate::NutErrors;
use crate::stepper::Contact;

/// What the transmission's force at the end of a step does over it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    /// Travel for a unit of acceleration, s².
    travel: f64,
    /// Speed for a unit of acceleration, s.
    speed: f64,
    /// Part of the force at the step's start that acts too.
    start: f64,
}

impl Share {
    /// The force of start and end, half of a step of `h` seconds each.
    #[inline]
    pub fn average(h: f64) -> Self {
        Self {
            travel: 0.25 * h * h,
            speed: 0.5 * h,
            start: 1.0,
        }
    }

    /// The force of the end over a whole step of `h` seconds.
    #[inline]
    pub fn implicit(h: f64) -> Self {
        Self {
            travel: h * h,
            speed: h,
            start: 0.0,
        }
    }
}

/// What start and torque of a step tell of its end: load and force are left.
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
        let compression = compression.accelerated(h, stepper.mobility * left_out);
        let contact = contact(stepper, start.origin + y.value, share, errors);
        let driven = stepper.per_torque * torque;
        let compression = compression.accelerated(h, driven);
        let mut ahead = Self {
            stepper,
            errors,
            share,
            contact,
            y,
            compression,
            driven,
            closed: [0.0; 2],
        };
        if contact.half_gap == 0.0 {
            let per_load = Course::default().accelerated(h, stepper.load_mobility);
            ahead.closed = [
                ahead.contact_force(0.0),
                contact.force(per_load.value, per_load.rate),
            ];
        }
        ahead
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

/// The contact at the end of a step that leads to `x`.
#[inline]
fn contact(stepper: &ElasticStepper, x: f64, share: Share, errors: &NutErrors) -> Contact {
    let p = stepper.drive.parameters();
    let stiffness = p.stiffness.at(x);
    Contact {
        stiffness,
        damping: stiffness * p.stiffness_damping,
        travel: share.travel * stepper.mobility,
        speed: share.speed * stepper.mobility,
        half_gap: 0.5 * errors.gap(),
    }
}
