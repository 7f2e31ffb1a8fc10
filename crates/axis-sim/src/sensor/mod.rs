//! Position sensors: of the load and of the motor.

mod encoder;
mod resolver;
mod scale;
mod signal;

use std::fmt;

use crate::freedom::Freedom;
use crate::part::PartKind;

/// All kinds of position sensor, one line each.
pub const SENSORS: &[&PartKind<dyn Sensor>] = &[&scale::KIND, &encoder::KIND, &resolver::KIND];

/// A position sensor, immutable.
pub trait Sensor: fmt::Debug + Send + Sync {
    /// What it measures: a position along a line, or an angle.
    fn freedom(&self) -> Freedom;

    /// Step of what it shows, m or rad; 0 for none.
    fn resolution(&self) -> f64 {
        0.0
    }

    /// Time by which what it shows is late, s.
    fn delay(&self) -> f64 {
        0.0
    }

    /// Whether it shows its quantity without noise and without steps, late or periodically wrong as it may be.
    fn is_exact(&self) -> bool {
        self.resolution() == 0.0
    }

    /// The sensor at work, sampled every `period` seconds. `noise` is the seed of its noise;
    /// without one it has neither noise nor steps, but all that repeats and delays.
    fn start(&self, period: f64, noise: Option<u64>) -> Box<dyn Sensing>;
}

/// A position sensor at work.
pub trait Sensing: fmt::Debug + Send + Sync {
    /// What it shows of a true position or angle (m, rad).
    fn read(&mut self, position: f64) -> f64;

    /// As if the position had been there, at the speed (per second), for ever.
    fn settle(&mut self, position: f64, speed: f64);

    /// A copy.
    fn copy(&self) -> Box<dyn Sensing>;
}
