//! The reference of a log.

use axis_log::Log;
use trajectories::{Motion, Setpoint};

use super::ReplayError;
use crate::channels::reference_in;

/// A logged reference as a motion: cubic between samples, through positions
/// and velocities.
#[derive(Clone, Debug)]
pub struct LoggedReference {
    pub(super) period: f64,
    position: Vec<f64>,
    velocity: Vec<f64>,
}

impl LoggedReference {
    /// The reference of a uniformly sampled log with the sampling period
    /// `period` (s). Without `velocity_ref_m_s` the velocity is the central
    /// difference of the position.
    ///
    /// # Errors
    /// [`ReplayError::Log`] without `position_ref_m`; [`ReplayError::Period`].
    pub fn new(log: &Log, period: f64) -> Result<Self, ReplayError> {
        if !(period.is_finite() && period > 0.0) {
            return Err(ReplayError::Period { period });
        }
        let position = reference_in(log)?.to_vec();
        let last = position.len() - 1;
        let difference = |k: usize| {
            let (a, b) = (k.saturating_sub(1), (k + 1).min(last));
            (position[b] - position[a]) / (period * (b - a).max(1) as f64)
        };
        let velocity = match log
            .channel("velocity_ref_m_s")
            .or(log.channel("velocity_ref_rad_s"))
        {
            Ok(samples) => samples.to_vec(),
            Err(_) => (0..=last).map(difference).collect(),
        };
        Ok(Self {
            period,
            position,
            velocity,
        })
    }
}

impl Motion for LoggedReference {
    fn duration(&self) -> f64 {
        (self.position.len() - 1) as f64 * self.period
    }

    fn at(&self, t: f64) -> Setpoint {
        if t.is_nan() {
            return Setpoint::at_rest(self.position[0]);
        }
        let last = self.position.len() - 1;
        let along = (t / self.period).clamp(0.0, last as f64);
        let near = along.round();
        if (along - near).abs() < 1e-6 {
            let k = near as usize;
            let inside = t > -self.period && t < self.duration() + self.period;
            return Setpoint {
                position: self.position[k],
                velocity: if inside { self.velocity[k] } else { 0.0 },
                ..Setpoint::default()
            };
        }
        let k = (along as usize).min(last.saturating_sub(1));
        let (s, h) = (along - k as f64, self.period);
        let (p0, p1) = (self.position[k], self.position[k + 1]);
        let (m0, m1) = (h * self.velocity[k], h * self.velocity[k + 1]);
        let (s2, s3) = (s * s, s * s * s);
        let position = (2.0 * s3 - 3.0 * s2 + 1.0) * p0
            + (s3 - 2.0 * s2 + s) * m0
            + (3.0 * s2 - 2.0 * s3) * p1
            + (s3 - s2) * m1;
        let velocity = (6.0 * (s2 - s) * (p0 - p1)
            + (3.0 * s2 - 4.0 * s + 1.0) * m0
            + (3.0 * s2 - 2.0 * s) * m1)
            / h;
        Setpoint {
            position,
            velocity,
            ..Setpoint::default()
        }
    }
}
