//! `motor-inertia`: inertia on the motor's shaft.

use super::{Effect, EffectChannel, Measure, Need, Variable, size};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "motor-inertia",
    summary: "inertia on the motor's shaft",
    channel: EffectChannel::Torque,
    depends_on: "acceleration",
    shown_over: Variable::Acceleration,
    parameters: &[size("inertia", Measure::MotorInertia, 4e-4, 0.05)],
    needs: &[Need::Role(Role::MotorInertia)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.add(Role::MotorInertia, v[0])?;
    Ok(())
}
