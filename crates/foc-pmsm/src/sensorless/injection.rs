//! The angle at standstill, from the answer of the currents to a voltage that alternates.

use crate::error::{FocError, check, positive};
use crate::frames::{AlphaBeta, Dq};
use crate::math::wrapped;
use crate::motor::Pmsm;
use axis_scalar::Scalar;

/// The constants of a [`SignalInjection`]. Plain data; [`SignalInjection::new`] validates them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct SignalInjectionParameters<T = f64> {
    /// U: the voltage that is added with alternating sign, V, greater than 0. It makes a ripple of the current of
    /// U T_s/L_d from peak to peak.
    pub voltage: T,
    /// α: both poles of the angle's and the speed's estimation, 1/s, greater than 0.
    pub bandwidth: T,
    /// Sampling period T_s, s, greater than 0.
    pub period: T,
    /// Whether a voltage acts one period later than it is computed, as in most drives.
    pub late: bool,
}

/// Injection of a square wave of half the sampling rate along the estimated d axis. A salient motor (L_d ≠ L_q) at an error
/// θ̃ = θ − θ̂ of the angle answers to ±U in a period by
///
/// ```text
/// Δi_d = ±U T_s (cos² θ̃/L_d + sin² θ̃/L_q),    Δi_q = ±U T_s (1/L_d − 1/L_q) sin θ̃ cos θ̃
/// ```
///
/// in the estimated frame, so that ε = Δi_q/(±U T_s (1/L_d − 1/L_q)) = ½ sin 2θ̃, whatever the speed, at standstill too. Of
/// three samples the second difference is taken: what changes evenly, as the fundamental does, is not in it. A loop of second
/// order follows:
///
/// ```text
/// ω_s = ω̂ + 2 α ε,   dω̂/dt = α² ε,   dθ̂/dt = ω_s
/// ```
///
/// S. Kim, J.-I. Ha and S.-K. Sul, "PWM switching frequency signal injection sensorless method in IPMSM", IEEE Trans. Ind.
/// Appl. 48 (2012) 1576–1587, doi 10.1109/TIA.2012.2210175, is the method's source; the formulas here are derived from the voltage equations of the crate's
/// head with ω L i and R i left out: over a period they change by little.
///
/// What it cannot do: sin 2θ̃ is the same half a turn on, so that it settles at the rotor's angle or opposite to it. Iron
/// that the magnets saturate tells which: at a current of +I along the true d axis the inductance is lower and the ripple
/// [`SignalEstimate::ripple`] larger than at −I; [`SignalInjection::turned`] turns the state over. Saturation across the axes
/// shifts the angle by some degrees. In fast motion a [`super::FluxObserver`] needs no signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignalInjection<T = f64> {
    parameters: SignalInjectionParameters<T>,
    /// U T_s (1/L_d − 1/L_q), A.
    answer: T,
}

/// The memory of a [`SignalInjection`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignalInjectionState<T = f64> {
    /// Electrical angle, rad, from −π to π.
    pub angle: T,
    /// Electrical speed, rad/s.
    pub speed: T,
    /// Currents of the last sample and of the one before, A, stator's frame.
    pub before: [AlphaBeta<T>; 2],
    /// Samples that are known, up to 2.
    pub known: u8,
    /// Whether the next voltage is the positive one.
    pub is_up: bool,
}

/// What a [`SignalInjection`] knows at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignalEstimate<T = f64> {
    /// Electrical angle θ̂, rad, from −π to π.
    pub angle: T,
    /// Electrical speed ω̂, rad/s: that of the speed controller.
    pub speed: T,
    /// ω_s: how fast the estimated frame turns, electrical rad/s.
    pub frame_speed: T,
    /// Currents in the estimated frame without the ripple, A: the mean of two samples, so half a period old.
    pub current: Dq<T>,
    /// Answer of the currents to the positive voltage in one period, A; 0 until three samples are known.
    pub ripple: Dq<T>,
    /// ε: the angle's correction, rad.
    pub error: T,
    /// What to add to the voltage of this period, V, estimated frame.
    pub voltage: Dq<T>,
}

impl<T: Scalar> SignalInjection<T> {
    /// Validates the parameters, and that the motor is salient.
    ///
    /// # Errors
    /// [`FocError`] naming the first field out of the range its doc gives; `saliency` (1/L_d − 1/L_q) of a motor with L_d = L_q,
    /// which shows nothing of its angle.
    pub fn new(
        motor: &Pmsm<T>,
        parameters: SignalInjectionParameters<T>,
    ) -> Result<Self, FocError> {
        positive("voltage", parameters.voltage)?;
        positive("bandwidth", parameters.bandwidth)?;
        positive("period", parameters.period)?;
        let p = motor.parameters();
        let saliency = T::ONE / p.inductance_d - T::ONE / p.inductance_q;
        let answer = parameters.voltage * parameters.period * saliency;
        let is_seen = answer.is_finite() && (T::ONE / answer).is_finite();
        check(is_seen, "saliency", saliency, "not 0: L_d and L_q apart")?;
        Ok(Self { parameters, answer })
    }

    /// The parameters the law was built from.
    pub fn parameters(&self) -> &SignalInjectionParameters<T> {
        &self.parameters
    }

    /// The state at the electrical `angle` (rad) and `speed` (rad/s), as far as they are known.
    pub fn begin(&self, angle: T, speed: T) -> SignalInjectionState<T> {
        let none = AlphaBeta {
            alpha: T::ZERO,
            beta: T::ZERO,
        };
        SignalInjectionState {
            angle: wrapped(angle),
            speed,
            before: [none; 2],
            known: 0,
            is_up: true,
        }
    }

    /// The same state half a turn on, where the magnets turned out to be the other way round.
    #[must_use]
    pub fn turned(&self, state: &SignalInjectionState<T>) -> SignalInjectionState<T> {
        SignalInjectionState {
            angle: wrapped(state.angle + T::PI),
            ..*state
        }
    }

    /// What is known at a sample of the current (A, stator's frame).
    pub fn estimate(
        &self,
        state: &SignalInjectionState<T>,
        current: AlphaBeta<T>,
    ) -> SignalEstimate<T> {
        let p = &self.parameters;
        let [last, first] = state.before;
        let up = |is_up: bool| if is_up { T::ONE } else { -T::ONE };
        let now = current.park(state.angle);
        let (mean, ripple) = if state.known < 2 {
            (now, Dq::ZERO)
        } else {
            let (last, first) = (last.park(state.angle), first.park(state.angle));
            // The sign alternates: the one that acted in the last period is the opposite of the next, or, late, the next itself.
            let acted = up(state.is_up == p.late);
            let second = now - last * T::TWO + first;
            ((now + last) * T::HALF, second * (T::HALF * acted))
        };
        let error = ripple.q / self.answer;
        SignalEstimate {
            angle: state.angle,
            speed: state.speed,
            frame_speed: state.speed + T::TWO * p.bandwidth * error,
            current: mean,
            ripple,
            error,
            voltage: Dq {
                d: p.voltage * up(state.is_up),
                q: T::ZERO,
            },
        }
    }

    /// On to the next sample, after [`SignalInjection::estimate`] of this `current` (A, stator's frame). The sign alternates in any
    /// case; numbers that would leave the angle or the speed not finite leave both as they were, and a current that is not
    /// finite is forgotten with those before it.
    pub fn advance(
        &self,
        state: &mut SignalInjectionState<T>,
        estimate: &SignalEstimate<T>,
        current: AlphaBeta<T>,
    ) {
        let p = &self.parameters;
        state.is_up = !state.is_up;
        let angle = wrapped(estimate.angle + estimate.frame_speed * p.period);
        let speed = estimate.speed + p.bandwidth * p.bandwidth * estimate.error * p.period;
        if angle.is_finite() && speed.is_finite() {
            (state.angle, state.speed) = (angle, speed);
        }
        if current.alpha.is_finite() && current.beta.is_finite() {
            state.before = [current, state.before[0]];
            state.known = (state.known + 1).min(2);
        } else {
            state.known = 0;
        }
    }
}
