//! `lead-error`: travel per turn.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "lead-error",
    summary: "travel per turn",
    channel: EffectChannel::Kinematics,
    depends_on: "position",
    shown_over: EffectVariable::Position,
    parameters: &[signed("slope", Measure::Ratio, 1e-4, 5e-3)],
    needs: &[EffectNeed::Transmission],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    let r = to.travel_per_radian();
    let growth = v[0] * r;
    to.offset(move |s| [growth * s.angle, growth * s.rate, growth]);
    Ok(())
}
