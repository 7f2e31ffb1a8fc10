//! `lead-error`: travel per turn.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "lead-error",
    summary: "travel per turn",
    channel: EffectChannel::Kinematics,
    depends_on: "position",
    parameters: &[size("slope", "", 1e-4, 5e-3)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    let r = to.ball_screw()?.travel_per_radian();
    to.offset(move |s| [v[0] * r * s.angle, v[0] * r * s.rate]);
    Ok(())
}
