//! `stribeck-friction`: dry friction that falls with speed.

use super::{Effect, EffectChannel, EffectVariable, Measure, Nature, shape, size};
use crate::error::SetupError;

/// A tenth of the reference machine's speed, m/s, where forms of friction end too: above that it is no fall from break-away to sliding,
/// but a curve over all speeds, which beside dry and viscous friction stands for any law over speed.
const FASTEST: f64 = 0.012;

pub(super) const EFFECT: Effect = Effect {
    name: "stribeck-friction",
    summary: "dry friction that falls with speed (rises if the force is negative)",
    channel: EffectChannel::Torque,
    depends_on: "low speed",
    shown_over: EffectVariable::Speed,
    parameters: &[
        size("force", Measure::Force, 60.0, 5e3),
        shape(
            "velocity",
            Measure::Speed,
            Nature::Speed([0.001, 0.003, 0.009], [0.001, 0.008]),
            0.005,
            [2e-4, FASTEST],
        ),
    ],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    // The steepest slope of e^(−x²) is √(2/e).
    let steepness = super::Steepness {
        speed: 0.858 * (v[0] / v[1]).abs(),
        bristle: v[0].abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| {
        let ratio = t.speed / v[1];
        v[0] * (-ratio * ratio).exp() * t.bristle
    });
    Ok(())
}
