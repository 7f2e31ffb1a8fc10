//! `presliding`: pre-sliding stiffness of the friction contact.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, size};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "presliding",
    summary: "pre-sliding stiffness of the friction contact",
    channel: EffectChannel::Torque,
    depends_on: "displacement after a reversal",
    shown_over: EffectVariable::Time,
    parameters: &[size("stiffness", Measure::Stiffness, 1.5e6, 5e7)],
    needs: &[EffectNeed::Role(Role::BristleStiffness)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    // The law's coordinate may be another than the load's.
    let lever = to.friction_lever();
    to.add(Role::BristleStiffness, v[0] * lever * lever)?;
    Ok(())
}
