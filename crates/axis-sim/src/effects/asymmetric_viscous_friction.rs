//! `asymmetric-viscous-friction`: viscous friction that differs between the directions.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "asymmetric-viscous-friction",
    summary: "viscous friction that differs between the directions",
    channel: EffectChannel::Torque,
    depends_on: "speed and its sign",
    parameters: &[
        size("forward", "N*s/m", 4000.0, 1e5),
        size("backward", "N*s/m", 2000.0, 1e5),
    ],
    on_rigid: true,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 2] = super::changes::array(values);
    to.load(move |t| {
        let coefficient = if t.speed > 0.0 { v[0] } else { v[1] };
        coefficient * t.speed
    });
    Ok(())
}
