//! `periodic-lead-error`: travel error that repeats with the screw's turn.

use super::{Effect, EffectChannel, Measure, Need, PHASE, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "periodic-lead-error",
    summary: "travel error that repeats with the screw's turn",
    channel: EffectChannel::Kinematics,
    depends_on: "screw angle",
    parameters: &[size("amplitude", Measure::Way, 2e-6, 1e-3), PHASE],
    needs: &[Need::Transmission],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    to.offset(move |s| {
        let at = s.angle + v[1];
        [v[0] * at.sin(), v[0] * s.rate * at.cos()]
    });
    Ok(())
}
