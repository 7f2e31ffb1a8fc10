//! `speed-controller-gain`: gain of the speed controller.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "speed-controller-gain",
    summary: "gain of the speed controller",
    channel: EffectChannel::Controller,
    depends_on: "speed error",
    parameters: &[size("relative_change", "", 0.05, 0.8)],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.speed_gain(v[0])?;
    Ok(())
}
