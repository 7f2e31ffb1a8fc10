//! `presliding`: stiffness of the contact before it slides.

use super::{Effect, EffectChannel, changes::out_of_range, size};

pub(super) const EFFECT: Effect = Effect {
    name: "presliding",
    summary: "stiffness of the contact before it slides",
    channel: EffectChannel::Torque,
    depends_on: "displacement after a reversal",
    parameters: &[size("stiffness", "N/m", 1.5e6, 5e7)],
    on_rigid: false,
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), feed_dynamics::DriveError> {
    let v: [f64; 1] = super::changes::array(values);
    let axis = to.ball_screw()?;
    let mut law = axis.friction.parameters();
    let r = axis.travel_per_radian();
    law.stiffness += v[0] * r * r;
    axis.friction = lugre::LuGre::new(law).map_err(|_| out_of_range("stiffness", v[0]))?;
    Ok(())
}
