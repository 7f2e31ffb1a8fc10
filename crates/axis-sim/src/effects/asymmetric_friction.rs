//! `asymmetric-friction`: dry friction that differs between the directions.

use super::{Effect, EffectChannel, EffectVariable, Measure, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "asymmetric-friction",
    summary: "dry friction that differs between the directions",
    channel: EffectChannel::Torque,
    depends_on: "sign of speed",
    shown_over: EffectVariable::Speed,
    parameters: &[
        size("forward", Measure::Force, 60.0, 5e3),
        size("backward", Measure::Force, 20.0, 5e3),
    ],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    let steepness = super::Steepness {
        bristle: v[0].abs().max(v[1].abs()),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| {
        let level = if t.bristle > 0.0 { v[0] } else { v[1] };
        level * t.bristle
    });
    Ok(())
}
