//! What a search is asked, and what it says.

use std::borrow::Cow;
use std::sync::Arc;

use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, FrictionForm};
use axis_sim::{Axis, ReplayError};
use nalgebra::DMatrix;
use thiserror::Error;

use super::evidence::needed;
use super::is_form::is_form;
use crate::answers::LogSet;
use crate::estimate::columns::Columns;
use crate::estimate::fit::Fit;
use crate::estimate::interval::Spread;
use crate::name::library::{Library, applicable};
use crate::noise::Hum;
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

/// Why a search cannot be made as it is asked.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// A name of no effect.
    #[error("no effect is called \"{name}\"; there are: {all}")]
    NoSuchEffect {
        /// As given.
        name: String,
        /// All names.
        all: String,
    },
    /// An effect that a machine of this kind cannot have.
    #[error("\"{name}\" cannot be accepted: {machine} has no such effect; it may have: {all}")]
    NotOn {
        /// As given.
        name: String,
        /// Kind of machine, in words.
        machine: &'static str,
        /// Names of the effects that it can have.
        all: String,
    },
    /// One effect that is to be there and not to be there.
    #[error("\"{name}\" is both accepted and rejected; give it once")]
    Both {
        /// As given.
        name: String,
    },
    /// More effects than are named at most.
    #[error("{accepted} effects are accepted; at most {most} are named")]
    TooMany {
        /// Number of accepted effects.
        accepted: usize,
        /// Most that are named.
        most: usize,
    },
}

/// Why there is no result of a search.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SearchError {
    /// It cannot be made as it is asked.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The machine as its file says does not run.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A library that was made for other logs or another machine.
    #[error(
        "the library's responses are of logs with another length or other channels, or of \
         another machine; make it from the logs that are fitted, or from logs like them"
    )]
    OtherLibrary,
}

impl Settings {
    /// Looks at the names of effects, for this machine.
    ///
    /// # Errors
    /// [`SettingsError`] of the first that cannot be meant.
    pub fn check(&self, machine: &Axis) -> Result<(), SettingsError> {
        let names = |all: &mut dyn Iterator<Item = &'static Effect>| {
            all.map(|e| e.name).collect::<Vec<_>>().join(", ")
        };
        for name in self.accepted.iter().chain(&self.rejected) {
            if Effect::named(name).is_none() {
                return Err(SettingsError::NoSuchEffect {
                    name: name.clone(),
                    all: names(&mut EFFECTS.iter().copied()),
                });
            }
        }
        for name in &self.accepted {
            let name = || name.clone();
            if self.rejected.contains(&name()) {
                return Err(SettingsError::Both { name: name() });
            }
            if applicable(machine).all(|e| e.name != name()) {
                return Err(SettingsError::NotOn {
                    name: name(),
                    machine: machine.mechanism.kind().name,
                    all: names(&mut applicable(machine)),
                });
            }
        }
        if self.accepted.len() > self.most_effects {
            return Err(SettingsError::TooMany {
                accepted: self.accepted.len(),
                most: self.most_effects,
            });
        }
        Ok(())
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
    /// What was named when these were sought; `None` where they were not.
    pub beside: Option<Vec<&'static str>>,
    /// Its values when it had just been added: as a model without the effects
    /// that were added later has them.
    pub when_named: Vec<f64>,
    /// The others of the round in which it was added.
    pub runners_up: Vec<RunnerUp>,
}

impl Named {
    /// Whether it is no effect, but says in which form one is there.
    pub fn is_form(&self) -> bool {
        FrictionForm::is_one(self.name)
    }
}

/// An effect that another took the place of, once more effects were there.
#[derive(Clone, Debug)]
pub struct Replaced {
    /// With its values when it had just been added.
    pub when_named: ActiveEffect,
    /// Name of the other.
    pub by: &'static str,
}

/// Effects that were named and are not given.
#[derive(Clone, Debug)]
pub struct Refused {
    /// The effects.
    pub effects: Vec<Named>,
    /// Why not.
    pub reason: RefusalReason,
}

/// Why effects are not given.
#[derive(Clone, Debug)]
pub enum RefusalReason {
    /// Check motion was further off than without them in these channels; in none, where it
    /// was so in total only.
    Worse(Vec<&'static str>),
    /// They take away this share of the gap on check motion, too little to explain it.
    Little(f64),
    /// The size of the first of them, fitted to the check logs, is this times its size.
    Size(f64),
    /// A law outside the library is more probable than all of them together.
    Law {
        /// On what it depends.
        over: String,
        /// The law.
        law: LawInPlace,
        /// Fall of D that it brings on the fitted logs, beyond chance, and on the check logs.
        evidence: [f64; 2],
    },
}

/// A law outside the library that took the place of effects.
#[derive(Clone, Debug, PartialEq)]
pub enum LawInPlace {
    /// A curve.
    Curve {
        /// Its place among the library's.
        index: usize,
        /// Its values at the knots.
        values: Vec<f64>,
    },
    /// A short term, in words.
    Term(&'static str),
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
    /// What was named in the end and is not given, as it makes check motion worse.
    pub refused: Option<Refused>,
    /// Effects that are not given, as the error of the others' laws may be as large, and their share of what the others do.
    pub within_error: Vec<(&'static str, f64)>,
    /// Derivatives with respect to the parameters: known ones, then free ones of
    /// the effects.
    pub columns: Columns,
    /// Parameters' covariance, in the same order, as the fit weighs noise.
    pub covariance: DMatrix<f64>,
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
    /// What was taken out of both.
    pub(crate) hum: Hum,
    /// Logs that took no part, from which the figures are; `None` where these are of the
    /// check logs.
    pub test: Option<Test>,
}

/// Logs that took no part in any choice.
#[derive(Clone, Debug)]
pub struct Test {
    /// With the defects of the machine as its file says.
    pub as_filed: LogSet,
    /// With those of the fitted machine.
    pub fitted: LogSet,
}

/// Standard deviation by which two simulations of one machine, with other mesh and
/// step, differ, as a share of a parameter's value (of a radian, for a phase): where
/// noise said less than three times this, hidden sizes were missed by 1.1e-4 RMS.
pub(super) const SIMULATED: f64 = 2e-4;

impl Found {
    /// The law outside the library that took the place of effects, and the fall of D of the fitted and the check logs with it.
    pub(crate) fn law_in_place(&self) -> Option<(&LawInPlace, [f64; 2])> {
        match &self.refused.as_ref()?.reason {
            RefusalReason::Law { law, evidence, .. } => Some((law, *evidence)),
            _ => None,
        }
    }

    /// Fall of D that naming an effect of one number took.
    pub fn needed(&self) -> f64 {
        let tried = self.library.candidates.len();
        let false_alarm = Settings::default().false_alarm;
        needed(&self.fit_logs.layout, 1, tried, false_alarm)
    }

    /// With the figures that are reported taken from these logs, which took no part.
    #[must_use]
    pub fn tested_on(mut self, machine: &Axis, logs: LogSet) -> Self {
        // What does not run is compared as it is.
        let without_hum = self.hum.out_of(machine, &logs, &self.fit.state);
        let logs = without_hum.map_or_else(|_| logs.clone(), Cow::into_owned);
        let mut fitted = logs.clone();
        // What does not run in the exact way is compared without it.
        if fitted.follow(machine, &self.fit.state).is_err() {
            fitted = logs.clone();
        }
        self.test = Some(Test {
            as_filed: logs,
            fitted,
        });
        self
    }

    /// The effects that an axis file can have. A form of a friction that is there already
    /// has no entry in one.
    pub fn effects_for_file(&self) -> impl Iterator<Item = &ActiveEffect> {
        let all = self.fit.state.effects.iter();
        all.filter(|active| !is_form(active))
    }

    /// Half width of the 95 % interval of a parameter of this value, by its place: of
    /// noise, of known parameters, and of the simulation.
    pub fn half_width(&self, index: usize, value: f64) -> f64 {
        self.spreads[index].half_width(SIMULATED * value)
    }
}
