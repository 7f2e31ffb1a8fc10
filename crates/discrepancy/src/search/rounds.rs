//! A search on its way: rounds of screening, refining and adding.

use std::sync::Arc;

use axis_sim::ReplayError;
use axis_sim::effects::{ActiveEffect, Effect, Machine};
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::evidence::{EQUAL, LEAST_HELD_OUT, MATERIAL, WORSE, enough, needed};
use super::promise::{Promises, WORTH};
use super::{Alike, Found, Named, ONE_CLASS, Replaced, RunnerUp, Settings, calibrated};
use crate::fit::{Columns, Fit, Fitter, free_parameters};
use crate::interval::Spread;
use crate::library::{FORCE, Library};
use crate::model::LogSet;
use crate::noise::{drawn, noise_on, sensor_noise, spreads};
use crate::projector::sine;
use crate::screen::Screened;
use crate::spectrum::Amplitudes;

/// A search on its way.
#[derive(Clone)]
pub(super) struct Search<'a> {
    pub(super) machine: &'a Machine,
    pub(super) settings: &'a Settings,
    pub(super) library: Arc<Library>,
    pub(super) fit_logs: LogSet,
    pub(super) check_logs: LogSet,
    pub(super) known: Columns,
    pub(super) fit: Fit,
    pub(super) check: Fit,
    pub(super) named: Vec<Named>,
    pub(super) replaced: Vec<Replaced>,
    pub(super) leftover: Vec<RunnerUp>,
}

/// Share of the promised fall of D that a simulation must keep, or other sizes are
/// tried.
const KEPT: f64 = 0.8;

/// One effect, or two, after refinement by simulation.
struct Refined {
    parts: Vec<Screened>,
    fit: Fit,
    gain: f64,
}

impl Refined {
    fn runner_up(&self) -> RunnerUp {
        RunnerUp {
            name: self.parts[0].effect.name,
            gain: self.gain,
        }
    }
}

impl Search<'_> {
    pub(super) fn fitter(&self) -> Fitter<'_> {
        Fitter {
            machine: self.machine,
            set: &self.fit_logs,
        }
    }

    pub(super) fn checker(&self) -> Fitter<'_> {
        Fitter {
            machine: self.machine,
            set: &self.check_logs,
        }
    }

    /// Adds the effect that explains most of what is left, or two that explain
    /// together what none does alone; false where none proves itself.
    pub(super) fn add_next(&mut self) -> bool {
        let awaited = self.awaited();
        let own = self.own_columns();
        let promises = Promises::new(self, &own);
        let screenings = promises.screenings(&own, |effect| self.wanted(effect, &awaited));
        let screened = promises.one_by_one(&screenings[0]);
        let candidates = if awaited.is_empty() {
            let mut worth = promises.worth_refining(&screened);
            if self.named.len() + 2 <= self.settings.most_effects {
                let most = screened.first().map_or(0.0, |s| s.gain);
                worth.extend(promises.pairs(&screenings, most));
            }
            worth
        } else {
            screened.iter().map(|s| vec![s.clone()]).collect()
        };
        let refined = self.refine(candidates, &own);
        // Where the best does not hold on other motion, the next may.
        let proven = refined.iter().enumerate().find_map(|(place, candidate)| {
            let check = self.checker().at(candidate.fit.state.clone()).ok()?;
            let held_out = self.check.deviance - check.deviance;
            let holds = !awaited.is_empty()
                || self.proves_itself(candidate, held_out) && self.worsens_none(&check);
            holds.then_some((place, check))
        });
        let Some((place, check)) = proven else {
            let alone = refined.iter().filter(|r| r.parts.len() == 1);
            self.leftover = alone.map(Refined::runner_up).collect();
            return false;
        };
        self.add(&refined, place, check, &screened);
        true
    }

    /// Fall of D that `effects` with so many parameters must bring at once.
    pub(super) fn needed(&self, parameters: usize, effects: usize) -> f64 {
        let tried = self.library.candidates.len();
        let tried = match effects {
            1 => tried,
            _ => tried * tried.saturating_sub(1) / 2,
        };
        needed(
            &self.fit_logs.layout,
            parameters,
            tried,
            self.settings.false_alarm,
        )
    }

    fn add(&mut self, refined: &[Refined], place: usize, check: Fit, screened: &[Screened]) {
        let best = &refined[place];
        let others = refined.iter().enumerate();
        let others = others.filter(|(i, r)| *i != place && r.parts.len() == 1);
        let others: Vec<RunnerUp> = others.map(|(_, r)| r.runner_up()).collect();
        for part in &best.parts {
            self.named.push(Named {
                name: part.effect.name,
                evidence: best.gain,
                held_out: self.check.deviance - check.deviance,
                alike: alike(part, best, refined, screened),
                when_named: Vec::new(),
                runners_up: others.clone(),
            });
        }
        self.fit = best.fit.clone();
        self.check = check;
        self.settle();
        let new = self.named.len() - best.parts.len();
        let effects = &self.fit.state.effects[new..];
        for (named, active) in self.named[new..].iter_mut().zip(effects) {
            named.when_named.clone_from(&active.values);
        }
    }

    /// What the engineer takes as there and is not yet: it goes first, whatever
    /// speaks for it.
    fn awaited(&self) -> Vec<&str> {
        let active = |name: &str| self.named.iter().any(|n| n.name == name);
        let accepted = self.settings.accepted.iter().map(String::as_str);
        accepted.filter(|name| !active(name)).collect()
    }

    /// Derivatives with respect to all parameters of the fit.
    pub(super) fn own_columns(&self) -> Columns {
        let effects = self.fitter().effect_columns(&self.fit, 0);
        self.known.iter().cloned().chain(effects).collect()
    }

    /// Whether an effect may be named next.
    pub(super) fn wanted(&self, effect: &Effect, awaited: &[&str]) -> bool {
        let rejected = self.settings.rejected.iter().any(|r| r == effect.name);
        // A second harmonic of the same kind may be there.
        let active = self.named.iter().any(|n| n.name == effect.name);
        let free = !active || effect.name == "cogging-torque";
        free && !rejected && (awaited.is_empty() || awaited.contains(&effect.name))
    }

    /// Noise alone, as of sensors like those of the logs; `None` where these do
    /// not show it.
    pub(super) fn noise(&self) -> Option<Amplitudes> {
        let (machine, set, fit) = (self.machine, &self.fit_logs, &self.fit);
        let noise = sensor_noise(machine, set, &fit.state, &fit.traces)?;
        noise_on(machine, &fit.state, set, &fit.traces, noise, 0).ok()
    }

    /// Candidates of one effect or two, by simulation; the simplest of the best first.
    fn refine(&self, candidates: Vec<Vec<Screened>>, own: &Columns) -> Vec<Refined> {
        let fitter = self.fitter();
        let promised = candidates.iter().map(|parts| parts[0].gain);
        let least = WORTH * promised.fold(0.0, f64::max);
        let awaited = self.awaited().contains(&FORCE);
        let begin = |parts: Vec<Screened>| {
            let as_screened = || {
                let mut state = self.fit.state.clone();
                state.effects.extend(parts.iter().map(|s| ActiveEffect {
                    effect: s.effect,
                    values: s.values.clone(),
                }));
                let fit = fitter.at(state).ok()?;
                // Promised sizes are near enough where an answer grows with its
                // size.
                let kept = self.fit.deviance - fit.deviance >= KEPT * parts[0].gain;
                Some(match kept {
                    true => fit,
                    false => fitter.best_size(fit, parts.len()),
                })
            };
            let start = match parts.as_slice() {
                [force] if force.effect.name == FORCE => {
                    let found = self.force_in_time(own, least);
                    found.or_else(|| as_screened().filter(|_| awaited))?
                }
                _ => as_screened()?,
            };
            Some(Refined {
                parts,
                fit: fitter.refine(start, own, 2),
                gain: 0.0,
            })
        };
        let mut refined: Vec<Refined> = candidates.into_par_iter().filter_map(begin).collect();
        refined.retain(|r| match r.fit.state.effects.last() {
            Some(last) if r.parts.len() == 1 && last.effect.name == FORCE => {
                awaited || self.acts(last.values[2])
            }
            _ => true,
        });
        let gain = |fit: &Fit| self.fit.deviance - fit.deviance;
        // What is far behind after two rounds is not carried further.
        let best = refined.iter().map(|r| gain(&r.fit)).fold(0.0, f64::max);
        refined.par_iter_mut().for_each(|r| {
            if gain(&r.fit) > 0.5 * best - 50.0 {
                r.fit = fitter.refine(r.fit.clone(), own, 4);
            }
            r.gain = gain(&r.fit);
        });
        // Those that are near one another are compared where they end, with
        // derivatives of all effects as they are there, or a simple one that is
        // not there yet loses to one that contains it.
        let best = refined.iter().map(|r| r.gain).fold(0.0, f64::max);
        let near = |r: &Refined| r.gain > 0.8 * best;
        if refined.iter().filter(|r| near(r)).count() > 1 {
            refined.par_iter_mut().filter(|r| near(r)).for_each(|r| {
                r.fit = fitter.refine(r.fit.clone(), &self.known, 8);
                r.gain = gain(&r.fit);
            });
        }
        refined.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        for r in &refined {
            let found = r.fit.state.effects.iter().rev().take(r.parts.len());
            tracing::debug!(
                name = r.parts.iter().map(|p| p.effect.name).collect::<Vec<_>>().join(" and "),
                foreseen = r.parts[0].gain,
                gain = r.gain,
                screened = ?r.parts.iter().map(|p| &p.values).collect::<Vec<_>>(),
                found = ?found.rev().map(|a| &a.values).collect::<Vec<_>>(),
                "refined"
            );
        }
        simplest_first(refined)
    }

    fn proves_itself(&self, best: &Refined, held_out: f64) -> bool {
        let added = free_parameters(&best.fit.state).len() - free_parameters(&self.fit.state).len();
        let needed = self.needed(added, best.parts.len());
        // Beside what was found, a hundredth of its weight is what the model's
        // own simplifications may bring.
        let largest = self.named.iter().map(|n| n.evidence).fold(0.0, f64::max);
        tracing::debug!(gain = best.gain, held_out, needed, "on check logs");
        best.gain >= needed && held_out >= LEAST_HELD_OUT && best.gain >= MATERIAL * largest
    }

    /// Whether no channel of the check logs is further off than before: those
    /// that are not fitted count as well.
    fn worsens_none(&self, check: &Fit) -> bool {
        let before = self.check_logs.rest(&self.check.traces);
        let after = self.check_logs.rest(&check.traces);
        let power = |rest: &[Vec<Vec<f64>>], c: usize| -> f64 {
            rest.iter().flat_map(|log| &log[c]).map(|r| r * r).sum()
        };
        (0..self.check_logs.channels.len()).all(|c| power(&after, c) <= WORSE * power(&before, c))
    }

    /// Fits all parameters again, and the defects of the machine as it now is.
    fn settle(&mut self) {
        let known = self.fitter().known_columns(&self.fit);
        let (fit, known) = calibrated(&self.fitter(), self.fit.clone(), known);
        let mut corrected = self.fit_logs.clone();
        if corrected.correct_defects(self.machine, &fit.state).is_ok() {
            let with = Fitter {
                machine: self.machine,
                set: &corrected,
            };
            // An axis that vibrates by itself does so with another phase in
            // every simulation, and the difference of two is no defect.
            if let Ok(better) = with.at(fit.state.clone())
                && better.deviance < fit.deviance
            {
                self.fit = with.refine(better, &known, 4);
                self.fit_logs = corrected;
            } else {
                self.fit = fit;
            }
        } else {
            self.fit = fit;
        }
        self.known = known;
        self.settle_check();
    }

    fn settle_check(&mut self) {
        let Ok(check) = self.checker().at(self.fit.state.clone()) else {
            return;
        };
        self.check = check;
        let mut corrected = self.check_logs.clone();
        let done = corrected.correct_defects(self.machine, &self.fit.state);
        if done.is_ok() {
            let with = Fitter {
                machine: self.machine,
                set: &corrected,
            };
            if let Ok(better) = with.at(self.fit.state.clone())
                && better.deviance < self.check.deviance
            {
                self.check = better;
                self.check_logs = corrected;
            }
        }
    }

    /// Derivatives, covariance and spread of all parameters at the end.
    pub(super) fn intervals(&self) -> Result<Intervals, ReplayError> {
        let columns = self.own_columns();
        let fitter = self.fitter();
        let covariance = fitter.solve(&self.fit, &columns).covariance;
        let noise = drawn(&fitter, &self.fit)?;
        Ok(Intervals {
            spreads: spreads(&fitter, &self.fit, &columns, &covariance, &noise),
            columns,
            covariance,
            noise,
        })
    }

    pub(super) fn finish(self, base: Fit, intervals: Intervals) -> Found {
        let Intervals {
            columns,
            covariance,
            spreads,
            noise,
        } = intervals;
        Found {
            spreads,
            base,
            columns,
            covariance,
            noise,
            fit: self.fit,
            named: self.named,
            replaced: self.replaced,
            leftover: self.leftover,
            library: self.library,
            fit_logs: self.fit_logs,
            check_logs: self.check_logs,
        }
    }
}

/// How well the parameters of a fit are known.
pub(super) struct Intervals {
    pub(super) columns: Columns,
    covariance: DMatrix<f64>,
    pub(super) noise: Vec<Amplitudes>,
    spreads: Vec<Spread>,
}

/// Effects that do nearly the same as the best, or explain as much: the logs
/// cannot tell. What can do more is not among them, unless these logs would not
/// show the more.
fn alike(own: &Screened, best: &Refined, refined: &[Refined], all: &[Screened]) -> Vec<Alike> {
    let pair = best.parts.iter().map(|p| p.effect.name);
    let pair: Vec<&str> = pair.collect();
    let others = all
        .iter()
        .filter(|other| !pair.contains(&other.effect.name))
        .filter(|other| {
            let more = other.basis.ncols() > own.basis.ncols();
            !(more && other.more_is_shown(own, best.gain, EQUAL))
        });
    let mut all: Vec<Alike> = others
        .filter_map(|other| {
            let same = |r: &&Refined| match r.parts.as_slice() {
                [one] => one.effect.name == other.effect.name,
                _ => false,
            };
            let fitted = refined.iter().find(same);
            let equal = fitted.is_some_and(|r| (r.gain - best.gain).abs() < EQUAL);
            let sine = sine(&own.fingerprint, &other.basis);
            let more = other.basis.ncols() > own.basis.ncols();
            let nearest = || ActiveEffect {
                effect: other.effect,
                // A fit drives what the logs do not show wherever noise points.
                values: match more {
                    true => other.nearest(&own.fingerprint),
                    false => other.values.clone(),
                },
            };
            let fitted = fitted.filter(|_| !more);
            let last = fitted.and_then(|r| r.fit.state.effects.last().cloned());
            (sine < ONE_CLASS || equal).then(|| Alike {
                fitted: last.unwrap_or_else(nearest),
                sine,
            })
        })
        .collect();
    all.sort_by(|a, b| a.sine.total_cmp(&b.sine));
    all
}

/// Moves the simplest of those that explain about as much as the best to the
/// front.
fn simplest_first(mut refined: Vec<Refined>) -> Vec<Refined> {
    let Some(best) = refined.first().map(|r| r.gain) else {
        return refined;
    };
    let enough = enough(best);
    let parameters = |r: &Refined| -> usize {
        let each = r.parts.iter().map(|p| p.effect.parameters.len());
        each.sum()
    };
    let near = refined.iter().enumerate().filter(|(_, r)| r.gain >= enough);
    if let Some((at, _)) = near.min_by_key(|(_, r)| parameters(r)) {
        refined[..=at].rotate_right(1);
    }
    refined
}
