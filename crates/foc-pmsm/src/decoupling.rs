//! Decoupling of the current controllers: the voltage that the rotation induces, added
//! to what they put out.

use crate::error::{FocError, check};
use crate::frames::Dq;
use crate::motor::Pmsm;
use axis_scalar::Scalar;

/// Which currents the induced voltage is computed from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum DecouplingCurrent {
    /// Those measured: the axes are decoupled also while the currents change. A delay
    /// of the voltage turns part of it into feedback of the wrong phase, which is little
    /// while ω_e T_d is.
    #[default]
    Measured,
    /// Those wanted: nothing is fed back, so that stability is that of the controllers
    /// alone; the current that lags its reference leaves a part of the coupling.
    Reference,
}

/// The voltage that a cycle adds to its current controllers,
///
/// ```text
/// u_d = −ω_e L_q i_q − r_d i_d
/// u_q =  ω_e (L_d i_d + ψ) − r_q i_q
/// ```
///
/// Without it the integrals find the same voltage, later: a step of the q current by Δ
/// moves the d axis by ω_e L_q Δ volts. With it the motor's equations ([`Pmsm`]) are two
/// of first order, L di/dt = u' − (R + r) i with the controllers' output u'. The parts
/// that hold the other axis' current decouple, ω_e ψ is the feed-forward of the back-EMF,
/// and r is the active resistance of [`crate::CurrentGains`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decoupling<T = f64> {
    motor: Pmsm<T>,
    current: DecouplingCurrent,
    active_resistance: Dq<T>,
}

impl<T: Scalar> Decoupling<T> {
    /// Decoupling by the constants of `motor`, without active resistance.
    pub fn new(motor: Pmsm<T>, current: DecouplingCurrent) -> Self {
        Self {
            motor,
            current,
            active_resistance: Dq::ZERO,
        }
    }

    /// The same with the active resistance r (V/A) of an axis each, as in
    /// [`crate::CurrentGains::active_resistance`]. It acts on the measured currents.
    ///
    /// # Errors
    /// [`FocError`] unless both are finite.
    pub fn with_active_resistance(self, active_resistance: Dq<T>) -> Result<Self, FocError> {
        let Dq { d, q } = active_resistance;
        check(d.is_finite(), "active_resistance.d", d, "finite")?;
        check(q.is_finite(), "active_resistance.q", q, "finite")?;
        Ok(Self {
            active_resistance,
            ..self
        })
    }

    /// The voltage (V) to add, from the measured and the wanted currents (A) and the
    /// mechanical speed (rad/s). What is not a number passes.
    #[inline]
    pub fn voltage(&self, measured: Dq<T>, reference: Dq<T>, speed: T) -> Dq<T> {
        let i = match self.current {
            DecouplingCurrent::Measured => measured,
            DecouplingCurrent::Reference => reference,
        };
        let induced = self.motor.rotational_voltage(i, speed);
        let r = self.active_resistance;
        Dq {
            d: induced.d - r.d * measured.d,
            q: induced.q - r.q * measured.q,
        }
    }
}
