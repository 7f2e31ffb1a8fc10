//! Values as serde reads and writes them (feature `serde`): what the constructors refuse does not get in.

use serde::{Deserialize, Serialize};

use crate::{FeedLimits, NurbsData, ToolpathError};

/// serde has arrays of fixed lengths only.
fn axes<const D: usize>(field: &'static str, values: Vec<f64>) -> Result<[f64; D], ToolpathError> {
    <[f64; D]>::try_from(values).map_err(|values| ToolpathError::Count {
        field,
        count: values.len(),
        valid: format!("{D}, one for each axis"),
    })
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "FeedLimits", deny_unknown_fields)]
pub(crate) struct StoredLimits {
    feed: f64,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    jerk: Vec<f64>,
    acceleration_step: Vec<f64>,
}

impl<const D: usize> TryFrom<StoredLimits> for FeedLimits<D> {
    type Error = ToolpathError;

    fn try_from(stored: StoredLimits) -> Result<Self, ToolpathError> {
        let limits = Self {
            feed: stored.feed,
            velocity: axes("velocity", stored.velocity)?,
            acceleration: axes("acceleration", stored.acceleration)?,
            jerk: axes("jerk", stored.jerk)?,
            acceleration_step: axes("acceleration_step", stored.acceleration_step)?,
        };
        limits.check()?;
        Ok(limits)
    }
}

impl<const D: usize> From<FeedLimits<D>> for StoredLimits {
    fn from(limits: FeedLimits<D>) -> Self {
        Self {
            feed: limits.feed,
            velocity: limits.velocity.to_vec(),
            acceleration: limits.acceleration.to_vec(),
            jerk: limits.jerk.to_vec(),
            acceleration_step: limits.acceleration_step.to_vec(),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "NurbsData", deny_unknown_fields)]
pub(crate) struct StoredNurbs {
    degree: usize,
    points: Vec<Vec<f64>>,
    weights: Vec<f64>,
    knots: Vec<f64>,
}

impl<const D: usize> TryFrom<StoredNurbs> for NurbsData<D> {
    type Error = ToolpathError;

    fn try_from(stored: StoredNurbs) -> Result<Self, ToolpathError> {
        let points = stored
            .points
            .into_iter()
            .map(|point| axes("a point", point));
        Ok(Self {
            degree: stored.degree,
            points: points.collect::<Result<_, _>>()?,
            weights: stored.weights,
            knots: stored.knots,
        })
    }
}

impl<const D: usize> From<NurbsData<D>> for StoredNurbs {
    fn from(data: NurbsData<D>) -> Self {
        Self {
            degree: data.degree,
            points: data.points.iter().map(|point| point.to_vec()).collect(),
            weights: data.weights,
            knots: data.knots,
        }
    }
}
