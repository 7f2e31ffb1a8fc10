//! The tracking error as a linear filter of the reference.

use core::f64::consts::TAU;

use axis_scalar::Scalar;

use crate::error::{self, require, within};
use crate::{Compensator, CompensatorError, Correction, Sample};

/// Largest number of poles of a [`TransferFunctionModel`].
pub const MAX_ORDER: usize = 16;

/// A linear model e(z) = H(z) a(z) of the tracking error e (m) that follows
/// from the reference acceleration a (m/s²):
///
/// ```text
/// H(z) = d + Σᵢ cᵢ Bᵢ(z)                                     i = 1 … n
/// Bᵢ(z) = √(1 − pᵢ²)/(1 − pᵢ z⁻¹) · Πⱼ₍ⱼ₌₁…ᵢ₋₁₎ (z⁻¹ − pⱼ)/(1 − pⱼ z⁻¹)
/// ```
///
/// The Bᵢ are orthonormal (Takenaka–Malmquist; with one repeated pole they are
/// Laguerre's functions), so the model is linear in c and d, and stable
/// whatever they are. Plain numbers, immutable; the caller stores them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "crate::stored::StoredModel<T>",
        into = "crate::stored::StoredModel<T>"
    )
)]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: Scalar + serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct TransferFunctionModel<T = f64> {
    period: T,
    direct: T,
    order: usize,
    poles: [T; MAX_ORDER],
    gains: [T; MAX_ORDER],
    coefficients: [T; MAX_ORDER],
}

impl<T: Scalar> TransferFunctionModel<T> {
    /// Control `period` (from 1e-9 to 1e3 s), `direct` feed-through d (s²), real `poles` pᵢ (of
    /// z, one for each term) and `coefficients` cᵢ (s²).
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] for a period outside its range, another
    /// number that is not finite, a pole
    /// outside −1 < p < 1, more than [`MAX_ORDER`] poles, or as many
    /// coefficients as there are not poles.
    pub fn new(
        period: T,
        direct: T,
        poles: &[T],
        coefficients: &[T],
    ) -> Result<Self, CompensatorError> {
        let order = poles.len();
        let valid = "at most 16 poles";
        require(order <= MAX_ORDER, "order", order as f64, valid)?;
        let count = coefficients.len();
        let valid = "as many coefficients as poles";
        require(count == order, "coefficients", count as f64, valid)?;
        let mut model = Self {
            period: error::period(period)?,
            direct: require(direct.is_finite(), "direct", direct, "finite")?,
            order,
            poles: [T::ZERO; MAX_ORDER],
            gains: [T::ZERO; MAX_ORDER],
            coefficients: [T::ZERO; MAX_ORDER],
        };
        for (i, (&p, &c)) in poles.iter().zip(coefficients).enumerate() {
            require(p.abs() < T::ONE, "pole", p, "above -1 and below 1")?;
            require(c.is_finite(), "coefficient", c, "finite")?;
            model.poles[i] = p;
            model.gains[i] = ((T::ONE - p) * (T::ONE + p)).sqrt();
            model.coefficients[i] = c;
        }
        Ok(model)
    }

    /// The same model, each number rounded to the nearest of another scalar.
    ///
    /// # Errors
    /// As [`new`](Self::new), where one has left its range by that: in `f32` a
    /// pole above 1 − 3e-8 becomes 1, which is not settled.
    pub fn cast<U: Scalar>(&self) -> Result<TransferFunctionModel<U>, CompensatorError> {
        let cast = |value: T| U::of(value.to_f64());
        let (poles, coefficients) = (self.poles.map(cast), self.coefficients.map(cast));
        TransferFunctionModel::new(
            cast(self.period),
            cast(self.direct),
            &poles[..self.order],
            &coefficients[..self.order],
        )
    }

    /// Control period, s.
    pub fn period(&self) -> T {
        self.period
    }

    /// Direct feed-through d, s².
    pub fn direct(&self) -> T {
        self.direct
    }

    /// Number of poles.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Poles of z, in the order of the terms.
    pub fn poles(&self) -> &[T] {
        &self.poles[..self.order]
    }

    /// Coefficients cᵢ, s².
    pub fn coefficients(&self) -> &[T] {
        &self.coefficients[..self.order]
    }

    /// cᵢ √(1 − pᵢ²), s²: what each section's value is weighed with.
    pub fn weights(&self) -> impl Iterator<Item = T> + '_ {
        let pairs = self.coefficients().iter().zip(&self.gains);
        pairs.map(|(&c, &gain)| c * gain)
    }

    /// Error at constant acceleration, per acceleration, s².
    ///
    /// At constant velocity the model's error is always zero.
    pub fn dc_gain(&self) -> T {
        self.response(T::ZERO).0
    }

    /// Real and imaginary part (s²) of H at `frequency` (Hz); NaN if that
    /// is not finite.
    pub fn response(&self, frequency: T) -> (T, T) {
        let (sin, cos) = (T::of(TAU) * frequency * self.period).sin_cos();
        let delay = (cos, -sin); // z⁻¹
        let mut chain = (T::ONE, T::ZERO);
        let mut sum = (self.direct, T::ZERO);
        for i in 0..self.order {
            let p = self.poles[i];
            let section = divide(chain, (T::ONE - p * delay.0, -p * delay.1));
            let weight = self.coefficients[i] * self.gains[i];
            sum = (sum.0 + weight * section.0, sum.1 + weight * section.1);
            chain = multiply(section, (delay.0 - p, delay.1));
        }
        sum
    }

    /// The errors (m) that a reference acceleration (m/s², one value a cycle,
    /// from rest) causes; each at the instant of its acceleration.
    #[cfg(feature = "alloc")]
    pub fn simulate(&self, acceleration: &[T]) -> alloc::vec::Vec<T> {
        let mut state = Sections::default();
        let error = |&a| self.output(&mut state, a);
        acceleration.iter().map(error).collect()
    }

    /// One cycle of the filter.
    fn output(&self, state: &mut Sections<T>, acceleration: T) -> T {
        let mut error = self.direct * acceleration;
        state.advance(self.poles(), acceleration, |i, section| {
            error += self.coefficients[i] * self.gains[i] * section;
        });
        error
    }
}

fn multiply<T: Scalar>(a: (T, T), b: (T, T)) -> (T, T) {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn divide<T: Scalar>(a: (T, T), b: (T, T)) -> (T, T) {
    let scale = T::ONE / (b.0 * b.0 + b.1 * b.1);
    multiply(a, (b.0 * scale, -b.1 * scale))
}

/// The filter's memory: one number a section.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sections<T>([T; MAX_ORDER]);

impl<T: Scalar> Sections<T> {
    /// Moves every section on by one cycle and shows its new value, which is
    /// Bᵢ's output without the factor √(1 − pᵢ²).
    pub(crate) fn advance(&mut self, poles: &[T], input: T, mut show: impl FnMut(usize, T)) {
        let mut chain = input;
        for (i, (section, &p)) in self.0.iter_mut().zip(poles).enumerate() {
            let last = *section;
            *section = p * last + chain; // 1/(1 − p z⁻¹)
            show(i, *section);
            chain = last - p * *section; // (z⁻¹ − p)/(1 − p z⁻¹)
        }
    }
}

/// Feed-forward of the error that a linear model predicts from the reference:
/// the paper's baseline.
///
/// At t_k the reference of t_{k+1} is known, so the correction is ê(k+1). It
/// depends on the reference only: no noise, no loop closed.
#[derive(Clone, Copy, Debug)]
pub struct TransferFunction<T = f64> {
    model: TransferFunctionModel<T>,
    lead: T,
    state: Sections<T>,
    last: Option<T>,
}

impl<T: Scalar> TransferFunction<T> {
    /// Adds ê(k+1) to the position error.
    pub fn new(model: TransferFunctionModel<T>) -> Self {
        Self {
            model,
            lead: T::ZERO,
            state: Sections::default(),
            last: None,
        }
    }

    /// Adds ê + τ dê/dt instead, `lead_time` τ in s.
    ///
    /// A correction reaches the table through the closed position loop,
    /// 1/(1 + s/(P r)) as long as the speed loop follows: τ = 1/(P r), with P
    /// in rad/s per m and r = lead/2π, undoes that. 0 is [`TransferFunction::new`].
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] unless `lead_time` lies from 0 to 1e3 s.
    pub fn with_lead(
        model: TransferFunctionModel<T>,
        lead_time: T,
    ) -> Result<Self, CompensatorError> {
        let inside = within(lead_time, 0.0, 1e3);
        let lead = require(inside, "lead_time", lead_time, "from 0 to 1e3 s")?;
        Ok(Self {
            lead,
            ..Self::new(model)
        })
    }

    /// The model.
    pub fn model(&self) -> &TransferFunctionModel<T> {
        &self.model
    }

    /// The lead time τ, s.
    pub fn lead_time(&self) -> T {
        self.lead
    }

    /// The same at the start of a motion, each number rounded to the nearest of another scalar.
    ///
    /// # Errors
    /// As [`TransferFunctionModel::cast`].
    pub fn cast<U: Scalar>(&self) -> Result<TransferFunction<U>, CompensatorError> {
        TransferFunction::with_lead(self.model.cast()?, U::of(self.lead.to_f64()))
    }

    /// ê(k+1), m: the error that the model expects at the end of the cycle
    /// that begins with `sample`.
    ///
    /// Call it, or [`Compensator::correct`], once a cycle: both move the
    /// filter on.
    pub fn predict_error(&mut self, sample: &Sample<T>) -> T {
        self.step(sample).0
    }

    /// ê(k+1) and ê(k).
    fn step(&mut self, sample: &Sample<T>) -> (T, T) {
        let present = match self.last {
            Some(error) => error,
            None => self
                .model
                .output(&mut self.state, sample.reference.acceleration),
        };
        let next = self
            .model
            .output(&mut self.state, sample.next_reference.acceleration);
        self.last = Some(next);
        (next, present)
    }
}

impl<T: Scalar> Compensator<T> for TransferFunction<T> {
    fn reset(&mut self) {
        self.state = Sections::default();
        self.last = None;
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        let (next, present) = self.step(sample);
        Correction {
            position: next + self.lead / self.model.period * (next - present),
            command: T::ZERO,
        }
    }
}
