//! The error at the end of the cycle, from a model of one cycle.

use axis_scalar::Scalar;

use crate::remainder::remainder;
use crate::{Compensator, Correction, MotionEstimator, Sample};

/// A model of one control cycle: how far the table moves in it.
///
/// Implemented for closures `|position, speed, acceleration, command|`,
/// for `cfnn::Predictor<4, 1>` (feature `alloc`, `f64`) and for
/// [`cfnn::FixedNetwork`] with 4 inputs and 1 output in `f64` or `f32`. One in
/// `f32` also serves a law in `f64`: it rounds the increment, 10 µm a cycle at
/// 100 mm/s, not the position.
pub trait IncrementModel<T = f64> {
    /// S(k+1) − S(k) in m, from the table's position S (m), speed (m/s) and
    /// acceleration (m/s²) at t_k, and the q current command I_qr (A).
    fn increment(&mut self, position: T, speed: T, acceleration: T, command: T) -> T;
}

impl<T, F: FnMut(T, T, T, T) -> T> IncrementModel<T> for F {
    fn increment(&mut self, position: T, speed: T, acceleration: T, command: T) -> T {
        self(position, speed, acceleration, command)
    }
}

#[cfg(feature = "alloc")]
impl IncrementModel for cfnn::Predictor<4, 1> {
    fn increment(&mut self, position: f64, speed: f64, acceleration: f64, command: f64) -> f64 {
        let [increment] = self.predict(&[position, speed, acceleration, command]);
        increment
    }
}

impl<T: cfnn::NetworkScalar, const A: usize> IncrementModel<T>
    for cfnn::FixedNetwork<'_, T, 4, 1, A>
{
    fn increment(&mut self, position: T, speed: T, acceleration: T, command: T) -> T {
        let [increment] = self.evaluate(&[position, speed, acceleration, command]);
        increment
    }
}

impl<const A: usize> IncrementModel for cfnn::FixedNetwork<'_, f32, 4, 1, A> {
    fn increment(&mut self, position: f64, speed: f64, acceleration: f64, command: f64) -> f64 {
        let input = [position, speed, acceleration, command].map(|x| x as f32);
        let [increment] = self.evaluate(&input);
        f64::from(increment)
    }
}

/// The network strategy of Liu et al. 2025 (Section 4.4):
///
/// ```text
/// Ŝ(k+1) = S(k) + model(S, v, a, I_qr)
/// Ê(k+1) = S_ref(k+1) − Ŝ(k+1)             (Eq. 36)
/// position correction = Ê(k+1)             so that ΔS = S_ref − S + Ê
/// ```
///
/// I_qr is the command of the cycle before: the present one follows from the
/// correction, which would close an algebraic loop.
#[derive(Clone, Copy, Debug)]
pub struct NetworkCompensation<M, T = f64> {
    model: M,
    estimator: MotionEstimator<T>,
}

impl<M: IncrementModel<T>, T: Scalar> NetworkCompensation<M, T> {
    /// Joins a model of one cycle and the estimator of its inputs; both must
    /// be made for the same control period.
    pub fn new(model: M, estimator: MotionEstimator<T>) -> Self {
        Self { model, estimator }
    }

    /// The model of one cycle.
    pub fn model(&self) -> &M {
        &self.model
    }

    /// The estimator of its inputs.
    pub fn estimator(&self) -> &MotionEstimator<T> {
        &self.estimator
    }

    /// Ê(k+1), m: the tracking error predicted for the end of the cycle that
    /// begins with `sample`.
    ///
    /// Call it, or [`Compensator::correct`], once a cycle: both move the
    /// estimator on.
    pub fn predict_error(&mut self, sample: &Sample<T>) -> T {
        let now = self.estimator.update(sample);
        let increment = self.model.increment(
            now.position,
            now.velocity,
            now.acceleration,
            sample.last_command,
        );
        // Eq. (36)
        remainder(sample.next_reference.position, now.position, increment)
    }
}

#[cfg(feature = "alloc")]
impl NetworkCompensation<cfnn::Predictor<4, 1>> {
    /// The strategy from a trained network: inputs S (m), v (m/s), a (m/s²),
    /// I_qr (A), output S(k+1) − S(k) (m).
    ///
    /// # Errors
    /// [`crate::CompensatorError::NetworkShape`] for other numbers of inputs
    /// or outputs.
    pub fn from_network(
        network: cfnn::Network,
        estimator: MotionEstimator,
    ) -> Result<Self, crate::CompensatorError> {
        let (inputs, outputs) = (network.shape().inputs, network.shape().outputs);
        let model = cfnn::Predictor::new(network)
            .map_err(|_| crate::CompensatorError::NetworkShape { inputs, outputs })?;
        Ok(Self::new(model, estimator))
    }
}

impl<M: IncrementModel<T>, T: Scalar> Compensator<T> for NetworkCompensation<M, T> {
    fn reset(&mut self) {
        self.estimator.reset();
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        Correction {
            position: self.predict_error(sample),
            command: T::ZERO,
        }
    }
}
