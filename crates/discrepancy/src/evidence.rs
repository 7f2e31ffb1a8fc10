//! The logs of one search, and the search from them to its verdict.

use axis_sim::{Axis, ReplayError};
use thiserror::Error;

use crate::answers::{LogSet, Prepared};
use crate::controller::{OwnController, better_than_own};
use crate::judge::{Discovered, Verdict, discovery};
use crate::logs::{LogSetError, NamedLog, check_distinct, set_apart};
use crate::name::search::{Found, SearchError, Settings, search};

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
        let test = (!test.is_empty()).then(|| LogSet::new(test, machine));
        Ok(Self {
            fit: LogSet::new(fit, machine)?,
            check: LogSet::new(check, machine)?,
            test: test.transpose()?,
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
        let mut found = search(machine, &self.fit, &self.check, settings, &mut progress)?;
        if let Some(test) = &self.test {
            found = found.tested_on(machine, test.clone());
        }
        progress("verdict");
        let mut discovered = discovery(machine, &self.fit, &self.check, &found)?;
        let verdict = discovered.discovery.verdict;
        if !self.fit.is_balanced() && matches!(verdict, Verdict::Unknown | Verdict::PartlyExplained)
        {
            progress("controller");
            discovered.discovery.assessment.controller = self.other_controller(machine, &found);
        }
        Ok((found, discovered))
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
