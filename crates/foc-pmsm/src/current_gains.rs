//! Gains of the two current controllers from the motor and a bandwidth.

use crate::error::{FocError, check, positive};
use crate::frames::Dq;
use crate::gains::ServoGains;
use crate::motor::Pmsm;
use axis_scalar::Scalar;

/// Gains of the two current controllers, one number an axis. They hold for axes that
/// are decoupled ([`crate::Decoupling`]).
///
/// ```
/// use foc_pmsm::{CurrentGains, MotorParameters, Pmsm};
///
/// let motor = Pmsm::new(MotorParameters {
///     pole_pairs: 4, resistance: 0.75, inductance_d: 4.11e-3,
///     inductance_q: 13.2e-3, flux_linkage: 0.2735_f64,
/// })?;
/// // A period of 100 µs and half of one for the hold, with 60° of phase margin.
/// let bandwidth = CurrentGains::bandwidth(1.5e-4, 60_f64.to_radians())?;
/// let gains = CurrentGains::pole_zero(&motor, bandwidth)?;
/// assert!((bandwidth - 3490.7).abs() < 0.1);
/// assert!((gains.kp.d - 14.35).abs() < 0.01 && (gains.ki.d - 2618.0).abs() < 0.1);
/// # Ok::<(), foc_pmsm::FocError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CurrentGains<T = f64> {
    /// Voltage per current error, V/A.
    pub kp: Dq<T>,
    /// Voltage per integrated current error, V/(A·s).
    pub ki: Dq<T>,
    /// r: the voltage −r i, r in V/A, that is added to the controller's output
    /// ([`crate::Decoupling::with_active_resistance`]); 0 for one degree of freedom.
    pub active_resistance: Dq<T>,
}

impl<T: Scalar> CurrentGains<T> {
    /// The zero of the controller on the pole of the axis: k_p = α L, k_i = α R, for the
    /// bandwidth α (rad/s). The open loop is α/s, the closed one α/(s + α). Internal
    /// model control with a filter of first order gives the same (L. Harnefors and
    /// H.-P. Nee, "Model-based current control of AC machines using the internal model
    /// control method", IEEE Trans. Ind. Appl. 34 (1998) 133–141, doi
    /// 10.1109/28.658735).
    ///
    /// A voltage that the controller does not know of dies with the time constant
    /// L/R of the winding, which this loop does not change;
    /// [`CurrentGains::two_degrees_of_freedom`] does.
    ///
    /// # Errors
    /// [`FocError`] unless `bandwidth` is finite and greater than 0.
    pub fn pole_zero(motor: &Pmsm<T>, bandwidth: T) -> Result<Self, FocError> {
        positive("bandwidth", bandwidth)?;
        let p = motor.parameters();
        let inductance = Dq {
            d: p.inductance_d,
            q: p.inductance_q,
        };
        let integral = bandwidth * p.resistance;
        Ok(Self {
            kp: inductance * bandwidth,
            ki: Dq {
                d: integral,
                q: integral,
            },
            active_resistance: Dq::ZERO,
        })
    }

    /// Both poles of an axis at α (rad/s): k_p = α L, k_i = α² L, r = α L − R, for
    ///
    /// ```text
    /// u = k_p (i_ref − i) + k_i ∫(i_ref − i) dt − r i
    /// i/i_ref = α/(s + α),   i/(disturbing voltage) = s/(L (s + α)²)
    /// ```
    ///
    /// The reference is followed as with [`CurrentGains::pole_zero`], a disturbance dies
    /// with 1/α. It follows from L di/dt = u − R i by comparing coefficients. motulator
    /// 0.5 (`CurrentController`) has it with R left out; see also M. Hinkkanen, H. A. A.
    /// Awan, Z. Qu, T. Tuovinen and F. Briz, "Current control for synchronous motor
    /// drives: direct discrete-time pole-placement design", IEEE Trans. Ind. Appl. 2015,
    /// doi 10.1109/TIA.2015.2495288. Where α L < R, r is negative and takes off what the
    /// winding has too much.
    ///
    /// # Errors
    /// [`FocError`] unless `bandwidth` is finite and greater than 0.
    pub fn two_degrees_of_freedom(motor: &Pmsm<T>, bandwidth: T) -> Result<Self, FocError> {
        let kp = Self::pole_zero(motor, bandwidth)?.kp;
        let resistance = motor.parameters().resistance;
        Ok(Self {
            kp,
            ki: kp * bandwidth,
            active_resistance: Dq {
                d: kp.d - resistance,
                q: kp.q - resistance,
            },
        })
    }

    /// The bandwidth α (rad/s) that leaves a phase margin φ (rad) beside a `delay`
    /// T_d (s): α = (π/2 − φ)/T_d, since the loop α e^(−s T_d)/s of
    /// [`CurrentGains::pole_zero`] crosses 1 at ω = α with the phase −π/2 − α T_d.
    /// T_d is the time from the sample to the middle of the period in which the voltage
    /// stands ([`crate::VoltageDelay::total`]).
    ///
    /// # Errors
    /// [`FocError`] unless 0 < φ < π/2 and the delay is finite and greater than 0.
    pub fn bandwidth(delay: T, phase_margin: T) -> Result<T, FocError> {
        positive("delay", delay)?;
        let quarter = T::HALF * T::PI;
        let inside = phase_margin > T::ZERO && phase_margin < quarter;
        let valid = "greater than 0 and less than pi/2";
        check(inside, "phase_margin", phase_margin, valid)?;
        Ok((quarter - phase_margin) / delay)
    }
}

impl<T: Scalar> ServoGains<T> {
    /// The same position and speed gains with other current controllers. The active
    /// resistance of `current` has no place here: it belongs into
    /// [`crate::Decoupling`].
    pub fn with_current(self, current: &CurrentGains<T>) -> Self {
        Self {
            d_p: current.kp.d,
            d_i: current.ki.d,
            q_p: current.kp.q,
            q_i: current.ki.q,
            ..self
        }
    }
}
