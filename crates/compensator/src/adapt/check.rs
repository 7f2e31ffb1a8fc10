//! Refusal of logs that nothing can be learned from.

use super::AdaptError;
use crate::{DriveModel, Sample};

/// Greatest magnitude of a sample.
const LARGEST: f64 = 1e9;
/// Least travel, in deflections at which friction breaks away.
const LEAST_TRAVEL: f64 = 3.0;

/// Refuses a log with fewer than `least` samples, with values that no sensor shows, or of
/// an axis that stands.
pub(super) fn check(model: &DriveModel, log: &[Sample], least: usize) -> Result<(), AdaptError> {
    let samples = log.len();
    if samples < least {
        return Err(AdaptError::TooShort { samples, least });
    }
    for (sample, s) in log.iter().enumerate() {
        let named = [
            ("position", s.position),
            ("motor_angle", s.motor_angle),
            ("motor_speed", s.motor_speed),
            ("iq", s.iq),
            ("last_command", s.last_command),
        ];
        // Written so that NaN is caught too.
        let inside = |value: f64| value.abs() <= LARGEST;
        if let Some((what, value)) = named.into_iter().find(|(_, v)| !inside(*v)) {
            return Err(AdaptError::Value {
                sample,
                what,
                value,
            });
        }
    }
    let positions = log.iter().map(|s| s.position);
    let most = positions.clone().fold(f64::MIN, f64::max);
    let travel = most - positions.fold(f64::MAX, f64::min);
    let least = LEAST_TRAVEL * model.friction.bristle_limit() * model.lever;
    if travel > least {
        return Ok(());
    }
    Err(AdaptError::Standstill { travel, least })
}
