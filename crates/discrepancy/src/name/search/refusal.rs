//! What makes check motion worse is not given.

use axis_sim::{ReplayError, Trace};

use super::intervals::Intervals;
use super::state::Search;
use super::types::{Named, RefusalReason, Refused, RunnerUp};
use crate::answers::{LogSet, State};
use crate::estimate::columns::free_parameters;
use crate::name::gap::{Gap, gap, worsened};
use crate::noise::{Hum, MotionAndRest, floors};

/// Share of the gap above the noise, RMS on check motion, that all named effects together
/// must take away: what leaves more than half of it explains something else.
const LEAST_SHARE: f64 = 0.5;

/// Fall of D that is asked of a balance of which no channel stood out of its noise, as a multiple of
/// what naming takes: the noise of its motion passes through the model, and looks like evidence.
const WITHOUT_GAP: f64 = 1.5;

impl Search<'_> {
    /// The effects, where check motion is further off with them than without: than with
    /// the machine as its file says (`as_filed`), or with its known parameters fitted
    /// (`without`). Never what the engineer takes as there.
    pub(super) fn refused(
        &self,
        as_filed: &LogSet,
        without: &Self,
    ) -> Result<Option<Refused>, ReplayError> {
        if self.named.is_empty() || self.settings_ask_for_all() {
            return Ok(None);
        }
        let set = &self.check_logs;
        let after = set.rest(&self.check.traces);
        let floors = floors(self.machine, set, &self.check.state, &after)?;
        let initial = State::initial(self.machine);
        // The hum may be another since.
        let before = |logs: &LogSet, traces: &[Trace]| Hum::as_in(set, logs).rest(traces);
        let befores = [
            before(as_filed, &as_filed.simulate(self.machine, &initial)?),
            before(&without.check_logs, &without.check.traces),
        ];
        for before in &befores {
            if let Some(channels) = worsened(set, before, &after, &floors) {
                tracing::debug!(?channels, "check motion is further off");
                return Ok(Some(self.refusal(RefusalReason::Worse(channels))));
            }
        }
        let [_, calibrated] = &befores;
        let of_gap = gap(set, calibrated, &after, &floors);
        tracing::debug!(?of_gap, "of the gap on check motion");
        let share = of_gap.reduction;
        let is_little = share < LEAST_SHARE;
        // Where no channel stood out of its noise, evidence alone speaks; and what is left of a
        // replay is no gap where it is noise of another colour. In a balance noise of the motion
        // passes through the model, and follows it.
        let is_gap =
            || !of_gap.may_be_noise_apart_from_motion() || self.rest_follows_motion(&of_gap);
        let is_left = of_gap.stands_out() && (set.is_balanced() || is_gap());
        let refused = is_little && is_left;
        Ok(refused.then(|| self.refusal(RefusalReason::Little(share))))
    }

    /// What had another size on the check logs, if nothing else was named.
    pub(super) fn refused_for_size(&self) -> Option<Refused> {
        let (_, ratio) = self.untransferred.first()?;
        let effects = self.untransferred.iter().map(|(named, _)| named.clone());
        (self.effects_named() == 0).then(|| Refused {
            effects: effects.collect(),
            reason: RefusalReason::Size(*ratio),
        })
    }

    /// Whether the effects of a balance of which no channel stood out of its noise bring less than
    /// is asked then: as if nothing had been named.
    pub(super) fn lacks_evidence(&self, without: &Self) -> Result<bool, ReplayError> {
        let set = &self.check_logs;
        if self.named.is_empty() || !set.is_balanced() || self.settings_ask_for_all() {
            return Ok(false);
        }
        let after = set.rest(&self.check.traces);
        let before = without.check_logs.rest(&without.check.traces);
        let floors = floors(self.machine, set, &self.check.state, &after)?;
        let fall = without.fit.deviance - self.fit.deviance;
        let parameters = free_parameters(&self.fit.state).len();
        let is_weak = fall < WITHOUT_GAP * self.needed(parameters, 1);
        Ok(is_weak && !gap(set, &before, &after, &floors).stands_out())
    }

    /// Whether the 95 % intervals of all sizes of an effect hold zero.
    pub(super) fn may_be_nothing(&self, effect: usize, intervals: &Intervals) -> bool {
        let state = &self.fit.state;
        let parameters = state.effects[effect].effect.parameters;
        let free = free_parameters(state).into_iter().enumerate();
        let mut sizes = free.filter(|(_, (e, p))| *e == effect && parameters[*p].is_size());
        sizes.all(|(at, (e, p))| {
            let value = state.effects[e].values[p];
            value.abs() <= intervals.half_width(state.shares.len() + at, value)
        })
    }

    /// Whether what is left follows the motion, in any band of a channel that stands out of
    /// its noise.
    fn rest_follows_motion(&self, of_gap: &Gap) -> bool {
        let fit = (&self.fit_logs, self.fit.traces.as_slice());
        let check = (&self.check_logs, self.check.traces.as_slice());
        let rest = MotionAndRest::new(fit, check);
        let mut bands = self.check_logs.layout.bands();
        let stands_out = |c: usize| {
            let channel = of_gap.channels.get(self.check_logs.fitted[c]);
            channel.is_none_or(|c| !c.is_at_floor())
        };
        bands.any(|(edges, _)| rest.follows_in(edges, stands_out))
    }

    fn refusal(&self, reason: RefusalReason) -> Refused {
        let effects = self.named.iter().filter(|named| !named.is_form());
        Refused {
            effects: effects.cloned().collect(),
            reason,
        }
    }

    /// Whether the engineer takes all that is named as there.
    fn settings_ask_for_all(&self) -> bool {
        let accepted = &self.settings.accepted;
        self.named
            .iter()
            .all(|n| accepted.iter().any(|a| a == n.name))
    }

    /// With this said of what was tried.
    pub(super) fn with_refused(self, refused: Refused) -> Self {
        let search = self.with_leftover(&refused.effects);
        Self {
            refused: Some(refused),
            ..search
        }
    }

    /// With these as what was tried.
    pub(super) fn with_leftover(self, tried: &[Named]) -> Self {
        let runner_up = |n: &Named| RunnerUp {
            name: n.name,
            gain: n.evidence,
        };
        Self {
            leftover: tried.iter().map(runner_up).collect(),
            ..self
        }
    }
}
