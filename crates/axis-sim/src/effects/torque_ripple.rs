//! `torque-ripple`: torque that repeats at six times the electrical turn, in proportion to it.

use super::{Effect, EffectChannel, shape, size};

pub(super) const EFFECT: Effect = Effect {
    name: "torque-ripple",
    summary: "torque that repeats at six times the electrical turn, in proportion to it",
    channel: EffectChannel::Torque,
    depends_on: "motor angle and current",
    parameters: &[
        size("relative_amplitude", "", 0.03, 0.5),
        shape("phase", "rad", 0.0, [-7.0, 7.0]),
    ],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 2] = super::changes::array(values);
    let order = 6.0 * f64::from(to.ball_screw()?.motor.parameters().pole_pairs);
    to.torque(move |angle, torque| v[0] * torque * (order * angle + v[1]).sin());
    Ok(())
}
