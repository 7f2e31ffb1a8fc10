//! `current-sensor-offset`: what the current sensor shows at no current.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "current-sensor-offset",
    summary: "what the current sensor shows at no current",
    channel: EffectChannel::Torque,
    depends_on: "nothing",
    parameters: &[size("current", "A", 0.05, 2.0)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.hooks.sensors.current_offset += v[0];
    Ok(())
}
