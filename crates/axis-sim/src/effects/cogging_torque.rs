//! `cogging-torque`: torque that repeats with each turn of the motor, at any current. Of a linear
//! motor it is
//! `force-ripple`.
//!
//! With Q slots and p pole pairs the fundamental has the order lcm(Q, 2p), an even multiple of p
//! (Zhu and
//! Howe, IEEE Trans. Energy Conversion 15 (2000) 407–412, doi:10.1109/60.900501): 24 of 12 slots
//! and 8
//! poles, 60 of 12 and 10, 72 of 9 or 36 and 8. Tolerances of slots and magnets make lower orders.

use super::{
    Effect, EffectChannel, EffectNeed, EffectVariable, Measure, Nature, PHASE, shape, size,
};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "cogging-torque",
    summary: "torque that repeats with each turn of the motor, at any current",
    channel: EffectChannel::Torque,
    depends_on: "motor angle",
    shown_over: EffectVariable::MotorAngle,
    parameters: &[
        size("amplitude", Measure::MotorTorque, 0.05, 2.0),
        shape(
            "order",
            Measure::Ratio,
            Nature::TurnOrder([1, 24]),
            8.0,
            [1.0, 1000.0],
        ),
        PHASE,
    ],
    needs: &[EffectNeed::TurningMotor],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let v: [f64; 3] = super::changes::array(values);
    to.torque(move |angle, _| v[0] * (v[1] * angle + v[2]).sin());
    Ok(())
}
