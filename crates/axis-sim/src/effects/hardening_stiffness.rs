//! `hardening-stiffness`: a transmission whose stiffness grows with the force through it.
//!
//! Between force F and deflection δ of the transmission `F = k (1 + s |F| / F₀) δ`: at the
//! actuator's greatest force F₀ it is stiffer by the share s than without load. Against
//! the linear `δ = F / k` that is a displacement of the load by
//!
//! ```text
//! F/k · x / (1 + x),   x = s |F| / F₀
//! ```
//!
//! cubic-like where it is small, never more than F/k. Strain-wave gears harden so (Tuttle
//! and Seering, IEEE Trans. Robot. Autom. 12 (1996) 368–374, doi:10.1109/70.499819), and
//! rolling contacts, whose δ goes with F^(2/3). Damping stays that of the linear
//! transmission, so no rate goes with it.
//!
//! F is the course of the last step continued to the end of this one
//! ([`super::ScrewState::transmitted`]): one step late alone would put energy in.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, positive};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "hardening-stiffness",
    summary: "stiffness of the transmission that grows with the force through it",
    channel: EffectChannel::Kinematics,
    depends_on: "transmitted force",
    shown_over: EffectVariable::Acceleration,
    parameters: &[positive("relative_increase", Measure::Ratio, 2.0, 8.0)],
    needs: &[EffectNeed::Transmission],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    let (compliance, per_force) = (1.0 / to.stiffness(), v[0] / to.greatest_force());
    to.offset(move |s| {
        let harder = per_force * s.transmitted.abs();
        let shorter = compliance * s.transmitted * (harder / (1.0 + harder));
        [shorter, 0.0, 0.0]
    });
    Ok(())
}
