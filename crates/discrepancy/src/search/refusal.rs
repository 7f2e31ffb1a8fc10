//! What makes check motion worse is not given.

use axis_sim::ReplayError;

use super::state::Search;
use super::types::{Refused, RunnerUp};
use crate::gap::worsened;
use crate::model::{LogSet, State};
use crate::noise::floors;

impl Search<'_> {
    /// The effects, where check motion is further off with them than without: than with
    /// the machine as its file says (`as_filed`), or with its known parameters fitted
    /// (`without`).
    pub(super) fn refused(
        &self,
        as_filed: &LogSet,
        without: &Self,
    ) -> Result<Option<Refused>, ReplayError> {
        if self.named.is_empty() {
            return Ok(None);
        }
        let set = &self.check_logs;
        let after = set.rest(&self.check.traces);
        let floors = floors(self.machine, set, &self.check.state, &after)?;
        let initial = State::initial(self.machine);
        let befores = [
            as_filed.rest(&as_filed.simulate(self.machine, &initial)?),
            without.check_logs.rest(&without.check.traces),
        ];
        for before in &befores {
            if let Some(channels) = worsened(set, before, &after, &floors) {
                tracing::debug!(?channels, "check motion is further off");
                return Ok(Some(Refused {
                    effects: self.named.clone(),
                    channels,
                }));
            }
        }
        Ok(None)
    }

    /// With this said of what was tried.
    pub(super) fn with_refused(mut self, refused: Refused) -> Self {
        let runner_up = |n: &super::types::Named| RunnerUp {
            name: n.name,
            gain: n.evidence,
        };
        self.leftover = refused.effects.iter().map(runner_up).collect();
        self.refused = Some(refused);
        self
    }
}
