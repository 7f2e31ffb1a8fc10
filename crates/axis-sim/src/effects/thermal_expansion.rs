//! `thermal-expansion`: growth of the screw with time.

use super::{Effect, EffectChannel, shape, size};

pub(super) const EFFECT: Effect = Effect {
    name: "thermal-expansion",
    summary: "growth of the screw with time",
    channel: EffectChannel::Kinematics,
    depends_on: "time and position",
    parameters: &[
        size("strain", "", 4e-5, 2e-3),
        shape("time_constant", "s", 5.0, [0.2, 1e3]),
    ],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 2] = super::changes::array(values);
    to.offset(move |s| {
        let left = (-s.time / v[1]).exp();
        let grown = v[0] * (1.0 - left);
        [
            grown * s.position,
            v[0] * left / v[1] * s.position + grown * s.speed,
        ]
    });
    Ok(())
}
