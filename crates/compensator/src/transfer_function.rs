//! The tracking error as a linear filter of the reference.

use core::f64::consts::TAU;

use crate::error::{self, require};
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
pub struct TransferFunctionModel {
    period: f64,
    direct: f64,
    order: usize,
    poles: [f64; MAX_ORDER],
    gains: [f64; MAX_ORDER],
    coefficients: [f64; MAX_ORDER],
}

impl TransferFunctionModel {
    /// Control `period` (from 1e-9 to 1e3 s), `direct` feed-through d (s²), real `poles` pᵢ (of
    /// z, one for each term) and `coefficients` cᵢ (s²).
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] for a period outside its range, another
    /// number that is not finite, a pole
    /// outside −1 < p < 1, more than [`MAX_ORDER`] poles, or as many
    /// coefficients as there are not poles.
    pub fn new(
        period: f64,
        direct: f64,
        poles: &[f64],
        coefficients: &[f64],
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
            poles: [0.0; MAX_ORDER],
            gains: [0.0; MAX_ORDER],
            coefficients: [0.0; MAX_ORDER],
        };
        for (i, (&p, &c)) in poles.iter().zip(coefficients).enumerate() {
            require(p.abs() < 1.0, "pole", p, "above -1 and below 1")?;
            require(c.is_finite(), "coefficient", c, "finite")?;
            model.poles[i] = p;
            model.gains[i] = libm::sqrt((1.0 - p) * (1.0 + p));
            model.coefficients[i] = c;
        }
        Ok(model)
    }

    /// Control period, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Direct feed-through d, s².
    pub fn direct(&self) -> f64 {
        self.direct
    }

    /// Number of poles.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Poles of z, in the order of the terms.
    pub fn poles(&self) -> &[f64] {
        &self.poles[..self.order]
    }

    /// Coefficients cᵢ, s².
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients[..self.order]
    }

    /// Error at constant acceleration, per acceleration, s².
    ///
    /// At constant velocity the model's error is always zero.
    pub fn dc_gain(&self) -> f64 {
        self.response(0.0).0
    }

    /// Real and imaginary part (s²) of H at `frequency` (Hz); NaN where that
    /// is not finite.
    pub fn response(&self, frequency: f64) -> (f64, f64) {
        let (sin, cos) = libm::sincos(TAU * frequency * self.period);
        let delay = (cos, -sin); // z⁻¹
        let mut chain = (1.0, 0.0);
        let mut sum = (self.direct, 0.0);
        for i in 0..self.order {
            let p = self.poles[i];
            let section = divide(chain, (1.0 - p * delay.0, -p * delay.1));
            let weight = self.coefficients[i] * self.gains[i];
            sum = (sum.0 + weight * section.0, sum.1 + weight * section.1);
            chain = multiply(section, (delay.0 - p, delay.1));
        }
        sum
    }

    /// The errors (m) that a reference acceleration (m/s², one value a cycle,
    /// from rest) causes; each at the instant of its acceleration.
    #[cfg(feature = "alloc")]
    pub fn simulate(&self, acceleration: &[f64]) -> alloc::vec::Vec<f64> {
        let mut state = Sections::default();
        let error = |&a| self.output(&mut state, a);
        acceleration.iter().map(error).collect()
    }

    /// One cycle of the filter.
    fn output(&self, state: &mut Sections, acceleration: f64) -> f64 {
        let mut error = self.direct * acceleration;
        state.advance(self.poles(), acceleration, |i, section| {
            error += self.coefficients[i] * self.gains[i] * section;
        });
        error
    }
}

fn multiply(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn divide(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let scale = 1.0 / (b.0 * b.0 + b.1 * b.1);
    multiply(a, (b.0 * scale, -b.1 * scale))
}

/// The filter's memory: one number a section.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sections([f64; MAX_ORDER]);

impl Sections {
    /// Moves every section on by one cycle and shows its new value, which is
    /// Bᵢ's output without the factor √(1 − pᵢ²).
    pub(crate) fn advance(&mut self, poles: &[f64], input: f64, mut show: impl FnMut(usize, f64)) {
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
pub struct TransferFunction {
    model: TransferFunctionModel,
    lead: f64,
    state: Sections,
    last: Option<f64>,
}

impl TransferFunction {
    /// Adds ê(k+1) to the position error.
    pub fn new(model: TransferFunctionModel) -> Self {
        Self {
            model,
            lead: 0.0,
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
        model: TransferFunctionModel,
        lead_time: f64,
    ) -> Result<Self, CompensatorError> {
        let inside = (0.0..=1e3).contains(&lead_time);
        let lead = require(inside, "lead_time", lead_time, "from 0 to 1e3 s")?;
        Ok(Self {
            lead,
            ..Self::new(model)
        })
    }

    /// The model.
    pub fn model(&self) -> &TransferFunctionModel {
        &self.model
    }

    /// ê(k+1), m: the error that the model expects at the end of the cycle
    /// that begins with `sample`.
    ///
    /// Call it, or [`Compensator::correct`], once a cycle: both move the
    /// filter on.
    pub fn predict_error(&mut self, sample: &Sample) -> f64 {
        self.step(sample).0
    }

    /// ê(k+1) and ê(k).
    fn step(&mut self, sample: &Sample) -> (f64, f64) {
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

impl Compensator for TransferFunction {
    fn reset(&mut self) {
        self.state = Sections::default();
        self.last = None;
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        let (next, present) = self.step(sample);
        Correction {
            position: next + self.lead / self.model.period * (next - present),
            iq: 0.0,
        }
    }
}
