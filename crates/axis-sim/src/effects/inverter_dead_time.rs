//! `inverter-dead-time`: voltage that each phase loses against its current.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "inverter-dead-time",
    summary: "voltage that each phase loses against its current",
    channel: EffectChannel::Voltage,
    depends_on: "sign of phase currents",
    parameters: &[size("phase_voltage", "V", 2.0, 50.0)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.hooks.dead_time_voltage += v[0];
    Ok(())
}
