//! The permanent-magnet synchronous motor in the rotor's frame.

use crate::error::{FocError, check, not_negative, positive};
use crate::frames::Dq;
use crate::matrix_exponential::exponential_increment;
use axis_scalar::Scalar;

/// The motor's constants. Plain data; [`Pmsm::new`] validates them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct MotorParameters<T = f64> {
    /// Pole pairs p, 1 or more.
    pub pole_pairs: u32,
    /// Stator resistance R of one phase, Ω, 0 or more.
    pub resistance: T,
    /// Direct-axis inductance L_d, H, greater than 0.
    pub inductance_d: T,
    /// Quadrature-axis inductance L_q, H, greater than 0.
    pub inductance_q: T,
    /// Peak flux linkage ψ of the magnets with one phase, V·s, greater than 0; exactly 0
    /// for a synchronous reluctance motor ([`Pmsm::reluctance`]).
    pub flux_linkage: T,
}

impl<T: Scalar> MotorParameters<T> {
    /// Replaces the flux linkage by the one that gives the torque constant
    /// K_t (N·m per ampere of peak phase current, at i_d = 0):
    /// ψ = K_t / (1.5 p).
    pub fn from_torque_constant(self, torque_constant: T) -> Self {
        Self {
            flux_linkage: torque_constant / (T::of(1.5) * number(self.pole_pairs)),
            ..self
        }
    }
}

/// A validated motor without saturation, iron loss or slotting. Immutable:
/// the currents are the caller's.
///
/// With ω_e = p ω and amplitude-invariant dq vectors,
///
/// ```text
/// L_d di_d/dt = u_d − R i_d + ω_e L_q i_q
/// L_q di_q/dt = u_q − R i_q − ω_e (L_d i_d + ψ)
/// T = 1.5 p (ψ i_q + (L_d − L_q) i_d i_q)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(try_from = "MotorParameters<T>", into = "MotorParameters<T>")
)]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: Scalar + serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Pmsm<T = f64> {
    parameters: MotorParameters<T>,
    pole_pairs: T,
}

/// A count as a scalar; exact up to 2²⁴ in `f32`.
pub(crate) fn number<T: Scalar>(count: u32) -> T {
    T::of(f64::from(count))
}

impl<T: Scalar> Pmsm<T> {
    /// Validates the parameters.
    ///
    /// # Errors
    /// [`FocError`] naming the first field that is NaN, infinite or out of
    /// the range its doc gives.
    pub fn new(parameters: MotorParameters<T>) -> Result<Self, FocError> {
        let motor = Self::windings(parameters)?;
        positive("flux_linkage", parameters.flux_linkage)?;
        Ok(motor)
    }

    /// A synchronous reluctance motor: no magnets, ψ = 0. All of its torque is that of the
    /// saliency, so that a cascade with i_d = 0 has none, and [`Pmsm::q_current`] is
    /// infinite; [`Pmsm::mtpa_for_torque`] and [`Pmsm::operating_currents`] have its
    /// currents. Which axis has the larger inductance is the caller's choice.
    ///
    /// # Errors
    /// [`FocError`] as [`Pmsm::new`], and where `flux_linkage` is not 0 or the two
    /// inductances are equal.
    pub fn reluctance(parameters: MotorParameters<T>) -> Result<Self, FocError> {
        let motor = Self::windings(parameters)?;
        let (flux, lq) = (parameters.flux_linkage, parameters.inductance_q);
        check(flux == T::ZERO, "flux_linkage", flux, "0 without magnets")?;
        let salient = lq != parameters.inductance_d;
        let valid = "different from inductance_d without magnets";
        check(salient, "inductance_q", lq, valid)?;
        Ok(motor)
    }

    /// All but the magnets.
    fn windings(parameters: MotorParameters<T>) -> Result<Self, FocError> {
        if parameters.pole_pairs == 0 {
            return Err(FocError::NoPolePairs);
        }
        not_negative("resistance", parameters.resistance)?;
        positive("inductance_d", parameters.inductance_d)?;
        positive("inductance_q", parameters.inductance_q)?;
        Ok(Self {
            parameters,
            pole_pairs: number(parameters.pole_pairs),
        })
    }

    /// The parameters the motor was built from.
    pub fn parameters(&self) -> &MotorParameters<T> {
        &self.parameters
    }

    /// Electrical speed ω_e = p ω, rad/s, from the mechanical speed, rad/s.
    #[inline]
    pub fn electrical_speed(&self, speed: T) -> T {
        self.pole_pairs * speed
    }

    /// Air-gap torque, N·m, from the currents, A.
    #[inline]
    pub fn torque(&self, i: Dq<T>) -> T {
        let p = &self.parameters;
        let saliency = p.inductance_d - p.inductance_q;
        T::of(1.5) * self.pole_pairs * (p.flux_linkage + saliency * i.d) * i.q
    }

    /// The q current, A, that gives `torque` (N·m) at i_d = 0.
    #[inline]
    pub fn q_current(&self, torque: T) -> T {
        torque / (T::of(1.5) * self.pole_pairs * self.parameters.flux_linkage)
    }

    /// Voltage induced by the rotation at mechanical `speed` (rad/s):
    /// (−ω_e L_q i_q, ω_e (L_d i_d + ψ)), V. As a feed-forward it decouples
    /// the two current loops.
    #[inline]
    pub fn rotational_voltage(&self, i: Dq<T>, speed: T) -> Dq<T> {
        let p = &self.parameters;
        let omega = self.pole_pairs * speed;
        Dq {
            d: -omega * p.inductance_q * i.q,
            q: omega * (p.inductance_d * i.d + p.flux_linkage),
        }
    }

    /// The voltage, V, that holds the currents `i` (A) at constant
    /// mechanical `speed` (rad/s).
    #[inline]
    pub fn steady_voltage(&self, i: Dq<T>, speed: T) -> Dq<T> {
        self.rotational_voltage(i, speed) + i * self.parameters.resistance
    }

    /// Rate of change of the currents, A/s, at currents `i` (A), voltage `u`
    /// (V) and mechanical `speed` (rad/s).
    #[inline]
    pub fn derivative(&self, i: Dq<T>, u: Dq<T>, speed: T) -> Dq<T> {
        let drop = u - self.steady_voltage(i, speed);
        Dq {
            d: drop.d / self.parameters.inductance_d,
            q: drop.q / self.parameters.inductance_q,
        }
    }

    /// Copper loss 1.5 R |i|², W.
    pub fn copper_loss(&self, i: Dq<T>) -> T {
        T::of(1.5) * self.parameters.resistance * i.dot(i)
    }

    /// Magnetic energy of the currents, 0.75 (L_d i_d² + L_q i_q²), J
    /// (the magnets' own is constant and left out).
    pub fn magnetic_energy(&self, i: Dq<T>) -> T {
        let p = &self.parameters;
        T::of(0.75) * (p.inductance_d * i.d * i.d + p.inductance_q * i.q * i.q)
    }

    /// The currents after a time `h` (s), from `i0` (A), with the voltage
    /// `u` (V) held and the mechanical `speed` (rad/s) being its mean over
    /// the step.
    ///
    /// Implicit midpoint rule: second order, stable for every `h` and speed,
    /// one division. With the mean current (i0 + i1)/2 the power balance
    /// holds without any error of discretisation:
    /// h·1.5 u·ī = h·copper_loss(ī) + Δ magnetic_energy + h·T(ī)·ω.
    #[inline]
    pub fn step(&self, i0: Dq<T>, u: Dq<T>, speed: T, h: T) -> Dq<T> {
        let p = &self.parameters;
        let half = T::HALF * h;
        // (L + h/2 Z) Δi = h (u − Z i0 − e), Z = [[R, −ω_e L_q], [ω_e L_d, R]]
        let rhs = u - self.steady_voltage(i0, speed);
        let turn = half * self.pole_pairs * speed;
        let dd = p.inductance_d + half * p.resistance;
        let qq = p.inductance_q + half * p.resistance;
        let dq = turn * p.inductance_q;
        let qd = turn * p.inductance_d;
        // The determinant is a sum of positive products: never zero. The
        // inverse needs no current, so it is off the path from i0 to i1.
        let scale = h / (dd * qq + dq * qd);
        let inverse = [[scale * qq, scale * dq], [-scale * qd, scale * dd]];
        Dq {
            d: i0.d + (inverse[0][0] * rhs.d + inverse[0][1] * rhs.q),
            q: i0.q + (inverse[1][0] * rhs.d + inverse[1][1] * rhs.q),
        }
    }

    /// As [`Pmsm::step`], exact for constant speed by the matrix
    /// exponential: i1 = i0 + h φ₁(hA) di/dt. Slower; for checks.
    pub fn step_exact(&self, i0: Dq<T>, u: Dq<T>, speed: T, h: T) -> Dq<T> {
        let p = &self.parameters;
        let omega = self.pole_pairs * speed;
        let ratio = p.inductance_q / p.inductance_d;
        let a = [
            [-h * p.resistance / p.inductance_d, h * omega * ratio],
            [-h * omega / ratio, -h * p.resistance / p.inductance_q],
        ];
        let rate = self.derivative(i0, u, speed);
        let [d, q] = exponential_increment(a, [h * rate.d, h * rate.q]);
        i0 + Dq { d, q }
    }
}
