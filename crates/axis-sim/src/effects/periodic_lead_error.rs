//! `periodic-lead-error`: travel error that repeats with the motor's turn; of another order it is
//! `kinematic-error-harmonic`.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, PHASE, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "periodic-lead-error",
    summary: "travel error that repeats with the motor's turn",
    channel: EffectChannel::Kinematics,
    depends_on: "motor angle",
    shown_over: EffectVariable::MotorAngle,
    parameters: &[size("amplitude", Measure::Displacement, 2e-6, 1e-3), PHASE],
    needs: &[EffectNeed::Transmission],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    super::kinematic_error_harmonic::add(to, 1.0, v);
    Ok(())
}
