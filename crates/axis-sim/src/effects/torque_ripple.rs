//! `torque-ripple`: torque that repeats at six times the electrical turn, in proportion to it.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, PHASE, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "torque-ripple",
    summary: "torque that repeats at six times the electrical turn, in proportion to it",
    channel: EffectChannel::Torque,
    depends_on: "motor angle and current",
    shown_over: EffectVariable::MotorAngle,
    parameters: &[size("relative_amplitude", Measure::Ratio, 0.03, 0.5), PHASE],
    needs: &[EffectNeed::Poles],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    let order = 6.0 * to.pole_pairs();
    to.torque(move |angle, torque| v[0] * torque * (order * angle + v[1]).sin());
    Ok(())
}
