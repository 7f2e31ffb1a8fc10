//! The onset of Bouc and Wen.

use super::{Onset, approach};
use crate::exponential::Exponential;
use crate::family::error::FrictionError;
use crate::family::steady::{check_range, power};

/// `Y = 1 − (σ sign y + 1 − σ) |y|^n`: the equation of R. Bouc (1967) and Y.-K. Wen (J. Eng.
/// Mech. Div. ASCE 102(2), 1976, 249–263),
///
/// ```text
/// dζ/dt = A v − β |v| |ζ|^{n−1} ζ − γ v |ζ|^n
/// ```
///
/// normalised as by F. Ikhouane and J. Rodellar (Nonlinear Dynamics 42, 2005, 63–78) with
/// `σ = β/(β + γ)` and `z_ss` the greatest ζ, `(A/(β + γ))^{1/n}`. [`ClassicBoucWen`](crate::ClassicBoucWen) takes A,
/// β, γ.
///
/// Exact for n = 1 and loading, and for unloading with σ = 1/2; otherwise a fourth-order
/// solution that cannot pass the steady state.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct BoucWenOnset<T = f64> {
    /// `n`, 1 to 16: how sharply sliding begins.
    pub exponent: T,
    /// `σ = β/(β + γ)`, 0.5 to 10. At 0.5 unloading is linear, above it is stiffer at first.
    pub loading_share: T,
}

impl<T: Exponential> BoucWenOnset<T> {
    /// `2 σ − 1`: what unloading adds to the stiffness at `y = −1`.
    fn unloading(&self) -> T {
        T::TWO * self.loading_share - T::ONE
    }

    /// The greatest |y| whose power does not overflow. Beyond it y falls within ξ = 1e-19 y.
    fn most(&self, y: T) -> T {
        if y.abs() <= T::of(8.0) {
            return T::of(8.0);
        }
        (T::HALF * T::MAX.ln() / self.exponent).exp()
    }

    /// From `−u` towards 0 over `xi`: `u` at the end and the displacement left. `dξ = du/R`,
    /// `R = 1 + (2 σ − 1) uⁿ`, is a quadrature near 0 (Gauss and Legendre's, five points),
    /// so that the passage through 0 is met; Runge and Kutta's method before that.
    fn unload(&self, mut u: T, mut left: T) -> (T, T) {
        let (extra, n) = (self.unloading(), self.exponent);
        if extra == T::ZERO {
            return if left < u {
                (u - left, T::ZERO)
            } else {
                (T::ZERO, left - u)
            };
        }
        let rate = |u: T| T::ONE + extra * power(u.max(T::ZERO), n);
        // Steps change R by up to 5 %; from 1 to 0 there are some 34 n of them.
        for _ in 0..10_000 {
            let step = T::of(0.05) / n * u.max(T::HALF);
            if u <= step {
                let needed = quadrature(u, |u| T::ONE / rate(u));
                if left >= needed {
                    return (T::ZERO, left - needed);
                }
            }
            let first = rate(u);
            let whole = step / first;
            let h = if left < whole { left } else { whole };
            let second = rate(u - T::HALF * h * first);
            let third = rate(u - T::HALF * h * second);
            let fourth = rate(u - h * third);
            let by = h * (first + T::TWO * (second + third) + fourth) / T::of(6.0);
            u = if by < u { u - by } else { T::ZERO };
            if left <= whole {
                return (u, T::ZERO);
            }
            left -= h;
        }
        (u, T::ZERO)
    }
}

/// `∫₀ᵘ f` by Gauss and Legendre's five points (M. Abramowitz and I. Stegun, Table 25.4).
fn quadrature<T: Exponential>(u: T, f: impl Fn(T) -> T) -> T {
    const INNER: [f64; 2] = [0.538_469_310_105_683_1, 0.478_628_670_499_366_47];
    const OUTER: [f64; 2] = [0.906_179_845_938_664, 0.236_926_885_056_189_1];
    const MIDDLE: f64 = 0.568_888_888_888_888_9;
    let half = T::HALF * u;
    let mut sum = T::of(MIDDLE) * f(half);
    for [at, weight] in [INNER, OUTER] {
        let by = half * T::of(at);
        sum += T::of(weight) * (f(half - by) + f(half + by));
    }
    half * sum
}

impl<T: Exponential> Onset<T> for BoucWenOnset<T> {
    fn slope(&self, y: T, _: T) -> T {
        let size = power(y.abs(), self.exponent);
        if y < T::ZERO {
            T::ONE + self.unloading() * size
        } else {
            T::ONE - size
        }
    }

    fn advance(&self, y: T, xi: T, _: T) -> T {
        if self.exponent == T::ONE && y >= T::ZERO {
            return (T::ONE - y) * xi.one_minus_exp();
        }
        let most = self.most(y);
        if y.abs() > most * T::of(1.001) {
            let within = most.copysign(y);
            return (within - y) + self.advance(within, xi, T::ONE);
        }
        let (unloaded, p, left) = if y < T::ZERO {
            let (u, left) = self.unload(-y, xi);
            if u > T::ZERO || left == T::ZERO {
                return -y - u;
            }
            (-y, T::ONE, left)
        } else {
            (T::ZERO, T::ONE - y, xi)
        };
        let n = self.exponent;
        // (1 − yⁿ)/(1 − y), which is n at y = 1
        let rate = |p: T| (T::ONE - power(T::ONE - p, n)) / p;
        unloaded + approach(p, left, n, rate)
    }

    fn validate(&self) -> Result<(), FrictionError> {
        let exponents = [T::ONE, T::of(16.0)];
        check_range("exponent", self.exponent, "between 1 and 16", exponents)?;
        check_range(
            "loading_share",
            self.loading_share,
            "between 0.5 and 10",
            [T::HALF, T::of(10.0)],
        )
    }
}
