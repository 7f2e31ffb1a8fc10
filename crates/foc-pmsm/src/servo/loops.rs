//! The loops of the cascade one by one, and what limits them.

use super::Servo;
use crate::frames::Dq;
use crate::signals::ServoState;
use axis_scalar::Scalar;

impl<T: Scalar> Servo<T> {
    /// What the current limit I leaves for the q current, A, beside `id`
    /// (A): √(I² − i_d²), and nothing beyond I.
    #[inline]
    pub fn q_current_limit(&self, id: T) -> T {
        let most = self.limits.current;
        if id == T::ZERO {
            // Without the root, whose argument could overflow.
            return most;
        }
        // Of an infinite limit infinity is left.
        ((most - id) * (most + id)).max(T::ZERO).sqrt()
    }

    /// The lower of [`crate::ServoLimits::voltage`] and `limit` (V), at least 0;
    /// a `limit` that is not a number is none.
    #[inline]
    pub fn available_voltage(&self, limit: T) -> T {
        self.limits.voltage.min(limit).max(T::ZERO)
    }

    /// P controller: ω_ref = P_Sw e + feed-forward, rad/s, from the position
    /// error (m) and a speed feed-forward (rad/s, motor side).
    #[inline]
    pub fn position_loop(&self, error: T, feed_forward: T) -> T {
        self.gains.position * error + feed_forward
    }

    /// PI controller: the q current reference (A) from the speed error
    /// (rad/s) and a current feed-forward (A), and whether it was limited.
    #[inline]
    pub fn speed_loop(&self, state: &mut ServoState<T>, error: T, feed_forward: T) -> (T, bool) {
        self.speed_loop_within(state, error, feed_forward, T::INFINITY)
    }

    /// As [`Servo::speed_loop`], with this cycle's limit (A) of the q current
    /// ([`Servo::q_current_limit`]); the lower of it and
    /// [`crate::ServoLimits::current`] holds.
    #[inline]
    pub fn speed_loop_within(
        &self,
        state: &mut ServoState<T>,
        error: T,
        feed_forward: T,
        limit: T,
    ) -> (T, bool) {
        let state = &mut state.speed;
        let out = self
            .speed
            .update_with_feed_forward(state, error, feed_forward, limit);
        (out.value, out.saturated)
    }

    /// Two PI controllers: the voltage (V) from the current error (A) and a
    /// voltage feed-forward (V; [`crate::Pmsm::rotational_voltage`] would
    /// decouple the axes, zero leaves that to the integrals), and whether
    /// the d and the q voltage were limited.
    ///
    /// The vector's length is limited to U: |u_d| ≤ U first, because the flux
    /// must stay controlled, then |u_q| ≤ √(U² − u_d²).
    #[inline]
    pub fn current_loop(
        &self,
        state: &mut ServoState<T>,
        error: Dq<T>,
        feed_forward: Dq<T>,
    ) -> (Dq<T>, bool, bool) {
        self.currents(state, error, feed_forward, self.limits.voltage)
    }

    /// As [`Servo::current_loop`], with this cycle's limit U (V) of the
    /// voltage, as in [`crate::OperatingPoint::voltage_limit`].
    #[inline]
    pub fn current_loop_within(
        &self,
        state: &mut ServoState<T>,
        error: Dq<T>,
        feed_forward: Dq<T>,
        limit: T,
    ) -> (Dq<T>, bool, bool) {
        self.currents(state, error, feed_forward, self.available_voltage(limit))
    }

    /// Both current controllers within the voltage `limit` (V, 0 or more).
    #[inline]
    pub(super) fn currents(
        &self,
        state: &mut ServoState<T>,
        error: Dq<T>,
        feed_forward: Dq<T>,
        limit: T,
    ) -> (Dq<T>, bool, bool) {
        let (d_state, q_state) = (&mut state.d, &mut state.q);
        let d = self
            .d
            .update_with_feed_forward(d_state, error.d, feed_forward.d, limit);
        // U = ∞ leaves ∞ for q, and |u_d| ≤ U keeps the root real.
        let rest = ((limit - d.value) * (limit + d.value)).sqrt();
        let q = self
            .q
            .update_with_feed_forward(q_state, error.q, feed_forward.q, rest);
        let voltage = Dq {
            d: d.value,
            q: q.value,
        };
        (voltage, d.saturated, q.saturated)
    }
}
