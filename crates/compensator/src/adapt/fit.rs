//! Gauss–Newton on one record: the most probable parameters of it and of what was known.

use std::vec::Vec;

use super::coordinates::GAP;
use super::information::{information_from, inverse};
use super::known::{ALL, Column, Information, Known};
use super::parameter::{COUNT, Theta};
use super::record::Record;
use super::residual::Residuals;

/// Most Gauss–Newton steps.
const STEPS: usize = 30;
/// A step below this share of the standard error ends them.
const CLOSE: f64 = 1e-2;
/// A step is halved down to this share of it.
const SHORTEST: f64 = 1e-3;

/// What a record says.
pub(super) struct Fit {
    pub estimate: Theta,
    /// Of the record and of what was known, the prior left out.
    pub information: Information,
    /// Posterior variances, the prior included.
    pub variances: Theta,
    /// RMS of the torque balance before and after, weighed as in the fit, N·m.
    pub weighed: [f64; 2],
    /// RMS of it after, N·m.
    pub left: f64,
    /// Free travel of the transmission and its standard error, rad at the motor.
    pub gap: Option<[f64; 2]>,
}

impl Known<'_> {
    /// The most probable parameters of what was known and the record.
    pub fn fit(&self, record: &Record) -> Fit {
        let mut at = Column::zeros();
        for i in 0..COUNT {
            at[i] = self.estimate[i];
        }
        at[GAP] = self.gap[0];
        let free: Vec<usize> = (0..ALL).filter(|&i| self.free(record, i)).collect();
        let start = Residuals::at(self.assumed, record, &at, &free);
        let mut weights = start.weights(free.len(), true);
        let mut residuals = start.clone();
        let mut settled = 0;
        for _ in 0..STEPS {
            let (gradient, curvature) = self.normal(record, &at, &residuals, &weights);
            let held = |i: &usize| {
                let [least, most] = self.bounds(*i);
                (at[*i] <= least && gradient[*i] > 0.0) || (at[*i] >= most && gradient[*i] < 0.0)
            };
            let moving: Vec<usize> = free.iter().copied().filter(|i| !held(i)).collect();
            let Some(inverse) = inverse(&curvature, &moving) else {
                break;
            };
            let step = -(inverse * gradient);
            let before = self.cost(record, [&at, &at], &free) + residuals.square(&weights);
            let mut share = 1.0;
            let mut better = None;
            while share > SHORTEST && better.is_none() {
                let mut next = at + share * step;
                for i in 0..ALL {
                    let [least, most] = self.bounds(i);
                    next[i] = next[i].clamp(least, most);
                }
                let there = Residuals::at(self.assumed, record, &next, &free);
                let cost = self.cost(record, [&next, &at], &free) + there.square(&weights);
                // Not a number is no improvement.
                if cost <= before {
                    better = Some((next, there));
                }
                share *= 0.5;
            }
            let small = |i: &usize| step[*i].abs() <= CLOSE * inverse[(*i, *i)].sqrt();
            let close = moving.iter().all(small);
            let stuck = better.is_none();
            if let Some((next, there)) = better {
                (at, residuals) = (next, there);
            }
            if close || stuck {
                settled += 1;
                if settled > 2 {
                    break;
                }
            }
            // First all alike, then by what is left: weights of residuals that are far off
            // would keep them there.
            weights = residuals.weights(free.len(), settled == 0);
        }
        let weights = residuals.weights(free.len(), false);
        let (information, variances, gap) =
            information_from(self, record, &at, (&residuals, &weights), &free);
        Fit {
            estimate: std::array::from_fn(|i| at[i]),
            information,
            variances,
            weighed: [&start, &residuals].map(|r| r.weighed(&weights[0])),
            left: residuals.rms(),
            gap,
        }
    }
}
