//! Space-vector pulse-width modulation: duty cycles of the three half
//! bridges from a voltage vector.
//!
//! A leg with duty D ∈ \[0, 1\] puts D·U_dc on its phase in the mean. The
//! vectors that can be made fill the hexagon max − min ≤ U_dc of the phase
//! voltages (a, b, c); its inscribed circle, radius U_dc/√3, is the linear
//! range, its corners are 2 U_dc/3 long.

mod discontinuous;

pub use discontinuous::DiscontinuousPwm;

use crate::error::{FocError, check, positive};
use crate::frames::{AlphaBeta, FRAC_1_SQRT_3, Phases};
use crate::math::clamp;
use axis_scalar::Scalar;
use core::f64::consts::FRAC_2_PI;

/// The mean fraction of a period that each leg is on the upper rail: always
/// within \[0, 1\], or NaN if [`Svpwm`] was asked for a vector that is not
/// a number, so that a loop that has diverged shows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Duties<T = f64> {
    pub(crate) a: T,
    pub(crate) b: T,
    pub(crate) c: T,
}

/// What is made of a vector outside the hexagon. The two names are those of
/// Hava, Sul, Kerkman and Lipo, "Dynamic overmodulation characteristics of
/// triangle intersection PWM methods", IEEE Trans. Ind. Appl. 35 (1999).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Overmodulation {
    /// Minimum phase error: shortened to the hexagon at the same angle. The
    /// fundamental of a turning vector grows to √3 ln 3/π U_dc = 0.6057 U_dc.
    #[default]
    MinimumPhaseError,
    /// Minimum magnitude error: the nearest point of the hexagon, which is
    /// what clipping each duty to \[0, 1\] gives. The fundamental of a turning
    /// vector tends to the six-step limit 2/π U_dc = 0.6366 U_dc.
    MinimumMagnitudeError,
    /// Up to six-step: the length is kept, up to 2 U_dc/3, and the angle held at the
    /// nearest one at which the hexagon is that long (S. Bolognani and M. Zigliotto, "Novel
    /// digital continuous control of SVM inverters in the overmodulation range", IEEE
    /// Trans. Ind. Appl. 33 (1997), doi 10.1109/28.568019). With r the length and cos α =
    /// U_dc/(√3 r), the fundamental of a turning vector is 6/π r (π/6 − α + sin α): it is
    /// continuous in r and reaches 2/π U_dc, with six steps a turn, at r = 2 U_dc/3.
    SixStep,
}

/// A modulator for one DC-link voltage. Immutable, without memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Svpwm<T = f64> {
    dc_voltage: T,
    inverse: T,
    overmodulation: Overmodulation,
}

impl<T: Scalar> Svpwm<T> {
    /// A modulator for the DC-link voltage U_dc (V, greater than 0).
    ///
    /// # Errors
    /// [`FocError`] if the voltage is not finite and greater than 0.
    pub fn new(dc_voltage: T, overmodulation: Overmodulation) -> Result<Self, FocError> {
        positive("dc_voltage", dc_voltage)?;
        Ok(Self {
            dc_voltage,
            inverse: T::ONE / dc_voltage,
            overmodulation,
        })
    }

    /// Radius of the linear range, U_dc/√3, V.
    #[inline]
    pub fn linear_limit(&self) -> T {
        self.dc_voltage * T::of(FRAC_1_SQRT_3)
    }

    /// Fundamental of six-step operation, 2/π U_dc, V: the most there is.
    #[inline]
    pub fn six_step_limit(&self) -> T {
        self.dc_voltage * T::of(FRAC_2_PI)
    }

    /// Duty cycles for the voltage vector `u` (V): the phase voltages plus
    /// the zero sequence −(max + min)/2, which centres them between the
    /// rails and splits the zero-vector time evenly, as space-vector
    /// modulation does (van der Broeck, Skudelny and Stanke, IEEE Trans. Ind.
    /// Appl. 24 (1988) 142–150). Outside the hexagon [`Overmodulation`]
    /// decides. NaN if the phase voltages are not finite.
    #[inline]
    pub fn duties(&self, u: AlphaBeta<T>) -> Duties<T> {
        let phases = u.inverse_clarke();
        let max = phases.a.max(phases.b).max(phases.c);
        let min = phases.a.min(phases.b).min(phases.c);
        // Half of max − min, which does not overflow where the phases do not.
        let half_range = T::HALF * max - T::HALF * min;
        let outside = half_range > T::HALF * self.dc_voltage;
        if outside && self.overmodulation == Overmodulation::SixStep {
            return self.held(phases, max, min);
        }
        let shorten = outside && self.overmodulation == Overmodulation::MinimumPhaseError;
        // A ray meets the hexagon where its range is U_dc.
        let scale = if shorten {
            T::HALF / half_range
        } else {
            self.inverse
        };
        let centre = T::HALF * (max + min);
        // The clamp clips outside the hexagon, and takes off rounding inside.
        let duty = |x: T| clamp(T::HALF + (x - centre) * scale, T::ZERO, T::ONE);
        Duties {
            a: duty(phases.a),
            b: duty(phases.b),
            c: duty(phases.c),
        }
    }

    /// The vector of the same length on the hexagon's edge, or its corner. Along the
    /// normal of the edge it is U_dc/√3 long, across it as long as the middle phase.
    #[cold]
    fn held(&self, phases: Phases<T>, max: T, min: T) -> Duties<T> {
        let middle = -(max + min);
        let (a, b, c) = (
            max * self.inverse,
            min * self.inverse,
            middle * self.inverse,
        );
        let square = T::TWO / T::of(3.0) * (a * a + b * b + c * c);
        let across = square.min(T::of(4.0 / 9.0)) - T::of(1.0 / 3.0);
        let side = T::of(1.5) * across.max(T::ZERO).sqrt().copysign(middle);
        let held = clamp(T::HALF + side, T::ZERO, T::ONE);
        let finite = phases.a.is_finite() && phases.b.is_finite() && phases.c.is_finite();
        let duty = |x: T| match x {
            _ if !finite => T::NAN,
            x if x == max => T::ONE,
            x if x == min => T::ZERO,
            _ => held,
        };
        Duties {
            a: duty(phases.a),
            b: duty(phases.b),
            c: duty(phases.c),
        }
    }

    /// Six-step operation: each leg on the rail of its phase's sign, the
    /// hexagon's corner nearest to `u` in angle.
    pub fn six_step(&self, u: AlphaBeta<T>) -> Duties<T> {
        let phases = u.inverse_clarke();
        let rail = |x: T| match x {
            x if x.is_nan() => x,
            x if x > T::ZERO => T::ONE,
            _ => T::ZERO,
        };
        Duties {
            a: rail(phases.a),
            b: rail(phases.b),
            c: rail(phases.c),
        }
    }

    /// The mean voltage vector (V) that the duties make.
    #[inline]
    pub fn voltage(&self, duties: Duties<T>) -> AlphaBeta<T> {
        duties.voltage(self.dc_voltage)
    }
}

impl<T: Scalar> Duties<T> {
    /// The duties of the legs a, b and c.
    ///
    /// # Errors
    /// [`FocError`] naming the first that is not within \[0, 1\].
    pub fn new(a: T, b: T, c: T) -> Result<Self, FocError> {
        let leg = |field, duty: T| {
            let valid = "0 or greater and at most 1";
            check((T::ZERO..=T::ONE).contains(&duty), field, duty, valid)
        };
        Ok(Self {
            a: leg("duty a", a)?,
            b: leg("duty b", b)?,
            c: leg("duty c", c)?,
        })
    }

    /// Leg a.
    #[inline]
    pub fn a(&self) -> T {
        self.a
    }

    /// Leg b.
    #[inline]
    pub fn b(&self) -> T {
        self.b
    }

    /// Leg c.
    #[inline]
    pub fn c(&self) -> T {
        self.c
    }

    /// The mean voltage vector (V) at the DC-link voltage `dc_voltage` (V).
    #[inline]
    pub fn voltage(self, dc_voltage: T) -> AlphaBeta<T> {
        Phases {
            a: self.a * dc_voltage,
            b: self.b * dc_voltage,
            c: self.c * dc_voltage,
        }
        .clarke()
    }
}

/// The hexagon's sector of a vector, 1 to 6: sector n holds the angles from
/// (n − 1)·60° up to, not including, n·60°. The zero vector is in sector 1,
/// as is one that is not a number.
pub fn sector<T: Scalar>(u: AlphaBeta<T>) -> u8 {
    let Phases { a, b, c } = u.inverse_clarke();
    if b >= a && a > c {
        2
    } else if b > c && c >= a {
        3
    } else if c >= b && b > a {
        4
    } else if c > a && a >= b {
        5
    } else if a >= c && c > b {
        6
    } else {
        1
    }
}
