//! `asymmetric-viscous-friction`: viscous friction that differs between the directions.

use super::{Effect, EffectChannel, EffectVariable, Measure, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "asymmetric-viscous-friction",
    summary: "viscous friction that differs between the directions",
    channel: EffectChannel::Torque,
    depends_on: "speed and its sign",
    shown_over: EffectVariable::Speed,
    parameters: &[
        size("forward", Measure::Damping, 4000.0, 1e5),
        size("backward", Measure::Damping, 2000.0, 1e5),
    ],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    let steepness = super::Steepness {
        speed: v[0].abs().max(v[1].abs()),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| {
        let coefficient = if t.speed > 0.0 { v[0] } else { v[1] };
        coefficient * t.speed
    });
    Ok(())
}
