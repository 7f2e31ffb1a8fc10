//! `thermal-expansion`: thermal growth of the transmission over time.
//!
//! The load is at x = r θ + ε x, so that it moves by dx/dθ = r/(1 − ε) with the motor.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, Nature, shape, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "thermal-expansion",
    summary: "thermal growth of the transmission over time",
    channel: EffectChannel::Kinematics,
    depends_on: "time and position",
    shown_over: EffectVariable::Position,
    parameters: &[
        signed("strain", Measure::Ratio, 4e-5, 2e-3),
        shape(
            "time_constant",
            Measure::Time,
            Nature::Time([1.0, 5.0], [1.0, 10.0]),
            5.0,
            [0.2, 1e3],
        ),
    ],
    needs: &[EffectNeed::Transmission],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    let r = to.travel_per_radian();
    to.offset(move |s| {
        let left = (-s.time / v[1]).exp();
        let grown = v[0] * (1.0 - left);
        [
            grown * s.position,
            v[0] * left / v[1] * s.position + grown * s.speed,
            r * grown / (1.0 - grown),
        ]
    });
    Ok(())
}
