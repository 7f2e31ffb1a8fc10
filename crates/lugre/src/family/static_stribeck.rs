//! Friction without memory: the Stribeck curve, made continuous at rest.

use axis_scalar::Scalar;

use super::error::FrictionError;
use super::steady::{SteadyState, check};
use super::{FrictionLaw, pressing};
use crate::exponential::Exponential;

/// The smooth function in place of the sign of the speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Regularisation {
    /// `tanh(v/v₀)`: 1 to within 1 % from 2.7 v₀ on.
    #[default]
    Tanh,
    /// `(2/π) arctan(v/v₀)`: 1 to within 1 % from 64 v₀ on.
    Arctan,
}

/// Parameters of [`StaticFriction`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct StaticFrictionParameters<T = f64> {
    /// Friction at constant speed.
    pub steady: SteadyState<T>,
    /// `v₀`, the speed over which the sign comes on, m/s or rad/s.
    pub transition_speed: T,
    /// How.
    pub regularisation: Regularisation,
}

/// The Stribeck curve with a continuous sign, without memory:
///
/// ```text
/// F = g(v) s(v/v₀) + v (k₁ + k₂ |v| + k₃ v²),   s = tanh or (2/π) arctan
/// ```
///
/// It does not hold: under any load the contact creeps, with up to some v₀. Nothing is
/// integrated, so nothing is inexact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticFriction<T = f64> {
    parameters: StaticFrictionParameters<T>,
    per_transition_speed: T,
}

impl<T: Scalar> StaticFriction<T> {
    /// A law of validated parameters.
    ///
    /// # Errors
    /// [`FrictionError`] names the first parameter that is not acceptable.
    pub fn new(parameters: StaticFrictionParameters<T>) -> Result<Self, FrictionError> {
        parameters.steady.validate()?;
        const POSITIVE: &str = "finite and greater than 0";
        check(
            "transition_speed",
            parameters.transition_speed,
            POSITIVE,
            false,
        )?;
        Ok(Self {
            parameters,
            per_transition_speed: T::ONE / parameters.transition_speed,
        })
    }

    /// The parameters that the law was made from.
    #[must_use]
    pub fn parameters(&self) -> StaticFrictionParameters<T> {
        self.parameters
    }
}

impl<T: Exponential> FrictionLaw<T> for StaticFriction<T> {
    type State = ();

    fn step(&self, (): (), _: T, _: T, _: T) {}

    fn force_at_load(&self, (): &(), speed: T, load: T) -> T {
        let x = speed * self.per_transition_speed;
        let sign = match self.parameters.regularisation {
            Regularisation::Tanh => x.tanh(),
            Regularisation::Arctan => x.arctan() * (T::TWO / T::PI),
        };
        let steady = &self.parameters.steady;
        pressing(load) * steady.level(speed) * sign + steady.viscous_force(speed)
    }

    fn steady_state(&self, speed: T) -> T {
        self.force(&(), speed)
    }

    fn settled(&self, _: T) {}

    fn stiffness(&self) -> T {
        T::ZERO
    }

    fn spring_limits(&self) -> [T; 2] {
        [T::ZERO; 2]
    }

    fn spring_force(&self, (): &()) -> T {
        T::ZERO
    }

    fn stored_energy(&self, (): &()) -> T {
        T::ZERO
    }

    /// Always: force and speed have one sign.
    fn is_passive(&self) -> bool {
        true
    }
}
