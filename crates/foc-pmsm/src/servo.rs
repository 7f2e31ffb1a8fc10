//! The cascade of position, speed and current controllers with i_d = 0.

use crate::error::{FocError, limit, not_negative};
use crate::frames::Dq;
use crate::math::sqrt;
use crate::pi::{AntiWindup, Pi, PiParameters, PiState};

/// The gains of the cascade. Plain data; [`Servo::new`] validates them: all
/// finite and 0 or more. Symbols of Liu et al. 2025, Table 4
/// (doi 10.3390/machines13050433).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoGains {
    /// P_Sw: motor speed per position error, (rad/s)/m.
    pub position: f64,
    /// P_ωR: q current per speed error, A/(rad/s).
    pub speed_p: f64,
    /// I_ωR: q current per integrated speed error, A/rad.
    pub speed_i: f64,
    /// P_id: d voltage per d current error, V/A.
    pub d_p: f64,
    /// I_id: d voltage per integrated d current error, V/(A·s).
    pub d_i: f64,
    /// P_iq: q voltage per q current error, V/A.
    pub q_p: f64,
    /// I_iq: q voltage per integrated q current error, V/(A·s).
    pub q_i: f64,
}

/// The limits of the cascade, greater than 0 (infinity: none).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoLimits {
    /// Magnitude of the q current reference, A.
    pub current: f64,
    /// Length of the voltage vector, V; U_dc/√3 for linear modulation
    /// ([`crate::svpwm::Svpwm::linear_limit`]).
    pub voltage: f64,
}

/// What the controller samples at the start of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measurement {
    /// Position of the load, m.
    pub position: f64,
    /// Mechanical motor speed, rad/s.
    pub motor_speed: f64,
    /// Currents in the rotor's frame, A.
    pub current: Dq,
}

/// What the load should do at the start of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reference {
    /// Position of the load, m.
    pub position: f64,
    /// Reference velocity on the motor's side, rad/s: the load's velocity
    /// (m/s) already divided by its travel per radian, r = lead/2π (m/rad).
    pub motor_speed: f64,
}

/// What a compensation adds to the cascade in this cycle; zero by default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Correction {
    /// Added to the position error, m.
    pub position_offset: f64,
    /// Added to the speed reference, rad/s (motor side).
    pub speed: f64,
    /// Added to the speed controller's output before its limit, A.
    pub iq: f64,
}

/// Which limits changed an output in this cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Saturated {
    /// The q current reference.
    pub current: bool,
    /// The d voltage.
    pub voltage_d: bool,
    /// The q voltage.
    pub voltage_q: bool,
}

/// What the cascade asks for in this cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Command {
    /// Speed reference of the motor, rad/s.
    pub speed_ref: f64,
    /// q current reference, A, after its limit (the d reference is 0).
    pub iq_ref: f64,
    /// Voltage to hold over the cycle, V.
    pub voltage: Dq,
    /// The limits that were active.
    pub saturated: Saturated,
}

/// The memory of the cascade; zero at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ServoState {
    /// Speed controller, A.
    pub speed: PiState,
    /// d current controller, V.
    pub d: PiState,
    /// q current controller, V.
    pub q: PiState,
}

impl ServoState {
    /// The state of a cascade that has settled, all errors zero, at the q
    /// current `iq` (A) and the voltage `u` (V), as from
    /// [`crate::Pmsm::steady_voltage`].
    pub fn settled(iq: f64, u: Dq) -> Self {
        let at = |integral| PiState { integral };
        Self {
            speed: at(iq),
            d: at(u.d),
            q: at(u.q),
        }
    }
}

/// A validated cascade. Immutable; [`ServoState`] is the caller's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Servo {
    gains: ServoGains,
    limits: ServoLimits,
    speed: Pi,
    d: Pi,
    q: Pi,
}

impl Servo {
    /// Validates gains, limits and the cycle time `period` (s, greater
    /// than 0); anti-windup is [`AntiWindup::Conditional`].
    ///
    /// # Errors
    /// [`FocError`] naming the first field that is NaN or out of range.
    pub fn new(gains: ServoGains, limits: ServoLimits, period: f64) -> Result<Self, FocError> {
        let ServoGains {
            speed_p, speed_i, ..
        } = gains;
        not_negative("position", gains.position)?;
        not_negative("speed_p", speed_p)?;
        not_negative("speed_i", speed_i)?;
        not_negative("d_p", gains.d_p)?;
        not_negative("d_i", gains.d_i)?;
        not_negative("q_p", gains.q_p)?;
        not_negative("q_i", gains.q_i)?;
        limit("current", limits.current)?;
        limit("voltage", limits.voltage)?;
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
            speed: pi(speed_p, speed_i, limits.current)?,
            d: pi(gains.d_p, gains.d_i, limits.voltage)?,
            q: pi(gains.q_p, gains.q_i, limits.voltage)?,
        })
    }

    /// The same cascade with another anti-windup in all three controllers.
    ///
    /// # Errors
    /// As [`Pi::with_anti_windup`].
    pub fn with_anti_windup(self, anti_windup: AntiWindup) -> Result<Self, FocError> {
        Ok(Self {
            speed: self.speed.with_anti_windup(anti_windup)?,
            d: self.d.with_anti_windup(anti_windup)?,
            q: self.q.with_anti_windup(anti_windup)?,
            ..self
        })
    }

    /// The gains.
    pub fn gains(&self) -> &ServoGains {
        &self.gains
    }

    /// The limits.
    pub fn limits(&self) -> &ServoLimits {
        &self.limits
    }

    /// Cycle time, s.
    pub fn period(&self) -> f64 {
        self.speed.parameters().period
    }

    /// One control cycle: the measurements of its start to the voltage that
    /// is held until the next, without delay.
    #[inline]
    pub fn cycle(
        &self,
        state: &mut ServoState,
        m: &Measurement,
        r: &Reference,
        c: &Correction,
    ) -> Command {
        let error = r.position - m.position + c.position_offset;
        let speed_ref = self.position_loop(error, r.motor_speed + c.speed);

        let speed_error = speed_ref - m.motor_speed;
        let (iq_ref, current) = self.speed_loop(state, speed_error, c.iq);

        let reference = Dq { d: 0.0, q: iq_ref };
        let (voltage, d, q) = self.current_loop(state, reference - m.current, Dq::ZERO);
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

    /// P controller: ω_ref = P_Sw e + feed-forward, rad/s, from the position
    /// error (m) and a speed feed-forward (rad/s, motor side).
    #[inline]
    pub fn position_loop(&self, error: f64, feed_forward: f64) -> f64 {
        self.gains.position * error + feed_forward
    }

    /// PI controller: the q current reference (A) from the speed error
    /// (rad/s) and a current feed-forward (A), and whether it was limited.
    #[inline]
    pub fn speed_loop(&self, state: &mut ServoState, error: f64, feed_forward: f64) -> (f64, bool) {
        let out = self.speed.update_with_feed_forward(
            &mut state.speed,
            error,
            feed_forward,
            f64::INFINITY,
        );
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
        state: &mut ServoState,
        error: Dq,
        feed_forward: Dq,
    ) -> (Dq, bool, bool) {
        let limit = self.limits.voltage;
        let d =
            self.d
                .update_with_feed_forward(&mut state.d, error.d, feed_forward.d, f64::INFINITY);
        // U = ∞ leaves ∞ for q, and |u_d| ≤ U keeps the root real.
        let rest = sqrt((limit - d.value) * (limit + d.value));
        let q = self
            .q
            .update_with_feed_forward(&mut state.q, error.q, feed_forward.q, rest);
        let voltage = Dq {
            d: d.value,
            q: q.value,
        };
        (voltage, d.saturated, q.saturated)
    }
}
