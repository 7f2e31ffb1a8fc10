//! The reference of a log.

use axis_log::Log;
use trajectories::{Motion, Setpoint};

use super::ReplayError;
use super::curve::{Curve, slopes};
use super::smooth::smooth;
use crate::balance::LowPass;
use crate::channels::reference_in;

/// A logged reference as a motion: cubic between samples, through positions
/// and velocities; its acceleration a spline.
#[derive(Clone, Debug)]
pub struct LoggedReference {
    position: Curve,
    /// The acceleration, whose slope is the jerk.
    acceleration: Curve,
    /// Time by which the log shows it late, s.
    pub(super) late: f64,
    /// Whether the velocity was logged, and is not that of the spline.
    is_logged: bool,
}

impl LoggedReference {
    /// The reference of a uniformly sampled log with the sampling period
    /// `period` (s).
    ///
    /// Without `velocity_ref_m_s` the velocity is that of the cubic spline through the
    /// positions. Without `acceleration_ref_m_s2` the acceleration is that of the spline
    /// through the velocities or, where there are none, that of the spline through the
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
        let acceleration = of("acceleration_ref_m_s2", "acceleration_ref_rad_s2");
        let acceleration = match (acceleration, velocity) {
            (Some(logged), _) => logged.to_vec(),
            (None, Some(velocity)) => slopes(&smooth(velocity, 2), period),
            (None, None) => slopes(&slopes(&smooth(position, 3), period), period),
        };
        let is_logged = velocity.is_some();
        let velocity = velocity.map_or_else(|| slopes(position, period), <[f64]>::to_vec);
        Ok(Self {
            position: Curve::through(position.to_vec(), velocity, period),
            acceleration: Curve::spline(&acceleration, period),
            late: 0.0,
            is_logged,
        })
    }

    /// Its sampling period, s.
    pub(super) fn period(&self) -> f64 {
        self.position.period
    }

    /// With positions, velocities and accelerations like these at its samples.
    fn with(&self, position: Vec<f64>, velocity: Vec<f64>, acceleration: &[f64]) -> Self {
        let period = self.period();
        let velocity = match self.is_logged {
            true => velocity,
            false => slopes(&position, period),
        };
        Self {
            position: Curve::through(position, velocity, period),
            acceleration: Curve::spline(acceleration, period),
            ..*self
        }
    }

    /// The same, sampled so much after each of its instants, s.
    pub(super) fn sampled_off(&self, by: &[f64]) -> Self {
        let read = |k: usize| {
            let off = by.get(k).copied().unwrap_or(0.0);
            self.at(k as f64 * self.period() - self.late + off)
        };
        let read: Vec<Setpoint> = (0..self.position.values().len()).map(read).collect();
        let of = |value: fn(&Setpoint) -> f64| -> Vec<f64> { read.iter().map(value).collect() };
        self.with(
            of(|s| s.position),
            of(|s| s.velocity),
            &of(|s| s.acceleration),
        )
    }

    /// The same without what is faster than a tenth of its rate, where of a motion's corners nothing is lost
    /// that matters, and of noise most of what its derivatives show.
    pub(super) fn smoothed(&self) -> Self {
        let filter = LowPass::new(SMOOTH);
        let of = |series: &[f64]| filter.apply(series);
        self.with(
            of(self.position.values()),
            of(self.position.slopes()),
            &of(self.acceleration.values()),
        )
    }
}

/// Cut-off of a smoothed reference, as a share of its rate.
const SMOOTH: f64 = 0.1;

impl Motion for LoggedReference {
    fn duration(&self) -> f64 {
        self.position.duration()
    }

    fn at(&self, t: f64) -> Setpoint {
        if t.is_nan() {
            return Setpoint::at_rest(self.position.values()[0]);
        }
        let t = t + self.late;
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
