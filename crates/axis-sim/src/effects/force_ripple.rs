//! `force-ripple`: force of a linear motor that repeats with its magnets, at any current.
//!
//! `a sin(n π y / τ + φ)` against positive motion, n periods in an electrical one of 2τ (τ: pole
//! pitch). Magnets of either polarity pull alike on the iron, so that most of it has n = 2 (Otten, de
//! Vries, van Amerongen, Rankers and Gaal, IEEE/ASME Trans. Mechatronics 2 (1997) 179–187,
//! doi:10.1109/3516.622970); unlike magnets make n = 1, and harmonics higher orders. Of a motor
//! that turns this is `cogging-torque`, in orders of a turn; what grows with the current is
//! `torque-ripple`. At the start of a log it comes up over 20 ms.

use super::{
    Effect, EffectChannel, EffectNeed, EffectVariable, Measure, Nature, PHASE, shape, size,
};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "force-ripple",
    summary: "force that repeats with a linear motor's magnets, at any current",
    channel: EffectChannel::Torque,
    depends_on: "position",
    shown_over: EffectVariable::Position,
    parameters: &[
        size("amplitude", Measure::Force, 60.0, 5e3),
        shape(
            "order",
            Measure::Ratio,
            Nature::Order([1, 24]),
            2.0,
            [1.0, 100.0],
        ),
        PHASE,
    ],
    needs: &[EffectNeed::LinearMotor],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let [amplitude, order, phase] = super::changes::array(values);
    // Electrical radians per metre are π/τ.
    let wave = order * to.pole_pairs();
    let steepness = super::Steepness {
        position: (wave * amplitude).abs(),
        ..super::Steepness::default()
    };
    to.load_within(steepness, move |t| {
        amplitude * (wave * t.position + phase).sin() * t.loaded
    });
    Ok(())
}
