//! What is the same for all cases on one motion, and what can be seen and told apart in
//! a case, before any search.

use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, Scales};
use axis_sim::{Axis, ReplayError};
use discrepancy::{Hypothesis, LogSet, PredictedEffect, Prediction};
use thiserror::Error;
use trajectories::TrajectoryError;

use super::case::{Case, HiddenEffect};
use crate::hidden::{Exercise, Hidden, LAW, Noise, OUTSIDE, exercise, supposed};

/// Why a bench cannot be set up.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BenchError {
    /// The exercise does not fit the axis.
    #[error(transparent)]
    Motion(#[from] TrajectoryError),
    /// The axis as its file says does not run it.
    #[error(transparent)]
    Replay(#[from] ReplayError),
}

/// What is the same for all cases on one motion.
pub struct Bench {
    pub(super) axis: Axis,
    pub(super) machine: Axis,
    pub(super) exercise: Exercise,
    /// Logs of the clean machine without noise, to fit to and to check on.
    pub(super) templates: [LogSet; 2],
    /// Of the first of them, with good sensors.
    pub(super) prediction: Prediction,
}

/// Sizes between which one is sought at which an effect is just so visible, as
/// multiples of the typical, and how often they are halved.
const SCALES: (f64, f64) = (1e-5, 4.0);
const HALVINGS: usize = 12;

impl Bench {
    /// Simulates what a motion needs: defects, known parameters, the library.
    ///
    /// # Errors
    /// [`BenchError`] where the axis does not run the exercise.
    pub fn new(axis: &Axis, kind: Exercise) -> Result<Self, BenchError> {
        let machine = axis.clone();
        let quiet = Hidden {
            effects: Vec::new(),
            shares: Vec::new(),
            noise: Noise::good(axis).scaled(0.0),
            seed: 0,
        };
        let template = |check: bool| -> Result<LogSet, BenchError> {
            let log = quiet.log(axis, &exercise(axis, kind, check)?, 1)?;
            let name = if check { "check" } else { "fit" };
            Ok(LogSet::new(
                vec![(name.to_owned(), log, axis.period)],
                &machine,
            )?)
        };
        let templates = [template(false)?, template(true)?];
        let good = supposed(Noise::good(axis));
        Ok(Self {
            axis: axis.clone(),
            exercise: kind,
            prediction: Prediction::new(&machine, &templates[0], good)?,
            templates,
            machine,
        })
    }

    /// The motion of this bench.
    pub fn exercise(&self) -> Exercise {
        self.exercise
    }

    /// What can be known of a case's effects; `None` for one that does not run
    /// on the nominal machine, and for all where one is unknown.
    pub fn predict(&self, case: &Case) -> Vec<Option<PredictedEffect>> {
        match self.supposed(case) {
            Some(supposed) => self.prediction.predict(&supposed),
            None => vec![None; case.hidden.len()],
        }
    }

    /// The case with its sizes where they are to be.
    pub(super) fn scaled(&self, case: &Case) -> Case {
        let Some(visible) = case.visible else {
            return case.clone();
        };
        let scales = Scales::of(&self.axis);
        let times = |by: f64| {
            let mut case = case.clone();
            for hidden in &mut case.hidden {
                *hidden = times_size(hidden, by, &scales);
            }
            case
        };
        let seen_in = |case: &Case| {
            let supposed = self.supposed(case);
            supposed.map_or(f64::INFINITY, |s| self.prediction.gain_over_needed(&s))
        };
        times(scale_at(SCALES, |by| seen_in(&times(by)) >= visible))
    }

    /// What is true of a case; `None` where an effect of it is unknown.
    fn supposed(&self, case: &Case) -> Option<Hypothesis> {
        let effects = case.hidden.iter().map(active);
        Some(Hypothesis {
            effects: effects.collect::<Option<_>>()?,
            shares: self.hidden(case).shares,
            noise: case.noise,
            of_channels: Vec::new(),
            rejected: case.rejected.clone(),
        })
    }
}

/// The least scale at which something is so, to a twelfth halving of the logarithm: the
/// gain grows with the size, from nothing as long as known parameters make up for it.
pub(crate) fn scale_at((mut low, mut high): (f64, f64), holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = f64::sqrt(low * high);
        match holds(middle) {
            true => high = middle,
            false => low = middle,
        }
    }
    high
}

/// A hidden effect with its sizes so many times as large, inside their bounds.
pub(crate) fn times_size(hidden: &HiddenEffect, by: f64, scales: &Scales) -> HiddenEffect {
    let mut hidden = hidden.clone();
    let parameters = named(&hidden.name).map_or(&[][..], |e| e.parameters);
    let sizes = hidden.values.iter_mut().zip(parameters);
    for (value, p) in sizes.filter(|(_, p)| p.is_size()) {
        let [low, high] = p.bounds(scales);
        *value = (*value * by).clamp(low, high);
    }
    hidden
}

/// The effect of that name, in the library or outside of it.
fn named(name: &str) -> Option<&'static Effect> {
    let mut all = EFFECTS.iter().chain(&OUTSIDE).copied().chain([&LAW]);
    all.find(|e| e.name == name)
}

pub(crate) fn active(hidden: &HiddenEffect) -> Option<ActiveEffect> {
    Some(ActiveEffect {
        effect: named(&hidden.name)?,
        values: hidden.values.clone(),
    })
}
