//! `payload-mass`: mass on the table.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "payload-mass",
    summary: "mass on the table",
    channel: EffectChannel::Torque,
    depends_on: "acceleration",
    parameters: &[size("mass", "kg", 30.0, 1e3)],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.mass(v[0])?;
    Ok(())
}
