//! The search for gains: starts, cost, and what the limits are held against.

use compensator::Drive;
use rayon::prelude::*;

use crate::error::LoopError;
use crate::law::LoopGains;
use crate::loops::{CornerLoop, Sensitivities};
use crate::plant::Corner;
use crate::search::least;
use crate::set::AxisLoops;
use crate::tune_settings::TuneSettings;
use crate::tuned_gains::{LoopFigures, TunedGains};
use crate::turn::radius;

/// Widths of the symmetric optimum from which the search starts.
const WIDTHS: [f64; 3] = [2.5, 4.0, 7.0];
/// Evaluations of each start, and of the best after that.
const COARSE: usize = 120;
const FINE: usize = 260;
/// Cost of a constraint, per logarithm of how far it is exceeded: more than any gain is worth.
const EXCESS: f64 = 30.0;
/// Cost of a loop that is not stable.
const UNSTABLE: f64 = 1e3;
/// Share by which limits are kept in the search, for the peaks between two frequencies of the grid.
const KEPT: f64 = 0.998;

/// Limits of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    pub sensitivity: [f64; 2],
    pub ripple: f64,
}

impl Limits {
    pub fn of(settings: &TuneSettings, by: f64) -> Self {
        // Lowered towards 1, which no loop is below.
        let lower = |most: f64| 1.0 + (most - 1.0) * by;
        Self {
            sensitivity: [
                lower(settings.sensitivity),
                lower(settings.sensitivity_late),
            ],
            ripple: settings.ripple,
        }
    }
}

impl AxisLoops {
    /// The best gains within the limits, and how many evaluations that took: from several starts, or
    /// from `near` alone.
    pub fn tuned(
        &self,
        limits: &Limits,
        near: Option<&LoopGains>,
    ) -> Result<(LoopGains, usize), LoopError> {
        let starts = match near {
            Some(gains) => vec![*gains],
            None => {
                let own = self.gains();
                let optimum = WIDTHS.map(|a| self.symmetric_optimum(a));
                optimum.into_iter().chain([own]).collect()
            }
        };
        let mut evaluations = 0;
        let mut cost = |x: &[f64]| {
            evaluations += 1;
            self.cost(&self.gains_of(x), limits)
        };
        let found = starts.iter().map(|gains| {
            let x = numbers(gains);
            least(&mut cost, &x, 0.35, 1e-4, COARSE)
        });
        let mut best = found
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or_else(|| (numbers(&self.gains()), f64::INFINITY));
        for size in [0.12, 0.03] {
            let next = least(&mut cost, &best.0, size, 1e-7, FINE);
            if next.1 < best.1 {
                best = next;
            }
        }
        let mut gains = self.gains_of(&best.0);
        // What little of a limit the cost leaves, and peaks between two frequencies of the grid.
        for _ in 0..40 {
            if self.keeps(&gains, limits) {
                return Ok((gains, evaluations));
            }
            gains.speed *= 0.99;
            gains.integral *= 0.99 * 0.99;
            gains.position *= 0.99;
        }
        let figures = self.figures(&gains);
        Err(LoopError::NoGains {
            most: limits.sensitivity[0],
            most_late: limits.sensitivity[1],
            found: figures.sensitivity.unwrap_or(f64::INFINITY),
            found_late: figures.sensitivity_late.unwrap_or(f64::INFINITY),
        })
    }

    fn gains_of(&self, x: &[f64]) -> LoopGains {
        let speed = x[0].exp();
        LoopGains {
            speed,
            position: x[1].exp(),
            integral: match (self.model.integrates(), x.get(2)) {
                (true, Some(time)) => speed / time.exp(),
                _ => 0.0,
            },
        }
    }

    /// k_p = J/(a T_Σ K), T_n = a² T_Σ, k_v = 1/(8 a T_Σ).
    fn symmetric_optimum(&self, a: f64) -> LoopGains {
        let (model, passage) = (&self.model.model, self.model.passage());
        let period = model.period;
        let inner = match &model.drive {
            Drive::Lag { bandwidth, .. } => 1.0 / bandwidth,
            Drive::FieldOriented { motor, q, late, .. } => {
                motor.parameters().inductance_q / q[0] + (late + 0.5) * period
            }
        };
        let speed_period = f64::from(passage.speed_every.max(1)) * period;
        let mut small = inner + model.delay + 0.5 * speed_period;
        if self.model.sensing.by_differences {
            small += 0.5 * speed_period;
        }
        let speed = self.inertia / (a * small * model.torque_constant());
        LoopGains {
            speed,
            integral: match self.model.integrates() {
                true => speed / (a * a * small),
                false => 0.0,
            },
            position: 1.0 / (8.0 * a * small) / model.travel,
        }
    }

    /// What the search makes least.
    fn cost(&self, gains: &LoopGains, limits: &Limits) -> f64 {
        let excess = self.excess(gains, limits);
        if excess.is_infinite() {
            return UNSTABLE;
        }
        self.objective(gains) + EXCESS * excess.max(0.0)
    }

    /// Logarithm by which the worst constraint is exceeded; infinite where a corner is unstable.
    fn excess(&self, gains: &LoopGains, limits: &Limits) -> f64 {
        let of = |s: Sensitivities| {
            let most = |pair: [f64; 2]| pair[0].max(pair[1]);
            let [now, late] = limits.sensitivity;
            (most(s.now) / now).max(most(s.late) / late)
        };
        let all: Vec<f64> = self
            .corners
            .par_iter()
            .map(|corner| of(corner.sensitivities(gains)))
            .collect();
        let mut worst = all.into_iter().fold(0.0, f64::max) / KEPT;
        if limits.ripple.is_finite() {
            worst = worst.max(self.corners[0].ripple(&self.model, gains) / limits.ripple);
        }
        worst.ln()
    }

    /// Whether these gains are within the limits, peaks between the frequencies of the grid
    /// included, with the greatest eigenvalue below 1 in every corner.
    fn keeps(&self, gains: &LoopGains, limits: &Limits) -> bool {
        if self.excess(gains, limits) > 0.0 {
            return false;
        }
        let [now, late] = self.peaks(gains);
        let [most, most_late] = limits.sensitivity;
        let is_stable = |corner: &CornerLoop| radius(&self.model, corner, gains) < 1.0;
        now <= most && late <= most_late && self.corners.par_iter().all(is_stable)
    }

    /// Maximum sensitivity of all corners at either cut, and with one more cycle of delay;
    /// infinite where one is unstable.
    fn peaks(&self, gains: &LoopGains) -> [f64; 2] {
        let all: Vec<[f64; 2]> = self
            .corners
            .par_iter()
            .map(|corner| corner.peaks(&self.model, gains))
            .collect();
        let most = |[now, late]: [f64; 2], peaks: [f64; 2]| [now.max(peaks[0]), late.max(peaks[1])];
        all.into_iter().fold([0.0; 2], most)
    }

    /// Mean over the file's mass of the logarithm of the compliance.
    fn compliance(&self, gains: &LoopGains) -> f64 {
        let own = |at: &Corner| at.mass == self.corners[0].at.mass;
        // Measured corners have limits to keep; what a force does to them the model alone knows.
        let corners = self
            .corners
            .iter()
            .filter(|c| own(&c.at) && !c.is_measured());
        let corners: Vec<_> = corners.collect();
        let all: Vec<f64> = corners
            .par_iter()
            .map(|corner| corner.compliance_rms(gains).ln())
            .collect();
        all.iter().sum::<f64>() / all.len() as f64
    }

    fn slope(&self, gains: &LoopGains) -> Option<f64> {
        let model = &self.model.model;
        let integral = gains.integral * gains.position * model.travel * model.torque_constant();
        let slope = std::f64::consts::TAU * model.travel * model.travel / integral;
        (gains.integral > 0.0).then_some(slope)
    }

    fn objective(&self, gains: &LoopGains) -> f64 {
        let slope = self.slope(gains).map_or(0.0, f64::ln);
        0.5 * slope + self.compliance(gains)
    }

    /// Figures of these gains.
    pub fn figures(&self, gains: &LoopGains) -> LoopFigures {
        let [now, late] = self.peaks(gains).map(|s| s.is_finite().then_some(s));
        let own = &self.corners[0];
        let peak = own.points.iter().map(|p| p.compliance(gains).norm());
        LoopFigures {
            sensitivity: now,
            sensitivity_late: late,
            compliance_slope: self.slope(gains),
            compliance_rms: self.compliance(gains).exp(),
            compliance_peak: peak.fold(0.0, f64::max),
            ripple: own.ripple(&self.model, gains),
            objective: self.objective(gains),
        }
    }

    pub fn shown(&self, gains: &LoopGains, fed: f64, notch: Option<f64>) -> TunedGains {
        TunedGains {
            kv_per_s: gains.position * self.model.model.travel,
            speed_proportional: gains.speed,
            integral_time_s: (gains.integral > 0.0).then(|| gains.speed / gains.integral),
            acceleration_feedforward: fed,
            notch_hz: notch,
        }
    }
}

/// The numbers that are searched for: logarithms of k_p, of k_v/r and, where there is an integral, of
/// T_n.
fn numbers(gains: &LoopGains) -> Vec<f64> {
    let mut all = vec![gains.speed.ln(), gains.position.ln()];
    if gains.integral > 0.0 {
        all.push((gains.speed / gains.integral).ln());
    }
    all
}
