//! `constant-load`: a force of constant size and direction, as of gravity.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "constant-load",
    summary: "a force of constant size and direction, as of gravity",
    channel: EffectChannel::Torque,
    depends_on: "nothing",
    parameters: &[size("force", "N", 40.0, 1e4)],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.load(move |t| v[0] * t.pressed);
    Ok(())
}
