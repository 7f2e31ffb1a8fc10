//! `encoder-eccentricity`: reading error of the motor's encoder, once per turn.

use super::{Effect, EffectChannel, shape, size};

pub(super) const EFFECT: Effect = Effect {
    name: "encoder-eccentricity",
    summary: "reading error of the motor's encoder, once per turn",
    channel: EffectChannel::Kinematics,
    depends_on: "motor angle",
    parameters: &[
        size("amplitude", "rad", 1e-3, 0.1),
        shape("phase", "rad", 0.0, [-7.0, 7.0]),
    ],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 2] = super::changes::array(values);
    to.hooks.sensors.eccentricities.push(v);
    Ok(())
}
