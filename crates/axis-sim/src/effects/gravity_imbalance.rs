//! `gravity-imbalance`: gravity on a load that turns and is out of balance.
//!
//! `m g l sin(φ + φ₀)` against positive motion, φ the angle of the load: the law of a
//! pendulum. At the start of a log it comes up over 20 ms. On a motor's shaft the same is
//! `cogging-torque` of order 1.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, PHASE, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "gravity-imbalance",
    summary: "gravity on a load that turns and is out of balance",
    channel: EffectChannel::Torque,
    depends_on: "position",
    shown_over: EffectVariable::Position,
    parameters: &[size("torque", Measure::Force, 60.0, 1e4), PHASE],
    needs: &[EffectNeed::Turning],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    let steepness = super::Steepness {
        position: v[0].abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| {
        v[0] * (t.position + v[1]).sin() * t.loaded
    });
    Ok(())
}
