//! A thermal model fitted to slow logs, checked on the part that was held out.

use axis_sim::Axis;
use axis_thermal::{
    FittedGrowth, FollowedLog, GrowthFit, GrowthLog, ThermalModel, ThermalParameters,
    ThermalUnknown,
};

use super::{HeatError, SlowLog};

/// Most segments of the screw while a model is fitted: growth of more differs by less than what is fitted.
const SEGMENTS: usize = 30;

/// Errors on readings that were not fitted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeldOut {
    /// Readings of growth.
    pub readings: usize,
    /// Greatest error of growth, m.
    pub greatest: f64,
    /// Root mean square, m.
    pub rms: f64,
    /// Greatest growth that was read, m.
    pub of: f64,
    /// Greatest error of the friction's power, as a share; none if nothing of it was read.
    pub friction: Option<f64>,
}

/// A model that was fitted, and how well.
#[derive(Clone, Debug)]
pub struct HeatFit {
    /// The model.
    pub fitted: FittedGrowth,
    /// Readings of growth that it was fitted to, without those that others count from.
    pub readings: usize,
    /// Readings of the friction's power.
    pub friction_readings: usize,
    /// Length of what was fitted, of all logs together, s.
    pub duration: f64,
    /// Errors of the assumed numbers on the part that was held out.
    pub before: HeldOut,
    /// Those of the fitted ones.
    pub after: HeldOut,
}

/// Fits the axis' thermal model to logs of hours; the last part of each, a share of `held_out` of its time, is not
/// fitted but predicted.
///
/// # Errors
/// [`HeatError`] if `held_out` is no share, or no growth can be compared in the part that is fitted.
pub fn fit(axis: &Axis, logs: &[SlowLog<'_>], held_out: f64) -> Result<HeatFit, HeatError> {
    if !(0.0..=0.9).contains(&held_out) {
        return Err(HeatError::Option {
            name: "held_out",
            value: held_out,
            valid: "from 0 to 0.9",
        });
    }
    let assumed = for_fit(axis)?;
    let model = ThermalModel::new(assumed.clone())?;
    let all: Vec<GrowthLog> = logs.iter().map(|log| log.stretches(&model)).collect();
    let kept: Vec<usize> = all.iter().map(|log| fitted_part(log, held_out)).collect();
    let parts: Vec<GrowthLog> = all
        .iter()
        .zip(&kept)
        .map(|(log, n)| log.first(*n))
        .collect();
    let mut fitted = assumed.fit(&parts, &ThermalUnknown::ALL, &GrowthFit::default())?;
    let errors = |model: &ThermalModel| -> Result<HeldOut, HeatError> {
        let followed: Result<Vec<FollowedLog>, _> =
            all.iter().map(|log| model.follow(log)).collect();
        Ok(held(&followed?, &kept))
    };
    let before = errors(&model)?;
    let after = errors(&ThermalModel::new(fitted.parameters.clone())?)?;
    with_segments_of(axis, &mut fitted.parameters);
    let stretches = || parts.iter().flat_map(|log| &log.stretches);
    Ok(HeatFit {
        readings: parts.iter().map(GrowthLog::comparisons).sum(),
        friction_readings: stretches().filter(|s| s.friction.is_some()).count(),
        duration: stretches().map(|s| s.duration).sum(),
        fitted,
        before,
        after,
    })
}

/// The thermal numbers of an axis with as few segments of its screw as a fit needs.
///
/// # Errors
/// [`HeatError::NoScrew`] if it has none.
pub(super) fn for_fit(axis: &Axis) -> Result<ThermalParameters, HeatError> {
    let mut fewer = axis.thermal_parameters();
    let screw = fewer.screw.as_mut().ok_or(HeatError::NoScrew)?;
    screw.segments = screw.segments.min(SEGMENTS);
    Ok(fewer)
}

/// Gives fitted numbers the segments that the axis has.
pub(super) fn with_segments_of(axis: &Axis, fitted: &mut ThermalParameters) {
    if let (Some(to), Some(from)) = (&mut fitted.screw, axis.thermal_parameters().screw) {
        to.segments = from.segments;
    }
}

/// How many stretches are fitted.
pub(super) fn fitted_part(log: &GrowthLog, held_out: f64) -> usize {
    let whole: f64 = log.stretches.iter().map(|s| s.duration).sum();
    let (mut until, mut count) = (0.0, 0);
    for stretch in &log.stretches {
        until += stretch.duration;
        if until > whole * (1.0 - held_out) + 1e-6 {
            break;
        }
        count += 1;
    }
    count
}

fn held(followed: &[FollowedLog], kept: &[usize]) -> HeldOut {
    let mut found = HeldOut::default();
    let mut squares = 0.0;
    for (log, kept) in followed.iter().zip(kept) {
        for read in log.growth.iter().filter(|read| read.stretch >= *kept) {
            let error = read.predicted - read.found;
            found.readings += 1;
            squares += error * error;
            found.greatest = found.greatest.max(error.abs());
            found.of = found.of.max(read.found.abs());
        }
        let worked = log.friction.iter();
        for read in worked.filter(|read| read.stretch >= *kept && read.found > 0.0) {
            let error = (read.predicted / read.found - 1.0).abs();
            found.friction = Some(found.friction.unwrap_or(0.0).max(error));
        }
    }
    found.rms = (squares / found.readings.max(1) as f64).sqrt();
    found
}
