//! Discontinuous modulation: one leg at a time does not switch.

use super::{Duties, Svpwm};
use crate::frames::{AlphaBeta, Dq};
use crate::math::clamp;
use axis_scalar::Scalar;

/// Which leg stands still. The names are those of A. M. Hava, R. J. Kerkman and T. A.
/// Lipo, "A high-performance generalized discontinuous PWM algorithm", IEEE Trans. Ind.
/// Appl. 34 (1998), doi 10.1109/28.720446. A leg stands for a third of a turn, and a third
/// of the switching is saved; most of its losses where the current is largest meanwhile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum DiscontinuousPwm {
    /// As [`DiscontinuousPwm::Dpwm1`], 30° (electrical) earlier: for a current that leads
    /// its voltage by about 30°.
    Dpwm0,
    /// The phase with the largest voltage, by magnitude, stands on the rail of its sign:
    /// for 60° about each of its two peaks. For a current in phase with its voltage.
    #[default]
    Dpwm1,
    /// As [`DiscontinuousPwm::Dpwm1`], 30° later: for a current that lags its voltage by
    /// about 30°, as in a motor with reactance.
    Dpwm2,
    /// The highest phase stands on the upper rail.
    Max,
    /// The lowest phase stands on the lower rail: usual where shunts below the legs
    /// measure the currents.
    Min,
}

/// cos 30°.
const COS_30: f64 = 0.866_025_403_784_438_6;

impl<T: Scalar> Svpwm<T> {
    /// As [`Svpwm::duties`], with all three shifted so that one is 0 or 1. The voltage is
    /// the same, overmodulation included. What is not a number stays so.
    ///
    /// ```
    /// use foc_pmsm::svpwm::{DiscontinuousPwm, Overmodulation, Svpwm};
    /// use foc_pmsm::AlphaBeta;
    ///
    /// let modulator = Svpwm::new(540.0, Overmodulation::default())?;
    /// // Phase a is at its positive peak.
    /// let u = AlphaBeta { alpha: 200.0, beta: 0.0 };
    /// let duties = modulator.discontinuous_duties(u, DiscontinuousPwm::Dpwm1);
    /// assert_eq!(duties.a(), 1.0);
    /// assert!((duties.b() - (1.0 - 300.0_f64 / 540.0)).abs() < 1e-12);
    /// # Ok::<(), foc_pmsm::FocError>(())
    /// ```
    pub fn discontinuous_duties(&self, u: AlphaBeta<T>, pwm: DiscontinuousPwm) -> Duties<T> {
        let duties = self.duties(u);
        let upper = match pwm {
            DiscontinuousPwm::Max => true,
            DiscontinuousPwm::Min => false,
            DiscontinuousPwm::Dpwm1 => positive_peak(u),
            // The voltage as it will be, or was, 30° of its turn away.
            DiscontinuousPwm::Dpwm0 => positive_peak(turned(u, T::HALF)),
            DiscontinuousPwm::Dpwm2 => positive_peak(turned(u, -T::HALF)),
        };
        let Duties { a, b, c } = duties;
        let shift = if upper {
            T::ONE - a.max(b).max(c)
        } else {
            -a.min(b).min(c)
        };
        // The leg that stands is at the rail exactly: 1 − D and the sum do not round where
        // D is at least 1/2, and the highest of three centred duties is.
        let leg = |duty: T| clamp(duty + shift, T::ZERO, T::ONE);
        Duties {
            a: leg(a),
            b: leg(b),
            c: leg(c),
        }
    }
}

/// Turned by the angle whose sine is `sin`, ±1/2, and whose cosine is that of 30°.
fn turned<T: Scalar>(u: AlphaBeta<T>, sin: T) -> AlphaBeta<T> {
    let u = Dq {
        d: u.alpha,
        q: u.beta,
    };
    u.inverse_park_sin_cos(sin, T::of(COS_30))
}

/// Whether the phase with the largest magnitude is positive: of three that add up to 0
/// that is where the highest and the lowest do not add up to less than 0.
fn positive_peak<T: Scalar>(u: AlphaBeta<T>) -> bool {
    let phases = u.inverse_clarke();
    let max = phases.a.max(phases.b).max(phases.c);
    let min = phases.a.min(phases.b).min(phases.c);
    max + min >= T::ZERO
}
