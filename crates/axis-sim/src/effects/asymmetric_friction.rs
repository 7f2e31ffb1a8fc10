//! `asymmetric-friction`: dry friction that differs between the directions.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "asymmetric-friction",
    summary: "dry friction that differs between the directions",
    channel: EffectChannel::Torque,
    depends_on: "sign of speed",
    parameters: &[
        size("forward", "N", 60.0, 5e3),
        size("backward", "N", 20.0, 5e3),
    ],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 2] = super::changes::array(values);
    to.load(move |t| {
        let level = if t.bristle > 0.0 { v[0] } else { v[1] };
        level * t.bristle
    });
    Ok(())
}
