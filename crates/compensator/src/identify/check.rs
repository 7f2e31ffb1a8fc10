//! Refusal of motions and candidates that cannot be used.

use std::vec::Vec;

use super::{Candidates, MotionRecord, TransferFunctionError};
use crate::error::require;
use crate::{MAX_ORDER, TransferFunctionModel};

/// Largest magnitude of a sample: sums of squares stay far below what f64 holds.
const LARGEST: f64 = 1e100;

/// Returns the period that all motions share.
pub(super) fn check(
    training: &[MotionRecord],
    validation: &[MotionRecord],
    candidates: &Candidates,
) -> Result<f64, TransferFunctionError> {
    let first = training
        .first()
        .ok_or(TransferFunctionError::Empty("training motion"))?
        .period;
    if validation.is_empty() {
        return Err(TransferFunctionError::Empty("validation motion"));
    }
    if candidates.pole_cycles.is_empty() || candidates.pole_cycles.iter().any(Vec::is_empty) {
        return Err(TransferFunctionError::Empty("pole"));
    }
    let order = candidates.max_order;
    let inside = (1..=MAX_ORDER).contains(&order);
    require(inside, "max_order", order as f64, "1 to 16")?;
    for &pole in candidates.pole_cycles.iter().flatten() {
        TransferFunctionModel::new(first, 0.0, &[pole], &[0.0])?;
    }
    for (set, motions) in [("training", training), ("validation", validation)] {
        for (index, motion) in motions.iter().enumerate() {
            check_motion(set, index, motion, first)?;
        }
    }
    if validation.iter().all(|motion| motion.error.is_empty()) {
        return Err(TransferFunctionError::Empty("validation sample"));
    }
    Ok(first)
}

fn check_motion(
    set: &'static str,
    index: usize,
    motion: &MotionRecord,
    first: f64,
) -> Result<(), TransferFunctionError> {
    let period = motion.period;
    if period != first {
        return Err(TransferFunctionError::Period {
            set,
            index,
            period,
            first,
        });
    }
    let (accelerations, errors) = (motion.acceleration.len(), motion.error.len());
    if accelerations != errors {
        return Err(TransferFunctionError::Length {
            set,
            index,
            accelerations,
            errors,
        });
    }
    let series = [
        ("acceleration", motion.acceleration),
        ("error", motion.error),
    ];
    for (what, values) in series {
        // Written so that NaN is caught too.
        let inside = |value: &f64| value.abs() <= LARGEST;
        if let Some(sample) = values.iter().position(|value| !inside(value)) {
            return Err(TransferFunctionError::Value {
                set,
                index,
                sample,
                what,
                value: values[sample],
            });
        }
    }
    Ok(())
}
