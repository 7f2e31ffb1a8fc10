//! `encoder-eccentricity`: reading error of the motor's encoder, once per turn.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, PHASE, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "encoder-eccentricity",
    summary: "reading error of the motor's encoder, once per turn",
    channel: EffectChannel::Kinematics,
    depends_on: "motor angle",
    shown_over: EffectVariable::MotorAngle,
    parameters: &[size("amplitude", Measure::MotorAngle, 1e-3, 0.1), PHASE],
    needs: &[EffectNeed::MotorEncoder],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    to.sensors().eccentricities.push(v);
    Ok(())
}
