//! `clock-offset`: time by which the table's channel is late against the motor's.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "clock-offset",
    summary: "time by which the table's channel is late against the motor's",
    channel: EffectChannel::Clock,
    depends_on: "speed",
    parameters: &[size("time", "s", 2e-5, 5e-3)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.hooks.clock_offset += v[0];
    Ok(())
}
