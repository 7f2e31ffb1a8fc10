//! `controller-gain`: gain of the position controller.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "controller-gain",
    summary: "gain of the position controller",
    channel: EffectChannel::Controller,
    depends_on: "position error",
    parameters: &[size("relative_change", "", 0.05, 0.8)],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.position_gain(v[0])?;
    Ok(())
}
