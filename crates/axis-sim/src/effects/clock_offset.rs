//! `clock-offset`: delay of the load's channel relative to those of the motor.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "clock-offset",
    summary: "delay of the load's channel relative to those of the motor",
    channel: EffectChannel::Clock,
    depends_on: "speed",
    shown_over: EffectVariable::Speed,
    parameters: &[signed("time", Measure::Time, 2e-5, 5e-3)],
    needs: &[EffectNeed::AnotherClock],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.clock_offset(v[0]);
    Ok(())
}
