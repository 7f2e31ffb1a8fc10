//! `torque-constant`: torque per current.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "torque-constant",
    summary: "torque per current",
    channel: EffectChannel::Torque,
    depends_on: "current",
    parameters: &[size("relative_change", "", 0.05, 0.5)],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.torque_constant(v[0])?;
    Ok(())
}
