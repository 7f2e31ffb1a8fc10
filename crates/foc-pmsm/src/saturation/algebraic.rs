//! Saturation as powers of the flux linkage.

use super::{FluxMap, IncrementalInductances, newton};
use crate::error::{FocError, check, not_negative, positive};
use crate::frames::Dq;
use axis_scalar::Scalar;

/// The constants of [`AlgebraicSaturation`]. Plain data; [`AlgebraicSaturation::new`]
/// validates them. The unit of a coefficient is A/(V·s) and as many times 1/(V·s) as its
/// exponent says.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct AlgebraicSaturationParameters<T = f64> {
    /// a_d0 (greater than 0) and a_dd (0 or greater): inverse inductance of the d axis
    /// without saturation, and what its own flux adds.
    pub self_d: [T; 2],
    /// a_q0 and a_qq: the same of the q axis.
    pub self_q: [T; 2],
    /// a_dq, 0 or greater: what the axes add to each other.
    pub cross: T,
    /// S and T, at most 20.
    pub exponents_self: [u8; 2],
    /// U and V, at most 20.
    pub exponents_cross: [u8; 2],
    /// i_f: the magnets as a current of the d axis, A; 0 without magnets.
    pub magnets: T,
}

/// The currents as powers of the flux linkages, with cross-saturation:
///
/// ```text
/// i_d = (a_d0 + a_dd |λ_d|^S + a_dq/(V + 2) |λ_d|^U |λ_q|^(V+2)) λ_d − i_f
/// i_q = (a_q0 + a_qq |λ_q|^T + a_dq/(U + 2) |λ_d|^(U+2) |λ_q|^V) λ_q
/// ```
///
/// M. Hinkkanen, P. Pescetto, E. Mölsä, S. E. Saarakkala, G. Pellegrino and R. Bojoi,
/// "Sensorless self-commissioning of synchronous reluctance motors at standstill without
/// rotor locking", IEEE Trans. Ind. Appl. 53 (2017), doi 10.1109/TIA.2016.2644624, as
/// written out in motulator's examples, which also have i_f; with whole exponents. Both
/// currents are slopes of one energy, so that ∂i_d/∂λ_q = ∂i_q/∂λ_d. The axes are the
/// caller's: in the papers d of a reluctance motor has the larger inductance.
///
/// A flux gives its current directly, about as fast as with constant inductances. A
/// current gives its flux by Newton's method in at most 40 steps. Far beyond the fluxes
/// for which the constants were found, the cross term can make the model ambiguous: the
/// answer there, if any, is one of several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlgebraicSaturation<T = f64> {
    parameters: AlgebraicSaturationParameters<T>,
    /// a_dq/(V + 2) and a_dq/(U + 2).
    cross: [T; 2],
    /// Their exponents, and those of the axes themselves, as numbers.
    s: T,
    t: T,
    u: T,
    v: T,
}

impl<T: Scalar> AlgebraicSaturation<T> {
    /// Validates the parameters.
    ///
    /// # Errors
    /// [`FocError`] naming the first field out of the range its doc gives.
    pub fn new(parameters: AlgebraicSaturationParameters<T>) -> Result<Self, FocError> {
        let p = &parameters;
        positive("self_d[0]", p.self_d[0])?;
        not_negative("self_d[1]", p.self_d[1])?;
        positive("self_q[0]", p.self_q[0])?;
        not_negative("self_q[1]", p.self_q[1])?;
        not_negative("cross", p.cross)?;
        check(p.magnets.is_finite(), "magnets", p.magnets, "finite")?;
        let number = |field, exponent: u8| {
            let value = T::of(f64::from(exponent));
            check(exponent <= 20, field, value, "at most 20")
        };
        let [s, t] = [
            number("exponents_self[0]", p.exponents_self[0])?,
            number("exponents_self[1]", p.exponents_self[1])?,
        ];
        let [u, v] = [
            number("exponents_cross[0]", p.exponents_cross[0])?,
            number("exponents_cross[1]", p.exponents_cross[1])?,
        ];
        Ok(Self {
            cross: [p.cross / (v + T::TWO), p.cross / (u + T::TWO)],
            parameters,
            s,
            t,
            u,
            v,
        })
    }

    /// The parameters the model was built from.
    pub fn parameters(&self) -> &AlgebraicSaturationParameters<T> {
        &self.parameters
    }

    /// ∂i/∂λ at a flux linkage (V·s), 1/H: closed forms, dd, dq = qd, qq.
    fn stiffness(&self, flux: Dq<T>) -> [T; 3] {
        let p = &self.parameters;
        let (d, q) = (flux.d.abs(), flux.q.abs());
        let ([s, t], [u, v]) = (p.exponents_self, p.exponents_cross);
        let (du, qv) = (power(d, u), power(q, v));
        let dd = p.self_d[0]
            + (self.s + T::ONE) * p.self_d[1] * power(d, s)
            + (self.u + T::ONE) * self.cross[0] * du * qv * q * q;
        let qq = p.self_q[0]
            + (self.t + T::ONE) * p.self_q[1] * power(q, t)
            + (self.v + T::ONE) * self.cross[1] * du * d * d * qv;
        let dq = p.cross * du * flux.d * qv * flux.q;
        [dd, dq, qq]
    }

    fn inverse(&self, [dd, dq, qq]: [T; 3]) -> IncrementalInductances<T> {
        let determinant = dd * qq - dq * dq;
        IncrementalInductances {
            dd: qq / determinant,
            dq: -dq / determinant,
            qd: -dq / determinant,
            qq: dd / determinant,
        }
    }

    /// The flux of an axis by its own saturation alone: no less than the true one. The
    /// lesser of the two terms' own solutions.
    fn alone(i: T, [first, second]: [T; 2], exponent: T) -> T {
        let size = i.abs();
        let power = ((size / second).ln() / (exponent + T::ONE)).exp();
        (size / first).min(power).copysign(i)
    }
}

impl<T: Scalar> FluxMap<T> for AlgebraicSaturation<T> {
    fn flux(&self, current: Dq<T>) -> Dq<T> {
        let p = &self.parameters;
        let driving = Dq {
            d: current.d + p.magnets,
            q: current.q,
        };
        let start = Dq {
            d: Self::alone(driving.d, p.self_d, self.s),
            q: Self::alone(driving.q, p.self_q, self.t),
        };
        newton(
            start,
            |x| self.current(x) - current,
            |x, e| {
                let [dd, dq, qq] = self.stiffness(x);
                let determinant = dd * qq - dq * dq;
                Dq {
                    d: (qq * e.d - dq * e.q) / determinant,
                    q: (dd * e.q - dq * e.d) / determinant,
                }
            },
            current.d.abs() + current.q.abs() + p.magnets.abs(),
        )
    }

    fn current(&self, flux: Dq<T>) -> Dq<T> {
        let p = &self.parameters;
        let (d, q) = (flux.d.abs(), flux.q.abs());
        let ([s, t], [u, v]) = (p.exponents_self, p.exponents_cross);
        let common = power(d, u) * power(q, v);
        let stiff_d = p.self_d[0] + p.self_d[1] * power(d, s) + self.cross[0] * common * q * q;
        let stiff_q = p.self_q[0] + p.self_q[1] * power(q, t) + self.cross[1] * common * d * d;
        Dq {
            d: stiff_d * flux.d - p.magnets,
            q: stiff_q * flux.q,
        }
    }

    fn inductances(&self, current: Dq<T>) -> IncrementalInductances<T> {
        self.inverse(self.stiffness(self.flux(current)))
    }
}

/// xⁿ by squaring.
fn power<T: Scalar>(x: T, mut n: u8) -> T {
    let (mut square, mut result) = (x, T::ONE);
    while n > 0 {
        if n & 1 == 1 {
            result *= square;
        }
        square = square * square;
        n >>= 1;
    }
    result
}
