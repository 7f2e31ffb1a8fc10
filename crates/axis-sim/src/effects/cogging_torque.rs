//! `cogging-torque`: torque that repeats with the motor's turn, at any current.

use super::{Effect, EffectChannel, shape, size};

pub(super) const EFFECT: Effect = Effect {
    name: "cogging-torque",
    summary: "torque that repeats with the motor's turn, at any current",
    channel: EffectChannel::Torque,
    depends_on: "motor angle",
    parameters: &[
        size("amplitude", "N*m", 0.05, 2.0),
        shape("order", "", 8.0, [1.0, 60.0]),
        shape("phase", "rad", 0.0, [-7.0, 7.0]),
    ],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 3] = super::changes::array(values);
    to.torque(move |angle, _| v[0] * (v[1] * angle + v[2]).sin());
    Ok(())
}
