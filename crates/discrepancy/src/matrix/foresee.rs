//! What can be seen and told apart in a case, from simulated fingerprints,
//! before any search.

use std::sync::Arc;

use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, Scales};
use axis_sim::{Axis, ReplayError};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use thiserror::Error;
use trajectories::TrajectoryError;

use super::case::{Case, HiddenEffect, Kind};
use super::outcome::{Foreseen, Imitation};
use crate::bounded::bounded;
use crate::fit::{Columns, Fit, Fitter};
use crate::hidden::{Exercise, Hidden, Noise, OUTSIDE, exercise};
use crate::known::{known_deviations, pinned, tolerances};
use crate::library::Library;
use crate::model::{LogSet, State};
use crate::noise::{LogNoise, noise_on, size_over_noise};
use crate::projector::{Projector, sine};
use crate::screen::{Screened, Screening, imitate};
use crate::search::{ABOVE_NOISE, ONE_CLASS, Settings, needed};
use crate::spectrum::{Amplitudes, Whitener};

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
    nominal: Fit,
    known: Columns,
    pub(super) library: Arc<Library>,
    /// Of good sensors' noise.
    whitener: Whitener,
    /// That noise, whitened: several runs.
    noise: Vec<DVector<f64>>,
}

/// Runs of noise.
const RUNS: u64 = 16;

/// Sizes between which one is sought at which an effect is just so visible, as
/// multiples of the typical, and how often they are halved.
const SCALES: (f64, f64) = (1e-5, 4.0);
const HALVINGS: usize = 12;

/// Left of an effect beside another, in D, below which the search may take the
/// other: it takes the simpler of two within 25.
const TELLS_APART: f64 = 40.0;

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
        let fitter = Fitter {
            machine: &machine,
            set: &templates[0],
        };
        let nominal = fitter.at(State::initial(&machine))?;
        let known = fitter.known_columns(&nominal);
        let library = Arc::new(Library::new(&fitter, &nominal, known.clone()));
        let (state, quiet) = (&nominal.state, &nominal.traces);
        let good = Noise::good(axis);
        let run = |seed| {
            noise_on(
                &machine,
                state,
                &templates[0],
                quiet,
                &LogNoise::of_sensors(good),
                seed,
            )
        };
        let layout = &templates[0].layout;
        let whitener = layout.whitener(&layout.spectral_matrices(&run(0)?));
        let noise = (1..=RUNS).into_par_iter().map(run);
        let noise: Vec<Amplitudes> = noise.collect::<Result<_, ReplayError>>()?;
        let noise = noise.iter().map(|n| layout.whiten(&whitener, n)).collect();
        Ok(Self {
            axis: axis.clone(),
            exercise: kind,
            nominal,
            known,
            library,
            whitener,
            noise,
            templates,
            machine,
        })
    }

    /// The motion of this bench.
    pub fn exercise(&self) -> Exercise {
        self.exercise
    }

    /// What can be known of a case's effects; `None` for one that does not run
    /// on the nominal machine.
    pub fn foresee(&self, case: &Case) -> Vec<Option<Foreseen>> {
        let shares = self.hidden(case).shares;
        let responses: Vec<Option<DVector<f64>>> = case
            .hidden
            .par_iter()
            .map(|effect| self.response(effect, case.noise))
            .collect();
        let one = |i: usize| {
            let own = responses[i].as_ref()?;
            let others = (0..responses.len()).filter(|&j| j != i);
            let others: Vec<&DVector<f64>> = others.filter_map(|j| responses[j].as_ref()).collect();
            let name = &case.hidden[i].name;
            Some(self.judge(case, name, own, &others, &shares))
        };
        (0..case.hidden.len()).map(one).collect()
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
                let parameters = named(&hidden.name).map_or(&[][..], |e| e.parameters);
                let sizes = hidden.values.iter_mut().zip(parameters);
                for (value, p) in sizes.filter(|(_, p)| p.is_size()) {
                    let [low, high] = p.bounds(&scales);
                    *value = (*value * by).clamp(low, high);
                }
            }
            case
        };
        // The gain grows with the size, from nothing as long as known parameters make
        // up for it: bisection of the size's logarithm.
        let (mut low, mut high) = SCALES;
        for _ in 0..HALVINGS {
            let middle = f64::sqrt(low * high);
            match self.seen_in(&times(middle)) < visible {
                true => low = middle,
                false => high = middle,
            }
        }
        times(high)
    }

    /// Expected fall of D of a case's only effect, over what naming takes.
    fn seen_in(&self, case: &Case) -> f64 {
        let only = case.hidden.first().and_then(|hidden| {
            let response = self.response(hidden, case.noise)?;
            let shares = self.hidden(case).shares;
            let (gain, ..) = self.gain_of(case.noise, &response, &[], &shares);
            Some(gain / self.needed(named(&hidden.name)?))
        });
        only.unwrap_or(f64::INFINITY)
    }

    /// Fall of D that naming an effect takes.
    fn needed(&self, effect: &Effect) -> f64 {
        let layout = &self.templates[0].layout;
        let tried = self.library.candidates.len();
        needed(layout, effect.parameters.len(), tried, 0.01)
    }

    fn judge(
        &self,
        case: &Case,
        name: &str,
        own: &DVector<f64>,
        others: &[&DVector<f64>],
        shares: &[f64],
    ) -> Foreseen {
        let noise = case.noise;
        let (gain, fitted_shares, columns) = self.gain_of(noise, own, others, shares);
        let pinned = pinned(&self.machine, &fitted_shares);
        let fitted = Projector::new(&self.machine, &columns, &pinned);
        let seen = fitted.reject(own);
        let needed = named(name).map_or(f64::INFINITY, |e| self.needed(e));
        let others = |e: &Effect| e.name != name;
        let through = |column: &Amplitudes| fitted.reject(&self.white(column, noise));
        let size = seen.norm_squared();
        let near = |screened: &Screened| {
            let sine = sine(&seen, &screened.basis);
            let alike = sine < ONE_CLASS || size * sine * sine < TELLS_APART;
            alike.then(|| screened.effect.name.to_owned())
        };
        let candidates = &self.library.candidates;
        let all = Screening::of(candidates, others, through, seen.clone()).one_by_one();
        let mut class: Vec<String> = all.iter().filter_map(near).collect();
        class.dedup();
        let absent = case.kind == Kind::Outside || case.rejected.iter().any(|r| r == name);
        let imitation = absent.then(|| {
            let has = |e: &Effect| !case.rejected.iter().any(|r| r == e.name);
            let most = Settings::default().most_effects;
            let (by, left) = imitate(candidates, has, through, &seen, most);
            Imitation {
                by,
                left,
                complete: left < 2.0 * needed,
            }
        });
        let above_noise = size_over_noise(&seen, &self.noise);
        let seen_above = above_noise >= 2f64.sqrt() * ABOVE_NOISE;
        Foreseen {
            gain,
            above_noise,
            detectable: gain >= 2.0 * needed && seen_above,
            class,
            imitation,
        }
    }

    /// Expected fall of D of a response beside others; the shares at which known
    /// parameters make up for most of it, and all columns beside it.
    fn gain_of(
        &self,
        noise: f64,
        own: &DVector<f64>,
        others: &[&DVector<f64>],
        shares: &[f64],
    ) -> (f64, Vec<f64>, Vec<DVector<f64>>) {
        let mut columns: Vec<DVector<f64>> =
            self.known.iter().map(|c| self.white(c, noise)).collect();
        let off = columns
            .iter()
            .zip(shares)
            .fold(DVector::zeros(own.len()), |sum, (c, &s)| sum + c * s);
        columns.extend(others.iter().map(|&v| v.clone()));
        let (gain, fitted) = self.gain(&columns, &(own + off), shares);
        (gain, fitted, columns)
    }

    /// D of what the columns leave of a change, the first of them known
    /// parameters' and kept inside their tolerance, less D of the truth, at whose
    /// shares nothing is left; and the shares at which that is.
    fn gain(
        &self,
        columns: &[DVector<f64>],
        change: &DVector<f64>,
        shares: &[f64],
    ) -> (f64, Vec<f64>) {
        let (n, known) = (columns.len(), shares.len());
        let deviations = known_deviations(&self.machine);
        let most = tolerances(&self.machine);
        let normal = DMatrix::from_fn(n, n, |i, j| {
            let own = if i != j {
                0.0
            } else if i < known {
                deviations[i].powi(-2)
            } else {
                1e-9 * columns[i].norm_squared() + f64::MIN_POSITIVE
            };
            columns[i].dot(&columns[j]) + own
        });
        let right = DVector::from_fn(n, |i, _| columns[i].dot(change));
        let x = bounded(&normal, &right, |i| {
            (i < known).then(|| [-most[i], most[i]])
        });
        let pairs = shares.iter().zip(&deviations);
        let price: f64 = pairs.map(|(s, deviation)| (s / deviation).powi(2)).sum();
        let left = change.norm_squared() - 2.0 * x.dot(&right) + x.dot(&(&normal * &x));
        (left - price, x.rows(0, known).iter().copied().collect())
    }

    fn white(&self, amplitudes: &Amplitudes, noise: f64) -> DVector<f64> {
        self.templates[0].layout.whiten(&self.whitener, amplitudes) / noise
    }

    fn response(&self, effect: &HiddenEffect, noise: f64) -> Option<DVector<f64>> {
        let mut state = State::initial(&self.machine);
        state.effects.push(active(effect)?);
        let set = &self.templates[0];
        let traces = set.simulate(&self.machine, &state).ok()?;
        let change = set.difference(&traces, &self.nominal.traces, 1.0);
        Some(self.white(&change, noise))
    }
}

/// The effect of that name, in the library or outside of it.
pub(super) fn named(name: &str) -> Option<&'static Effect> {
    let mut all = EFFECTS.iter().chain(&OUTSIDE);
    all.find(|e| e.name == name).copied()
}

pub(super) fn active(hidden: &HiddenEffect) -> Option<ActiveEffect> {
    Some(ActiveEffect {
        effect: named(&hidden.name)?,
        values: hidden.values.clone(),
    })
}
