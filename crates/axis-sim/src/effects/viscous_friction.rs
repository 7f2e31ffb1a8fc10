//! `viscous-friction`: friction proportional to speed.

use super::{Effect, EffectChannel, EffectVariable, Measure, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "viscous-friction",
    summary: "friction proportional to speed",
    channel: EffectChannel::Torque,
    depends_on: "speed",
    shown_over: EffectVariable::Speed,
    parameters: &[size("coefficient", Measure::Damping, 4000.0, 1e5)],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    let steepness = super::Steepness {
        speed: v[0].abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| v[0] * t.speed);
    Ok(())
}
