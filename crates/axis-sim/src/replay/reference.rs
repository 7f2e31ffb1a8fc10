//! The reference of a log.

use axis_log::Log;
use trajectories::{Motion, Setpoint};

use super::ReplayError;
use super::curve::{SampledCurve, slopes};
use super::smooth::smooth;
use crate::channels::reference_in;

/// A logged reference as a motion: of the fifth degree between samples, through positions,
/// velocities and the slopes of these; its acceleration a spline.
#[derive(Clone, Debug)]
pub struct LoggedReference {
    position: SampledCurve,
    /// The acceleration, whose slope is the jerk.
    acceleration: SampledCurve,
}

impl LoggedReference {
    /// The reference of a uniformly sampled log with the sampling period
    /// `period` (s).
    ///
    /// Without `velocity_ref_m_s` the velocity is that of the cubic spline through the
    /// positions. Without `acceleration_ref_m_s2` the acceleration is that of the spline
    /// through the velocities or, if there are none, that of the spline through the
    /// velocities of the positions. As a derivative makes much of the last digit that a log
    /// has, it is taken of the smoothest series that is as far from the logged one as this
    /// is noisy: one in steps of 1 µm at 1 kHz has its acceleration to some mm/s², where
    /// differences would be off by a m/s².
    ///
    /// # Errors
    /// [`ReplayError::Log`] without `position_ref_m`; [`ReplayError::Period`].
    pub fn new(log: &Log, period: f64) -> Result<Self, ReplayError> {
        if !(period.is_finite() && period > 0.0) {
            return Err(ReplayError::Period { period });
        }
        let position = reference_in(log)?;
        let of = |linear: &str, rotary: &str| log.channel(linear).or(log.channel(rotary)).ok();
        let velocity = of("velocity_ref_m_s", "velocity_ref_rad_s");
        let curvatures = match velocity {
            Some(velocity) => slopes(&smooth(velocity, 2), period),
            None => slopes(&slopes(&smooth(position, 3), period), period),
        };
        let acceleration = of("acceleration_ref_m_s2", "acceleration_ref_rad_s2");
        let acceleration = SampledCurve::spline(acceleration.unwrap_or(&curvatures), period);
        let velocity = velocity.map_or_else(|| slopes(position, period), <[f64]>::to_vec);
        Ok(Self {
            position: SampledCurve::through(position.to_vec(), velocity, curvatures, period),
            acceleration,
        })
    }

    /// The reference that the drive had, where the log shows it late by `time` (s).
    pub(super) fn ahead_by(&self, time: f64) -> Ahead<'_> {
        Ahead { logged: self, time }
    }

    /// Its sampling period, s.
    pub(super) fn period(&self) -> f64 {
        self.position.period
    }
}

impl Motion for LoggedReference {
    fn duration(&self) -> f64 {
        self.position.duration()
    }

    fn at(&self, t: f64) -> Setpoint {
        if t.is_nan() {
            return Setpoint::at_rest(self.position.values()[0]);
        }
        let [position, velocity] = self.position.at(t);
        let is_over = t <= -self.period() || t >= self.duration() + self.period();
        let [acceleration, jerk] = match is_over {
            true => [0.0; 2],
            false => self.acceleration.at(t),
        };
        Setpoint {
            position,
            velocity,
            acceleration,
            jerk,
        }
    }
}

/// A logged reference some time before the log shows it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ahead<'a> {
    logged: &'a LoggedReference,
    time: f64,
}

impl Motion for Ahead<'_> {
    fn duration(&self) -> f64 {
        self.logged.duration()
    }

    fn at(&self, t: f64) -> Setpoint {
        self.logged.at(t + self.time)
    }
}
