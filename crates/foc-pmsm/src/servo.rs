//! The cascade of position, speed and current controllers.

mod loops;

use crate::decoupling::Decoupling;
use crate::error::FocError;
use crate::frames::Dq;
use crate::gains::{ServoGains, ServoLimits};
use crate::math::clamp;
use crate::pi::{AntiWindup, Pi, PiParameters};
use crate::signals::{OperatingPoint, Saturated, ServoCommand, ServoInput, ServoState};
use axis_scalar::Scalar;

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
    pub fn cycle(&self, state: &mut ServoState<T>, input: &ServoInput<T>) -> ServoCommand<T> {
        let bounds = Bounds {
            id_ref: T::ZERO,
            iq: T::INFINITY,
            voltage: self.limits.voltage,
        };
        self.cycle_in(state, input, &bounds, |_| Dq::ZERO)
    }

    /// As [`Servo::cycle`], with a d current reference and this cycle's
    /// voltage. The length of the current reference stays within its limit,
    /// i_d first: |i_q| ≤ √(I² − i_d²). With [`OperatingPoint::default`] the
    /// results are those of [`Servo::cycle`] to the bit.
    #[inline]
    pub fn cycle_with(
        &self,
        state: &mut ServoState<T>,
        input: &ServoInput<T>,
        point: &OperatingPoint<T>,
    ) -> ServoCommand<T> {
        self.cycle_at(state, input, point, |_| Dq::ZERO)
    }

    /// As [`Servo::cycle_with`], with the voltage of `decoupling` added to the outputs of
    /// the current controllers, before their limit.
    #[inline]
    pub fn cycle_decoupled(
        &self,
        state: &mut ServoState<T>,
        input: &ServoInput<T>,
        point: &OperatingPoint<T>,
        decoupling: &Decoupling<T>,
    ) -> ServoCommand<T> {
        let now = &input.measurement;
        let added = |reference| decoupling.voltage(now.current, reference, now.motor_speed);
        self.cycle_at(state, input, point, added)
    }

    /// At an operating point, with the voltage that is `added` for a current reference.
    #[inline]
    fn cycle_at(
        &self,
        state: &mut ServoState<T>,
        input: &ServoInput<T>,
        point: &OperatingPoint<T>,
        added: impl FnOnce(Dq<T>) -> Dq<T>,
    ) -> ServoCommand<T> {
        let bounds = self.bounds(point);
        let mut command = self.cycle_in(state, input, &bounds, added);
        command.saturated.current |= point.id_ref.abs() > self.limits.current;
        command
    }

    #[inline]
    fn bounds(&self, point: &OperatingPoint<T>) -> Bounds<T> {
        let most = self.limits.current;
        let id_ref = clamp(point.id_ref, -most, most);
        Bounds {
            id_ref,
            iq: self.q_current_limit(id_ref),
            voltage: self.available_voltage(point.voltage_limit),
        }
    }

    // Called from two places, it would return its command through memory: 6 ns.
    #[inline(always)]
    fn cycle_in(
        &self,
        state: &mut ServoState<T>,
        input: &ServoInput<T>,
        bounds: &Bounds<T>,
        feed_forward: impl FnOnce(Dq<T>) -> Dq<T>,
    ) -> ServoCommand<T> {
        let ServoInput {
            measurement: m,
            reference: r,
            correction: c,
        } = input;
        let error = r.position - m.position + c.position_offset;
        let speed_ref = self.position_loop(error, r.motor_speed + c.speed);

        let speed_error = speed_ref - m.motor_speed;
        let (iq_ref, current) = self.speed_loop_within(state, speed_error, c.iq, bounds.iq);

        let reference = Dq {
            d: bounds.id_ref,
            q: iq_ref,
        };
        let error = reference - m.current;
        let (voltage, d, q) = self.currents(state, error, feed_forward(reference), bounds.voltage);
        ServoCommand {
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
}
