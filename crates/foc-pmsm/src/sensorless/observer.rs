//! Flux linkage, angle and speed from currents and voltages.

use crate::error::{FocError, not_negative, positive};
use crate::frames::{AlphaBeta, Dq};
use crate::math::wrapped;
use crate::motor::Pmsm;
use axis_scalar::Scalar;

/// The constants of a [`FluxObserver`]. Plain data; [`FluxObserver::new`] validates them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FluxObserverParameters<T = f64> {
    /// α: both poles of the angle's and the speed's estimation, 1/s, greater than 0.
    pub bandwidth: T,
    /// σ_0: correction of the flux at standstill, 1/s, 0 or greater. R (1/L_d + 1/L_q)/4 is
    /// usual.
    pub damping: T,
    /// What a speed of 1 rad/s (electrical) adds to the correction, 0 or greater; 0.2 is
    /// usual.
    pub damping_ratio: T,
    /// Sampling period T_s, s, greater than 0.
    pub period: T,
}

impl<T: Scalar> FluxObserverParameters<T> {
    /// The usual damping of `motor`, as motulator has it.
    pub fn of(motor: &Pmsm<T>, bandwidth: T, period: T) -> Self {
        let p = motor.parameters();
        let sum = T::ONE / p.inductance_d + T::ONE / p.inductance_q;
        Self {
            bandwidth,
            damping: T::of(0.25) * p.resistance * sum,
            damping_ratio: T::of(0.2),
            period,
        }
    }
}

/// The stator's flux linkage by the voltage model, in the estimated rotor frame, corrected
/// by the current model; the angle and the speed from the part of the difference that a
/// wrong angle makes. With e = L i + ψ − λ̂ and the auxiliary flux ψ_a = ψ + (L_d − L_q) i*
/// (complex dq vectors, * conjugate),
///
/// ```text
/// dλ̂/dt = u − R i − j ω_s λ̂ + k (e + e* ψ_a/ψ_a*),   k = σ_0 + ratio |ω̂|
/// ε = −Im(e/ψ_a),   ω_s = ω̂ + 2 α ε,   dω̂/dt = α² ε,   dθ̂/dt = ω_s
/// ```
///
/// M. Hinkkanen, S. E. Saarakkala, H. A. A. Awan, E. Mölsä and T. Tuovinen, "Observers for
/// sensorless synchronous motor drives: framework for design and analysis", IEEE Trans.
/// Ind. Appl. 2018, doi 10.1109/TIA.2018.2858753, as in motulator 0.5 (`Observer`), there
/// by Euler's rule; here the voltage, which stands in the stator, is integrated there, the
/// rest at the middle of the period, so that the steady state is right to second order. For motors with and without magnets, salient or not.
///
/// What it cannot do: at standstill and in slow motion the voltage holds nothing of the
/// angle; and the sign of the magnets is taken as it starts, so that it may settle half a
/// turn off. [`super::CurrentStart`] brings a drive to where it works.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluxObserver<T = f64> {
    motor: Pmsm<T>,
    parameters: FluxObserverParameters<T>,
}

/// The memory of a [`FluxObserver`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluxObserverState<T = f64> {
    /// Flux linkage in the estimated rotor frame, V·s.
    pub flux: Dq<T>,
    /// Electrical angle, rad, from −π to π.
    pub angle: T,
    /// Electrical speed, rad/s.
    pub speed: T,
}

/// What a [`FluxObserver`] knows at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluxEstimate<T = f64> {
    /// Electrical angle, rad, from −π to π.
    pub angle: T,
    /// Electrical speed ω̂, rad/s: that of the speed controller.
    pub speed: T,
    /// ω_s: how fast the estimated frame turns at this sample, electrical rad/s.
    pub frame_speed: T,
    /// Flux linkage in the estimated rotor frame, V·s.
    pub flux: Dq<T>,
    /// Currents in the estimated rotor frame, A.
    pub current: Dq<T>,
    /// ε: the angle's correction, rad.
    pub error: T,
    /// The flux's correction, V.
    pub correction: Dq<T>,
}

impl<T: Scalar> FluxObserver<T> {
    /// Validates the parameters.
    ///
    /// # Errors
    /// [`FocError`] naming the first field out of the range its doc gives.
    pub fn new(motor: Pmsm<T>, parameters: FluxObserverParameters<T>) -> Result<Self, FocError> {
        positive("bandwidth", parameters.bandwidth)?;
        not_negative("damping", parameters.damping)?;
        not_negative("damping_ratio", parameters.damping_ratio)?;
        positive("period", parameters.period)?;
        Ok(Self { motor, parameters })
    }

    /// The parameters the observer was built from.
    pub fn parameters(&self) -> &FluxObserverParameters<T> {
        &self.parameters
    }

    /// The state without current at the electrical `angle` (rad) and `speed` (rad/s).
    pub fn begin(&self, angle: T, speed: T) -> FluxObserverState<T> {
        FluxObserverState {
            flux: self.motor.flux(Dq::ZERO),
            angle: wrapped(angle),
            speed,
        }
    }

    /// What is known at a sample of the current (A, stator's frame).
    pub fn estimate(&self, state: &FluxObserverState<T>, current: AlphaBeta<T>) -> FluxEstimate<T> {
        let p = self.motor.parameters();
        let i = current.park(state.angle);
        let e = self.motor.flux(i) - state.flux;
        let saliency = p.inductance_d - p.inductance_q;
        let auxiliary = Dq {
            d: p.flux_linkage + saliency * i.d,
            q: -saliency * i.q,
        };
        let square = auxiliary.dot(auxiliary);
        let gain = self.parameters.damping + self.parameters.damping_ratio * state.speed.abs();
        let (error, correction) = if square > T::ZERO {
            // e/ψ_a = along + j across; k (e + e* ψ_a/ψ_a*) = 2 k ψ_a Re(e/ψ_a).
            let along = auxiliary.dot(e) / square;
            let across = (auxiliary.d * e.q - auxiliary.q * e.d) / square;
            (-across, auxiliary * (T::TWO * gain * along))
        } else {
            // Without a direction: k (e + e*).
            let d = T::TWO * gain * e.d;
            (T::ZERO, Dq { d, q: T::ZERO })
        };
        FluxEstimate {
            angle: state.angle,
            speed: state.speed,
            frame_speed: state.speed + T::TWO * self.parameters.bandwidth * error,
            flux: state.flux,
            current: i,
            error,
            correction,
        }
    }

    /// On to the next sample: `voltage` (V, stator's frame) is that of the period between
    /// the two, as it arrives at the motor (dead time taken off or compensated). A period
    /// whose numbers would leave the state not finite leaves it as it was.
    pub fn advance(
        &self,
        state: &mut FluxObserverState<T>,
        estimate: &FluxEstimate<T>,
        voltage: AlphaBeta<T>,
    ) {
        let period = self.parameters.period;
        let bandwidth = self.parameters.bandwidth;
        let u = voltage.park(estimate.angle);
        let resistance = self.motor.parameters().resistance;
        let turn = estimate.frame_speed * period;
        // The voltage stands in the stator, what belongs to the currents in the rotor: seen
        // from the middle of the period, half a turn each.
        let (sin, cos) = (T::HALF * turn).sin_cos();
        let turned = |x: Dq<T>| {
            let (alpha, beta) = (x.d, x.q);
            AlphaBeta { alpha, beta }.park_sin_cos(sin, cos)
        };
        let rate = estimate.correction - estimate.current * resistance;
        let flux = turned(turned(estimate.flux + u * period) + rate * period);
        let angle = wrapped(estimate.angle + turn);
        let speed = estimate.speed + bandwidth * bandwidth * estimate.error * period;
        let finite = [flux.d, flux.q, angle, speed];
        if finite.iter().all(|x| x.is_finite()) {
            *state = FluxObserverState { flux, angle, speed };
        }
    }
}
