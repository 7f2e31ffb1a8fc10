//! A sampled PI controller with a limited output.

use crate::error::{FocError, check, limit, not_negative, positive};
use axis_scalar::Scalar;

/// The constants of a [`Pi`]. Plain data; [`Pi::new`] validates them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PiParameters<T = f64> {
    /// Proportional gain, output unit per error unit, 0 or more.
    pub kp: T,
    /// Integral gain, output unit per error unit and second, 0 or more.
    pub ki: T,
    /// Limit of the output's magnitude, output unit, greater than 0
    /// (infinity: none).
    pub limit: T,
    /// Sampling period T_s, s, greater than 0.
    pub period: T,
}

/// What becomes of the integral while the output is at its limit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum AntiWindup<T = f64> {
    /// Conditional integration: the integral keeps its old value in a period
    /// in which the output saturates and the error would drive it further
    /// the same way.
    #[default]
    Conditional,
    /// Back-calculation: the integral is moved by (limited − unlimited
    /// output) T_s / T_t in each period (Åström and Rundqwist, "Integrator
    /// windup and how to avoid it", American Control Conference 1989,
    /// 1693–1698). What it was moved by is forgotten with the time constant
    /// kp/ki of the integral; a law with ki = 0 has none to move, and keeps
    /// what it is given.
    BackCalculation {
        /// Tracking time T_t, s, at least one period.
        tracking_time: T,
    },
}

/// A validated PI law, in the order integrate, then output:
///
/// ```text
/// I ← I + ki e T_s ;  y = kp e + I + feed-forward ;  output = y limited to ±limit
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pi<T = f64> {
    parameters: PiParameters<T>,
    anti_windup: AntiWindup<T>,
    ki_period: T,
    /// T_s / T_t of back-calculation, where there is an integral to move.
    tracking: Option<T>,
}

/// The memory of one PI controller; zero at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PiState<T = f64> {
    /// The integral I, in the output's unit.
    pub integral: T,
}

/// One output of a PI controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PiOutput<T = f64> {
    /// The limited output.
    pub value: T,
    /// Whether the limit changed it.
    pub saturated: bool,
}

impl<T: Scalar> Pi<T> {
    /// Validates the parameters; anti-windup is [`AntiWindup::Conditional`].
    ///
    /// # Errors
    /// [`FocError`] naming the first field out of the range its doc gives.
    pub fn new(parameters: PiParameters<T>) -> Result<Self, FocError> {
        not_negative("kp", parameters.kp)?;
        not_negative("ki", parameters.ki)?;
        limit("limit", parameters.limit)?;
        positive("period", parameters.period)?;
        Ok(Self {
            parameters,
            anti_windup: AntiWindup::Conditional,
            ki_period: parameters.ki * parameters.period,
            tracking: None,
        })
    }

    /// The same law with another anti-windup.
    ///
    /// # Errors
    /// [`FocError`] for a tracking time that is not finite or shorter than
    /// one period (the correction would overshoot).
    pub fn with_anti_windup(self, anti_windup: AntiWindup<T>) -> Result<Self, FocError> {
        let tracking = match anti_windup {
            AntiWindup::Conditional => None,
            AntiWindup::BackCalculation { tracking_time: t } => {
                let ok = t.is_finite() && t >= self.parameters.period;
                let valid = "finite and at least one period";
                let share = self.parameters.period / check(ok, "tracking_time", t, valid)?;
                (self.parameters.ki > T::ZERO).then_some(share)
            }
        };
        Ok(Self {
            anti_windup,
            tracking,
            ..self
        })
    }

    /// The parameters the law was built from.
    pub fn parameters(&self) -> &PiParameters<T> {
        &self.parameters
    }

    /// The anti-windup in use.
    pub fn anti_windup(&self) -> AntiWindup<T> {
        self.anti_windup
    }

    /// One period: from the `error` to the limited output. `limit` is this
    /// period's limit of the magnitude where it varies (what another axis
    /// leaves of a voltage); the lower of it and the law's own holds. Pass
    /// infinity for the law's own.
    #[inline]
    pub fn update(&self, state: &mut PiState<T>, error: T, limit: T) -> PiOutput<T> {
        self.update_with_feed_forward(state, error, T::ZERO, limit)
    }

    /// As [`Pi::update`], with a `feed_forward` (output unit) added before
    /// the limit, so that anti-windup sees it. A NaN passes through to the
    /// output instead of being hidden by the limit; the integral passes over
    /// a period whose numbers would not leave it finite, so that the output is
    /// sound again as soon as they are.
    #[inline]
    pub fn update_with_feed_forward(
        &self,
        state: &mut PiState<T>,
        error: T,
        feed_forward: T,
        limit: T,
    ) -> PiOutput<T> {
        // `min` and `max` skip a NaN limit; a negative one leaves nothing.
        let limit = self.parameters.limit.min(limit).max(T::ZERO);
        let integral = state.integral + self.ki_period * error;
        let output = self.parameters.kp * error + integral + feed_forward;
        let saturated = output.abs() > limit;
        let value = if saturated {
            limit.copysign(output)
        } else {
            output
        };
        let next = match self.tracking {
            _ if !saturated => integral,
            Some(share) => integral + share * (value - output),
            None if error * output <= T::ZERO => integral,
            None => state.integral,
        };
        if next.is_finite() {
            state.integral = next;
        }
        PiOutput { value, saturated }
    }
}
