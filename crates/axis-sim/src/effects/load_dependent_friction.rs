//! `load-dependent-friction`: losses of a gear or nut that grow with the force through it.
//!
//! `η |F| u` against the motion, with F the force of the transmission on the load and u
//! the unit bristle: of η = 0.05 a twentieth of the force is lost. Bittencourt and
//! Gunnarsson, J. Dyn. Syst. Meas. Control 134 (2012) 051013, doi:10.1115/1.4006589, find
//! dry friction of a robot's joint that is linear in the magnitude of its load torque.
//!
//! F is that of the step's start ([`super::TableState::transmitted`]).

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "load-dependent-friction",
    summary: "dry friction in proportion to the force through the transmission",
    channel: EffectChannel::Torque,
    depends_on: "transmitted force and sign of speed",
    shown_over: EffectVariable::Acceleration,
    parameters: &[size("ratio", Measure::Ratio, 0.05, 0.5)],
    needs: &[EffectNeed::Transmission],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    // No bound is known of the force, so none of how steep it is over the bristle.
    let unbounded = if v[0] == 0.0 { 0.0 } else { f64::INFINITY };
    let steepness = super::Steepness {
        bristle: unbounded,
        transmitted: v[0].abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| v[0] * t.transmitted.abs() * t.bristle);
    Ok(())
}
