//! `process-force`: a force during a part of the time.

use super::{Effect, EffectChannel, EffectVariable, Measure, Nature, shape, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "process-force",
    summary: "a force during a part of the time",
    channel: EffectChannel::Torque,
    depends_on: "time",
    shown_over: EffectVariable::Time,
    parameters: &[
        signed("force", Measure::Force, 60.0, 1e4),
        shape(
            "start",
            Measure::Time,
            Nature::Begin([0.4, 3.0]),
            1.0,
            [0.0, 1e3],
        ),
        shape(
            "end",
            Measure::Time,
            Nature::End([0.3, 1.5]),
            1.6,
            [0.0, 1e3],
        ),
    ],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 3] = super::changes::array(values);
    // Rises and falls over 10 ms, so that the times can be estimated.
    let ramp = |t: f64| (t / 0.01).clamp(0.0, 1.0);
    let steepness = super::Steepness::default();
    to.load_within(steepness, move |t| {
        v[0] * (ramp(t.time - v[1]) - ramp(t.time - v[2]))
    });
    Ok(())
}
