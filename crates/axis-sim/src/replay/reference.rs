//! The reference of a log.

use axis_log::Log;
use trajectories::{Motion, Setpoint};

use super::ReplayError;
use crate::balance::LowPass;
use crate::channels::reference_in;

/// A logged reference as a motion: cubic between samples, through positions
/// and velocities.
#[derive(Clone, Debug)]
pub struct LoggedReference {
    pub(super) period: f64,
    /// Time by which the log shows it late, s.
    pub(super) late: f64,
    position: Vec<f64>,
    velocity: Vec<f64>,
    /// Whether the velocity was logged, and is not that of the spline.
    is_logged: bool,
}

impl LoggedReference {
    /// The reference of a uniformly sampled log with the sampling period
    /// `period` (s). Without `velocity_ref_m_s` the velocity is that of the cubic spline
    /// through the positions.
    ///
    /// # Errors
    /// [`ReplayError::Log`] without `position_ref_m`; [`ReplayError::Period`].
    pub fn new(log: &Log, period: f64) -> Result<Self, ReplayError> {
        if !(period.is_finite() && period > 0.0) {
            return Err(ReplayError::Period { period });
        }
        let position = reference_in(log)?.to_vec();
        let logged = log.channel("velocity_ref_m_s");
        let logged = logged.or(log.channel("velocity_ref_rad_s")).ok();
        let is_logged = logged.is_some();
        let velocity = logged.map_or_else(|| slopes(&position, period), <[f64]>::to_vec);
        Ok(Self {
            period,
            late: 0.0,
            position,
            velocity,
            is_logged,
        })
    }

    /// With positions and velocities like these at its samples.
    fn with(self, position: Vec<f64>, velocity: impl FnOnce() -> Vec<f64>) -> Self {
        let velocity = match self.is_logged {
            true => velocity(),
            false => slopes(&position, self.period),
        };
        Self {
            position,
            velocity,
            ..self
        }
    }

    /// The same, sampled so much after each of its instants, s.
    pub(super) fn sampled_off(&self, by: &[f64]) -> Self {
        let read = |k: usize| {
            let off = by.get(k).copied().unwrap_or(0.0);
            self.at(k as f64 * self.period - self.late + off)
        };
        let read: Vec<Setpoint> = (0..self.position.len()).map(read).collect();
        let position = read.iter().map(|at| at.position).collect();
        let velocity = || read.iter().map(|at| at.velocity).collect();
        self.clone().with(position, velocity)
    }

    /// The same without what is faster than a tenth of its rate, where of a motion's corners nothing is lost
    /// that matters, and of noise most of what its derivatives show.
    pub(super) fn smoothed(self) -> Self {
        let filter = LowPass::new(SMOOTH);
        let position = filter.apply(&self.position);
        let velocity = self.velocity.clone();
        self.with(position, || filter.apply(&velocity))
    }
}

/// Cut-off of a smoothed reference, as a share of its rate.
const SMOOTH: f64 = 0.1;

/// Slopes at its knots of the cubic spline through samples, at rest at both ends or, where
/// it begins or ends in motion, with the slope of the first or last step there:
///
/// ```text
/// s(k−1) + 4 s(k) + s(k+1) = 3 (x(k+1) − x(k−1)) / h
/// ```
///
/// A wave of the frequency ω comes out off by (ω h)⁴/180, where a central difference is off
/// by (ω h)²/6: at 90 Hz and 1 kHz 0.06 instead of 5 %, which would be found as a
/// controller's gain.
fn slopes(samples: &[f64], period: f64) -> Vec<f64> {
    let last = samples.len() - 1;
    let step = |k: usize| (samples[k + 1] - samples[k]) / period;
    if last < 2 {
        return vec![if last == 0 { 0.0 } else { step(0) }; samples.len()];
    }
    // Thomas' algorithm; the matrix is diagonally dominant.
    let mut slopes = vec![0.0; samples.len()];
    slopes[0] = step(0);
    let mut factors = vec![0.0; samples.len()];
    for k in 1..last {
        let right = 3.0 * (samples[k + 1] - samples[k - 1]) / period;
        let pivot = 4.0 - factors[k - 1];
        factors[k] = 1.0 / pivot;
        slopes[k] = (right - slopes[k - 1]) / pivot;
    }
    slopes[last] = step(last - 1);
    for k in (1..last).rev() {
        slopes[k] -= factors[k] * slopes[k + 1];
    }
    slopes
}

impl Motion for LoggedReference {
    fn duration(&self) -> f64 {
        (self.position.len() - 1) as f64 * self.period
    }

    fn at(&self, t: f64) -> Setpoint {
        if t.is_nan() {
            return Setpoint::at_rest(self.position[0]);
        }
        let t = t + self.late;
        let last = self.position.len() - 1;
        let along = (t / self.period).clamp(0.0, last as f64);
        // The nearest sample; of numbers from 0 on a cast is faster than a call of `round`.
        let k = (along + 0.5) as usize;
        if (along - k as f64).abs() < 1e-6 {
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

#[cfg(test)]
mod tests {
    use super::slopes;

    #[test]
    fn slopes_of_a_wave_are_off_by_the_fourth_order() {
        let (h, frequency) = (1e-3, 90.0 * std::f64::consts::TAU);
        let at = |k: usize| (frequency * k as f64 * h).sin();
        let samples: Vec<f64> = (0..400).map(at).collect();
        let bound = 1.1 * (frequency * h).powi(4) / 180.0;
        for (k, slope) in slopes(&samples, h)
            .into_iter()
            .enumerate()
            .skip(20)
            .take(360)
        {
            let exact = (frequency * k as f64 * h).cos();
            assert!((slope / frequency - exact).abs() < bound, "{k}");
        }
    }

    #[test]
    fn a_line_has_one_slope() {
        let samples: Vec<f64> = (0..50).map(|k| 0.3 - 2e-3 * f64::from(k)).collect();
        assert!(
            slopes(&samples, 1e-2)
                .iter()
                .all(|s| (s + 0.2).abs() < 1e-12)
        );
        assert_eq!(slopes(&[1.0], 1.0), [0.0]);
        assert_eq!(slopes(&[1.0, 3.0], 1.0), [2.0, 2.0]);
    }
}
