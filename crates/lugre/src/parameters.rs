//! The six numbers of the law, and which of them make a law.

use axis_scalar::Scalar;
use thiserror::Error;

use crate::exponential::Exponential;

/// The six parameters of equations (1) to (3) of the crate page.
///
/// Units are those of a rotary contact; for a linear one read N, m and m/s.
/// With `coulomb = stiction = 0` the bristles carry nothing and the law is
/// purely viscous; with `viscous = 0` as well it is exactly no friction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Parameters<T = f64> {
    /// `T_C`, the Coulomb level reached at high speed, N·m.
    pub coulomb: T,
    /// `T_S`, the level at vanishing speed (break-away), N·m; at least `T_C`.
    pub stiction: T,
    /// `Ω_S`, the Stribeck speed at which 37 % of `T_S − T_C` is left, rad/s.
    pub stribeck_speed: T,
    /// `σ0`, the bristle stiffness, N·m/rad.
    pub stiffness: T,
    /// `σ1`, the bristle damping, N·m·s/rad.
    pub damping: T,
    /// `σ2`, the viscous coefficient, N·m·s/rad.
    pub viscous: T,
}

/// Why [`Parameters`] make no law.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum LugreError {
    /// A field is NaN, infinite or outside its range.
    #[error("LuGre parameter `{field}` is {value}, but must be {valid}")]
    Invalid {
        /// The field of [`Parameters`].
        field: &'static str,
        /// The value found, exactly, whatever the scalar.
        value: f64,
        /// What would be accepted.
        valid: &'static str,
    },
    /// `stiction` is below `coulomb`: friction would rise with speed through
    /// a term that is meant to let it fall.
    #[error("LuGre parameter `stiction` is {stiction}, but must be at least `coulomb` = {coulomb}")]
    StictionBelowCoulomb {
        /// The value of `stiction`, N·m.
        stiction: f64,
        /// The value of `coulomb`, N·m.
        coulomb: f64,
    },
}

/// 1 rpm in rad/s.
const RPM: f64 = core::f64::consts::PI / 30.0;

impl Parameters {
    /// A ball-screw axis with a table of 515 kg, referred to its screw: Liu,
    /// Guo, Liu and Niu, Machines 13(5), 433, 2025, Table 1
    /// (doi 10.3390/machines13050433).
    ///
    /// The table prints 0.6757, 0.7653, 25.9147 rpm, 1.5875, 0.1593 and
    /// 0.0003. Its N·mm are read as N·m (in N·mm friction would vanish beside
    /// the motor's 24 N·m), the unit of `σ0` as N·m/(rpm·s), one integration
    /// from that of `σ1`, and everything per rpm is divided by π/30.
    pub const LIU_2025: Self = Self {
        coulomb: 0.6757,
        stiction: 0.7653,
        stribeck_speed: 25.9147 * RPM,
        stiffness: 1.5875 / RPM,
        damping: 0.1593 / RPM,
        viscous: 0.0003 / RPM,
    };
}

impl<T: Scalar> Parameters<T> {
    /// The same parameters, each rounded to the nearest number of another
    /// scalar; one beyond its range becomes infinite, which
    /// [`validate`](Self::validate) refuses.
    ///
    /// ```
    /// use lugre::{LuGre, Parameters};
    ///
    /// let law = LuGre::new(Parameters::LIU_2025.cast::<f32>())?;
    /// assert_eq!(law.level(0.0), 0.7653_f32);
    /// # Ok::<(), lugre::LugreError>(())
    /// ```
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> Parameters<U> {
        let cast = |value: T| U::of(value.to_f64());
        Parameters {
            coulomb: cast(self.coulomb),
            stiction: cast(self.stiction),
            stribeck_speed: cast(self.stribeck_speed),
            stiffness: cast(self.stiffness),
            damping: cast(self.damping),
            viscous: cast(self.viscous),
        }
    }
}

impl<T: Exponential> Parameters<T> {
    /// Checks every field.
    ///
    /// # Errors
    /// [`LugreError`] names the first field that is not acceptable. `coulomb`
    /// may be zero only together with `stiction`: a level that vanishes at
    /// high speed alone makes the relaxation of equation (1) infinitely fast.
    /// The deflections `coulomb / stiffness` and `stiction / stiffness` must
    /// lie between 1e-150 and 1e150 rad (1e-18 and 1e18 in `f32`), so that no
    /// step overflows.
    pub fn validate(&self) -> Result<(), LugreError> {
        const NOT_NEGATIVE: &str = "finite and at least 0";
        const POSITIVE: &str = "finite and greater than 0";
        let null = self.coulomb == T::ZERO && self.stiction == T::ZERO;
        let stiffness_valid = if null { NOT_NEGATIVE } else { POSITIVE };
        let coulomb_valid = if null {
            NOT_NEGATIVE
        } else {
            "finite and greater than 0 (or 0 together with `stiction`)"
        };
        check("coulomb", self.coulomb, coulomb_valid, null)?;
        check("stiction", self.stiction, NOT_NEGATIVE, true)?;
        check("stribeck_speed", self.stribeck_speed, POSITIVE, false)?;
        check("stiffness", self.stiffness, stiffness_valid, null)?;
        check("damping", self.damping, NOT_NEGATIVE, true)?;
        check("viscous", self.viscous, NOT_NEGATIVE, true)?;
        if self.stiction < self.coulomb {
            return Err(LugreError::StictionBelowCoulomb {
                stiction: self.stiction.to_f64(),
                coulomb: self.coulomb.to_f64(),
            });
        }
        let deflections = [self.coulomb, self.stiction].map(|level| level / self.stiffness);
        let (least, greatest) = T::DEFLECTIONS;
        if !null && !deflections.iter().all(|z| (least..=greatest).contains(z)) {
            return Err(LugreError::Invalid {
                field: "stiffness",
                value: self.stiffness.to_f64(),
                valid: T::VALID_STIFFNESS,
            });
        }
        Ok(())
    }
}

fn check<T: Scalar>(
    field: &'static str,
    value: T,
    valid: &'static str,
    zero_allowed: bool,
) -> Result<(), LugreError> {
    // Subnormal numbers are refused too: their reciprocals overflow, and the
    // hot path divides by none of them afterwards.
    let positive = value >= T::MIN_POSITIVE && value.is_finite();
    if positive || (zero_allowed && value == T::ZERO) {
        Ok(())
    } else {
        Err(LugreError::Invalid {
            field,
            value: value.to_f64(),
            valid,
        })
    }
}
