//! `stribeck-friction`: dry friction that falls with speed.

use super::{Effect, EffectChannel, EffectVariable, Measure, Nature, shape, size};
use crate::error::SetupError;

/// Upper end of the range that the survey of Armstrong-Hélouvry, Dupont and Canudas
/// de Wit (1994, doi:10.1016/0005-1098(94)90209-7) gives for the velocity, m/s. With a
/// larger one, beside dry friction of the other sign, it would be a drag with the square
/// of speed.
const FASTEST: f64 = 0.1;

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
            Nature::Speed([0.004, 0.015, 0.05], [0.005, 0.05]),
            0.02,
            [1e-3, FASTEST],
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
