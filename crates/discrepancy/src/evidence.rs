//! The logs of one search, and the search from them to its verdict.

use axis_sim::{Axis, ReplayError};
use thiserror::Error;

use crate::answers::{LogSet, Prepared, State};
use crate::controller::{OwnController, better_than_own};
use crate::judge::{Discovered, Verdict, discovery};
use crate::late::{Late, is_better, late_reference, looks_late, note, note_beside};
use crate::logs::{LogSetError, NamedLog, check_distinct, set_apart};
use crate::name::search::{Found, SearchError, Settings, search};

/// The logs of one search.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Fitted to.
    pub fit: LogSet,
    /// Of other motion, on which what is named must prove itself.
    pub check: LogSet,
    /// Without part in any choice, for the figures. `None` where there is none to spare: the
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
    /// [`EvidenceError`] where samples were given twice, or a log cannot be compared.
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
        let mut discovered = self.judged(machine, &mut found, None, &mut progress)?;
        if self.may_be_late(&found, &discovered) {
            progress("a late reference");
            match late_reference(machine, &found)? {
                None => {}
                Some(Late::OrEffect(by, effect)) => {
                    let note = note_beside(by, effect, &self.fit);
                    discovered.discovery.notes.push(note);
                }
                Some(Late::Plainly(by)) => {
                    let [fit, check] = [&self.fit, &self.check].map(|set| {
                        let mut set = set.with_references_late(by);
                        set.correct_defects(machine, &State::initial(machine))?;
                        Ok::<LogSet, ReplayError>(set)
                    });
                    let again = search(machine, &fit?, &check?, settings, &mut progress)?;
                    if is_better(&found.fit, &again.fit) {
                        found = again;
                        discovered = self.judged(machine, &mut found, Some(by), &mut progress)?;
                        discovered.discovery.notes.push(note(by, &self.fit));
                    }
                }
            }
        }
        let verdict = discovered.discovery.verdict;
        if !self.fit.is_balanced() && matches!(verdict, Verdict::Unknown | Verdict::PartlyExplained)
        {
            progress("controller");
            discovered.discovery.told.controller = self.other_controller(machine, &found);
        }
        Ok((found, discovered))
    }

    /// The verdict of a search, with the references of the logs `late` by some time, s.
    fn judged(
        &self,
        machine: &Axis,
        found: &mut Found,
        late: Option<f64>,
        mut progress: impl FnMut(&str),
    ) -> Result<Discovered, ReplayError> {
        let read =
            |set: &LogSet| late.map_or_else(|| set.clone(), |by| set.with_references_late(by));
        if let Some(test) = &self.test {
            *found = found.clone().tested_on(machine, read(test));
        }
        progress("verdict");
        discovery(machine, &read(&self.fit), &read(&self.check), found)
    }

    /// Whether it is worth a look: something is left, or what was named of the controller looks like it.
    fn may_be_late(&self, found: &Found, discovered: &Discovered) -> bool {
        let verdict = discovered.discovery.verdict;
        let is_open = matches!(verdict, Verdict::Unknown | Verdict::PartlyExplained);
        !self.fit.is_balanced() && (is_open || looks_late(&found.fit.state))
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
