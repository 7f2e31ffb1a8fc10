//! `backlash`: free travel of the transmission.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, positive};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "backlash",
    summary: "free travel of the transmission",
    channel: EffectChannel::Kinematics,
    depends_on: "sign of the transmitted force",
    shown_over: EffectVariable::Acceleration,
    parameters: &[positive("gap", Measure::Displacement, 4e-6, 1e-3)],
    needs: &[EffectNeed::Role(Role::Backlash)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.add(Role::Backlash, v[0].max(0.0))?;
    Ok(())
}
