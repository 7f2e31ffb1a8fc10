//! What of a transmission's errors a plan predicts: one wave over the motor's turn.

use std::f64::consts::TAU;

use crate::axis::Axis;
use crate::effects::{Hooks, ScrewState};

/// Orders in a turn of the motor that are looked at: those that an effect may have.
const ORDERS: u32 = 200;

/// Angles of a turn at which the error is taken, enough for all of them.
const ANGLES: u32 = 1024;

/// Share of the errors below which a wave is rounding.
const ROUNDING: f64 = 1e-9;

/// Amplitude (m or rad at the load), order and phase (rad) of the mechanism's own wave, or else of
/// the strongest that the effects bring.
pub(super) fn harmonic(axis: &Axis, hooks: &Hooks) -> Option<[f64; 3]> {
    let own = axis.mechanism.kinematic_harmonic();
    own.or_else(|| {
        if !hooks.has_offsets() {
            return None;
        }
        let travel = axis.travel_per_radian();
        strongest(|angle| offset(hooks, travel, angle))
    })
}

/// Displacement of the load on its transmission at an angle of the motor (rad), m or rad.
pub(super) fn offset(hooks: &Hooks, travel: f64, angle: f64) -> f64 {
    let at = ScrewState {
        angle,
        position: travel * angle,
        ..ScrewState::default()
    };
    hooks.offset_at(&at)[0]
}

/// The strongest wave a sin(n θ + φ) of an error over a turn, beside what grows along the turn.
fn strongest(error: impl Fn(f64) -> f64) -> Option<[f64; 3]> {
    let angle = |k: u32| TAU * f64::from(k) / f64::from(ANGLES);
    let growth = (error(TAU) - error(0.0)) / TAU;
    let samples: Vec<f64> = (0..ANGLES)
        .map(|k| error(angle(k)) - growth * angle(k))
        .collect();
    let wave = |order: u32| {
        let sum = |by: fn(f64) -> f64| -> f64 {
            let terms = samples.iter().zip(0..ANGLES);
            let term = |(error, k): (&f64, u32)| error * by(f64::from(order) * angle(k));
            terms.map(term).sum::<f64>() * 2.0 / f64::from(ANGLES)
        };
        let [sine, cosine] = [sum(f64::sin), sum(f64::cos)];
        [sine.hypot(cosine), f64::from(order), cosine.atan2(sine)]
    };
    let best = (1..=ORDERS)
        .map(wave)
        .max_by(|a, b| a[0].total_cmp(&b[0]))?;
    let most = samples
        .iter()
        .fold(growth.abs(), |most, e| most.max(e.abs()));
    (best[0] > ROUNDING * most).then_some(best)
}
