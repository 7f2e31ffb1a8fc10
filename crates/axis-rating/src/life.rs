//! Nominal life of rolling contacts, and their static safety.
//!
//! Bearings by ISO 281, nuts of ball screws by ISO 3408-5, guides by ISO 14728-1: L = base (C/P)^p, which nine of ten reach
//! (source not read in the standards; the formulas are those of makers' pages, such as MISUMI's *Selection of Ball
//! Screws*, page 1678).

use crate::error::{RatingError, not_negative, positive};
use crate::rating::Rating;

/// What rolls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum RollingElement {
    /// Balls: p = 3.
    Ball,
    /// Rollers: p = 10/3.
    Roller,
}

impl RollingElement {
    /// Exponent p of the life.
    pub fn exponent(self) -> f64 {
        match self {
            Self::Ball => 3.0,
            Self::Roller => 10.0 / 3.0,
        }
    }
}

/// Travel at which a guide's dynamic load rating is defined: ISO 14728-1 has both, and the data sheet says which. Ratings of
/// 50 km are 2^(1/3) = 1.26 times those of 100 km of the same guide with balls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum GuideBase {
    /// 50 km, such as IKO's.
    Km50,
    /// 100 km, such as Schneeberger's.
    Km100,
}

impl GuideBase {
    /// The travel, m.
    pub fn travel_m(self) -> f64 {
        match self {
            Self::Km50 => 5e4,
            Self::Km100 => 1e5,
        }
    }
}

/// Revolutions of a basic load rating.
pub const BASE_REVOLUTIONS: f64 = 1e6;

/// Life in the unit of `base` (revolutions, m): base (C/P)^p; infinite without load. `load_n` is the equivalent load, the
/// mean one of a duty ([`crate::MeanLoad`]), times the work factor.
///
/// # Errors
/// [`RatingError::Invalid`] of a base or a rating that is not above 0, or a load below 0.
pub fn nominal_life(
    base: f64,
    rating_n: f64,
    load_n: f64,
    element: RollingElement,
) -> Result<f64, RatingError> {
    let base = positive("base", base)?;
    let rating = positive("rating_n", rating_n)?;
    let load = not_negative("load_n", load_n)?;
    Ok(match load == 0.0 {
        true => f64::INFINITY,
        false => base * (rating / load).powf(element.exponent()),
    })
}

/// Life of two contacts of which either fails: (L_1^(−w) + L_2^(−w))^(−1/w) with Weibull's slope w = 10/9 of balls,
/// 9/8 of rollers (Lundberg and Palmgren 1947; ISO 3408-5 for two nuts; sources not read).
///
/// # Errors
/// [`RatingError::Invalid`] of a life that is below 0 or no number.
pub fn joint_life(lives: [f64; 2], element: RollingElement) -> Result<f64, RatingError> {
    for value in lives {
        let name = "a life";
        if value.is_nan() || value < 0.0 {
            let valid = "0 or above";
            return Err(RatingError::Invalid { name, value, valid });
        }
    }
    let [low, high] = match lives[0] <= lives[1] {
        true => lives,
        false => [lives[1], lives[0]],
    };
    if low == 0.0 || high.is_infinite() {
        return Ok(low);
    }
    let slope = match element {
        RollingElement::Ball => 10.0 / 9.0,
        RollingElement::Roller => 9.0 / 8.0,
    };
    // As multiples of the shorter: no power overflows.
    Ok(low * (1.0 + (low / high).powf(slope)).powf(-1.0 / slope))
}

/// Equivalent load of a bearing, N: X F_r + Y F_a (ISO 281; the factors are in the bearing's data sheet).
///
/// # Errors
/// [`RatingError::Invalid`] of a load or factor below 0.
pub fn equivalent_load_n(
    radial_n: f64,
    axial_n: f64,
    factors: [f64; 2],
) -> Result<f64, RatingError> {
    let [x, y] = factors;
    let radial = not_negative("the radial factor", x)? * not_negative("radial_n", radial_n)?;
    Ok(radial + not_negative("the axial factor", y)? * not_negative("axial_n", axial_n)?)
}

/// Hours of a life, in whatever unit, used up at `per_s` of that unit a second; infinite at standstill.
///
/// # Errors
/// [`RatingError::Invalid`] of a rate below 0.
pub fn life_h(life: f64, per_s: f64) -> Result<f64, RatingError> {
    let rate = not_negative("per_s", per_s)?;
    Ok(match rate == 0.0 {
        true => f64::INFINITY,
        false => life / rate / 3600.0,
    })
}

/// Hours of a life against the hours that are asked for.
///
/// # Errors
/// [`RatingError::Invalid`] of hours that are not above 0.
pub fn life(life_h: f64, required_h: f64) -> Result<Rating, RatingError> {
    let limit = positive("required_h", required_h)?;
    Ok(Rating::at_least(life_h, limit, "h"))
}

/// Static load safety C_0/P_0 against what is asked for; infinite without load.
///
/// # Errors
/// [`RatingError::Invalid`] of a rating or safety that is not above 0, or a load below 0.
pub fn static_safety(rating_n: f64, greatest_n: f64, required: f64) -> Result<Rating, RatingError> {
    let rating = positive("rating_n", rating_n)?;
    let load = not_negative("greatest_n", greatest_n)?;
    let safety = match load == 0.0 {
        true => f64::INFINITY,
        false => rating / load,
    };
    Ok(Rating::at_least(
        safety,
        positive("required", required)?,
        "",
    ))
}
