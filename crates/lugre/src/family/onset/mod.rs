//! How the force of a bristle comes on with displacement.

mod bouc_wen;
mod dahl;
mod elasto_plastic;

use core::fmt::Debug;

pub use bouc_wen::BoucWenOnset;
pub use dahl::DahlOnset;
pub use elasto_plastic::ElastoPlasticOnset;

use super::error::FrictionError;
use crate::exponential::Exponential;

/// The equation of a [`Bristle`](super::Bristle) without units: `dy/dξ = Y(y)`, with `y` the
/// deflection over the steady one and `ξ` the displacement over the same, both positive in the
/// direction of motion.
///
/// A law of one's own has `Y(0) = 1`, `Y(1) = 0`, `0 ≤ Y ≤ 1` in between, `Y ≥ 1` below 0
/// and `Y ≤ 0` above 1.
pub trait Onset<T: Exponential>: Copy + Debug + PartialEq {
    /// `Y(y)`; `coulomb` is `F_C/g(v)`, 0 to 1.
    #[must_use]
    fn slope(&self, y: T, coulomb: T) -> T;

    /// `y(ξ) − y(0)` from `y(0) = y` over a displacement `xi > 0`, which may be infinite.
    #[must_use]
    fn advance(&self, y: T, xi: T, coulomb: T) -> T;

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`FrictionError`] names the first that is not acceptable.
    fn validate(&self) -> Result<(), FrictionError>;
}

/// `Y = 1 − y`: LuGre friction. The solution is exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LinearOnset {}

impl<T: Exponential> Onset<T> for LinearOnset {
    fn slope(&self, y: T, _: T) -> T {
        T::ONE - y
    }

    fn advance(&self, y: T, xi: T, _: T) -> T {
        (T::ONE - y) * xi.one_minus_exp()
    }

    fn validate(&self) -> Result<(), FrictionError> {
        Ok(())
    }
}

/// What a step of [`approach`] advances the logarithm by. Whole loops in one step are then off
/// by 1.7e-8 steady deflections in the elasto-plastic law and by 4.5e-8 in Bouc and Wen's; by
/// 2.7e-6 with an exponent of 1.3, whose power is not smooth at y = 0 (tests).
const LOGARITHM: f64 = 0.0625;

/// Solves `dp/dξ = −r(p) p` for the distance `p = 1 − y` from the steady state, over `xi`;
/// gives `p(0) − p(ξ)`. `r` is positive and tends to `last` at `p = 0`.
///
/// Written for `q = −ln(p/p(0))`, `dq/dξ = r`, by Runge and Kutta's fourth-order method: as q
/// can but grow, p keeps its sign and falls, whatever the step. Where r is constant it is exact.
/// A step advances q by about 1/16; below √ε the constant `last` is left of r.
fn approach<T: Exponential>(p: T, xi: T, last: T, rate: impl Fn(T) -> T) -> T {
    let small = T::EPSILON.sqrt();
    let (start, mut p, mut left) = (p, p, xi);
    // From the greatest number down to √ε there are 728 · 16 steps; usually 300 at most.
    for _ in 0..12_000 {
        if p.abs() <= small {
            break;
        }
        let first = rate(p);
        let whole = T::of(LOGARITHM) / first;
        let step = if left < whole { left } else { whole };
        let at = |q: T| rate(p * q.exp_minus());
        let second = at(T::HALF * step * first);
        let third = at(T::HALF * step * second);
        let fourth = at(step * third);
        let q = step * (first + T::TWO * (second + third) + fourth) / T::of(6.0);
        if left <= whole {
            return start - p + p * q.one_minus_exp();
        }
        p *= q.exp_minus();
        left -= step;
    }
    start - p + p * (last * left).one_minus_exp()
}
