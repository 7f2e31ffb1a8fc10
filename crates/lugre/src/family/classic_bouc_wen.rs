//! Bouc and Wen as they wrote it.

use super::bristle::BristleParameters;
use super::error::FrictionError;
use super::onset::BoucWenOnset;
use super::steady::{SteadyState, check, power};
use crate::exponential::Exponential;

/// Bouc and Wen's own parameters, of a force `c ζ`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ClassicBoucWen<T = f64> {
    /// `c`, force per ζ.
    pub scale: T,
    /// `A`.
    pub a: T,
    /// `β`.
    pub beta: T,
    /// `γ`.
    pub gamma: T,
    /// `n`.
    pub exponent: T,
}

impl<T: Exponential> ClassicBoucWen<T> {
    /// The same law as a bristle: `σ0 = c A`, `F_C = c (A/(β + γ))^{1/n}`, no viscous part.
    ///
    /// # Errors
    /// [`FrictionError`] where `scale`, `a`, `beta + gamma` or `exponent` are not positive.
    pub fn bristle(&self) -> Result<BristleParameters<T, BoucWenOnset<T>>, FrictionError> {
        const POSITIVE: &str = "finite and greater than 0";
        let sum = self.beta + self.gamma;
        check("scale", self.scale, POSITIVE, false)?;
        check("a", self.a, POSITIVE, false)?;
        check("beta + gamma", sum, POSITIVE, false)?;
        check("exponent", self.exponent, POSITIVE, false)?;
        let greatest = power(self.a / sum, T::ONE / self.exponent);
        Ok(BristleParameters {
            steady: SteadyState::coulomb(self.scale * greatest),
            stiffness: self.scale * self.a,
            damping: T::ZERO,
            onset: BoucWenOnset {
                exponent: self.exponent,
                loading_share: self.beta / sum,
            },
        })
    }
}
