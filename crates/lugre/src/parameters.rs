//! The six numbers of the law, and which of them make a law.

use thiserror::Error;

/// The six parameters of equations (1) to (3) of the crate page.
///
/// Units are those of a rotary contact; for a linear one read N, m and m/s.
/// With `coulomb = stiction = 0` the bristles carry nothing and the law is
/// purely viscous; with `viscous = 0` as well it is exactly no friction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Parameters {
    /// `T_C`, the Coulomb level reached at high speed, N·m.
    pub coulomb: f64,
    /// `T_S`, the level at vanishing speed (break-away), N·m; at least `T_C`.
    pub stiction: f64,
    /// `Ω_S`, the Stribeck speed at which 37 % of `T_S − T_C` is left, rad/s.
    pub stribeck_speed: f64,
    /// `σ0`, the bristle stiffness, N·m/rad.
    pub stiffness: f64,
    /// `σ1`, the bristle damping, N·m·s/rad.
    pub damping: f64,
    /// `σ2`, the viscous coefficient, N·m·s/rad.
    pub viscous: f64,
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
        /// The value found.
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

    /// Checks every field.
    ///
    /// # Errors
    /// [`LugreError`] names the first field that is not acceptable. `coulomb`
    /// may be zero only together with `stiction`: a level that vanishes at
    /// high speed alone makes the relaxation of equation (1) infinitely fast.
    /// The deflections `coulomb / stiffness` and `stiction / stiffness` must
    /// lie between 1e-150 and 1e150 rad, so that no step overflows.
    pub fn validate(&self) -> Result<(), LugreError> {
        const NOT_NEGATIVE: &str = "finite and at least 0";
        const POSITIVE: &str = "finite and greater than 0";
        let null = self.coulomb == 0.0 && self.stiction == 0.0;
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
                stiction: self.stiction,
                coulomb: self.coulomb,
            });
        }
        let deflections = [self.coulomb, self.stiction].map(|level| level / self.stiffness);
        if !null && !deflections.iter().all(|z| (1e-150..=1e150).contains(z)) {
            return Err(LugreError::Invalid {
                field: "stiffness",
                value: self.stiffness,
                valid: "such that `coulomb` and `stiction` divided by it are between 1e-150 and \
                        1e150 rad",
            });
        }
        Ok(())
    }
}

fn check(
    field: &'static str,
    value: f64,
    valid: &'static str,
    zero_allowed: bool,
) -> Result<(), LugreError> {
    // Subnormal numbers are refused too: their reciprocals overflow, and the
    // hot path divides by none of them afterwards.
    let positive = value.is_normal() && value > 0.0;
    if positive || (zero_allowed && value == 0.0) {
        Ok(())
    } else {
        Err(LugreError::Invalid {
            field,
            value,
            valid,
        })
    }
}
