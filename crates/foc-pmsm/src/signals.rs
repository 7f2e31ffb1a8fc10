//! What goes into a cycle of the cascade and what comes out of it.

use crate::frames::{Dq, FRAC_1_SQRT_3};
use crate::pi::PiState;
use axis_scalar::Scalar;

/// What the controller samples at the start of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measurement<T = f64> {
    /// Position of the load, m.
    pub position: T,
    /// Mechanical motor speed, rad/s.
    pub motor_speed: T,
    /// Currents in the rotor's frame, A.
    pub current: Dq<T>,
}

/// What the load should do at the start of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ServoReference<T = f64> {
    /// Position of the load, m.
    pub position: T,
    /// Reference velocity on the motor's side, rad/s: the load's velocity
    /// (m/s) already divided by its travel per radian, r = lead/2π (m/rad).
    pub motor_speed: T,
}

/// What a compensation adds to the cascade in this cycle; zero by default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ServoCorrection<T = f64> {
    /// Added to the position error, m.
    pub position_offset: T,
    /// Added to the speed reference, rad/s (motor side).
    pub speed: T,
    /// Added to the speed controller's output before its limit, A.
    pub iq: T,
}

/// All that one cycle of a [`crate::Servo`] takes from outside.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ServoInput<T = f64> {
    /// Sampled at the start of the cycle.
    pub measurement: Measurement<T>,
    /// Wanted at the start of the cycle.
    pub reference: ServoReference<T>,
    /// Added by a compensation.
    pub correction: ServoCorrection<T>,
}

/// What one cycle has to do with beyond its references: the flux to set and
/// the voltage to do it with. By default i_d = 0 and the voltage is limited
/// by [`crate::ServoLimits`] alone, as in [`crate::Servo::cycle`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OperatingPoint<T = f64> {
    /// d current reference, A; negative weakens the field
    /// ([`crate::FieldWeakening`]). Limited to ± [`crate::ServoLimits::current`].
    pub id_ref: T,
    /// Length of the voltage vector that can be made in this cycle, V. The
    /// lower of it and [`crate::ServoLimits::voltage`] holds; infinity, or what is
    /// not a number, leaves the latter, a negative one leaves no voltage.
    pub voltage_limit: T,
}

impl<T: Scalar> OperatingPoint<T> {
    /// i_d = 0 and what linear modulation makes of the DC-link voltage U_dc
    /// (V) measured in this cycle, U_dc/√3.
    #[inline]
    pub fn at_dc_voltage(dc_voltage: T) -> Self {
        Self {
            id_ref: T::ZERO,
            voltage_limit: dc_voltage * T::of(FRAC_1_SQRT_3),
        }
    }
}

impl<T: Scalar> Default for OperatingPoint<T> {
    fn default() -> Self {
        Self {
            id_ref: T::ZERO,
            voltage_limit: T::INFINITY,
        }
    }
}

/// Which limits changed an output in this cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Saturated {
    /// The current reference, d or q.
    pub current: bool,
    /// The d voltage.
    pub voltage_d: bool,
    /// The q voltage.
    pub voltage_q: bool,
}

/// What the cascade asks for in this cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ServoCommand<T = f64> {
    /// Speed reference of the motor, rad/s.
    pub speed_ref: T,
    /// q current reference, A, after its limit (the d reference is 0, or
    /// that of [`OperatingPoint`]).
    pub iq_ref: T,
    /// Voltage to hold over the cycle, V.
    pub voltage: Dq<T>,
    /// The limits that were active.
    pub saturated: Saturated,
}

/// The memory of the cascade; zero at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ServoState<T = f64> {
    /// Speed controller, A.
    pub speed: PiState<T>,
    /// d current controller, V.
    pub d: PiState<T>,
    /// q current controller, V.
    pub q: PiState<T>,
}

impl<T: Scalar> ServoState<T> {
    /// The state of a cascade that has settled, all errors zero, at the q
    /// current `iq` (A) and the voltage `u` (V), as from
    /// [`crate::Pmsm::steady_voltage`].
    pub fn settled(iq: T, u: Dq<T>) -> Self {
        let at = |integral| PiState { integral };
        Self {
            speed: at(iq),
            d: at(u.d),
            q: at(u.q),
        }
    }
}
