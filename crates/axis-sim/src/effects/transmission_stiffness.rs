//! `transmission-stiffness`: stiffness of screw and nut.

use super::{Effect, EffectChannel, size};

pub(super) const EFFECT: Effect = Effect {
    name: "transmission-stiffness",
    summary: "stiffness of screw and nut",
    channel: EffectChannel::Kinematics,
    depends_on: "nut force",
    parameters: &[size("relative_change", "", -0.2, 0.8)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    to.drive(|p| p.nut_stiffness *= 1.0 + v[0])?;
    Ok(())
}
