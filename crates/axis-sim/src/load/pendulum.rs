//! `pendulum`: gravity on a load that turns about a horizontal axis.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::Load;
use crate::effects::{Steepness, TableState};
use crate::part::units::{ANGLE, TORQUE};
use crate::part::{Known, PartKind, quantity};

pub(super) static KIND: PartKind<dyn Load> = PartKind {
    name: "pendulum",
    summary: "gravity on a joint, m g l sin(φ − φ₀): zero with its arm hanging down",
    keys: &[
        quantity("torque", &TORQUE, 0.0, 1e7),
        quantity("hanging_at", &ANGLE, -TAU, TAU),
    ],
    known: &[
        Known::by("gravity_torque", |v, by| v.scale("torque", by)),
        // An encoder's zero is set by a stop, a mark or a level: to half a degree, not to a milliradian.
        Known::by("hanging_angle", |v, by| v.shift("hanging_at", by - 1.0))
            .with_own_tolerance(0.01, None)
            .as_angle(),
    ],
    build: |v| {
        Ok(Arc::new(Pendulum {
            torque: v.number("torque")?,
            hanging_at: v.number("hanging_at")?,
        }))
    },
};

#[derive(Debug)]
struct Pendulum {
    torque: f64,
    hanging_at: f64,
}

impl Load for Pendulum {
    fn force(&self, at: &TableState) -> f64 {
        self.torque * (at.position - self.hanging_at).sin()
    }

    fn steepness(&self) -> Steepness {
        Steepness {
            position: self.torque,
            ..Steepness::default()
        }
    }
}
