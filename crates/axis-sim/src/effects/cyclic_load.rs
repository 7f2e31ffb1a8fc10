//! `cyclic-load`: a force that repeats in time, as with the cycle of the machine.
//!
//! `a sin(2π t / T + φ)` against positive motion, t from the start of the log. It comes up
//! over 20 ms.

use std::f64::consts::TAU;

use super::{Effect, EffectChannel, EffectVariable, Measure, Nature, PHASE, shape, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "cyclic-load",
    summary: "a force that repeats in time, as with the machine's cycle",
    channel: EffectChannel::Torque,
    depends_on: "time",
    shown_over: EffectVariable::Time,
    parameters: &[
        size("amplitude", Measure::Force, 60.0, 1e4),
        shape(
            "period",
            Measure::Time,
            Nature::Extent(&[0.5, 0.8, 1.3, 2.1], [0.5, 2.5]),
            1.0,
            [0.01, 1e3],
        ),
        PHASE,
    ],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 3] = super::changes::array(values);
    let steepness = super::Steepness::default();
    to.load_within(steepness, move |t| {
        v[0] * (TAU * t.time / v[1] + v[2]).sin() * t.loaded
    });
    Ok(())
}
