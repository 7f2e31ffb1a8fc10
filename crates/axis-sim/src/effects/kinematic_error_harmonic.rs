//! `kinematic-error-harmonic`: travel error that repeats several times in the motor's turn.
//!
//! `a sin(n θ + φ)` at the load, θ the angle of the motor, the transmission's input: of a
//! strain-wave gear mostly n = 2 (Ghorbel, Gandhi and Alpeter, J. Mech. Des. 123 (2001)
//! 90–97, doi:10.1115/1.1334379), of a belt or pinion its number of teeth. Once per turn
//! it is `periodic-lead-error`, so the search begins at n = 2.

use super::{
    Changes, Effect, EffectChannel, EffectNeed, EffectVariable, Measure, Nature, PHASE, shape, size,
};
use crate::error::SetupError;

pub(super) const EFFECT: Effect = Effect {
    name: "kinematic-error-harmonic",
    summary: "travel error that repeats several times in the motor's turn",
    channel: EffectChannel::Kinematics,
    depends_on: "motor angle",
    shown_over: EffectVariable::MotorAngle,
    parameters: &[
        size("amplitude", Measure::Displacement, 2e-6, 1e-3),
        shape(
            "order",
            Measure::Ratio,
            Nature::Order([2, 6]),
            2.0,
            [1.0, 200.0],
        ),
        PHASE,
    ],
    needs: &[EffectNeed::Transmission],
    install,
};

fn install(values: &[f64], to: &mut Changes<'_>) -> Result<(), SetupError> {
    let [amplitude, order, phase] = super::changes::array(values);
    add(to, order, [amplitude, phase]);
    Ok(())
}

/// Adds a harmonic of an order per radian of the motor, of amplitude (m or rad at the
/// load) and phase (rad).
pub(super) fn add(to: &mut Changes<'_>, order: f64, [amplitude, phase]: [f64; 2]) {
    to.offset(move |s| {
        let (sin, cos) = (order * s.angle + phase).sin_cos();
        let growth = amplitude * order * cos;
        [amplitude * sin, growth * s.rate, growth]
    });
}
