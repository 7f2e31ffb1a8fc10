//! One bristle with any onset: LuGre, Dahl, elasto-plastic and Bouc–Wen friction.

use super::error::FrictionError;
use super::onset::{BoucWenOnset, DahlOnset, ElastoPlasticOnset, LinearOnset, Onset};
use super::steady::{FrictionLevel, SteadyState, check};
use super::{FrictionLaw, halves, pressing, sound};
use crate::exponential::Exponential;

/// Parameters of a [`Bristle`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct BristleParameters<T, O> {
    /// Friction at constant speed.
    pub steady: SteadyState<T>,
    /// `σ0`, stiffness of the unloaded bristle, N/m or N·m/rad.
    pub stiffness: T,
    /// `σ1`, damping of the bristle, N·s/m or N·m·s/rad. 0 in the laws of Dahl, Bouc and Wen.
    pub damping: T,
    /// How the force comes on with displacement.
    pub onset: O,
}

/// A bristle of deflection `z` that follows the motion at first and slides in the end. With
/// `s = sign v`, the steady deflection `z_ss = g(v)/σ0` and `y = s z/z_ss`,
///
/// ```text
/// dz/dt = v Y(y),   Y(1) = 0
/// F     = σ0 z + σ1 dz/dt + v (k₁ + k₂ |v| + k₃ v²)
/// ```
///
/// where Y is the law's [`Onset`]. `dy/dx` depends on `y` alone while g does not change: of
/// displacement `x`, not of time. A step is therefore as exact as the solution of
/// `dy/dξ = Y(y)`, `ξ = |v| h/z_ss`, at a constant speed however long it is, and at any speed
/// where the level is the same at all speeds. Between two speeds on the Stribeck curve it is
/// second order.
///
/// `z` goes to `s z_ss` and not beyond it, so that `−F_S/σ0` backward and `F_S/σ0` forward
/// bound it, exactly and in floating point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bristle<T, O> {
    parameters: BristleParameters<T, O>,
    compliance: T,
    /// Least and greatest deflection, m or rad.
    limits: [T; 2],
}

/// LuGre friction with levels by direction, Stribeck exponent and viscous friction of higher
/// order (C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky, IEEE Trans. Automatic
/// Control 40(3), 1995, doi 10.1109/9.376053). [`LuGre`](crate::LuGre) is the same law with
/// one level and a Gaussian curve.
pub type GeneralLuGre<T = f64> = Bristle<T, LinearOnset>;

/// Dahl's friction (P. R. Dahl, "Solid friction damping of mechanical vibrations", AIAA
/// Journal 14(12), 1976, doi 10.2514/3.61511).
pub type Dahl<T = f64> = Bristle<T, DahlOnset<T>>;

/// Elasto-plastic friction (P. Dupont, V. Hayward, B. Armstrong, F. Altpeter, "Single state
/// elastoplastic friction models", IEEE Trans. Automatic Control 47(5), 2002,
/// doi 10.1109/TAC.2002.1000274).
pub type ElastoPlastic<T = f64> = Bristle<T, ElastoPlasticOnset<T>>;

/// Friction of Bouc and Wen, normalised (F. Ikhouane and J. Rodellar, "On the hysteretic
/// Bouc–Wen model, part I", Nonlinear Dynamics 42, 2005, 63–78).
pub type BoucWen<T = f64> = Bristle<T, BoucWenOnset<T>>;

impl<T: Exponential, O: Onset<T>> Bristle<T, O> {
    /// A law of validated parameters.
    ///
    /// # Errors
    /// [`FrictionError`] names the first parameter that is not acceptable. The deflections
    /// `coulomb / stiffness` and `stiction / stiffness`, unless 0, must lie between 1e-150 and
    /// 1e150 (1e-18 and 1e18 in `f32`), so that no step overflows.
    pub fn new(parameters: BristleParameters<T, O>) -> Result<Self, FrictionError> {
        let BristleParameters {
            steady,
            stiffness,
            damping,
            onset,
        } = parameters;
        steady.validate()?;
        check("stiffness", stiffness, "finite and greater than 0", false)?;
        check("damping", damping, "finite and at least 0", true)?;
        onset.validate()?;
        let (least, greatest) = T::DEFLECTIONS;
        let deflects =
            |level: T| level == T::ZERO || (least..=greatest).contains(&(level / stiffness));
        let FrictionLevel { coulomb, stiction } = steady.forward;
        let back = steady.backward;
        if ![coulomb, stiction, back.coulomb, back.stiction]
            .into_iter()
            .all(deflects)
        {
            return Err(FrictionError::Invalid {
                field: "stiffness",
                value: stiffness.to_f64(),
                valid: T::VALID_STIFFNESS,
            });
        }
        let compliance = T::ONE / stiffness;
        Ok(Self {
            parameters,
            compliance,
            limits: [-back.stiction * compliance, stiction * compliance],
        })
    }

    /// The parameters that the law was made from.
    #[must_use]
    pub fn parameters(&self) -> BristleParameters<T, O> {
        self.parameters
    }

    /// Least and greatest deflection, m or rad.
    #[must_use]
    pub fn deflection_limits(&self) -> [T; 2] {
        self.limits
    }

    /// `dz/dt`, m/s or rad/s.
    #[must_use]
    pub fn rate(&self, z: T, speed: T) -> T {
        if speed == T::ZERO && !z.is_nan() {
            return T::ZERO;
        }
        let (reach, coulomb) = self.reach(speed);
        if reach == T::ZERO {
            return T::ZERO * z * speed;
        }
        let along = z * T::ONE.copysign(speed);
        speed * self.parameters.onset.slope(along / reach, coulomb)
    }

    /// `z_ss` without sign, and `F_C/g`.
    #[inline]
    fn reach(&self, speed: T) -> (T, T) {
        let steady = &self.parameters.steady;
        let level = steady.level(speed);
        (
            level * self.compliance,
            steady.of_direction(speed).coulomb / level,
        )
    }

    /// The solution over `h` at a constant speed.
    fn slide(&self, z0: T, speed: T, h: T) -> T {
        if z0.is_nan() || speed.is_nan() || h.is_nan() {
            return T::NAN;
        }
        if speed == T::ZERO || h <= T::ZERO {
            return z0;
        }
        let (reach, coulomb) = self.reach(speed);
        if reach == T::ZERO {
            return T::ZERO;
        }
        let sign = T::ONE.copysign(speed);
        let travel = speed.abs() * h / reach;
        let along = self
            .parameters
            .onset
            .advance(sign * z0 / reach, travel, coulomb);
        let z1 = z0 + sign * reach * along;
        // Rounding may leave the way from z0 to its target by a bit.
        let target = sign * reach;
        let ends = if z0 < target {
            [z0, target]
        } else {
            [target, z0]
        };
        if z1 > ends[1] {
            ends[1]
        } else if z1 < ends[0] {
            ends[0]
        } else {
            z1
        }
    }
}

impl<T: Exponential, O: Onset<T>> FrictionLaw<T> for Bristle<T, O> {
    type State = T;

    fn step(&self, z: T, v0: T, v1: T, h: T) -> T {
        let z = sound(z, self.limits);
        halves(z, [v0, v1], h, |z, speed, h| self.slide(z, speed, h))
    }

    fn force_at_load(&self, z: &T, speed: T, load: T) -> T {
        let p = &self.parameters;
        let mut dry = p.stiffness * *z;
        // A product of 0 with an infinite rate would be none.
        if p.damping > T::ZERO {
            dry += p.damping * self.rate(*z, speed);
        }
        pressing(load) * dry + p.steady.viscous_force(speed)
    }

    fn steady_state(&self, speed: T) -> T {
        self.parameters.steady.force(speed)
    }

    fn settled(&self, speed: T) -> T {
        if speed == T::ZERO {
            return T::ZERO;
        }
        self.reach(speed).0.copysign(speed)
    }

    fn stiffness(&self) -> T {
        self.parameters.stiffness
    }

    fn spring_limits(&self) -> [T; 2] {
        let steady = &self.parameters.steady;
        [-steady.backward.stiction, steady.forward.stiction]
    }

    fn spring_force(&self, z: &T) -> T {
        self.parameters.stiffness * *z
    }

    fn stored_energy(&self, z: &T) -> T {
        T::HALF * self.parameters.stiffness * *z * *z
    }

    /// With `V = σ0 z²/2`, the power that goes neither out nor into V is
    ///
    /// ```text
    /// F v − dV/dt = |v| [ g y (1 − Y) + |v| (σ1 Y + k₁ + …) ]
    /// ```
    ///
    /// Every onset has `Y ≤ 1` for `y ≥ 0` and `Y ≥ 1` below, so that the first term takes
    /// energy. The second does unless `k₁ < −σ1 Y` at the greatest `y`, `F_S/F_C`; for LuGre
    /// this is the condition of N. Barabanov and R. Ortega, IEEE Trans. Automatic Control
    /// 45(4), 2000.
    fn is_passive(&self) -> bool {
        let p = &self.parameters;
        if p.damping == T::ZERO {
            return true;
        }
        [p.steady.forward, p.steady.backward].into_iter().all(
            |FrictionLevel { coulomb, stiction }| {
                coulomb == T::ZERO
                    || p.steady.viscous + p.damping * p.onset.slope(stiction / coulomb, T::ONE)
                        >= T::ZERO
            },
        )
    }
}
