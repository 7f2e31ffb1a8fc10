//! `velocity-feedforward`: share of the reference velocity that is fed forward.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "velocity-feedforward",
    summary: "share of the reference velocity that is fed forward",
    channel: EffectChannel::Controller,
    depends_on: "reference velocity",
    parameters: &[size("relative_change", "", 0.002, 0.5)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.ball_screw()?.velocity_feedforward *= 1.0 + v[0];
    Ok(())
}
