//! Transmission error: by how much the load is ahead of where the motor's angle puts it. Where both are
//! measured it is compared as a channel of its own, as what lies between them shows there directly:
//!
//! ```text
//! x − r θ = o(θ, x, t, F) − r C(x) (T − τ Ṫ) − g/2 sgn F − r e(θ) − δ v,   T = r F + Σ s_i J_i α
//! ```
//!
//! o: error of the kinematics; C: compliance seen at the motor; F: force at the load; J_i: what turns
//! between motor and load, at the share s_i of the compliance; g: backlash; e: reading error of the
//! motor's encoder; δ: time by which the load is shown later than the motor. Only how it changes in a
//! log counts, as neither encoder's zero is known.

use super::filter::derivative;
use super::law::{Ends, lagging, screw_state};
use super::motion::{Measured, Whose};
use super::spectrum::{most_noise, passed};
use crate::axis::Axis;
use crate::effects::Hooks;
use crate::freedom::Freedom;

/// The channel of a log of which motor and load were measured.
#[derive(Clone, Debug)]
pub(super) struct Transmission {
    /// Name with unit.
    pub name: &'static str,
    /// As measured, at each sample of the log.
    pub samples: Vec<f64>,
    /// Noise of it behind the low-pass of the comparison, RMS.
    pub noise: f64,
}

/// Names of the channel, of a load that moves along a line and of one that turns. It has no zero of its own.
pub const TRANSMISSION_ERROR: [&str; 2] = ["transmission_error_m", "transmission_error_rad"];

fn name(freedom: Freedom) -> &'static str {
    let [linear, rotary] = TRANSMISSION_ERROR;
    match freedom {
        Freedom::Linear => linear,
        Freedom::Rotary => rotary,
    }
}

impl Transmission {
    /// `None` unless positions of both were measured.
    pub fn of(measured: &[Measured], axis: &Axis, period: f64, cutoff: f64) -> Option<Self> {
        let of = |whose: Whose| measured.iter().find(|m| m.whose == whose);
        let [load, motor] = [of(Whose::Load)?, of(Whose::Motor)?];
        let r = axis.travel_per_radian();
        let pairs = load.samples().iter().zip(motor.samples());
        let samples: Vec<f64> = pairs.map(|(x, angle)| x - r * angle).collect();
        Some(Self {
            name: name(axis.freedom()),
            noise: (most_noise(&samples, period) * passed(0, cutoff)).sqrt(),
            samples,
        })
    }
}

/// Displacement at the load by the force that is transmitted there, m/N or rad/(N·m).
pub(super) fn give(axis: &Axis, position: f64) -> f64 {
    axis.mechanism.compliance(position) * axis.travel_per_radian().powi(2)
}

/// That of an axis (its effects made) along the motions of load and motor, `late` being the time by
/// which the load is shown later than the motor, s.
pub(super) fn error(axis: &Axis, hooks: &Hooks, ends: &Ends, late: f64, h: f64) -> Vec<f64> {
    let (load, motor) = (&ends.load, &ends.motor);
    let mass = axis.mechanism.load_inertia();
    let pairs = ends.forces.iter().zip(&load.acceleration);
    let transmitted: Vec<f64> = pairs.map(|(force, a)| force + mass * a).collect();
    let turning = lagging(axis, load) / axis.travel_per_radian();
    let pairs = transmitted.iter().zip(&motor.acceleration);
    let winding: Vec<f64> = pairs.map(|(force, a)| force + turning * a).collect();
    let rates = derivative(&winding, h);
    let damping = axis.mechanism.stiffness_damping();
    let half_gap = 0.5 * axis.mechanism.backlash();
    let one = |(k, force): (usize, &f64)| {
        let mut state = screw_state(load, motor, k, h);
        state.transmitted = *force;
        let of_kinematics = match hooks.has_offsets() {
            true => hooks.offset_at(&state)[0],
            false => 0.0,
        };
        let wind_up = give(axis, state.position) * (winding[k] - damping * rates[k]);
        let of_encoder = axis.travel_per_radian() * hooks.sensors.eccentricity(state.angle);
        of_kinematics - wind_up - half_gap * side(*force) - of_encoder - late * state.speed
    };
    transmitted.iter().enumerate().map(one).collect()
}

/// The flank of a transmission with play that a force is transmitted by.
fn side(force: f64) -> f64 {
    match force == 0.0 {
        true => 0.0,
        false => force.signum(),
    }
}
