//! How well a search knows what it found.

use super::types::SIMULATED;
use axis_sim::ReplayError;
use axis_sim::effects::{ActiveEffect, Measure, Nature};
use nalgebra::DMatrix;

use super::form::own_friction;
use super::is_form::is_form;
use super::state::Search;
use super::types::Found;
use crate::answers::is_form_of;
use crate::estimate::columns::{Columns, free_parameters};
use crate::estimate::fit::Fit;
use crate::estimate::interval::Spread;
use crate::estimate::known::tolerances;
use crate::estimate::spread::{drawn, spreads};
use crate::spectrum::Amplitudes;

/// How well the parameters of a fit are known.
pub(super) struct Intervals {
    pub(super) columns: Columns,
    covariance: DMatrix<f64>,
    pub(super) noise: Vec<Amplitudes>,
    spreads: Vec<Spread>,
}

impl Intervals {
    /// Half width of the 95 % interval of a parameter of this value, by its place.
    pub(super) fn half_width(&self, index: usize, value: f64) -> f64 {
        self.spreads[index].half_width(SIMULATED * value)
    }
}

impl Search<'_> {
    /// Derivatives, covariance and spread of all parameters at the end.
    pub(super) fn intervals(&self) -> Result<Intervals, ReplayError> {
        let columns = self.own_columns();
        let fitter = self.fitter();
        let covariance = fitter.solve(&self.fit, &columns).covariance;
        let noise = drawn(&fitter, &self.fit)?;
        let mut spreads = spreads(&fitter, &self.fit, &columns, &covariance, &noise);
        self.widen_by_own_friction(&mut spreads);
        self.widen_by_gaps(&mut spreads);
        Ok(Intervals {
            spreads,
            columns,
            covariance,
            noise,
        })
    }

    /// What tells a dry friction from the axis' own is its onset. Where that has another form
    /// than the library's, it tells nothing, and the tolerance of the own one counts in full.
    fn widen_by_own_friction(&self, spreads: &mut [Spread]) {
        let Some(own) = own_friction(self.machine) else {
            return;
        };
        let known = self.machine.known();
        let levels = ["coulomb_level", "coulomb"];
        let Some(level) = known.iter().position(|name| levels.contains(name)) else {
            return;
        };
        let most = tolerances(self.machine)[level] * own.values[0];
        let effects = &self.fit.state.effects;
        let has_form = |of: &ActiveEffect| effects.iter().any(|a| is_form_of(a, of));
        let everywhere = |of: &ActiveEffect| {
            (of.effect.place_of(|n| matches!(n, Nature::Place(_)))).is_none() && !is_form(of)
        };
        for (i, (e, p)) in free_parameters(&self.fit.state).into_iter().enumerate() {
            let active = &effects[e];
            let is_force = active.effect.parameters[p].measure == Measure::Force;
            if is_force && everywhere(active) && has_form(active) {
                let leans = &mut spreads[known.len() + i].of_known[level];
                *leans = leans.abs().max(most);
            }
        }
    }

    /// An instant at which no log tells anything, as a balance of a load that stands, may lie
    /// anywhere between the samples about it.
    fn widen_by_gaps(&self, spreads: &mut [Spread]) {
        if !self.fit_logs.is_balanced() {
            return;
        }
        let known = self.machine.known().len();
        for (i, (e, p)) in free_parameters(&self.fit.state).into_iter().enumerate() {
            let active = &self.fit.state.effects[e];
            let is_instant = matches!(
                active.effect.parameters[p].nature,
                Nature::Begin(_) | Nature::End(_)
            );
            let logs = self.fit_logs.logs.iter();
            let reach = logs.filter_map(|log| reach(log.log.time(), active.values[p]));
            if let Some(reach) = reach.min_by(f64::total_cmp).filter(|_| is_instant) {
                let spread = &mut spreads[known + i];
                // Uniform over the gap.
                spread.of_noise = spread.of_noise.hypot(reach / 3.0_f64.sqrt());
            }
        }
    }

    pub(super) fn finish(self, base: Fit, intervals: Intervals) -> Found {
        let Intervals {
            columns,
            covariance,
            spreads,
            noise,
        } = intervals;
        Found {
            spreads,
            base,
            columns,
            covariance,
            noise,
            fit: self.fit,
            named: self.named,
            replaced: self.replaced,
            within_error: self.within_error,
            refused: self.refused,
            leftover: self.leftover,
            library: self.library,
            fit_logs: self.fit_logs,
            check_logs: self.check_logs,
            hum: self.hum,
            test: None,
        }
    }
}

/// How far an instant is from the farther of the samples about it; `None` where it is not between
/// two.
fn reach(times: &[f64], instant: f64) -> Option<f64> {
    let next = times.partition_point(|&t| t <= instant);
    let before = times.get(next.checked_sub(1)?)?;
    Some((instant - before).max(times.get(next)? - instant))
}

#[cfg(test)]
mod tests {
    use super::reach;

    #[test]
    fn an_instant_is_known_to_the_gap_that_it_lies_in() {
        let times = [0.0, 0.1, 0.2, 0.9, 1.0];
        assert_eq!(reach(&times, 0.25), Some(0.9 - 0.25));
        assert_eq!(reach(&times, 0.2), Some(0.7));
        assert_eq!([-0.1, 1.0].map(|t| reach(&times, t)), [None; 2]);
    }
}
