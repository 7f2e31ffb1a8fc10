//! `scale`: a linear scale beside the load.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::Sensor;
use super::signal::Signal;
use crate::freedom::Freedom;
use crate::part::units::{ANGLE, LENGTH, TIME};
use crate::part::{PartKind, quantity};

pub(super) static KIND: PartKind<dyn Sensor> = PartKind {
    name: "scale",
    summary: "linear scale",
    keys: &[
        quantity("resolution", &LENGTH, 0.0, 1e-2).optional(),
        quantity("signal_period", &LENGTH, 1e-9, 0.1).optional(),
        quantity("periodic_error", &LENGTH, 0.0, 1e-3).optional(),
        quantity("phase", &ANGLE, -TAU, TAU).optional(),
        quantity("noise", &LENGTH, 0.0, 1e-3).optional(),
        quantity("delay", &TIME, 0.0, 0.01).optional(),
    ],
    known: &[],
    build: |v| {
        Ok(Arc::new(Signal {
            freedom: Freedom::Linear,
            resolution: v.or("resolution", 0.0),
            // The usual period of a photoelectric scale.
            signal_period: v.or("signal_period", 20e-6),
            periodic_error: v.or("periodic_error", 0.0),
            phase: v.or("phase", 0.0),
            noise: v.or("noise", 0.0),
            delay: v.or("delay", 0.0),
        }))
    },
};
