//! The delay of a sampled voltage, and what the rotor does in the meantime.

use crate::error::{FocError, not_negative, positive};
use crate::frames::{AlphaBeta, Dq};
use axis_scalar::Scalar;

/// When a commanded voltage arrives: after the computation, and held in the stator for a
/// period. The rotor turns on by ω_e T_d until the middle of that period; aimed at the
/// angle of that instant, the mean of the held voltage has the commanded direction in
/// the rotor's frame (B.-H. Bae and S.-K. Sul, "A compensation method for time delay of
/// full-digital synchronous frame current regulator of PWM AC drives", IEEE Trans. Ind.
/// Appl. 2003, doi 10.1109/TIA.2003.810660).
///
/// ```
/// use foc_pmsm::{Dq, VoltageDelay};
///
/// let delay = VoltageDelay::new(1e-4_f32, 1e-4)?;
/// // 1.5 periods at 1000 rad/s (electrical).
/// assert!((delay.angle(0.2, 1000.0) - 0.35).abs() < 1e-6);
/// let u = Dq { d: 0.0, q: 100.0 };
/// let aimed = delay.inverse_park(u, 0.2, 1000.0);
/// assert!((aimed.alpha - u.inverse_park(0.35).alpha).abs() < 1e-3);
/// # Ok::<(), foc_pmsm::FocError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoltageDelay<T = f64> {
    half_period: T,
    total: T,
}

impl<T: Scalar> VoltageDelay<T> {
    /// From the control `period` (s) and the time (s) from the sample to the beginning of
    /// the period in which the voltage stands: one period for most drives, 0 where the
    /// voltage stands at once.
    ///
    /// # Errors
    /// [`FocError`] unless the period is finite and greater than 0, and `computation`
    /// finite and 0 or greater.
    pub fn new(period: T, computation: T) -> Result<Self, FocError> {
        positive("period", period)?;
        not_negative("computation", computation)?;
        let half_period = T::HALF * period;
        Ok(Self {
            half_period,
            total: computation + half_period,
        })
    }

    /// T_d: from the sample to the middle of the period in which the voltage stands, s.
    pub fn total(&self) -> T {
        self.total
    }

    /// θ + ω_e T_d, rad: where the rotor is in the middle of that period, from its
    /// electrical angle (rad) at the sample and its electrical speed (rad/s).
    #[inline]
    pub fn angle(&self, electrical_angle: T, electrical_speed: T) -> T {
        electrical_angle + electrical_speed * self.total
    }

    /// The share of the vector's length that the mean of the held voltage has in the
    /// rotor's frame, sin(x)/x with x = ω_e T/2: 1 at standstill, 0.9996 at a turn in 126
    /// periods. Divide the commanded voltage by it where that matters.
    pub fn magnitude(&self, electrical_speed: T) -> T {
        let x = electrical_speed * self.half_period;
        if x == T::ZERO {
            return T::ONE;
        }
        let (sin, _) = x.sin_cos();
        sin / x
    }

    /// Inverse Park transform of the voltage `u` (V) at [`VoltageDelay::angle`].
    #[inline]
    pub fn inverse_park(&self, u: Dq<T>, electrical_angle: T, electrical_speed: T) -> AlphaBeta<T> {
        u.inverse_park(self.angle(electrical_angle, electrical_speed))
    }
}
