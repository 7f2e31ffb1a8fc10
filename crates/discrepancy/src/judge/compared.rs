//! Measured and simulated logs of a discovery, before and after.

use std::borrow::Cow;

use axis_sim::{Axis, ReplayError, Trace};

use super::left::Left;
use crate::answers::{LogSet, Rest, State};
use crate::name::gap::{Gap, furthest_above, gap};
use crate::name::search::Found;
use crate::noise::{Hum, Simulated, SlowNoise, floors, slow_noise};

/// The logs that a discovery is judged by, with the machine as its file says and as it was found.
pub(super) struct Compared<'a> {
    pub(super) machine: &'a Axis,
    pub(super) found: &'a Found,
    /// Gap on the fitted logs.
    pub(super) fit_gap: Gap,
    /// The fitted log whose residual is furthest above its floor, and how many times.
    pub(super) fit_above: Option<(usize, f64)>,
    /// The logs that are judged by, with the defects of the machine as filed.
    pub(super) as_filed: Cow<'a, LogSet>,
    /// The same with those of the machine as found.
    pub(super) set: &'a LogSet,
    /// What the machine leaves of them as its file says.
    pub(super) before: Rest,
    /// Simulated with all that was found.
    pub(super) traces: Vec<Trace>,
    /// What these leave.
    pub(super) after: Rest,
    /// Slow noise of their logger.
    pub(super) slow: SlowNoise,
    /// Their gap, and the noise it is judged by.
    pub(super) left: Left,
    /// By how many times the residual is above its floor at most.
    pub(super) above: f64,
}

impl<'a> Compared<'a> {
    /// Of the logs that took no part in the search, if there are such ([`Found::tested_on`]), or else of the check logs.
    pub(super) fn new(
        machine: &'a Axis,
        [fit_logs, check_logs]: [&LogSet; 2],
        found: &'a Found,
    ) -> Result<Self, ReplayError> {
        let (initial, full) = (State::initial(machine), &found.fit.state);
        // Before: as the file says. After: with the defects of the fitted machine.
        let before_of = |set: &LogSet| -> Result<Rest, ReplayError> {
            Ok(set.rest(&set.simulate(machine, &initial)?))
        };
        let (fit_gap, fit_above) = {
            let set = &found.fit_logs;
            let traces = set.simulate(machine, full)?;
            let after = set.rest(&traces);
            let slow = slow_noise(machine, set, full, &traces)?;
            let floors = slow.beside_floors(set, floors(machine, set, full, &after)?);
            let before = before_of(&Hum::as_in(set, fit_logs))?;
            let above = furthest_above(set, &after, &floors);
            (gap(set, &before, &after, &floors), above)
        };
        let (as_filed, set) = match &found.test {
            Some(test) => (Cow::Borrowed(&test.as_filed), &test.fitted),
            None => {
                let set = &found.check_logs;
                (Cow::Owned(Hum::as_in(set, check_logs)), set)
            }
        };
        let before = before_of(&as_filed)?;
        let traces = set.simulate(machine, full)?;
        let after = set.rest(&traces);
        let slow = slow_noise(machine, set, full, &traces)?;
        let floors = slow.beside_floors(set, floors(machine, set, full, &after)?);
        let above = furthest_above(set, &after, &floors).map_or(0.0, |(_, times)| times);
        let fitted = (&found.fit_logs, found.fit.traces.as_slice());
        let rests = [&before, &after];
        let left = Left::of(machine, full, fitted, (set, &traces), rests, floors, &slow)?;
        Ok(Self {
            machine,
            found,
            fit_gap,
            fit_above,
            as_filed,
            set,
            before,
            traces,
            after,
            slow,
            left,
            above,
        })
    }

    /// All that was found.
    pub(super) fn state(&self) -> &'a State {
        &self.found.fit.state
    }

    /// The fitted logs and their simulations.
    pub(super) fn fitted(&self) -> Simulated<'a> {
        (&self.found.fit_logs, self.found.fit.traces.as_slice())
    }

    /// The logs that are judged by, and their simulations.
    pub(super) fn checked(&self) -> Simulated<'_> {
        (self.set, &self.traces)
    }
}
