//! A start with a current that is turned faster and faster.

use crate::error::{FocError, check, not_negative, positive};
use crate::frames::Dq;
use crate::math::wrapped;
use axis_scalar::Scalar;

/// The constants of a [`CurrentStart`]. Plain data; [`CurrentStart::new`] validates them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CurrentStartParameters<T = f64> {
    /// Length of the current, A, greater than 0: enough for friction, load and
    /// acceleration together, with as much again to spare.
    pub current: T,
    /// How long the current grows and the rotor aligns before it is turned, s, 0 or more.
    pub alignment: T,
    /// Electrical acceleration, rad/s², greater than 0.
    pub acceleration: T,
    /// Electrical speed (rad/s, either sign, not 0) at which the start is over.
    pub speed: T,
    /// Sampling period T_s, s, greater than 0.
    pub period: T,
}

/// I/f start: a current of constant length in a frame that turns by itself, first standing
/// (the rotor aligns with it), then with constant acceleration. The rotor follows, lagging
/// by the angle at which the current makes the torque that it needs: more load, more
/// lag, more torque, which is why no sensor is needed as long as the current suffices and
/// friction damps the swinging about that angle.
///
/// The frame's d axis carries the current, so that an aligned rotor has i_q = 0. A rotor
/// that begins just opposite to it has no torque and stays: an alignment in two directions,
/// one after the other, avoids that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurrentStart<T = f64> {
    parameters: CurrentStartParameters<T>,
}

/// The memory of a [`CurrentStart`]; begins with all 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CurrentStartState<T = f64> {
    /// Time of the alignment that is over, s.
    pub aligned: T,
    /// Electrical angle of the frame, rad, from −π to π.
    pub angle: T,
    /// Electrical speed of the frame, rad/s.
    pub speed: T,
}

impl<T: Scalar> CurrentStart<T> {
    /// Validates the parameters.
    ///
    /// # Errors
    /// [`FocError`] naming the first field out of the range its doc gives.
    pub fn new(parameters: CurrentStartParameters<T>) -> Result<Self, FocError> {
        let p = &parameters;
        positive("current", p.current)?;
        not_negative("alignment", p.alignment)?;
        positive("acceleration", p.acceleration)?;
        let turning = p.speed.is_finite() && p.speed != T::ZERO;
        check(turning, "speed", p.speed, "finite and not 0")?;
        positive("period", p.period)?;
        Ok(Self { parameters })
    }

    /// The parameters the law was built from.
    pub fn parameters(&self) -> &CurrentStartParameters<T> {
        &self.parameters
    }

    /// The current reference (A) at the state, in the frame at its angle: growing while
    /// the rotor aligns, constant then.
    pub fn reference(&self, state: &CurrentStartState<T>) -> Dq<T> {
        let p = &self.parameters;
        let share = if state.aligned < p.alignment {
            state.aligned / p.alignment
        } else {
            T::ONE
        };
        Dq {
            d: p.current * share,
            q: T::ZERO,
        }
    }

    /// The same current seen from the frame at the electrical `angle` (rad), as of an
    /// observer: with it as the references the hand-over changes no current.
    pub fn reference_at(&self, state: &CurrentStartState<T>, angle: T) -> Dq<T> {
        self.reference(state).inverse_park(state.angle).park(angle)
    }

    /// Whether the speed is reached.
    pub fn is_over(&self, state: &CurrentStartState<T>) -> bool {
        state.speed == self.parameters.speed
    }

    /// On to the next sample. The frame goes on at its last speed when the start is over.
    pub fn advance(&self, state: &mut CurrentStartState<T>) {
        let p = &self.parameters;
        if state.aligned < p.alignment {
            state.aligned += p.period;
            return;
        }
        let gained = state.speed.abs() + p.acceleration * p.period;
        let before = state.speed;
        state.speed = gained.min(p.speed.abs()).copysign(p.speed);
        let turned = state.angle + T::HALF * (before + state.speed) * p.period;
        if turned.is_finite() {
            state.angle = wrapped(turned);
        }
    }
}
