//! Field weakening: a d current that lets a motor turn faster than its
//! voltage allows at i_d = 0.

use crate::error::{FocError, check, positive};
use crate::frames::Dq;
use crate::math::clamp;
use axis_scalar::Scalar;

/// The constants of [`FieldWeakening`]. Plain data; [`FieldWeakening::new`]
/// validates them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FieldWeakeningParameters<T = f64> {
    /// k: the share of the available voltage that is aimed at, greater than 0
    /// and less than 1. What it leaves is the current controllers' to move in.
    pub voltage_share: T,
    /// K_f: d current per integrated voltage, A/(V·s), greater than 0.
    pub ki: T,
    /// I_d,max: magnitude of the largest d current, A, greater than 0. Below
    /// ψ/L_d, and below what the magnets bear.
    pub current: T,
    /// Sampling period T_s, s, greater than 0.
    pub period: T,
}

/// A validated field-weakening law: the integral of what is left of the
/// voltage,
///
/// ```text
/// i_d,ref ← i_d,ref + K_f (k U_max − |u|) T_s,   within −I_d,max to 0
/// ```
///
/// after J.-M. Kim and S.-K. Sul, "Speed control of interior permanent magnet
/// synchronous motor drive for the flux weakening operation", IEEE Trans. Ind.
/// Appl. 33 (1997) 43–48, whose controller has a proportional part as well. It
/// needs no constant of the motor. Below base speed, where |u| < k U_max,
/// i_d,ref is exactly 0.
///
/// The length of the voltage grows by about ω_e L_d per ampere of i_d, so
/// that the law's bandwidth is K_f ω_e L_d (1/s); it must stay well below
/// that of the d current controller, P_id/L_d.
///
/// ```
/// use foc_pmsm::{Dq, FieldWeakening, FieldWeakeningParameters, FieldWeakeningState};
///
/// let law = FieldWeakening::new(FieldWeakeningParameters {
///     voltage_share: 0.95_f32, ki: 11.4, current: 13.0, period: 1e-4,
/// })?;
/// let mut state = FieldWeakeningState::default();
/// let most = 312.0;
/// // Voltage to spare, then none: (0.95 · 312 − 312) · 11.4e-4.
/// assert_eq!(law.update(&mut state, Dq { d: 0.0, q: 200.0 }, most), 0.0);
/// let id_ref = law.update(&mut state, Dq { d: 0.0, q: most }, most);
/// assert!((id_ref + 0.0178).abs() < 1e-4);
/// # Ok::<(), foc_pmsm::FocError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldWeakening<T = f64> {
    parameters: FieldWeakeningParameters<T>,
    ki_period: T,
}

/// The memory of the law; zero at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FieldWeakeningState<T = f64> {
    /// d current reference i_d,ref, A, 0 or less.
    pub id_ref: T,
}

impl<T: Scalar> FieldWeakening<T> {
    /// Validates the parameters.
    ///
    /// # Errors
    /// [`FocError`] naming the first field out of the range its doc gives.
    pub fn new(parameters: FieldWeakeningParameters<T>) -> Result<Self, FocError> {
        let share = parameters.voltage_share;
        let inside = share > T::ZERO && share < T::ONE;
        let valid = "greater than 0 and less than 1";
        check(inside, "voltage_share", share, valid)?;
        positive("ki", parameters.ki)?;
        positive("current", parameters.current)?;
        positive("period", parameters.period)?;
        Ok(Self {
            parameters,
            ki_period: parameters.ki * parameters.period,
        })
    }

    /// The parameters the law was built from.
    pub fn parameters(&self) -> &FieldWeakeningParameters<T> {
        &self.parameters
    }

    /// One period: the d current reference (A) of the next cycle
    /// ([`crate::OperatingPoint::id_ref`]), from the `voltage` (V) that this
    /// cycle commands, limited or not, and the length U_max (V) that it could
    /// have had ([`crate::Servo::available_voltage`]). A NaN passes through
    /// to this cycle's reference and leaves the state as it was.
    #[inline]
    pub fn update(&self, state: &mut FieldWeakeningState<T>, voltage: Dq<T>, most: T) -> T {
        let left = self.parameters.voltage_share * most - voltage.dot(voltage).sqrt();
        let next = state.id_ref + self.ki_period * left;
        let id_ref = clamp(next, -self.parameters.current, T::ZERO);
        if !id_ref.is_nan() {
            state.id_ref = id_ref;
        }
        id_ref
    }
}
