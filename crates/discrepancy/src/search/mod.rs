//! Stepwise search: screen, refine the best few by simulation, add, drop.

mod evidence;
mod force;
mod promise;
mod revise;
mod rounds;

use std::sync::Arc;

use axis_sim::ReplayError;
use axis_sim::effects::{ActiveEffect, Machine};

pub use self::evidence::{MATERIAL, needed};
pub(crate) use self::revise::ABOVE_NOISE;
use self::rounds::Search;
use crate::fit::{Columns, Fit, Fitter};
use crate::interval::Spread;
use crate::library::Library;
use crate::model::{LogSet, State};
use crate::spectrum::Amplitudes;

/// How the search is made.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Most effects that are named.
    pub most_effects: usize,
    /// Candidates that are refined by simulation in each round.
    pub refined: usize,
    /// Effects that are not to be named.
    pub rejected: Vec<String>,
    /// Effects that are taken as there.
    pub accepted: Vec<String>,
    /// Probability that a clean axis is given an effect.
    pub false_alarm: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            most_effects: 4,
            refined: 5,
            rejected: Vec::new(),
            accepted: Vec::new(),
            false_alarm: 0.01,
        }
    }
}

/// Sine of the angle below which two effects are one class.
pub const ONE_CLASS: f64 = 0.15;

/// A candidate of the last round, for the list of runners-up.
#[derive(Clone, Debug)]
pub struct RunnerUp {
    /// Name of the effect.
    pub name: &'static str,
    /// By how much it lowers D on the fit logs, alone.
    pub gain: f64,
}

/// An effect that does the same as another, on these logs.
#[derive(Clone, Debug)]
pub struct Alike {
    /// With the values that come nearest.
    pub fitted: ActiveEffect,
    /// Sine of the angle between the two fingerprints.
    pub sine: f64,
}

/// An effect that was added.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name of the effect.
    pub name: &'static str,
    /// By how much D rises on the fit logs without it.
    pub evidence: f64,
    /// By how much D falls on the check logs with it.
    pub held_out: f64,
    /// Effects that these logs cannot tell from it, the nearest first.
    pub alike: Vec<Alike>,
    /// Its values when it had just been added: as a model without the effects
    /// that were added later has them.
    pub when_named: Vec<f64>,
    /// The others of the round in which it was added.
    pub runners_up: Vec<RunnerUp>,
}

/// An effect that another took the place of, once more effects were there.
#[derive(Clone, Debug)]
pub struct Replaced {
    /// With its values when it had just been added.
    pub when_named: ActiveEffect,
    /// Name of the other.
    pub by: &'static str,
}

/// What a search found.
#[derive(Clone, Debug)]
pub struct Found {
    /// Fit with known parameters alone.
    pub base: Fit,
    /// Fit with the effects.
    pub fit: Fit,
    /// The effects, in the order of the state's.
    pub named: Vec<Named>,
    /// Effects that were named on the way and are no longer.
    pub replaced: Vec<Replaced>,
    /// Derivatives with respect to the parameters: known ones, then free ones of
    /// the effects.
    pub columns: Columns,
    /// Parameters' covariance, in the same order, as the fit weighs noise.
    pub covariance: nalgebra::DMatrix<f64>,
    /// How far they may be from the truth, in the same order.
    pub spreads: Vec<Spread>,
    /// Noise alone on the fitted logs, as simulated: several runs, or none.
    pub(crate) noise: Vec<Amplitudes>,
    /// The best of what was left out for want of evidence.
    pub leftover: Vec<RunnerUp>,
    /// What the library does on the motions of the fitted logs.
    pub library: Arc<Library>,
    /// The logs that were fitted, with the defects of the fitted machine.
    pub fit_logs: LogSet,
    /// The logs that were not, likewise.
    pub check_logs: LogSet,
}

/// Standard deviation by which two simulations of one machine, with other mesh and
/// step, differ, as a share of a parameter's value (of a radian, for a phase): where
/// noise said less than three times this, hidden sizes were missed by 1.1e-4 RMS.
const SIMULATED: f64 = 2e-4;

impl Found {
    /// Half width of the 95 % interval of a parameter of this value, by its place: of
    /// noise, of known parameters, and of the simulation.
    pub fn half_width(&self, index: usize, value: f64) -> f64 {
        self.spreads[index].half_width(SIMULATED * value)
    }
}

/// Searches for effects that explain the rest of `fit_logs`, and that prove
/// themselves on `check_logs`. `progress` is told what is being done.
///
/// # Errors
/// [`ReplayError`] where the machine as its file says does not run.
pub fn search(
    machine: &Machine,
    fit_logs: &LogSet,
    check_logs: &LogSet,
    settings: &Settings,
    progress: impl FnMut(&str),
) -> Result<Found, ReplayError> {
    search_with(machine, fit_logs, check_logs, settings, None, progress)
}

/// As [`search`], with the library's responses to these motions where they are
/// there already.
pub(crate) fn search_with(
    machine: &Machine,
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
    let (base, known) = calibrated(&fitter, start, nominal);
    // Defects of the machine with its parameters as they were fitted.
    let (fit_logs, check_logs) = match settled(machine, fit_logs, check_logs, &base) {
        Some((fit, check)) => (fit, check),
        None => (fit_logs.clone(), check_logs.clone()),
    };
    let fitter = Fitter {
        machine,
        set: &fit_logs,
    };
    let (base, known) = calibrated(&fitter, fitter.at(base.state)?, known);
    let library = library.unwrap_or_else(|| {
        progress("screening all effects");
        Arc::new(Library::new(&fitter, &base, known.clone()))
    });
    let mut search = Search {
        machine,
        settings,
        library,
        check: Fitter {
            machine,
            set: &check_logs,
        }
        .at(base.state.clone())?,
        fit: base.clone(),
        known,
        named: Vec::new(),
        replaced: Vec::new(),
        leftover: Vec::new(),
        fit_logs,
        check_logs,
    };
    while search.named.len() < settings.most_effects {
        progress(&format!("effect {}", search.named.len() + 1));
        if !search.add_next() {
            break;
        }
    }
    if search.named.len() > 1 {
        search.revise();
    }
    progress("intervals");
    let mut intervals = search.intervals()?;
    while search.drop_noise(&intervals) {
        // What was named together with it may be nothing without it.
        search.revise();
        intervals = search.intervals()?;
    }
    Ok(search.finish(base, intervals))
}

/// The known parameters fitted, and their derivatives where that ends: these
/// are made anew until it gets no further.
fn calibrated(fitter: &Fitter<'_>, mut fit: Fit, mut known: Columns) -> (Fit, Columns) {
    for _ in 0..3 {
        let before = fit.deviance;
        fit = fitter.refine(fit, &known, 8);
        if before - fit.deviance < 10.0 {
            break;
        }
        known = fitter.known_columns(&fit);
    }
    (fit, known)
}

/// The logs with the defects of a fitted machine, where it is one that runs.
fn settled(
    machine: &Machine,
    fit_logs: &LogSet,
    check_logs: &LogSet,
    fit: &Fit,
) -> Option<(LogSet, LogSet)> {
    let corrected = |set: &LogSet| {
        let mut set = set.clone();
        set.correct_defects(machine, &fit.state).ok()?;
        Some(set)
    };
    let (fitted, checked) = (corrected(fit_logs)?, corrected(check_logs)?);
    let with = Fitter {
        machine,
        set: &fitted,
    };
    let better = with.at(fit.state.clone()).ok()?;
    (better.deviance <= fit.deviance + 1.0).then_some((fitted, checked))
}
