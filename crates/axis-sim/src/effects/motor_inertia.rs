//! `motor-inertia`: inertia on the motor's shaft.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, size};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "motor-inertia",
    summary: "inertia on the motor's shaft",
    channel: EffectChannel::Torque,
    depends_on: "acceleration",
    shown_over: EffectVariable::Acceleration,
    parameters: &[size("inertia", Measure::MotorInertia, 4e-4, 0.05)],
    needs: &[EffectNeed::Role(Role::MotorInertia)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.add(Role::MotorInertia, v[0])?;
    Ok(())
}
