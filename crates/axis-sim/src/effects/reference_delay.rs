//! `reference-delay`: delay of the reference's channel relative to all others.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "reference-delay",
    summary: "delay of the reference's channel relative to all others",
    channel: EffectChannel::Clock,
    depends_on: "reference velocity",
    shown_over: EffectVariable::Speed,
    parameters: &[signed("time", Measure::Time, 5e-5, 2e-2)],
    needs: &[EffectNeed::Reference],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.reference_delay(v[0]);
    Ok(())
}
