//! `constant-load`: a force of constant size and direction, as of gravity.

use super::{Effect, EffectChannel, EffectVariable, Measure, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "constant-load",
    summary: "a force of constant size and direction, as of gravity",
    channel: EffectChannel::Torque,
    depends_on: "nothing",
    shown_over: EffectVariable::Time,
    parameters: &[signed("force", Measure::Force, 40.0, 1e4)],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    let steepness = super::Steepness::default();
    to.load_within(steepness, move |t| v[0] * t.loaded);
    Ok(())
}
