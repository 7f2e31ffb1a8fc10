//! Stepwise search: screen, refine the best few by simulation, add, drop.

mod evidence;
mod force;
mod form;
mod free_curve;
mod intervals;
mod is_form;
mod lines;
mod look_alikes;
mod one_curve;
mod one_law;
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

pub use self::evidence::{MATERIAL, needed};
pub(crate) use self::is_form::is_form;
pub(crate) use self::revise::ABOVE_NOISE;
use self::state::{ANEW, Search, steady_noise, steady_noise_beside};
pub use self::types::{
    Alike, Found, Named, ONE_CLASS, RefusalReason, Refused, Replaced, RunnerUp, SearchError,
    Settings, SettingsError, Test,
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
    let fitter = Fitter {
        machine,
        set: fit_logs,
    };
    let start = fitter.at(State::initial(machine))?;
    let nominal = library.as_ref().map(|l| l.known.clone());
    let nominal = nominal.unwrap_or_else(|| fitter.known_columns(&start));
    let (mut base, mut known) = calibrated(&fitter, start, nominal);
    // Defects and starts by the machine with its parameters as they were fitted.
    let as_filed = check_logs;
    let (mut fit_logs, mut check_logs) = (fit_logs.clone(), check_logs.clone());
    for _ in 0..SETTLINGS {
        let mut begins_elsewhere = false;
        if let Some(settled) = settled(machine, &fit_logs, &check_logs, &base, &known) {
            begins_elsewhere = settled.0.begins_elsewhere(&fit_logs, machine);
            (fit_logs, check_logs) = settled;
        }
        let fitter = Fitter {
            machine,
            set: &fit_logs,
        };
        (base, known) = fitter.calibrated(fitter.at(base.state)?, known);
        // What was fitted beside another start may have made up for it.
        if !begins_elsewhere {
            break;
        }
    }
    let checks = check_logs.simulate(machine, &base.state)?;
    let hum = Hum::of(
        (&fit_logs, &base.traces),
        (&check_logs, &checks),
        &Hum::default(),
    );
    if !hum.is_none() {
        fit_logs = hum.taken_out(&fit_logs, &base.traces);
        check_logs = hum.taken_out(&check_logs, &checks);
        let fitter = Fitter {
            machine,
            set: &fit_logs,
        };
        (base, known) = calibrated(&fitter, fitter.at(base.state)?, known);
    }
    let fitter = Fitter {
        machine,
        set: &fit_logs,
    };
    let library = library.unwrap_or_else(|| {
        progress("screening all effects");
        Arc::new(Library::new(&fitter, &base, known.clone()))
    });
    let checker = Fitter {
        machine,
        set: &check_logs,
    };
    let check = checker.at(base.state.clone())?;
    let mut search = Search {
        machine,
        settings,
        library,
        gap_before: sizes(&check_logs, &check_logs.rest(&check.traces)),
        check,
        steady: steady_noise_beside(&fitter, &base),
        fit: base.clone(),
        known,
        named: Vec::new(),
        replaced: Vec::new(),
        leftover: Vec::new(),
        refused: None,
        unseen: Vec::new(),
        hum,
        fit_logs,
        check_logs,
    };
    let without = search.clone();
    while search.effects_named() < settings.most_effects {
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
    let mut intervals = search.intervals()?;
    while search.drop_noise(&intervals) || search.drop_undetermined(&intervals) {
        // What was named together with it may be nothing without it.
        search.revise();
        intervals = search.intervals()?;
    }
    for instead in [Search::without_pieces, Search::without_imitations] {
        let Some(other) = instead(&search) else {
            continue;
        };
        search = match (other.named.is_empty(), &other.refused) {
            (true, Some(refused)) => without.clone().with_refused(refused.clone()),
            _ => other,
        };
        intervals = search.intervals()?;
    }
    if let Some(refused) = search.refused(as_filed, &without)? {
        search = without.with_refused(refused);
        intervals = search.intervals()?;
    } else if search.lacks_evidence(&without)? {
        search = without.with_leftover(&search.named);
        intervals = search.intervals()?;
    }
    search.find_look_alikes();
    Ok(search.finish(base, intervals))
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
    fit_logs: &LogSet,
    check_logs: &LogSet,
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
