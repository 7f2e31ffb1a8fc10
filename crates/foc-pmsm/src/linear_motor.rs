//! A linear synchronous motor: metres and newtons.

use crate::error::{FocError, positive};
use crate::frames::Dq;
use crate::motor::{MotorParameters, Pmsm};
use crate::operating::{OperatingLimits, OperatingRegion};
use axis_scalar::Scalar;

/// The constants of a linear motor. Plain data; [`LinearMotor::new`] validates them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LinearMotorParameters<T = f64> {
    /// Pole pitch τ_p, m, greater than 0: from a north pole to the next south pole, half a
    /// turn of the electrical angle. Data sheets may state the magnet period 2 τ_p.
    pub pole_pitch: T,
    /// Resistance R of one phase, Ω, 0 or more.
    pub resistance: T,
    /// Direct-axis inductance L_d, H, greater than 0.
    pub inductance_d: T,
    /// Quadrature-axis inductance L_q, H, greater than 0.
    pub inductance_q: T,
    /// Peak flux linkage ψ of the magnets with one phase, V·s, greater than 0.
    pub flux_linkage: T,
}

impl<T: Scalar> LinearMotorParameters<T> {
    /// Replaces the flux linkage by the one that gives the force constant K_f (N per
    /// ampere of peak phase current, at i_d = 0): ψ = K_f τ_p/(1.5 π). Of a constant per
    /// ampere RMS take 1/√2.
    pub fn from_force_constant(self, force_constant: T) -> Self {
        Self {
            flux_linkage: force_constant * self.pole_pitch / (T::of(1.5) * T::PI),
            ..self
        }
    }
}

/// A validated linear motor: a [`Pmsm`] with one pole pair whose electrical angle is
/// π x/τ_p, so that with v the velocity
///
/// ```text
/// ω_e = π v/τ_p,   F = 1.5 π/τ_p (ψ i_q + (L_d − L_q) i_d i_q)
/// ```
///
/// ([`Pmsm`]'s torque times the angle per metre: 1.5 u i = losses + F v.) Currents,
/// voltages and frames are the same; [`LinearMotor::motor`] with
/// [`LinearMotor::electrical_speed`] as its speed serves whatever takes a motor.
///
/// ```
/// use foc_pmsm::{Dq, LinearMotor, LinearMotorParameters};
///
/// let motor = LinearMotor::new(LinearMotorParameters {
///     pole_pitch: 0.016, resistance: 2.6, inductance_d: 13e-3,
///     inductance_q: 13e-3, flux_linkage: 0.0,
/// }.from_force_constant(68.0_f64))?;
/// assert!((motor.force(Dq { d: 0.0, q: 2.0 }) - 136.0).abs() < 1e-9);
/// assert!((motor.q_current(136.0) - 2.0).abs() < 1e-12);
/// // The magnets induce F/i v/1.5 at 3 m/s.
/// assert!((motor.rotational_voltage(Dq::ZERO, 3.0).q - 136.0).abs() < 1e-9);
/// # Ok::<(), foc_pmsm::FocError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearMotor<T = f64> {
    parameters: LinearMotorParameters<T>,
    motor: Pmsm<T>,
    /// π/τ_p, rad/m.
    wave_number: T,
}

/// The currents of a force, as [`LinearMotor::operating_currents`] finds them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LinearOperatingCurrents<T = f64> {
    /// Current references, A.
    pub current: Dq<T>,
    /// The force that they make, N.
    pub force: T,
    /// What decided.
    pub region: OperatingRegion,
}

impl<T: Scalar> LinearMotor<T> {
    /// Validates the parameters.
    ///
    /// # Errors
    /// [`FocError`] naming the first field out of the range its doc gives.
    pub fn new(parameters: LinearMotorParameters<T>) -> Result<Self, FocError> {
        let pitch = positive("pole_pitch", parameters.pole_pitch)?;
        let motor = Pmsm::new(MotorParameters {
            pole_pairs: 1,
            resistance: parameters.resistance,
            inductance_d: parameters.inductance_d,
            inductance_q: parameters.inductance_q,
            flux_linkage: parameters.flux_linkage,
        })?;
        Ok(Self {
            parameters,
            motor,
            wave_number: T::PI / pitch,
        })
    }

    /// The parameters the motor was built from.
    pub fn parameters(&self) -> &LinearMotorParameters<T> {
        &self.parameters
    }

    /// The rotating motor with one pole pair that has the same equations; its speed is
    /// [`LinearMotor::electrical_speed`].
    pub fn motor(&self) -> &Pmsm<T> {
        &self.motor
    }

    /// Electrical angle π x/τ_p (rad), within a turn, at the position x (m) from a place
    /// where the d axis is that of phase a.
    pub fn electrical_angle(&self, position: T) -> T {
        // Of the whole turns nothing is left, however far the motor is.
        let turns = position / (T::TWO * self.parameters.pole_pitch);
        T::TWO * T::PI * (turns - turns.floor())
    }

    /// Electrical speed ω_e = π v/τ_p, rad/s, from the velocity, m/s.
    #[inline]
    pub fn electrical_speed(&self, velocity: T) -> T {
        self.wave_number * velocity
    }

    /// Force, N, from the currents, A.
    #[inline]
    pub fn force(&self, i: Dq<T>) -> T {
        self.wave_number * self.motor.torque(i)
    }

    /// The q current, A, that gives `force` (N) at i_d = 0.
    #[inline]
    pub fn q_current(&self, force: T) -> T {
        self.motor.q_current(force / self.wave_number)
    }

    /// Voltage (V) induced by the motion at `velocity` (m/s), as
    /// [`Pmsm::rotational_voltage`].
    #[inline]
    pub fn rotational_voltage(&self, i: Dq<T>, velocity: T) -> Dq<T> {
        self.motor
            .rotational_voltage(i, self.electrical_speed(velocity))
    }

    /// The voltage, V, that holds the currents `i` (A) at constant `velocity` (m/s).
    #[inline]
    pub fn steady_voltage(&self, i: Dq<T>, velocity: T) -> Dq<T> {
        self.motor
            .steady_voltage(i, self.electrical_speed(velocity))
    }

    /// The currents after a time `h` (s), as [`Pmsm::step`], at `velocity` (m/s).
    #[inline]
    pub fn step(&self, i0: Dq<T>, u: Dq<T>, velocity: T, h: T) -> Dq<T> {
        self.motor.step(i0, u, self.electrical_speed(velocity), h)
    }

    /// The shortest current that makes `force` (N) at `velocity` (m/s) within the limits,
    /// as [`Pmsm::operating_currents`].
    pub fn operating_currents(
        &self,
        force: T,
        velocity: T,
        limits: &OperatingLimits<T>,
    ) -> LinearOperatingCurrents<T> {
        let speed = self.electrical_speed(velocity);
        let torque = force / self.wave_number;
        let found = self.motor.operating_currents(torque, speed, limits);
        LinearOperatingCurrents {
            current: found.current,
            force: self.wave_number * found.torque,
            region: found.region,
        }
    }
}
