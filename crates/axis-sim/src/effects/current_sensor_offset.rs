//! `current-sensor-offset`: reading of the current sensors of phases a and b at zero current.
//!
//! A drive measures two phases and has the third from their sum, so that offsets δ_a and δ_b are
//! a vector that stands still in the stator,
//!
//! ```text
//! δ_α = δ_a,   δ_β = (δ_a + 2 δ_b)/√3,   length 2/√3 √(δ_a² + δ_a δ_b + δ_b²)
//! ```
//!
//! and turns against the electrical angle in the rotor's frame, where the current is controlled:
//! with the shown current held, the torque ripples once in an electrical period. (Chung and Sul,
//! "Analysis and compensation of current measurement error in vector-controlled AC motor
//! drives", IEEE Trans. Ind. Appl. 34 (1998) 340–345, doi:10.1109/28.663477.) One phase that is off
//! makes a ripple of 2/√3 of its offset. A single current without an electrical angle shows δ_a,
//! whatever turns.
//!
//! Sensors are off by some thousandths of their range. It looks like a `cogging-torque` or
//! `force-ripple` of that order, which acts on the torque as it is, and beyond the bandwidth of
//! the current loop is not followed; on an axis that hardly turns, like a `constant-load`.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "current-sensor-offset",
    summary: "reading of the current sensors of phases a and b at zero current",
    channel: EffectChannel::Torque,
    depends_on: "motor angle",
    shown_over: EffectVariable::MotorAngle,
    parameters: &[
        signed("phase_a", Measure::Current, 0.05, 2.0),
        signed("phase_b", Measure::Current, 0.05, 2.0),
    ],
    needs: &[EffectNeed::Currents],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    let poles = to.axis.pole_pairs();
    let offset = &mut to.sensors().current_offset;
    for (phase, by) in offset.phases.iter_mut().zip(v) {
        *phase += by;
    }
    offset.poles = poles;
    Ok(())
}
