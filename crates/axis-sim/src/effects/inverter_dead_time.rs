//! `inverter-dead-time`: voltage error of each phase, opposite to its current.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, size};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "inverter-dead-time",
    summary: "voltage error of each phase, opposite to its current",
    channel: EffectChannel::Voltage,
    depends_on: "sign of phase currents",
    shown_over: EffectVariable::Current,
    parameters: &[size("phase_voltage", Measure::Voltage, 2.0, 50.0)],
    needs: &[EffectNeed::Role(Role::DeadTimeVoltage)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.add(Role::DeadTimeVoltage, v[0])?;
    Ok(())
}
