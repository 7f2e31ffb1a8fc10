//! Magnetic saturation: flux linkages as functions of the currents, and the motor with
//! them.

mod algebraic;
mod table;

pub use algebraic::{AlgebraicSaturation, AlgebraicSaturationParameters};
pub use table::{FluxTable, FluxTableParts};

use crate::error::{FocError, not_negative};
use crate::frames::Dq;
use crate::motor::{Pmsm, number};
use axis_scalar::Scalar;

/// Incremental inductances ∂λ/∂i of the stator, H. A machine without losses in its iron
/// has dq = qd.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct IncrementalInductances<T = f64> {
    /// ∂λ_d/∂i_d.
    pub dd: T,
    /// ∂λ_d/∂i_q.
    pub dq: T,
    /// ∂λ_q/∂i_d.
    pub qd: T,
    /// ∂λ_q/∂i_q.
    pub qq: T,
}

impl<T: Scalar> IncrementalInductances<T> {
    /// dd qq − dq qd, H².
    pub fn determinant(&self) -> T {
        self.dd * self.qq - self.dq * self.qd
    }

    /// The change of the currents (A) that changes the flux linkage by `flux` (V·s).
    pub(crate) fn solve(&self, flux: Dq<T>) -> Dq<T> {
        let determinant = self.determinant();
        Dq {
            d: (self.qq * flux.d - self.dq * flux.q) / determinant,
            q: (self.dd * flux.q - self.qd * flux.d) / determinant,
        }
    }
}

/// The magnetic state of a machine: flux linkage (V·s) against current (A), both ways.
/// What is not a number comes back so, and where there is no answer it is not a number.
pub trait FluxMap<T: Scalar> {
    /// The flux linkage of a current.
    fn flux(&self, current: Dq<T>) -> Dq<T>;

    /// The current of a flux linkage.
    fn current(&self, flux: Dq<T>) -> Dq<T>;

    /// How the flux linkage changes with the current, at `current`.
    fn inductances(&self, current: Dq<T>) -> IncrementalInductances<T>;
}

/// Constant inductances, and the magnets' flux.
impl<T: Scalar> FluxMap<T> for Pmsm<T> {
    fn flux(&self, current: Dq<T>) -> Dq<T> {
        Pmsm::flux(self, current)
    }

    fn current(&self, flux: Dq<T>) -> Dq<T> {
        self.current_of_flux(flux)
    }

    fn inductances(&self, _: Dq<T>) -> IncrementalInductances<T> {
        let p = self.parameters();
        IncrementalInductances {
            dd: p.inductance_d,
            dq: T::ZERO,
            qd: T::ZERO,
            qq: p.inductance_q,
        }
    }
}

/// A motor with any [`FluxMap`]. Its state is the flux linkage λ, which obeys, with
/// ω_e = p ω,
///
/// ```text
/// dλ_d/dt = u_d − R i_d + ω_e λ_q
/// dλ_q/dt = u_q − R i_q − ω_e λ_d
/// T = 1.5 p (λ_d i_q − λ_q i_d)
/// ```
///
/// ```
/// use foc_pmsm::saturation::{
///     AlgebraicSaturation, AlgebraicSaturationParameters, FluxMap, SaturatedMotor,
/// };
/// use foc_pmsm::Dq;
///
/// // A 6.7 kW synchronous reluctance motor.
/// let map = AlgebraicSaturation::new(AlgebraicSaturationParameters {
///     self_d: [17.4, 373.0], self_q: [52.1, 658.0], cross: 1120.0,
///     exponents_self: [5, 1], exponents_cross: [1, 0], magnets: 0.0_f64,
/// })?;
/// let motor = SaturatedMotor::new(2, 0.54, map)?;
/// let i = Dq { d: 10.0, q: 15.0 };
/// let torque = motor.torque(i);
/// // With twice the current less than four times the torque.
/// assert!(motor.torque(i * 2.0) < 3.0 * torque);
/// # Ok::<(), foc_pmsm::FocError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SaturatedMotor<M, T = f64> {
    pole_pairs: T,
    resistance: T,
    map: M,
}

impl<T: Scalar, M: FluxMap<T>> SaturatedMotor<M, T> {
    /// From the pole pairs p (1 or more), the resistance R (Ω, 0 or more) of a phase and
    /// the machine's flux map.
    ///
    /// # Errors
    /// [`FocError`] naming the number that is out of range.
    pub fn new(pole_pairs: u32, resistance: T, map: M) -> Result<Self, FocError> {
        if pole_pairs == 0 {
            return Err(FocError::NoPolePairs);
        }
        not_negative("resistance", resistance)?;
        Ok(Self {
            pole_pairs: number(pole_pairs),
            resistance,
            map,
        })
    }

    /// The flux map.
    pub fn map(&self) -> &M {
        &self.map
    }

    /// Air-gap torque, N·m, from the currents, A.
    pub fn torque(&self, current: Dq<T>) -> T {
        self.torque_of(self.map.flux(current), current)
    }

    fn torque_of(&self, flux: Dq<T>, i: Dq<T>) -> T {
        T::of(1.5) * self.pole_pairs * (flux.d * i.q - flux.q * i.d)
    }

    /// Air-gap torque, N·m, from the flux linkage, V·s.
    pub fn torque_at_flux(&self, flux: Dq<T>) -> T {
        self.torque_of(flux, self.map.current(flux))
    }

    /// The voltage (V) that the rotation at the mechanical `speed` (rad/s) induces at the
    /// currents (A): what a feed-forward that knows the saturation adds.
    pub fn rotational_voltage(&self, current: Dq<T>, speed: T) -> Dq<T> {
        let omega = self.pole_pairs * speed;
        let flux = self.map.flux(current);
        Dq {
            d: -omega * flux.q,
            q: omega * flux.d,
        }
    }

    /// The voltage (V) that holds the currents (A) at the mechanical `speed` (rad/s).
    pub fn steady_voltage(&self, current: Dq<T>, speed: T) -> Dq<T> {
        self.rotational_voltage(current, speed) + current * self.resistance
    }

    /// Rate of change of the flux linkage, V, at the flux linkage (V·s), the voltage (V)
    /// and the mechanical speed (rad/s).
    pub fn derivative(&self, flux: Dq<T>, u: Dq<T>, speed: T) -> Dq<T> {
        let omega = self.pole_pairs * speed;
        let i = self.map.current(flux);
        Dq {
            d: u.d - self.resistance * i.d + omega * flux.q,
            q: u.q - self.resistance * i.q - omega * flux.d,
        }
    }

    /// The flux linkage (V·s) after a time `h` (s) with the voltage `u` (V) held at the
    /// mechanical `speed` (rad/s): a step of the classical Runge-Kutta rule of fourth
    /// order. Stable while h R over the least inductance, and h ω_e, are below about 2.7.
    pub fn step(&self, flux: Dq<T>, u: Dq<T>, speed: T, h: T) -> Dq<T> {
        let half = T::HALF * h;
        let first = self.derivative(flux, u, speed);
        let second = self.derivative(flux + first * half, u, speed);
        let third = self.derivative(flux + second * half, u, speed);
        let fourth = self.derivative(flux + third * h, u, speed);
        let sum = first + (second + third) * T::TWO + fourth;
        flux + sum * (h / T::of(6.0))
    }
}

/// Of an inverse map: x with f(x) = y by Newton's method. A step that does not lower the
/// error is halved. The result is not a number if the error cannot be brought down to
/// rounding: `size` is what y is the sum of.
pub(crate) fn newton<T: Scalar>(
    start: Dq<T>,
    error: impl Fn(Dq<T>) -> Dq<T>,
    step: impl Fn(Dq<T>, Dq<T>) -> Dq<T>,
    size: T,
) -> Dq<T> {
    // Ten steps and two halvings were the most of a million draws in the tests; the rest is
    // for maps and numbers beyond them.
    const STEPS: usize = 40;
    const HALVINGS: usize = 12;
    let weigh = |e: Dq<T>| e.d.abs().max(e.q.abs()) + T::ZERO * (e.d + e.q);
    let (mut x, mut left) = (start, error(start));
    for _ in 0..STEPS {
        let mut change = step(x, left);
        let mut better = None;
        for _ in 0..HALVINGS {
            let next = error(x - change);
            if weigh(next) < weigh(left) {
                better = Some(next);
                break;
            }
            change = change * T::HALF;
        }
        let Some(next) = better else {
            break;
        };
        (x, left) = (x - change, next);
    }
    // 2.5 ε of the size was the most that was left in these draws.
    if weigh(left) <= T::of(64.0) * T::EPSILON * size {
        return x;
    }
    Dq {
        d: T::NAN,
        q: T::NAN,
    }
}
