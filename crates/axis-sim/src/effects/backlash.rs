//! `backlash`: free travel between screw and nut.

use super::{Effect, EffectChannel, positive};

pub(super) const EFFECT: Effect = Effect {
    name: "backlash",
    summary: "free travel between screw and nut",
    channel: EffectChannel::Kinematics,
    depends_on: "sign of nut force",
    parameters: &[positive("gap", "m", 4e-6, 1e-3)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.hooks.gap += v[0].max(0.0);
    Ok(())
}
