//! `motor-inertia`: inertia on the motor's shaft.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "motor-inertia",
    summary: "inertia on the motor's shaft",
    channel: EffectChannel::Torque,
    depends_on: "acceleration",
    parameters: &[size("inertia", "kg*m^2", 4e-4, 0.05)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.drive(|p| p.motor_inertia += v[0])?;
    Ok(())
}
