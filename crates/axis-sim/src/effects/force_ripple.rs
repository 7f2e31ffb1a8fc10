//! `force-ripple`: force of a linear motor that repeats with its pole pitch, at any current.
//!
//! `a sin(2π y / τ + φ)` against positive motion: magnets of either polarity pull alike on
//! the iron, so that it repeats twice in an electrical period 2τ (Otten, de Vries, van
//! Amerongen, Rankers and Gaal, IEEE/ASME Trans. Mechatronics 2 (1997) 179–187,
//! doi:10.1109/3516.622970). Of a motor that turns this is `cogging-torque`, whose whole
//! orders of a turn a linear motor does not have; what grows with the current is
//! `torque-ripple`. At the start of a log it comes up over 20 ms.

use super::{Effect, EffectChannel, EffectNeed, EffectVariable, Measure, PHASE, size};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "force-ripple",
    summary: "force that repeats with a linear motor's pole pitch, at any current",
    channel: EffectChannel::Torque,
    depends_on: "position",
    shown_over: EffectVariable::Position,
    parameters: &[size("amplitude", Measure::Force, 60.0, 5e3), PHASE],
    needs: &[EffectNeed::LinearMotor],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 2] = super::changes::array(values);
    // Electrical radians per metre are π/τ.
    let wave = 2.0 * to.pole_pairs();
    let steepness = super::Steepness {
        position: (wave * v[0]).abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| {
        v[0] * (wave * t.position + v[1]).sin() * t.pressed
    });
    Ok(())
}
