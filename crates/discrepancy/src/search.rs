//! Stepwise search: screen, refine the best few by simulation, add, drop.

use axis_sim::ReplayError;
use axis_sim::effects::{ActiveEffect, EFFECTS, Machine};
use rayon::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::fit::{Columns, Fit, Fitter, free_parameters};
use crate::model::{LogSet, State};
use crate::screen::{Screened, candidates, screen, sine};

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

/// An effect that was added.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name of the effect.
    pub name: &'static str,
    /// By how much D rises on the fit logs without it.
    pub evidence: f64,
    /// By how much D falls on the check logs with it.
    pub held_out: f64,
    /// Effects whose fingerprints lie within [`ONE_CLASS`] of it.
    pub alike: Vec<(&'static str, f64)>,
    /// The others of the round in which it was added.
    pub runners_up: Vec<RunnerUp>,
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
    /// Parameters' covariance: known ones, then free ones of the effects.
    pub covariance: nalgebra::DMatrix<f64>,
    /// The best of what was left out for want of evidence.
    pub leftover: Vec<RunnerUp>,
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
    mut progress: impl FnMut(&str),
) -> Result<Found, ReplayError> {
    let fitter = Fitter {
        machine,
        set: fit_logs,
    };
    let checker = Fitter {
        machine,
        set: check_logs,
    };
    progress("known parameters");
    let start = fitter.at(State::initial(machine))?;
    let mut known = fitter.known_columns(&start);
    let base = fitter.refine(start, &known, 8);
    let mut fit = base.clone();
    let mut check = checker.at(base.state.clone())?;
    let mut named: Vec<Named> = Vec::new();
    let mut leftover = Vec::new();

    while named.len() < settings.most_effects {
        progress("screening all effects");
        let own: Columns = known
            .iter()
            .cloned()
            .chain(fitter.effect_columns(&fit))
            .collect();
        let all = candidates(&fitter, &fit, &settings.rejected);
        let tried = all.len();
        let mut screened = screen(&fitter, &fit, &own, all);
        // What the engineer takes as there goes first, whatever speaks for it.
        let active = |name: &str| named.iter().any(|n| n.name == name);
        let awaited = settings.accepted.iter().any(|name| !active(name));
        if awaited {
            screened.retain(|s| {
                settings
                    .accepted
                    .iter()
                    .any(|a| a == s.candidate.effect.name)
            });
        }

        progress("refining the best");
        let refined: Vec<(usize, Fit, f64)> = {
            let one = |(i, s): (usize, &Screened)| {
                let mut state = fit.state.clone();
                state.effects.push(ActiveEffect {
                    effect: s.candidate.effect,
                    values: s.values.clone(),
                });
                let start = fitter.at(state).ok()?;
                let refined = fitter.refine(start, &known, 5);
                let gain = fit.deviance - refined.deviance;
                Some((i, refined, gain))
            };
            let top: Vec<(usize, &Screened)> =
                screened.iter().enumerate().take(settings.refined).collect();
            let mut refined: Vec<_> = top.into_par_iter().filter_map(one).collect();
            refined.sort_by(|a, b| b.2.total_cmp(&a.2));
            simplest_first(refined, &screened)
        };
        let runners: Vec<RunnerUp> = refined
            .iter()
            .map(|(i, _, gain)| RunnerUp {
                name: screened[*i].candidate.effect.name,
                gain: *gain,
            })
            .collect();
        let Some((index, better, gain)) = refined.into_iter().next() else {
            break;
        };
        let best = &screened[index];
        let added = free_parameters(&better.state).len() - free_parameters(&fit.state).len();
        let better_check = checker.at(better.state.clone());
        let held_out = better_check
            .as_ref()
            .map_or(f64::NEG_INFINITY, |c| check.deviance - c.deviance);
        let needed = threshold(added, tried, settings.false_alarm);
        tracing::debug!(
            effect = best.candidate.effect.name,
            gain,
            held_out,
            needed,
            "best candidate"
        );
        // Beside what was found, a hundredth of its weight is what the model's
        // own simplifications may bring.
        let largest = named.iter().map(|n| n.evidence).fold(0.0, f64::max);
        let material = gain >= MATERIAL * largest;
        if !awaited && (gain < needed || held_out < LEAST_HELD_OUT || !material) {
            leftover = runners;
            break;
        }
        let alike = screened
            .iter()
            .enumerate()
            .filter(|(i, other)| {
                *i != index && other.candidate.columns.len() <= best.candidate.columns.len()
            })
            .map(|(_, other)| {
                (
                    other.candidate.effect.name,
                    sine(&best.fingerprint, &other.basis),
                )
            })
            .filter(|(_, sine)| *sine < ONE_CLASS)
            .collect();
        named.push(Named {
            name: best.candidate.effect.name,
            evidence: gain,
            held_out,
            alike,
            runners_up: runners.into_iter().skip(1).collect(),
        });
        if let Ok(better_check) = better_check {
            check = better_check;
        }
        fit = better;
        known = fitter.known_columns(&fit);
        fit = fitter.refine(fit, &known, 8);
    }

    drop_needless(&fitter, &known, &mut fit, &mut named, settings);
    progress("intervals");
    let columns: Columns = known
        .iter()
        .cloned()
        .chain(fitter.effect_columns(&fit))
        .collect();
    let (_, covariance) = fitter.solve(&fit, &columns);
    Ok(Found {
        base,
        fit,
        named,
        covariance,
        leftover,
    })
}

/// Moves the simplest of those that explain about as much as the best to the
/// front: further parameters must bring a hundredth of the whole, and no less
/// than chance could.
fn simplest_first(
    mut refined: Vec<(usize, Fit, f64)>,
    screened: &[Screened],
) -> Vec<(usize, Fit, f64)> {
    let Some(best) = refined.first().map(|r| r.2) else {
        return refined;
    };
    let enough = best - (0.01 * best).max(25.0);
    let parameters = |r: &(usize, Fit, f64)| screened[r.0].candidate.effect.parameters.len();
    let near = refined.iter().enumerate().filter(|(_, r)| r.2 >= enough);
    if let Some((at, _)) = near.min_by_key(|(_, r)| parameters(r)) {
        refined[..=at].rotate_right(1);
    }
    refined
}

/// Least evidence of a further effect, as a share of the largest so far.
const MATERIAL: f64 = 0.01;

/// Least fall of D on logs that were not fitted.
const LEAST_HELD_OUT: f64 = 10.0;

/// Fall of D that chance alone passes with probability `false_alarm` in any of
/// `tried` candidates with `parameters` each (Bonferroni's bound), and twice
/// that, as S is estimated from the same data.
fn threshold(parameters: usize, tried: usize, false_alarm: f64) -> f64 {
    let each = false_alarm / tried.max(1) as f64;
    // Any whole number above 0 makes a distribution.
    let quantile = ChiSquared::new(parameters.max(1) as f64).map(|d| d.inverse_cdf(1.0 - each));
    2.0 * quantile.unwrap_or(40.0)
}

/// Takes out effects that others added later have made needless.
fn drop_needless(
    fitter: &Fitter<'_>,
    known: &Columns,
    fit: &mut Fit,
    named: &mut Vec<Named>,
    settings: &Settings,
) {
    let mut index = 0;
    while named.len() > 1 && index < named.len() {
        let mut state = fit.state.clone();
        let dropped = state.effects.remove(index);
        let Ok(start) = fitter.at(state) else {
            index += 1;
            continue;
        };
        let without = fitter.refine(start, known, 4);
        let loss = without.deviance - fit.deviance;
        let largest = named.iter().map(|n| n.evidence).fold(0.0, f64::max);
        let accepted = settings
            .accepted
            .iter()
            .any(|name| *name == named[index].name);
        let needed = threshold(
            dropped.effect.parameters.len(),
            EFFECTS.len(),
            settings.false_alarm,
        );
        if !accepted && loss < needed.max(MATERIAL * largest) {
            named.remove(index);
            *fit = without;
        } else {
            named[index].evidence = loss;
            index += 1;
        }
    }
}
