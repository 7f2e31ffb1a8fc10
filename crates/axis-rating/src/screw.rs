//! The shaft of a ball screw: critical speed, buckling, DN value.

use std::f64::consts::PI;

use crate::error::{RatingError, not_negative, positive};
use crate::rating::Rating;

/// How the ends of a screw are held against bending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum ScrewMounting {
    /// Clamped at both ends.
    FixedFixed,
    /// Clamped at one end, supported at the other.
    FixedSupported,
    /// Supported at both ends.
    SupportedSupported,
    /// Clamped at one end, free at the other.
    FixedFree,
}

impl ScrewMounting {
    /// β L of the first bending mode of an Euler-Bernoulli beam: the roots of cos β L cosh β L = 1,
    /// tan β L = tanh β L, sin β L = 0 and cos β L cosh β L = −1. Makers print 4.73, 3.927, 3.142 and 1.875
    /// (THK catalogue 513-1E, page A15-32, equation 7).
    pub fn mode(self) -> f64 {
        match self {
            Self::FixedFixed => 4.730_040_744_862_704,
            Self::FixedSupported => 3.926_602_312_047_919,
            Self::SupportedSupported => PI,
            Self::FixedFree => 1.875_104_068_711_961,
        }
    }

    /// Euler's factor n of the buckling load n π² E I/L², as makers have it (THK catalogue 514E, page A15-30,
    /// equation 5: 4, 2, –, 0.25; HSK, page Screw Shaft Design: 4, 2, 1, 1/4). The exact factor of fixed-supported is
    /// 2.0457; 2 is the smaller.
    pub fn buckling(self) -> f64 {
        match self {
            Self::FixedFixed => 4.0,
            Self::FixedSupported => 2.0,
            Self::SupportedSupported => 1.0,
            Self::FixedFree => 0.25,
        }
    }
}

/// The shaft of a screw.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ScrewStrength {
    /// Diameter at the root of the thread, m.
    pub root_diameter_m: f64,
    /// Young's modulus, Pa; 206e9 of steel.
    pub youngs_modulus_pa: f64,
    /// Density, kg/m³; 7850 of steel.
    pub density_kg_per_m3: f64,
    /// How its ends are held.
    pub mounting: ScrewMounting,
}

/// Share of the critical speed up to which a screw is run (THK, page A15-32; MISUMI, page 1677).
pub const CRITICAL_SPEED_SHARE: f64 = 0.8;

/// Share of the buckling load up to which a screw is pressed (THK, page A15-30; MISUMI, page 1676).
pub const BUCKLING_SHARE: f64 = 0.5;

impl ScrewStrength {
    /// First critical speed over a length (m) without support, rad/s: the first natural frequency in bending,
    ///
    /// ```text
    /// ω = (β L)²/L² √(E I/(ρ A)) = (β L)²/L² (d/4) √(E/ρ)
    /// ```
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no screw has.
    pub fn critical_speed_rad_per_s(&self, length_m: f64) -> Result<f64, RatingError> {
        let length = positive("length_m", length_m)?;
        let diameter = positive("root_diameter_m", self.root_diameter_m)?;
        let modulus = positive("youngs_modulus_pa", self.youngs_modulus_pa)?;
        let density = positive("density_kg_per_m3", self.density_kg_per_m3)?;
        let wave = self.mounting.mode() / length;
        Ok(wave * wave * 0.25 * diameter * (modulus / density).sqrt())
    }

    /// Load at which it buckles over a length (m), N: n π² E I/L², I = π d⁴/64.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no screw has.
    pub fn buckling_load_n(&self, length_m: f64) -> Result<f64, RatingError> {
        let length = positive("length_m", length_m)?;
        let diameter = positive("root_diameter_m", self.root_diameter_m)?;
        let modulus = positive("youngs_modulus_pa", self.youngs_modulus_pa)?;
        let inertia = PI / 64.0 * diameter.powi(4);
        let wave = PI / length;
        Ok(self.mounting.buckling() * wave * wave * modulus * inertia)
    }

    /// The greatest speed of the screw against a share of the critical speed ([`CRITICAL_SPEED_SHARE`]).
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no screw has.
    pub fn critical_speed(
        &self,
        fastest_rad_per_s: f64,
        length_m: f64,
        share: f64,
    ) -> Result<Rating, RatingError> {
        let value = not_negative("fastest_rad_per_s", fastest_rad_per_s)?;
        let limit = positive("share", share)? * self.critical_speed_rad_per_s(length_m)?;
        Ok(Rating::at_most(value, limit, "rad/s"))
    }

    /// The greatest axial load against a share of the buckling load ([`BUCKLING_SHARE`]).
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of values that no screw has.
    pub fn buckling(
        &self,
        greatest_n: f64,
        length_m: f64,
        share: f64,
    ) -> Result<Rating, RatingError> {
        let value = not_negative("greatest_n", greatest_n)?;
        let limit = positive("share", share)? * self.buckling_load_n(length_m)?;
        Ok(Rating::at_most(value, limit, "N"))
    }
}

/// DN value, mm/min: the diameter of the ball circle (m), or the nominal one if the limit is for that, times the speed,
/// against the maker's limit, by which the balls' speed is kept (THK, page A15-33; equations 8 to 17 are of its form).
///
/// # Errors
/// [`RatingError::Invalid`] of a diameter or a limit that is not above 0.
pub fn dn_value(
    diameter_m: f64,
    fastest_rad_per_s: f64,
    limit_mm_per_min: f64,
) -> Result<Rating, RatingError> {
    let diameter_mm = 1e3 * positive("diameter_m", diameter_m)?;
    let per_min = 30.0 / PI * not_negative("fastest_rad_per_s", fastest_rad_per_s)?;
    let limit = positive("limit_mm_per_min", limit_mm_per_min)?;
    Ok(Rating::at_most(diameter_mm * per_min, limit, "mm/min"))
}
