//! `spring-force`: a force in proportion to the position, as of a spring or a cable chain.
//!
//! `k (y − y₀)` against positive motion, y₀ where motions start: `constant-load` has what
//! acts there. It takes what it gives back. At the start of a log it comes up over 20 ms.

use super::{Effect, EffectChannel, EffectVariable, Measure, signed};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "spring-force",
    summary: "a force that grows along the stroke, as of a spring or a cable chain",
    channel: EffectChannel::Torque,
    depends_on: "position",
    shown_over: EffectVariable::Position,
    parameters: &[signed("stiffness", Measure::SpringRate, 600.0, 1e5)],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 1] = super::changes::array(values);
    let zero = to.stroke_start();
    let steepness = super::Steepness {
        position: v[0].abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| v[0] * (t.position - zero) * t.loaded);
    Ok(())
}
