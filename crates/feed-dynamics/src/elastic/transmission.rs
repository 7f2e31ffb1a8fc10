//! What the transmission's force does over a step.

use crate::stepper::Contact;

/// What the transmission's force at the end of a step does over it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    /// Travel for a unit of acceleration, s².
    pub(super) travel: f64,
    /// Speed for a unit of acceleration, s.
    pub(super) speed: f64,
    /// Part of the force at the step's start that acts too.
    pub(super) start: f64,
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

/// The transmission where its stiffness is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transmission {
    /// k, N/m.
    pub(super) stiffness: f64,
    /// βk, N·s/m.
    pub(super) damping: f64,
    /// Without a gap, over a step with the force of both ends: the share of a force that remains after
    /// both sides have moved under it, and the force per newton of load.
    pub(super) left: f64,
    pub(super) per_load: f64,
}

impl Transmission {
    /// Of stiffness k (N/m) and damping βk (N·s/m), over steps of `h` seconds; mobilities of both
    /// sides together and of the load, 1/kg.
    #[inline]
    pub fn new(stiffness: f64, damping: f64, h: f64, [mobility, load_mobility]: [f64; 2]) -> Self {
        let share = Share::average(h);
        let own = stiffness * share.travel + damping * share.speed;
        let left = 1.0 / (1.0 + own * mobility);
        Self {
            stiffness,
            damping,
            left,
            per_load: left * own * load_mobility,
        }
    }

    /// As a contact with a gap or without.
    #[inline]
    pub(super) fn contact(&self, mobility: f64, share: Share, half_gap: f64) -> Contact {
        Contact {
            stiffness: self.stiffness,
            damping: self.damping,
            travel: share.travel * mobility,
            speed: share.speed * mobility,
            half_gap,
        }
    }
}
