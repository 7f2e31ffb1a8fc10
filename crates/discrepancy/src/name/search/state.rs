//! A search on its way.

use std::sync::Arc;

use axis_sim::Axis;
use axis_sim::effects::Effect;

use super::evidence::needed;
use super::is_form::is_form;
use super::types::{Named, Refused, Replaced, RunnerUp, Settings};
use crate::answers::LogSet;
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::known::tolerances;
use crate::estimate::starts::with_starts;
use crate::name::library::Library;
use crate::noise::{Hum, log_noise, noise_on};
use crate::spectrum::Amplitudes;

/// Times at most that derivatives are made anew on the way of least squares, which ends before where
/// the sum falls no more. A way that is cut short leaves a gap that some effect fills.
pub(super) const ANEW: usize = 40;

/// A search on its way.
#[derive(Clone)]
pub(super) struct Search<'a> {
    pub(super) machine: &'a Axis,
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
    pub(super) refused: Option<Refused>,
    /// What had another size on the check logs, and the ratio of the sizes.
    pub(super) untransferred: Vec<(Named, f64)>,
    /// What may be made of the error of the other effects' laws, and its share of what they do.
    pub(super) within_error: Vec<(&'static str, f64)>,
    /// Effects that ended as a simpler one when they were added to what is named now.
    pub(super) unseen: Vec<&'static str>,
    /// What was taken out of the logs.
    pub(super) hum: Hum,
    /// Root mean square of each channel's rest on the check logs before anything was named.
    pub(super) gap_before: Vec<f64>,
    /// What weighs the rest where a fit begins far off; `None` where it does not.
    pub(super) steady: Option<Arc<Amplitudes>>,
}

/// Tolerance of a known parameter beyond which what is linear about the file's values may lead
/// astray.
const WIDE: f64 = 0.02;

/// How many times the power of noise a residual has from which it is its own weight rather than noise is:
/// log |r|² is far from its parabola there.
const FAR: f64 = 10.0;

/// Noise alone, as the logs of a fit show it, where a known parameter may be far off.
pub(super) fn steady_noise(fitter: &Fitter<'_>, fit: &Fit) -> Option<Arc<Amplitudes>> {
    let (machine, set) = (fitter.machine, fitter.set);
    let noise = is_wide(machine).then(|| noise_of(machine, set, fit))??;
    Some(Arc::new(noise))
}

/// Noise alone, as the logs of a fit show it, where a known parameter may be far off or the residual is
/// far above it.
pub(super) fn steady_noise_beside(fitter: &Fitter<'_>, fit: &Fit) -> Option<Arc<Amplitudes>> {
    let noise = noise_of(fitter.machine, fitter.set, fit)?;
    let power = fitter.squares(&noise)(fit) / fitter.set.layout.size() as f64;
    tracing::debug!(power, "residual over noise");
    (is_wide(fitter.machine) || power > FAR).then(|| Arc::new(noise))
}

fn is_wide(machine: &Axis) -> bool {
    tolerances(machine).into_iter().any(|t| t > WIDE)
}

/// Noise alone, as of sensors like those of the logs; `None` where these do not show it.
fn noise_of(machine: &Axis, set: &LogSet, fit: &Fit) -> Option<Amplitudes> {
    let (state, traces) = (&fit.state, &fit.traces);
    let noise = log_noise(machine, set, state, traces)?;
    noise_on(machine, state, set, traces, &noise, 0).ok()
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

    /// What the engineer takes as there and is not yet: it goes first, whatever
    /// speaks for it.
    pub(super) fn awaited(&self) -> Vec<&str> {
        let active = |name: &str| self.named.iter().any(|n| n.name == name);
        let accepted = self.settings.accepted.iter().map(String::as_str);
        accepted.filter(|name| !active(name)).collect()
    }

    /// Number of effects that are named, their forms not counted.
    pub(super) fn effects_named(&self) -> usize {
        let effects = self.fit.state.effects.iter();
        effects.filter(|active| !is_form(active)).count()
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
        let free = !active || effect.place_of(|n| n.is_order()).is_some();
        let unseen = self.unseen.contains(&effect.name);
        free && !(rejected || unseen)
            && !self.doubles_a_friction(effect)
            && (awaited.is_empty() || awaited.contains(&effect.name))
    }

    /// Noise alone, as of sensors like those of the logs; `None` where these do
    /// not show it.
    pub(super) fn noise(&self) -> Option<Amplitudes> {
        noise_of(self.machine, &self.fit_logs, &self.fit)
    }

    /// Fits all parameters again, and the defects of the machine as it now is.
    pub(super) fn settle(&mut self) {
        let fitter = self.fitter();
        let known = fitter.known_columns(&self.fit);
        let near = self.steady.as_ref().map(|noise| {
            let near = fitter.by_least_squares(self.fit.clone(), known.clone(), noise, ANEW);
            let known = fitter.known_columns(&near);
            fitter.calibrated(near, known)
        });
        let (fit, known) = fitter.calibrated(self.fit.clone(), known);
        let (fit, known) = match near {
            Some((near, known)) if near.deviance < fit.deviance => (near, known),
            _ => (fit, known),
        };
        let mut corrected = self.fit_logs.clone();
        if corrected.follow(self.machine, &fit.state).is_ok() {
            let with = Fitter {
                machine: self.machine,
                set: &corrected,
            };
            // What was fitted beside another beginning of a log may have made up for it. An axis that
            // vibrates by itself does so with another phase in every simulation, and the difference of
            // two is no defect.
            let there = with.at(fit.state.clone()).ok();
            let there = there.map(|there| with.refine(there, &known, 4));
            match there.filter(|there| there.deviance < fit.deviance) {
                Some(better) => {
                    self.fit = better;
                    self.fit_logs = corrected;
                }
                None => self.fit = fit,
            }
        } else {
            self.fit = fit;
        }
        self.known = known;
        self.settle_hum();
        self.settle_starts();
        self.settle_check();
        if !is_wide(self.machine) && self.steady.is_some() {
            self.steady = steady_noise_beside(&self.fitter(), &self.fit);
        }
    }

    /// Seeks the hum of the logs anew: beside a large gap a line may be hidden, or be a part of the gap.
    fn settle_hum(&mut self) {
        if self.fit_logs.is_balanced() {
            return;
        }
        let [fit_logs, check_logs] = [&self.fit_logs, &self.check_logs].map(Hum::put_back);
        let Ok(checks) = check_logs.simulate(self.machine, &self.fit.state) else {
            return;
        };
        let fits = &self.fit.traces;
        let hum = Hum::of((&fit_logs, fits), (&check_logs, &checks), &self.hum);
        if hum.is_none() && self.hum.is_none() {
            return;
        }
        let fit_logs = hum.taken_out(&fit_logs, fits);
        let with = Fitter {
            machine: self.machine,
            set: &fit_logs,
        };
        let Ok(fit) = with.at(self.fit.state.clone()) else {
            return;
        };
        (self.fit, self.known) = with.calibrated(fit, self.known.clone());
        self.check_logs = hum.taken_out(&check_logs, &checks);
        self.fit_logs = fit_logs;
        self.hum = hum;
    }

    /// Fits what drives with a coarse command hold at the starts of the fitted logs.
    fn settle_starts(&mut self) {
        if self.fit_logs.coarse_efforts(self.machine).is_none() {
            return;
        }
        let own = self.own_columns();
        if let Some((set, fit)) = with_starts(&self.fitter(), &self.fit, Some(&own)) {
            self.fit_logs = set;
            self.fit = fit;
        }
    }

    fn settle_check(&mut self) {
        let Ok(check) = self.checker().at(self.fit.state.clone()) else {
            return;
        };
        self.check = check;
        let mut corrected = self.check_logs.clone();
        let done = corrected.follow(self.machine, &self.fit.state);
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
        if let Some((set, check)) = with_starts(&self.checker(), &self.check, None) {
            self.check_logs = set;
            self.check = check;
        }
    }
}
