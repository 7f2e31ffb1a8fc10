//! `encoder`: a rotary encoder, on a motor or a load that turns.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::Sensor;
use super::signal::Signal;
use crate::freedom::Freedom;
use crate::part::units::{ANGLE, TIME};
use crate::part::{PartKind, count, quantity};

pub(super) static KIND: PartKind<dyn Sensor> = PartKind {
    name: "encoder",
    summary: "rotary encoder with lines, the error in its signal period",
    keys: &[
        count("lines", 1, 10_000_000),
        quantity("resolution", &ANGLE, 0.0, 1.0).optional(),
        quantity("periodic_error", &ANGLE, 0.0, 0.1).optional(),
        quantity("phase", &ANGLE, -TAU, TAU).optional(),
        quantity("noise", &ANGLE, 0.0, 0.1).optional(),
        quantity("delay", &TIME, 0.0, 0.01).optional(),
    ],
    known: &[],
    build: |v| {
        Ok(Arc::new(Signal {
            freedom: Freedom::Rotary,
            resolution: v.or("resolution", 0.0),
            signal_period: TAU / f64::from(v.count("lines")?),
            periodic_error: v.or("periodic_error", 0.0),
            phase: v.or("phase", 0.0),
            noise: v.or("noise", 0.0),
            delay: v.or("delay", 0.0),
        }))
    },
};
