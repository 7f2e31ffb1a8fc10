//! The logs of one search, and the search from them to its verdict.

use axis_sim::{Axis, ReplayError};
use thiserror::Error;

use crate::answers::{LogSet, Prepared, State};
use crate::controller::{OwnController, better_than_own};
use crate::judge::{Discovered, Verdict, discovery};
use crate::logs::{LogSetError, NamedLog, check_distinct, set_apart};
use crate::name::search::{Found, SearchError, Settings, dry_friction, search};

/// The logs of one search.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Fitted to.
    pub fit: LogSet,
    /// Of other motion, on which what is named must prove itself.
    pub check: LogSet,
    /// Without part in any choice, for the figures. `None` if there is none to spare: the
    /// figures then are of the check logs.
    pub test: Option<LogSet>,
    /// Those of torque balances as they were logged; none of replays.
    logs: [Vec<NamedLog>; 3],
}

/// Why logs are no evidence.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EvidenceError {
    /// The same samples in two places.
    #[error(transparent)]
    Intake(#[from] LogSetError),
    /// A log that cannot be compared with this machine, or a machine that does not run.
    #[error(transparent)]
    Replay(#[from] ReplayError),
}

/// Said where [`Evidence::resolved`] chose samples anew.
const RESOLVED: &str = "the search was made twice: the axis file states less than half of the dry friction that was found, and which samples beside reversals a torque balance can use depends on it; the figures are those of the second search";

impl Evidence {
    /// Takes logs that were looked at ([`crate::logs::admit`]). Where `test` is empty, a part
    /// of the check logs is set apart for it, if it can be ([`set_apart`]).
    ///
    /// # Errors
    /// [`EvidenceError`] if samples were given twice, or a log cannot be compared.
    pub fn new(
        machine: &Axis,
        fit: Vec<NamedLog>,
        check: Vec<NamedLog>,
        test: Vec<NamedLog>,
    ) -> Result<Self, EvidenceError> {
        for (seen, new) in [(&fit, &check), (&fit, &test), (&check, &test)] {
            check_distinct(seen, new)?;
        }
        let (check, test) = match test.is_empty() {
            true => set_apart(check, machine),
            false => (check, test),
        };
        Ok(Self::prepared([fit, check, test], machine)?)
    }

    fn prepared(logs: [Vec<NamedLog>; 3], machine: &Axis) -> Result<Self, ReplayError> {
        let set = |logs: &Vec<NamedLog>| LogSet::new(logs.clone(), machine);
        let [fit, check, test] = &logs;
        let fit = set(fit)?;
        Ok(Self {
            check: set(check)?,
            test: (!test.is_empty()).then(|| set(test)).transpose()?,
            logs: match fit.is_balanced() {
                true => logs,
                false => Default::default(),
            },
            fit,
        })
    }

    /// Searches, and puts what was found into words and figures. `progress` is told what is
    /// being done.
    ///
    /// # Errors
    /// [`SearchError`] as [`search`] gives it.
    pub fn discover(
        &self,
        machine: &Axis,
        settings: &Settings,
        mut progress: impl FnMut(&str),
    ) -> Result<(Found, Discovered), SearchError> {
        let machine = &self.as_fast_as_logged(machine)?;
        let mut found = search(machine, &self.fit, &self.check, settings, &mut progress)?;
        let resolved = self.resolved(machine, &found);
        let Self {
            fit, check, test, ..
        } = resolved.as_ref().unwrap_or(self);
        if resolved.is_some() {
            progress("samples by the friction that was found");
            found = search(machine, fit, check, settings, &mut progress)?;
        }
        if let Some(test) = test {
            found = found.tested_on(machine, test.clone());
        }
        progress("verdict");
        let mut discovered = discovery(machine, fit, check, &found)?;
        if resolved.is_some() {
            discovered.discovery.notes.push(RESOLVED.to_owned());
        }
        let verdict = discovered.discovery.verdict;
        if !fit.is_balanced() && matches!(verdict, Verdict::Unknown | Verdict::PartlyExplained) {
            progress("controller");
            discovered.discovery.assessment.controller = self.other_controller(machine, &found);
        }
        Ok((found, discovered))
    }

    /// The machine with the greatest speed of the fitted logs, to which speeds of effects are in proportion where its file lists no
    /// trajectories.
    fn as_fast_as_logged(&self, machine: &Axis) -> Result<Axis, ReplayError> {
        let mut machine = machine.clone();
        if machine.trajectories.is_empty() {
            let traces = self.fit.simulate(&machine, &State::initial(&machine))?;
            let speeds = traces.iter().flat_map(|trace| &trace.speed);
            let fastest = speeds.fold(0.0_f64, |most, v| most.max(v.abs()));
            machine.fastest = Some(fastest).filter(|v| *v > 0.0);
        }
        Ok(machine)
    }

    /// The logs balanced anew where effects add more dry friction than the axis file states: which samples beside reversals are used
    /// depends on its level. `None` too if so few samples are left that there is no balance.
    fn resolved(&self, machine: &Axis, found: &Found) -> Option<Self> {
        if !self.fit.is_balanced() {
            return None;
        }
        let [own, added] = dry_friction(machine, &found.fit.state.effects);
        if added <= own {
            return None;
        }
        let machine = machine.clone().with_dry_friction(own + added).ok()?;
        Self::prepared(self.logs.clone(), &machine).ok()
    }

    /// What another controller than that of the fitted machine would leave of the commands.
    fn other_controller(&self, machine: &Axis, found: &Found) -> Option<OwnController> {
        let logs = |set: &LogSet| -> Vec<NamedLog> {
            let one = |log: &Prepared| (log.name.clone(), log.log.clone(), log.period);
            set.logs.iter().map(one).collect()
        };
        let fitted = machine.with_known(&found.fit.state.shares);
        better_than_own(&fitted, &logs(&self.fit), &logs(&self.check))
    }
}
