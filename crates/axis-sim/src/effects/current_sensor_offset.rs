//! `current-sensor-offset`: what the current sensor shows at no current.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "current-sensor-offset",
    summary: "what the current sensor shows at no current",
    channel: EffectChannel::Torque,
    depends_on: "nothing",
    shown_over: EffectVariable::Time,
    parameters: &[signed("current", Measure::Current, 0.05, 2.0)],
    needs: &[EffectNeed::Currents],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.sensors().current_offset += v[0];
    Ok(())
}
