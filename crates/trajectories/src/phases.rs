//! The closed-form time-optimal timing of a rest-to-rest move.

use axis_scalar::Scalar;

use crate::Limits;

/// Durations and peaks of the symmetric seven-segment motion
/// `+J 0 −J | 0 | −J 0 +J` over a distance `d > 0`.
///
/// With jerk time `τ`, constant-acceleration time `α` and cruise time `κ`:
///
/// ```text
/// peak acceleration  a = J τ                       (1)
/// peak velocity      v = a (τ + α)                 (2)
/// distance           d = v (2τ + α + κ)            (3)
/// duration           T = 4τ + 2α + κ               (4)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Phases<T> {
    /// τ, s: each of the four segments of full jerk.
    pub jerk_time: T,
    /// α, s: each of the two segments of constant acceleration.
    pub acceleration_time: T,
    /// κ, s: the segment of constant velocity.
    pub cruise_time: T,
    /// v, m/s.
    pub velocity: T,
    /// a, m/s².
    pub acceleration: T,
}

impl<T: Scalar> Phases<T> {
    /// Least-time phases over `distance` (m, greater than zero).
    ///
    /// The peaks are never above the limits, not by rounding either.
    #[inline]
    pub fn time_optimal(distance: T, limits: &Limits<T>) -> Self {
        let (v, a, j) = (limits.velocity(), limits.acceleration(), limits.jerk());
        let full_jerk_time = a / j;

        // The ramp from rest to the speed limit: with α = v/a − a/j if the acceleration limit is
        // reached on the way (v ≥ a²/j), else α = 0 and v = J τ².
        let ramp = if v >= a * full_jerk_time {
            // Not below zero by rounding where both limits are reached at once.
            let alpha = (v / a - full_jerk_time).max(T::ZERO);
            Self::without_cruise(full_jerk_time, alpha, v, a)
        } else {
            let jerk_time = (v / j).sqrt();
            Self::without_cruise(jerk_time, T::ZERO, v, (j * jerk_time).min(a))
        };
        let ramps_distance = v * (T::TWO * ramp.jerk_time + ramp.acceleration_time);
        if distance >= ramps_distance {
            let cruise_time = (distance - ramps_distance) / v;
            return Self {
                cruise_time,
                ..ramp
            };
        }

        // No cruise: (3) with κ = 0, τ = a/j is α² + 3τα + 2τ² − d/a = 0. Its root, in the form
        // that does not cancel, is positive when d ≥ 2 a³/j².
        let tau = full_jerk_time;
        let rest = distance / a - T::TWO * tau * tau;
        if rest >= T::ZERO {
            let root = (tau * tau + T::of(4.0) * distance / a).sqrt();
            let alpha = T::TWO * rest / (T::of(3.0) * tau + root);
            return Self::without_cruise(tau, alpha, (a * (tau + alpha)).min(v), a);
        }

        // Neither limit is reached: (3) with α = κ = 0 is d = 2 J τ³.
        let tau = (distance / (T::TWO * j)).cbrt().min(full_jerk_time);
        let peak = (j * tau).min(a);
        Self::without_cruise(tau, T::ZERO, (peak * tau).min(v), peak)
    }

    /// Phases with a cruise of no length.
    #[inline]
    const fn without_cruise(
        jerk_time: T,
        acceleration_time: T,
        velocity: T,
        acceleration: T,
    ) -> Self {
        Self {
            jerk_time,
            acceleration_time,
            cruise_time: T::ZERO,
            velocity,
            acceleration,
        }
    }

    /// The eight switching instants, s: from 0 to the duration.
    #[inline]
    pub fn switching_times(&self) -> [T; 8] {
        let (tau, alpha, kappa) = (self.jerk_time, self.acceleration_time, self.cruise_time);
        let ramp = T::TWO * tau + alpha;
        let slowing = ramp + kappa;
        [
            T::ZERO,
            tau,
            tau + alpha,
            ramp,
            slowing,
            slowing + tau,
            slowing + tau + alpha,
            slowing + ramp,
        ]
    }
}
