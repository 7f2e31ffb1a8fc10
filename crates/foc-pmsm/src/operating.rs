//! Which currents make a torque: with the least current, with the least flux, within the
//! limits of current and voltage.

mod limits;

pub use limits::{OperatingCurrents, OperatingLimits, OperatingRegion};

use crate::frames::Dq;
use crate::math::length;
use crate::motor::Pmsm;
use axis_scalar::Scalar;
use core::f64::consts::SQRT_2;

/// Newton's steps for w⁴ + c w = 1. From above they converge monotonically; the fifth
/// leaves 2.7e-17 of w at the worst c, which is 1; one more for rounding.
const NEWTON_STEPS: usize = 6;

impl<T: Scalar> Pmsm<T> {
    /// Flux linkage of the stator, V·s: (L_d i_d + ψ, L_q i_q), from the currents, A.
    #[inline]
    pub fn flux(&self, i: Dq<T>) -> Dq<T> {
        let p = self.parameters();
        Dq {
            d: p.inductance_d * i.d + p.flux_linkage,
            q: p.inductance_q * i.q,
        }
    }

    /// The currents, A, of a flux linkage of the stator, V·s: the inverse of
    /// [`Pmsm::flux`].
    #[inline]
    pub fn current_of_flux(&self, flux: Dq<T>) -> Dq<T> {
        let p = self.parameters();
        Dq {
            d: (flux.d - p.flux_linkage) / p.inductance_d,
            q: flux.q / p.inductance_q,
        }
    }

    /// Maximum torque per ampere: of all currents of the length `current` (A, its
    /// magnitude counts) those with the most torque, i_q ≥ 0. With Δ = L_q − L_d,
    ///
    /// ```text
    /// i_d = −2 Δ I²/(ψ + √(ψ² + 8 Δ² I²)),   i_q = √(I² − i_d²)
    /// ```
    ///
    /// which is the root of S. Morimoto, Y. Takeda, T. Hirasa and K. Taniguchi,
    /// "Expansion of operating limits for permanent magnet motor by current vector
    /// control considering inverter capacity", IEEE Trans. Ind. Appl. 26 (1990), doi
    /// 10.1109/28.60058, written so that it holds for Δ = 0 (i_d = 0), either sign of Δ,
    /// and ψ = 0 (|i_d| = i_q). What is not a number comes back so.
    ///
    /// ```
    /// use foc_pmsm::{MotorParameters, Pmsm};
    ///
    /// let motor = Pmsm::new(MotorParameters {
    ///     pole_pairs: 4, resistance: 0.75, inductance_d: 4.11e-3,
    ///     inductance_q: 13.2e-3, flux_linkage: 0.2735_f64,
    /// })?;
    /// let i = motor.mtpa(15.0);
    /// assert!((i.d + 5.481).abs() < 1e-3 && (i.q - 13.963).abs() < 1e-3);
    /// assert!(motor.torque(i) > 1.1 * motor.torque(foc_pmsm::Dq { d: 0.0, q: 15.0 }));
    /// # Ok::<(), foc_pmsm::FocError>(())
    /// ```
    pub fn mtpa(&self, current: T) -> Dq<T> {
        let p = self.parameters();
        most_on_circle(p.flux_linkage, self.saliency(), current.abs())
    }

    /// Maximum torque per ampere, from the torque (N·m, either sign): the shortest current
    /// that makes it. With t = |T|/(1.5 p), i_r = √(t/|Δ|) and c = ψ/√(|Δ| t), i_q =
    /// w i_r, where w is the root of w⁴ + c w = 1 between 0 and 1 (from the torque
    /// equation and Δ i_d² − ψ i_d = Δ i_q², which is the locus of [`Pmsm::mtpa`]), found
    /// by 6 steps of Newton's method. What is not a number comes back so.
    pub fn mtpa_for_torque(&self, torque: T) -> Dq<T> {
        let i = self.mtpa_for(self.torque_over_pairs(torque).abs());
        Dq {
            d: i.d,
            q: i.q.copysign(torque),
        }
    }

    /// Maximum torque per volt: of all currents whose flux linkage has the length `flux`
    /// (V·s, its magnitude counts) those with the most torque, i_q ≥ 0. Above base speed
    /// and without resistance, `flux` is the voltage over the electrical speed. In the
    /// flux plane the torque is 1.5 p (ψ/L_d − λ_d Δ/(L_d L_q)) λ_q, of the same form as in
    /// the current plane, and so is the solution (Morimoto et al. 1990, as in
    /// [`Pmsm::mtpa`]). What is not a number comes back so.
    pub fn mtpv(&self, flux: T) -> Dq<T> {
        let p = self.parameters();
        let magnets = p.flux_linkage / p.inductance_d;
        let saliency = self.saliency() / (p.inductance_d * p.inductance_q);
        self.current_of_flux(most_on_circle(magnets, saliency, flux.abs()))
    }

    /// Δ = L_q − L_d, H.
    #[inline]
    fn saliency(&self) -> T {
        let p = self.parameters();
        p.inductance_q - p.inductance_d
    }

    /// T/(1.5 p), V·s·A.
    #[inline]
    fn torque_over_pairs(&self, torque: T) -> T {
        torque / self.electrical_speed(T::of(1.5))
    }

    /// [`Pmsm::mtpa_for_torque`] from t = |T|/(1.5 p).
    fn mtpa_for(&self, t: T) -> Dq<T> {
        let (psi, delta) = (self.parameters().flux_linkage, self.saliency());
        let size = (delta.abs() * t).sqrt();
        let c = psi / size;
        let q = if t == T::ZERO {
            T::ZERO
        } else if c < T::ONE / T::EPSILON {
            root(c) * (size / delta.abs())
        } else {
            // The saliency adds less than the last place, or there is none.
            t / psi
        };
        let twice = T::TWO * delta * q;
        let d = if q == T::ZERO {
            T::ZERO
        } else {
            -twice * q / (psi + length(psi, twice))
        };
        Dq { d, q }
    }
}

/// The root of w⁴ + c w = 1 between 0 and 1, for c ≥ 0.
fn root<T: Scalar>(c: T) -> T {
    let mut w = T::ONE.min(T::ONE / c);
    for _ in 0..NEWTON_STEPS {
        let cube = w * w * w;
        w -= ((cube + c) * w - T::ONE) / (T::of(4.0) * cube + c);
    }
    w
}

/// The point of the circle about 0 at which (ψ − Δ x) y is greatest, y ≥ 0.
fn most_on_circle<T: Scalar>(psi: T, delta: T, radius: T) -> Dq<T> {
    let product = delta * radius;
    if product == T::ZERO {
        return Dq {
            d: T::ZERO,
            q: radius,
        };
    }
    let size = psi + length(psi, T::of(2.0 * SQRT_2) * product);
    let cos = -T::TWO * product / size;
    Dq {
        d: radius * cos,
        q: radius * ((T::ONE - cos) * (T::ONE + cos)).sqrt(),
    }
}
