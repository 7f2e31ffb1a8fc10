//! Compensation of the dead time of an inverter.

use crate::error::{FocError, check, not_negative, positive};
use crate::frames::{AlphaBeta, Phases};
use crate::math::clamp;
use crate::svpwm::Duties;
use axis_scalar::Scalar;

/// What dead time takes from a leg by the sign of its current, given back: D + t_d/T
/// sat(i/i_0), linear for currents below i_0, where the sign of a measured current is
/// that of its ripple and noise (S.-G. Jeong and M.-H. Park, "The analysis and
/// compensation of dead-time effects in PWM inverters", IEEE Trans. Ind. Electron. 38
/// (1991) 108–114; the linear zone is common practice). The counterpart of
/// [`crate::inverter::Inverter::effective_duties`]. On-state voltages are not compensated.
///
/// ```
/// use foc_pmsm::svpwm::Duties;
/// use foc_pmsm::{DeadTimeCompensation, Phases};
///
/// let law = DeadTimeCompensation::new(2e-6, 1e-4, 0.5)?;
/// let asked = Duties::new(0.5, 0.4, 1.0)?;
/// let duties = law.duties(asked, Phases { a: 3.0, b: -0.25, c: -2.75 });
/// assert!((duties.a() - 0.52_f64).abs() < 1e-15);
/// assert!((duties.b() - 0.39_f64).abs() < 1e-15);
/// // A leg that does not switch loses nothing.
/// assert_eq!(duties.c(), 1.0);
/// # Ok::<(), foc_pmsm::FocError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeadTimeCompensation<T = f64> {
    share: T,
    zone: T,
}

impl<T: Scalar> DeadTimeCompensation<T> {
    /// From the dead time t_d (s), the PWM period T (s) and the current i_0 (A) up to
    /// which the compensation is linear; 0 for the sign alone.
    ///
    /// # Errors
    /// [`FocError`] unless the period is finite and greater than 0, 0 ≤ dead time <
    /// period/2, and `zone` is finite and 0 or greater.
    pub fn new(dead_time: T, period: T, zone: T) -> Result<Self, FocError> {
        positive("period", period)?;
        let ok = (T::ZERO..T::HALF * period).contains(&dead_time);
        let valid = "0 or greater and less than half the period";
        check(ok, "dead_time", dead_time, valid)?;
        not_negative("zone", zone)?;
        Ok(Self {
            share: dead_time / period,
            zone,
        })
    }

    /// The duties to command so that `duties` arrive, from the phase currents (A, positive
    /// into the motor) at the period's start. Within \[0, 1\]; a leg whose current is not a
    /// number has a duty that is none.
    pub fn duties(&self, duties: Duties<T>, currents: Phases<T>) -> Duties<T> {
        let leg = |duty: T, i: T| {
            if duty > T::ZERO && duty < T::ONE {
                clamp(duty + self.share * self.saturated(i), T::ZERO, T::ONE)
            } else {
                duty
            }
        };
        Duties {
            a: leg(duties.a, currents.a),
            b: leg(duties.b, currents.b),
            c: leg(duties.c, currents.c),
        }
    }

    /// The same as a voltage vector (V) to add before the modulator, at the DC-link
    /// voltage `dc_voltage` (V): for flux observers, which have to know what arrives, and
    /// while all legs switch.
    pub fn voltage(&self, dc_voltage: T, currents: Phases<T>) -> AlphaBeta<T> {
        let lost = dc_voltage * self.share;
        Phases {
            a: lost * self.saturated(currents.a),
            b: lost * self.saturated(currents.b),
            c: lost * self.saturated(currents.c),
        }
        .clarke()
    }

    /// The sign of a current, linear within the zone; 0 has none.
    fn saturated(&self, i: T) -> T {
        if i == T::ZERO || i.abs() < self.zone {
            i / self.zone.max(T::MIN_POSITIVE)
        } else if i.is_nan() {
            i
        } else {
            T::ONE.copysign(i)
        }
    }
}
