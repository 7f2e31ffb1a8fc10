//! `position-dependent-friction`: dry friction that is higher over a stretch of the travel.

use super::{Effect, EffectChannel, shape, size};

pub(super) const EFFECT: Effect = Effect {
    name: "position-dependent-friction",
    summary: "dry friction that is higher over a stretch of the travel",
    channel: EffectChannel::Torque,
    depends_on: "position",
    parameters: &[
        size("peak", "N", 60.0, 5e3),
        shape("centre", "m", 0.75, [0.0, 2.0]),
        shape("width", "m", 0.03, [5e-3, 0.3]),
    ],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 3] = super::changes::array(values);
    to.load(move |t| {
        let ratio = (t.position - v[1]) / v[2];
        v[0] * (-0.5 * ratio * ratio).exp() * t.bristle
    });
    Ok(())
}
