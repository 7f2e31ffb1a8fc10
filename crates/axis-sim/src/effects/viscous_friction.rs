//! `viscous-friction`: friction proportional to speed.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "viscous-friction",
    summary: "friction proportional to speed",
    channel: EffectChannel::Torque,
    depends_on: "speed",
    parameters: &[size("coefficient", "N*s/m", 4000.0, 1e5)],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.load(move |t| v[0] * t.speed);
    Ok(())
}
