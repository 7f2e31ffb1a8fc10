//! `coulomb-friction`: dry friction, equal in both directions.

use super::{Effect, EffectChannel, EffectVariable, Measure, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "coulomb-friction",
    summary: "dry friction, equal in both directions",
    channel: EffectChannel::Torque,
    depends_on: "sign of speed",
    shown_over: EffectVariable::Speed,
    parameters: &[size("force", Measure::Force, 60.0, 5e3)],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    let steepness = super::Steepness {
        bristle: v[0].abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| v[0] * t.bristle);
    Ok(())
}
