//! Stepwise search: screen, refine the best few by simulation, add, drop.

mod evidence;
mod force;
mod form;
mod imitation;
mod intervals;
mod is_form;
mod law_error;
mod laws;
mod lines;
mod look_alikes;
mod promise;
mod refined;
mod refusal;
mod revise;
mod rounds;
mod state;
mod swing;
mod turn;
mod types;
mod unseen;
mod wave;

use std::sync::Arc;

use axis_sim::{Axis, ReplayError};

pub use self::evidence::{DECISIVE_EVIDENCE, LEAST_EVIDENCE_SHARE, needed};
pub(crate) use self::form::dry_friction;
use self::intervals::Intervals;
pub(crate) use self::is_form::is_form;
pub(crate) use self::law_error::LAW_ERROR;
pub(crate) use self::revise::ABOVE_NOISE;
use self::state::{ANEW, Search, steady_noise, steady_noise_beside};
pub use self::types::{
    Alike, Found, LawInPlace, Named, ONE_CLASS, RefusalReason, Refused, Replaced, RunnerUp,
    SearchError, Settings, SettingsError, Test,
};
use crate::answers::{LogSet, State};
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::starts::with_starts;
use crate::name::gap::sizes;
use crate::name::library::Library;
use crate::noise::Hum;

/// Searches for effects that explain the rest of `fit_logs`, and that prove
/// themselves on `check_logs`. `progress` is told what is being done.
///
/// # Errors
/// [`SearchError`] where the settings ask for what this machine cannot have, or where it
/// does not run as its file says.
pub fn search(
    machine: &Axis,
    fit_logs: &LogSet,
    check_logs: &LogSet,
    settings: &Settings,
    progress: impl FnMut(&str),
) -> Result<Found, SearchError> {
    settings.check(machine)?;
    Ok(searched(
        machine, fit_logs, check_logs, settings, None, progress,
    )?)
}

/// As [`search`], with what the library's effects do on motions like these, where that is
/// there already: of many searches on one motion, it takes most of the time.
///
/// # Errors
/// As [`search`], and [`SearchError::OtherLibrary`] where the library was made for logs of
/// another length or with other channels, or for another machine.
pub fn search_with(
    machine: &Axis,
    fit_logs: &LogSet,
    check_logs: &LogSet,
    settings: &Settings,
    library: Arc<Library>,
    progress: impl FnMut(&str),
) -> Result<Found, SearchError> {
    settings.check(machine)?;
    if !library.fits(machine, fit_logs) {
        return Err(SearchError::OtherLibrary);
    }
    let library = Some(library);
    Ok(searched(
        machine, fit_logs, check_logs, settings, library, progress,
    )?)
}

fn searched(
    machine: &Axis,
    fit_logs: &LogSet,
    check_logs: &LogSet,
    settings: &Settings,
    library: Option<Arc<Library>>,
    mut progress: impl FnMut(&str),
) -> Result<Found, ReplayError> {
    progress("known parameters");
    let nominal = library.as_ref().map(|l| l.known.clone());
    let begun = Begun::new(machine, [fit_logs, check_logs], nominal)?;
    let library = library.unwrap_or_else(|| {
        progress("screening all effects");
        begun.library(machine)
    });
    let mut search = begun.search(machine, settings, library)?;
    let without = search.clone();
    while search.effects_named() < settings.most_effects && search.is_worth_it() {
        progress(&format!("effect {}", search.effects_named() + 1));
        if !search.add_next() {
            break;
        }
    }
    match search.named.len() {
        1 => search.simplify(),
        _ => search.revise(),
    }
    progress("intervals");
    let (mut search, intervals) = search.tested(&without, check_logs)?;
    search.find_look_alikes();
    Ok(search.finish(without.fit, intervals))
}

/// Logs with what is known of them, and known parameters fitted to them, before anything is named.
struct Begun {
    fit_logs: LogSet,
    check_logs: LogSet,
    fit: Fit,
    known: Columns,
    hum: Hum,
}

impl Begun {
    /// From the logs as they were read, and the derivatives of the known parameters at the file's values where they are
    /// there already.
    fn new(
        machine: &Axis,
        [fit_logs, check_logs]: [&LogSet; 2],
        nominal: Option<Columns>,
    ) -> Result<Self, ReplayError> {
        let fitter = Fitter {
            machine,
            set: fit_logs,
        };
        let start = fitter.at(State::initial(machine))?;
        let nominal = nominal.unwrap_or_else(|| fitter.known_columns(&start));
        let (fit, known) = calibrated(&fitter, start, nominal);
        let mut begun = Self {
            fit_logs: fit_logs.clone(),
            check_logs: check_logs.clone(),
            fit,
            known,
            hum: Hum::default(),
        };
        begun.settle(machine)?;
        begun.take_out_hum(machine)?;
        Ok(begun)
    }

    /// Defects and starts by the machine with its parameters as they were fitted, and these fitted again.
    fn settle(&mut self, machine: &Axis) -> Result<(), ReplayError> {
        for _ in 0..SETTLINGS {
            let logs = [&self.fit_logs, &self.check_logs];
            let mut begins_elsewhere = false;
            if let Some(settled) = settled(machine, logs, &self.fit, &self.known) {
                begins_elsewhere = settled.0.begins_elsewhere(&self.fit_logs, machine);
                (self.fit_logs, self.check_logs) = settled;
            }
            let fitter = Fitter {
                machine,
                set: &self.fit_logs,
            };
            let there = fitter.at(self.fit.state.clone())?;
            (self.fit, self.known) = fitter.calibrated(there, self.known.clone());
            // What was fitted beside another start may have made up for it.
            if !begins_elsewhere {
                break;
            }
        }
        Ok(())
    }

    fn take_out_hum(&mut self, machine: &Axis) -> Result<(), ReplayError> {
        let checks = self.check_logs.simulate(machine, &self.fit.state)?;
        self.hum = Hum::of(
            (&self.fit_logs, &self.fit.traces),
            (&self.check_logs, &checks),
            &Hum::default(),
        );
        if self.hum.is_none() {
            return Ok(());
        }
        self.fit_logs = self.hum.taken_out(&self.fit_logs, &self.fit.traces);
        self.check_logs = self.hum.taken_out(&self.check_logs, &checks);
        let fitter = Fitter {
            machine,
            set: &self.fit_logs,
        };
        let there = fitter.at(self.fit.state.clone())?;
        (self.fit, self.known) = calibrated(&fitter, there, self.known.clone());
        Ok(())
    }

    /// All effects, screened on these logs.
    fn library(&self, machine: &Axis) -> Arc<Library> {
        let fitter = Fitter {
            machine,
            set: &self.fit_logs,
        };
        Arc::new(Library::new(&fitter, &self.fit, self.known.clone()))
    }

    /// A search in which nothing is named yet.
    fn search<'a>(
        self,
        machine: &'a Axis,
        settings: &'a Settings,
        library: Arc<Library>,
    ) -> Result<Search<'a>, ReplayError> {
        let set = &self.check_logs;
        let check = Fitter { machine, set }.at(self.fit.state.clone())?;
        let fitter = Fitter {
            machine,
            set: &self.fit_logs,
        };
        Ok(Search {
            machine,
            settings,
            library,
            gap_before: sizes(set, &set.rest(&check.traces)),
            check,
            steady: steady_noise_beside(&fitter, &self.fit),
            fit: self.fit,
            known: self.known,
            named: Vec::new(),
            replaced: Vec::new(),
            leftover: Vec::new(),
            refused: None,
            untransferred: Vec::new(),
            within_error: Vec::new(),
            unseen: Vec::new(),
            hum: self.hum,
            fit_logs: self.fit_logs,
            check_logs: self.check_logs,
        })
    }
}

impl Search<'_> {
    /// What remains of what was named once it is asked whether it is noise, imitates a law outside the library, or makes check
    /// motion worse; with the intervals of that. `without` is the search in which nothing was named.
    fn tested(self, without: &Self, as_filed: &LogSet) -> Result<(Self, Intervals), ReplayError> {
        let mut search = self;
        let mut intervals = search.intervals()?;
        while search.drop_noise(&intervals)
            || search.drop_undetermined(&intervals)
            || search.drop_untransferred()
        {
            // What was named together with it may be nothing without it.
            search.revise();
            intervals = search.intervals()?;
        }
        if let Some(other) = search.without_imitations() {
            search = match (other.named.is_empty(), &other.refused) {
                (true, Some(refused)) => without.clone().with_refused(refused.clone()),
                _ => other,
            };
            intervals = search.intervals()?;
        }
        // After the laws outside the library: what is small beside another effect may be what parts it from such a law.
        while search.drop_within_law_error() {
            search.revise();
            intervals = search.intervals()?;
        }
        // Only forms of friction beside a law that took the place of all effects: nothing is named that could be refused.
        if search.effects_named() == 0 && search.refused.is_some() {
            return Ok((search, intervals));
        }
        if let Some(refused) = search.refused_for_size() {
            search = without.clone().with_refused(refused);
            intervals = search.intervals()?;
        } else if let Some(refused) = search.refused(as_filed, without)? {
            search = without.clone().with_refused(refused);
            intervals = search.intervals()?;
        } else if search.lacks_evidence(without)? {
            search = without.clone().with_leftover(&search.named);
            intervals = search.intervals()?;
        }
        Ok((search, intervals))
    }
}

/// The known parameters fitted: from the file's values, and where these may be far off, from
/// where least squares lead as well.
fn calibrated(fitter: &Fitter<'_>, start: Fit, nominal: Columns) -> (Fit, Columns) {
    let direct = || fitter.calibrated(start.clone(), nominal.clone());
    let Some(noise) = steady_noise(fitter, &start) else {
        return direct();
    };
    let by_squares = || {
        let near = fitter.by_least_squares(start.clone(), nominal.clone(), &noise, ANEW);
        let known = fitter.known_columns(&near);
        fitter.calibrated(near, known)
    };
    let (one, other) = rayon::join(direct, by_squares);
    tracing::debug!(
        direct = one.0.deviance,
        by_squares = other.0.deviance,
        "known parameters"
    );
    match other.0.deviance < one.0.deviance {
        true => other,
        false => one,
    }
}

/// Times at most that the known parameters are fitted again beside other starts of the logs.
const SETTLINGS: usize = 4;

/// The logs with the defects and starts of a fitted machine, where it is one that runs.
fn settled(
    machine: &Axis,
    [fit_logs, check_logs]: [&LogSet; 2],
    fit: &Fit,
    known: &Columns,
) -> Option<(LogSet, LogSet)> {
    let corrected = |set: &LogSet| {
        let mut set = set.clone();
        set.follow(machine, &fit.state).ok()?;
        Some(set)
    };
    let at = |set: &LogSet| Fitter { machine, set }.at(fit.state.clone()).ok();
    let followed = corrected(fit_logs)?;
    let there = at(&followed)?;
    // Far from the truth what follows the machine may lead farther away; starts may not.
    let (fitted, checked, there) = match there.deviance > fit.deviance + 1.0 {
        true => (fit_logs.clone(), check_logs.clone(), fit.clone()),
        false => (followed, corrected(check_logs)?, there),
    };
    let [with, checker] = [&fitted, &checked].map(|set| Fitter { machine, set });
    let started = with_starts(&with, &there, Some(known));
    let check_started = checked
        .coarse_efforts(machine)
        .and_then(|_| with_starts(&checker, &at(&checked)?, None));
    Some((
        started.map_or(fitted, |(set, _)| set),
        check_started.map_or(checked, |(set, _)| set),
    ))
}
