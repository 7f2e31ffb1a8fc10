//! `transmission-stiffness`: stiffness of the transmission.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "transmission-stiffness",
    summary: "stiffness of the transmission",
    channel: EffectChannel::Kinematics,
    depends_on: "transmitted force",
    shown_over: EffectVariable::Acceleration,
    parameters: &[signed("relative_change", Measure::Ratio, -0.2, 0.8)],
    needs: &[EffectNeed::Role(Role::TransmissionStiffness)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.scale(Role::TransmissionStiffness, v[0])?;
    Ok(())
}
