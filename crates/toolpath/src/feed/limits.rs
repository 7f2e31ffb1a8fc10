//! What each axis may do.

use crate::error::{ToolpathError, positive, within};

/// Limits of the axes, and the feed wanted along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "crate::stored::StoredLimits",
        into = "crate::stored::StoredLimits"
    )
)]
pub struct FeedLimits<const D: usize> {
    /// Feed along the path, m/s.
    pub feed: f64,
    /// Greatest |velocity| of each axis, m/s.
    pub velocity: [f64; D],
    /// Greatest |acceleration| of each axis, m/s².
    pub acceleration: [f64; D],
    /// Greatest |jerk| of each axis, m/s³.
    pub jerk: [f64; D],
    /// Greatest step of each axis' acceleration where the curvature jumps, m/s². With 0 the feed
    /// is zero there, since a step is a jerk without bound.
    pub acceleration_step: [f64; D],
}

impl<const D: usize> FeedLimits<D> {
    /// The same velocity (m/s), acceleration (m/s²) and jerk (m/s³) for each axis, with the
    /// feed (m/s) along the path; no step of acceleration.
    pub fn equal(feed: f64, velocity: f64, acceleration: f64, jerk: f64) -> Self {
        Self {
            feed,
            velocity: [velocity; D],
            acceleration: [acceleration; D],
            jerk: [jerk; D],
            acceleration_step: [0.0; D],
        }
    }

    pub(crate) fn check(&self) -> Result<(), ToolpathError> {
        positive("feed", self.feed, "m/s")?;
        for i in 0..D {
            positive("velocity", self.velocity[i], "m/s")?;
            positive("acceleration", self.acceleration[i], "m/s²")?;
            positive("jerk", self.jerk[i], "m/s³")?;
            let step = self.acceleration_step[i];
            within(
                "acceleration_step",
                step - 5e8,
                "m/s²",
                5e8,
                "from 0 to 1e9",
            )?;
        }
        Ok(())
    }
}
