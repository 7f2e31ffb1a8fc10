//! The cascade of position, speed and current controllers.

use crate::error::FocError;
use crate::frames::Dq;
use crate::math::clamp;
use crate::pi::{AntiWindup, Pi, PiParameters};
use crate::signals::{
    Command, Correction, Measurement, OperatingPoint, Reference, Saturated, ServoGains,
    ServoLimits, ServoState,
};
use scalar::Scalar;

/// A validated cascade. Immutable; [`ServoState`] is the caller's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Servo<T = f64> {
    gains: ServoGains<T>,
    limits: ServoLimits<T>,
    speed: Pi<T>,
    d: Pi<T>,
    q: Pi<T>,
}

/// What the current loop of one cycle has to keep to.
struct Bounds<T> {
    id_ref: T,
    iq: T,
    voltage: T,
}

impl<T: Scalar> Servo<T> {
    /// Validates gains, limits and the cycle time `period` (s, greater
    /// than 0); anti-windup is [`AntiWindup::Conditional`].
    ///
    /// # Errors
    /// [`FocError`] naming the first field that is NaN or out of range.
    pub fn new(gains: ServoGains<T>, limits: ServoLimits<T>, period: T) -> Result<Self, FocError> {
        gains.check()?;
        limits.check()?;
        let pi = |kp, ki, limit| {
            Pi::new(PiParameters {
                kp,
                ki,
                limit,
                period,
            })
        };
        Ok(Self {
            gains,
            limits,
            speed: pi(gains.speed_p, gains.speed_i, limits.current)?,
            d: pi(gains.d_p, gains.d_i, limits.voltage)?,
            q: pi(gains.q_p, gains.q_i, limits.voltage)?,
        })
    }

    /// The same cascade with another anti-windup in all three controllers.
    ///
    /// # Errors
    /// As [`Pi::with_anti_windup`].
    pub fn with_anti_windup(self, anti_windup: AntiWindup<T>) -> Result<Self, FocError> {
        Ok(Self {
            speed: self.speed.with_anti_windup(anti_windup)?,
            d: self.d.with_anti_windup(anti_windup)?,
            q: self.q.with_anti_windup(anti_windup)?,
            ..self
        })
    }

    /// The gains.
    pub fn gains(&self) -> &ServoGains<T> {
        &self.gains
    }

    /// The limits.
    pub fn limits(&self) -> &ServoLimits<T> {
        &self.limits
    }

    /// Cycle time, s.
    pub fn period(&self) -> T {
        self.speed.parameters().period
    }

    /// One control cycle with i_d = 0: the measurements of its start to the
    /// voltage that is held until the next, without delay.
    #[inline]
    pub fn cycle(
        &self,
        state: &mut ServoState<T>,
        m: &Measurement<T>,
        r: &Reference<T>,
        c: &Correction<T>,
    ) -> Command<T> {
        let bounds = Bounds {
            id_ref: T::ZERO,
            iq: T::INFINITY,
            voltage: self.limits.voltage,
        };
        self.cycle_in(state, m, r, c, &bounds)
    }

    /// As [`Servo::cycle`], with a d current reference and this cycle's
    /// voltage. The length of the current reference stays within its limit,
    /// i_d first: |i_q| ≤ √(I² − i_d²). With [`OperatingPoint::default`] the
    /// results are those of [`Servo::cycle`] to the bit.
    #[inline]
    pub fn cycle_with(
        &self,
        state: &mut ServoState<T>,
        m: &Measurement<T>,
        r: &Reference<T>,
        c: &Correction<T>,
        point: &OperatingPoint<T>,
    ) -> Command<T> {
        let most = self.limits.current;
        let id_ref = clamp(point.id_ref, -most, most);
        let bounds = Bounds {
            id_ref,
            iq: self.q_current_limit(id_ref),
            voltage: self.available_voltage(point.voltage_limit),
        };
        let mut command = self.cycle_in(state, m, r, c, &bounds);
        command.saturated.current |= point.id_ref.abs() > most;
        command
    }

    #[inline]
    fn cycle_in(
        &self,
        state: &mut ServoState<T>,
        m: &Measurement<T>,
        r: &Reference<T>,
        c: &Correction<T>,
        bounds: &Bounds<T>,
    ) -> Command<T> {
        let error = r.position - m.position + c.position_offset;
        let speed_ref = self.position_loop(error, r.motor_speed + c.speed);

        let speed_error = speed_ref - m.motor_speed;
        let (iq_ref, current) = self.speed_loop_within(state, speed_error, c.iq, bounds.iq);

        let reference = Dq {
            d: bounds.id_ref,
            q: iq_ref,
        };
        let error = reference - m.current;
        let (voltage, d, q) = self.currents(state, error, Dq::ZERO, bounds.voltage);
        Command {
            speed_ref,
            iq_ref,
            voltage,
            saturated: Saturated {
                current,
                voltage_d: d,
                voltage_q: q,
            },
        }
    }

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

    /// The lower of [`ServoLimits::voltage`] and `limit` (V), at least 0;
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
    /// [`ServoLimits::current`] holds.
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
    /// voltage, as in [`OperatingPoint::voltage_limit`].
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

    #[inline]
    fn currents(
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
