//! `stator-resistance`: resistance of the winding.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "stator-resistance",
    summary: "resistance of the winding",
    channel: EffectChannel::Voltage,
    depends_on: "current",
    parameters: &[size("relative_change", "", 0.15, 0.8)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.motor(|p| p.resistance *= 1.0 + v[0])?;
    Ok(())
}
