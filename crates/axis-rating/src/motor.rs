//! Torque of a motor against its curves over speed, and its speed.
//!
//! Rotary or linear: torque and force, rad/s and m/s take the same formulas. Names say N·m and rad/s.

use crate::error::{RatingError, not_negative, positive};
use crate::means::RootMeanSquare;
use crate::rating::Rating;

/// A limit of the torque over speed: points, straight between them, constant below the first, 0 beyond the
/// last.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(try_from = "Vec<[f64; 2]>", into = "Vec<[f64; 2]>")
)]
pub struct TorqueCurve(Vec<[f64; 2]>);

impl TorqueCurve {
    /// Of points (speed in rad/s, torque in N·m), by rising speed.
    ///
    /// # Errors
    /// [`RatingError::Curve`] without a point, or if speeds do not rise or torques are not above 0.
    pub fn new(points: Vec<[f64; 2]>) -> Result<Self, RatingError> {
        let wrong = |what| Err(RatingError::Curve { what });
        if points.is_empty() {
            return wrong("has no point");
        }
        if !points.iter().flatten().all(|v| v.is_finite()) {
            return wrong("has a number that is not finite");
        }
        if points
            .iter()
            .any(|[speed, torque]| *speed < 0.0 || *torque < 0.0)
        {
            return wrong("has a number below 0");
        }
        if points.iter().all(|[_, torque]| *torque == 0.0) {
            return wrong("has no torque above 0");
        }
        if points.windows(2).any(|pair| pair[1][0] <= pair[0][0]) {
            return wrong("has speeds that do not rise");
        }
        Ok(Self(points))
    }

    /// The same torque at every speed, N·m.
    ///
    /// # Errors
    /// [`RatingError::Invalid`] of a torque that is not above 0.
    pub fn constant(torque_n_m: f64) -> Result<Self, RatingError> {
        let torque = positive("torque_n_m", torque_n_m)?;
        Ok(Self(vec![[0.0, torque], [f64::MAX, torque]]))
    }

    /// Its points: speed, rad/s, and torque, N·m.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// The torque that it allows at a speed of either sign, N·m.
    pub fn at(&self, speed_rad_per_s: f64) -> f64 {
        let speed = speed_rad_per_s.abs();
        let above = self.0.iter().position(|[at, _]| *at >= speed);
        match above {
            Some(0) => self.0[0][1],
            Some(i) => {
                let ([from, low], [to, high]) = (self.0[i - 1], self.0[i]);
                low + (high - low) * ((speed - from) / (to - from))
            }
            None => 0.0,
        }
    }
}

/// Torque and speed of a motor over a duty.
#[derive(Clone, Debug, Default)]
pub struct MotorDuty {
    torque: RootMeanSquare,
    travel_rad: f64,
    duration_s: f64,
    fastest_rad_per_s: f64,
    peak_n_m: f64,
}

impl MotorDuty {
    /// Adds a stretch.
    pub fn push(&mut self, duration_s: f64, torque_n_m: f64, speed_rad_per_s: f64) {
        self.torque.push(duration_s, torque_n_m);
        self.duration_s += duration_s;
        self.travel_rad += duration_s * speed_rad_per_s.abs();
        self.fastest_rad_per_s = self.fastest_rad_per_s.max(speed_rad_per_s.abs());
        self.peak_n_m = self.peak_n_m.max(torque_n_m.abs());
    }

    /// Root mean square of the torque, N·m.
    pub fn rms_torque_n_m(&self) -> f64 {
        self.torque.value()
    }

    /// Greatest torque, N·m.
    pub fn peak_torque_n_m(&self) -> f64 {
        self.peak_n_m
    }

    /// Mean of the speed without its sign, rad/s.
    pub fn mean_speed_rad_per_s(&self) -> f64 {
        match self.duration_s > 0.0 {
            true => self.travel_rad / self.duration_s,
            false => 0.0,
        }
    }

    /// Greatest speed, rad/s.
    pub fn fastest_rad_per_s(&self) -> f64 {
        self.fastest_rad_per_s
    }

    /// Duration of the duty, s.
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Root mean square of the torque against the continuous curve at the mean speed, as makers' selection
    /// guides have it: a duty much shorter than the motor's thermal time constant warms the winding by its
    /// root mean square (losses by resistance grow with the square of the torque).
    pub fn continuous(&self, curve: &TorqueCurve, unit: &'static str) -> Rating {
        let limit = curve.at(self.mean_speed_rad_per_s());
        Rating::at_most(self.rms_torque_n_m(), limit, unit)
    }
}

/// One instant against the peak curve: the torque and what the curve allows at that speed. The duty's rating is the
/// [worse](Rating::worse) of all instants.
pub fn peak(
    torque_n_m: f64,
    speed_rad_per_s: f64,
    curve: &TorqueCurve,
    unit: &'static str,
) -> Rating {
    Rating::at_most(torque_n_m.abs(), curve.at(speed_rad_per_s), unit)
}

/// The greatest speed against the limit of the motor's data sheet.
///
/// # Errors
/// [`RatingError::Invalid`] of a limit that is not above 0.
pub fn speed(fastest_rad_per_s: f64, limit_rad_per_s: f64) -> Result<Rating, RatingError> {
    let value = not_negative("fastest_rad_per_s", fastest_rad_per_s)?;
    let limit = positive("limit_rad_per_s", limit_rad_per_s)?;
    Ok(Rating::at_most(value, limit, "rad/s"))
}

/// Inertia of the load seen at the motor over that of the rotor, against the ratio that the drive's maker allows.
///
/// # Errors
/// [`RatingError::Invalid`] of inertias or a limit that are not above 0.
pub fn inertia_ratio(load_kg_m2: f64, rotor_kg_m2: f64, limit: f64) -> Result<Rating, RatingError> {
    let load = not_negative("load_kg_m2", load_kg_m2)?;
    let rotor = positive("rotor_kg_m2", rotor_kg_m2)?;
    Ok(Rating::at_most(load / rotor, positive("limit", limit)?, ""))
}
