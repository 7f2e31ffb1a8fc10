//! `resolver`: the error of its two windings repeats twice in each of its periods.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::Sensor;
use super::signal::Signal;
use crate::freedom::Freedom;
use crate::part::units::{ANGLE, TIME};
use crate::part::{PartKind, count, quantity};

pub(super) static KIND: PartKind<dyn Sensor> = PartKind {
    name: "resolver",
    summary: "resolver, its error twice in each of its periods",
    keys: &[
        count("pole_pairs", 1, 100),
        count("bits", 4, 32),
        quantity("error", &ANGLE, 0.0, 0.1),
        quantity("phase", &ANGLE, -TAU, TAU).optional(),
        quantity("noise", &ANGLE, 0.0, 0.1).optional(),
        quantity("delay", &TIME, 0.0, 0.01).optional(),
    ],
    known: &[],
    build: |v| {
        let period = TAU / f64::from(v.count("pole_pairs")?);
        Ok(Arc::new(Signal {
            freedom: Freedom::Rotary,
            resolution: period / 2f64.powi(v.count("bits")? as i32),
            signal_period: 0.5 * period,
            periodic_error: v.number("error")?,
            phase: v.or("phase", 0.0),
            noise: v.or("noise", 0.0),
            delay: v.or("delay", 0.0),
        }))
    },
};
