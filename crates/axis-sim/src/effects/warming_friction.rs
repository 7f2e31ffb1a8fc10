//! `warming-friction`: dry friction that falls as the machine warms by its own motion.
//!
//! `−F (1 − e^(−s/D)) u` against the motion: s the way that the load has travelled to and
//! fro since the log began, D that after which 63 % of the fall has come, u the unit
//! bristle. Losses heat in proportion to the way, so that standing still does not warm; no
//! cooling within a log. The first-order course is that of Simoni, Beschi, Legnani and
//! Visioli, Robotica 37 (2019), doi:10.1017/S0263574717000509, with the way for the time.
//!
//! On `liu2025.toml` D is some 20 m, three minutes at 0.1 m/s. A log of a few motions
//! shows no more than its slope F/D, hence one start for D.

use super::{Effect, EffectChannel, EffectVariable, Measure, Nature, shape, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "warming-friction",
    summary: "dry friction that falls with the distance travelled, as by warming up",
    channel: EffectChannel::Torque,
    depends_on: "distance travelled and sign of speed",
    shown_over: EffectVariable::Distance,
    parameters: &[
        size("force", Measure::Force, 120.0, 5e3),
        shape(
            "warming_distance",
            Measure::Travel,
            Nature::Extent(&[20.0], [2.0, 50.0]),
            20.0,
            [0.1, 1e4],
        ),
    ],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    // The way is known before the step.
    let steepness = super::Steepness {
        bristle: v[0].abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| {
        v[0] * (-t.travelled / v[1]).exp_m1() * t.bristle
    });
    Ok(())
}
