//! `position-dependent-friction`: dry friction that is higher over a stretch of the travel.

use super::{Effect, EffectChannel, EffectVariable, Measure, Nature, shape, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "position-dependent-friction",
    summary: "dry friction that is higher over a stretch of the travel",
    channel: EffectChannel::Torque,
    depends_on: "position",
    shown_over: EffectVariable::Position,
    parameters: &[
        size("peak", Measure::Force, 60.0, 5e3),
        shape(
            "centre",
            Measure::Displacement,
            Nature::Place([0.15, 0.75]),
            0.75,
            [0.0, 2.0],
        ),
        shape(
            "width",
            Measure::Displacement,
            Nature::Width([0.05, 0.2]),
            0.03,
            [5e-3, 0.3],
        ),
    ],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 3] = super::changes::array(values);
    // The steepest slope of e^(−x²/2) is 1/√e.
    let steepness = super::Steepness {
        position: 0.607 * (v[0] / v[2]).abs(),
        bristle: v[0].abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| {
        let ratio = (t.position - v[1]) / v[2];
        v[0] * (-0.5 * ratio * ratio).exp() * t.bristle
    });
    Ok(())
}
