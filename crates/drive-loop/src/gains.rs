//! The search for gains: starts, cost, and what the limits are held against.

use compensator::Drive;
use rayon::prelude::*;

use crate::error::LoopError;
use crate::law::LoopGains;
use crate::linear::{Worth, least_within};
use crate::loops::{CornerLoop, Sensitivities};
use crate::plant::Corner;
use crate::search::least;
use crate::set::AxisLoops;
use crate::tune_settings::TuneSettings;
use crate::tuned_gains::{LoopFigures, TunedGains};
use crate::turn::radius;

/// Widths of the symmetric optimum from which the search starts.
const WIDTHS: [f64; 3] = [2.5, 4.0, 7.0];
/// Edges of the simplex from a start.
const WIDE: f64 = 0.35;
/// Evaluations of each turn of the simplex, and of the steps along the limits.
const SIMPLEX: usize = 120;
const STEPS: usize = 200;
/// Cost of a constraint, per logarithm of how far it is exceeded: more than any gain is worth.
const EXCESS: f64 = 30.0;
/// Cost of a loop that is not stable.
const UNSTABLE: f64 = 1e3;
/// Share of the limits that is searched within at first, for the peaks between two frequencies of the grid;
/// share of them that the found peaks are brought to, with edges of the simplex for each time that takes.
const KEPT: f64 = 0.998;
const REACHED: f64 = 0.9998;
const BROUGHT: [f64; 4] = [0.15, 0.03, 0.03, 0.03];
/// Improvement of the cost below which another round of the search is not worth its time.
const IMPROVED: f64 = 2e-5;
const ROUNDS: usize = 4;

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

    /// A share of the limits of the sensitivity.
    fn tightened(&self, share: f64) -> Self {
        Self {
            sensitivity: self.sensitivity.map(|most| share * most),
            ripple: self.ripple,
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
        let mut search = |from: &[f64], limits: &Limits, size: f64| {
            let (found, used) = self.searched(from, limits, size);
            evaluations += used;
            found
        };
        let mut within = limits.tightened(KEPT);
        let found = starts
            .iter()
            .map(|gains| search(&numbers(gains), &within, WIDE));
        let mut best = found
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or_else(|| (numbers(&self.gains()), f64::INFINITY));
        // The peaks between the frequencies of the grid are brought to the limits.
        let mut kept: Option<LoopGains> = None;
        let mut share = KEPT;
        let mut sizes = BROUGHT.into_iter();
        loop {
            let gains = self.gains_of(&best.0);
            let better = |before: &LoopGains| self.objective(&gains) < self.objective(before);
            if self.keeps(&gains, limits) && kept.as_ref().is_none_or(better) {
                kept = Some(gains);
            }
            let [now, late] = self.peaks(&gains);
            let over = (now / limits.sensitivity[0]).max(late / limits.sensitivity[1]);
            if !over.is_finite() || (REACHED..=1.0).contains(&over) {
                break;
            }
            let Some(size) = sizes.next() else {
                break;
            };
            share = (share * 0.5 * (1.0 + REACHED) / over).min(1.0);
            within = limits.tightened(share);
            best = search(&best.0, &within, size);
        }
        if let Some(gains) = kept {
            return Ok((gains, evaluations));
        }
        // Where that does not do it: an eigenvalue of slower loops, which the grid does not see.
        let mut gains = self.gains_of(&best.0);
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

    /// The least cost that is found from a point, and the evaluations that it took. A simplex and steps along
    /// the limits take turns: the first finds the way from afar and over bends, the second along the edges
    /// in which limits meet.
    fn searched(&self, from: &[f64], limits: &Limits, size: f64) -> ((Vec<f64>, f64), usize) {
        let mut evaluations = 0;
        let (mut best, mut size) = ((from.to_vec(), f64::INFINITY), size);
        for _ in 0..ROUNDS {
            let before = best.1;
            let mut cost = |x: &[f64]| {
                evaluations += 1;
                self.cost(&self.gains_of(x), limits)
            };
            let next = least(&mut cost, &best.0, size, 1e-5, SIMPLEX);
            if next.1 < best.1 {
                best = next;
            }
            let mut worth = |x: &[f64]| {
                evaluations += 1;
                self.worth(&self.gains_of(x), limits)
            };
            let next = least_within(&mut worth, EXCESS, &best.0, 0.5 * size.abs(), STEPS);
            if next.1 < best.1 {
                best = next;
            }
            if before - best.1 < IMPROVED {
                break;
            }
            // The other direction of each edge, too.
            size *= -0.5;
        }
        (best, evaluations)
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
        let (model, signal_path) = (&self.model.model, self.model.signal_path());
        let period = model.period;
        let inner = match &model.drive {
            Drive::Lag { bandwidth, .. } => 1.0 / bandwidth,
            Drive::FieldOriented { motor, q, late, .. } => {
                motor.parameters().inductance_q / q[0] + (late + 0.5) * period
            }
        };
        let speed_period = f64::from(signal_path.speed_every.max(1)) * period;
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
        let Some(worth) = self.worth(gains, limits) else {
            return UNSTABLE;
        };
        worth.height + EXCESS * worth.excess.into_iter().fold(0.0, f64::max)
    }

    /// The objective, and the logarithms by which the limits are exceeded; none where a corner is unstable.
    fn worth(&self, gains: &LoopGains, limits: &Limits) -> Option<Worth> {
        let excess = self.excess(gains, limits)?;
        let height = self.objective(gains);
        Some(Worth { height, excess })
    }

    /// The logarithm by which each constraint is exceeded, below 0 where it is kept; none where a corner is
    /// unstable.
    fn excess(&self, gains: &LoopGains, limits: &Limits) -> Option<Vec<f64>> {
        let [now, late] = limits.sensitivity;
        let of = |s: Sensitivities| {
            let [a, b] = s.now.map(|peak| (peak / now).ln());
            let [c, d] = s.late.map(|peak| (peak / late).ln());
            [a, b, c, d]
        };
        let all: Vec<[f64; 4]> = self
            .corners
            .par_iter()
            .map(|corner| of(corner.sensitivities(gains)))
            .collect();
        let mut all = all.concat();
        if limits.ripple.is_finite() {
            let ripple = self.corners[0].ripple(&self.model, gains) / limits.ripple;
            // Without a step there is none.
            all.push(ripple.max(f64::MIN_POSITIVE).ln());
        }
        all.iter().all(|excess| excess.is_finite()).then_some(all)
    }

    /// Whether these gains are within the limits, peaks between the frequencies of the grid
    /// included, with the greatest eigenvalue below 1 in every corner.
    fn keeps(&self, gains: &LoopGains, limits: &Limits) -> bool {
        let excess = self.excess(gains, limits);
        if excess.is_none_or(|all| all.iter().any(|excess| *excess > 0.0)) {
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
