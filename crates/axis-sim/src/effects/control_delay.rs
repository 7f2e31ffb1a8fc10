//! `control-delay`: time by which the current reference comes late.

use super::{Effect, EffectChannel, positive};

pub(super) const EFFECT: Effect = Effect {
    name: "control-delay",
    summary: "time by which the current reference comes late",
    channel: EffectChannel::Controller,
    depends_on: "change of the current reference",
    parameters: &[positive("time", "s", 1e-4, 5e-3)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.hooks.delay += v[0].max(0.0);
    Ok(())
}
