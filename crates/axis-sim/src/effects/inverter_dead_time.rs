//! `inverter-dead-time`: voltage that each phase loses against its current.

use super::{Effect, EffectChannel, Measure, Need, Variable, size};
use crate::error::SetupError;
use crate::part::Role;

pub(super) const EFFECT: Effect = Effect {
    name: "inverter-dead-time",
    summary: "voltage that each phase loses against its current",
    channel: EffectChannel::Voltage,
    depends_on: "sign of phase currents",
    shown_over: Variable::Current,
    parameters: &[size("phase_voltage", Measure::Voltage, 2.0, 50.0)],
    needs: &[Need::Role(Role::DeadTimeVoltage)],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.add(Role::DeadTimeVoltage, v[0])?;
    Ok(())
}
