//! `current-sensor-gain`: the share by which the drive reads too great a current.
//!
//! Both currents are shown as `(1 + c) i`, so that the torque at a shown current is smaller
//! by 1/(1 + c), while the back-EMF at a speed stays as it is: `torque-constant` changes
//! both. The current controllers work with what is shown, so their loop is faster by as
//! much. On errors of a drive's current sensors: Song et al., Energies 18 (2025) 1367,
//! doi:10.3390/en18061367; here the scales of all phases are off alike.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "current-sensor-gain",
    summary: "relative gain error of the current sensors",
    channel: EffectChannel::Torque,
    depends_on: "current",
    shown_over: EffectVariable::Current,
    parameters: &[signed("relative_change", Measure::Ratio, 0.03, 0.3)],
    needs: &[EffectNeed::Currents],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    to.sensors().current_gain += v[0];
    Ok(())
}
