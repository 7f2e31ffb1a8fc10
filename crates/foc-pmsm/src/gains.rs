//! The constants of the cascade.

use crate::error::{FocError, limit, not_negative};
use axis_scalar::Scalar;

/// The gains of the cascade. Plain data; [`crate::Servo::new`] validates them:
/// all finite and 0 or more. Symbols of Liu et al. 2025, Table 4
/// (doi 10.3390/machines13050433).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ServoGains<T = f64> {
    /// P_Sw: motor speed per position error, (rad/s)/m.
    pub position: T,
    /// P_ωR: q current per speed error, A/(rad/s).
    pub speed_p: T,
    /// I_ωR: q current per integrated speed error, A/rad.
    pub speed_i: T,
    /// P_id: d voltage per d current error, V/A.
    pub d_p: T,
    /// I_id: d voltage per integrated d current error, V/(A·s).
    pub d_i: T,
    /// P_iq: q voltage per q current error, V/A.
    pub q_p: T,
    /// I_iq: q voltage per integrated q current error, V/(A·s).
    pub q_i: T,
}

/// The limits of the cascade, greater than 0 (infinity: none).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ServoLimits<T = f64> {
    /// Length of the current reference, A: with i_d = 0 the magnitude of the
    /// q current reference.
    pub current: T,
    /// Length of the voltage vector, V; U_dc/√3 for linear modulation
    /// ([`crate::svpwm::Svpwm::linear_limit`]).
    pub voltage: T,
}

impl<T: Scalar> ServoGains<T> {
    pub(crate) fn check(&self) -> Result<(), FocError> {
        not_negative("position", self.position)?;
        not_negative("speed_p", self.speed_p)?;
        not_negative("speed_i", self.speed_i)?;
        not_negative("d_p", self.d_p)?;
        not_negative("d_i", self.d_i)?;
        not_negative("q_p", self.q_p)?;
        not_negative("q_i", self.q_i)?;
        Ok(())
    }
}

impl<T: Scalar> ServoLimits<T> {
    pub(crate) fn check(&self) -> Result<(), FocError> {
        limit("current", self.current)?;
        limit("voltage", self.voltage)?;
        Ok(())
    }
}
