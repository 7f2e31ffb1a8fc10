//! The motion that would tell apart what these logs cannot.
//!
//! Two explanations A and B fit the logs alike. On a further motion, B is
//! fitted again, to the old logs and to what A predicts for the new one; what
//! is left of A's prediction then, whitened by the sensors' noise, is the fall
//! of D to be expected from running it. A is what was named, unless its rival can do
//! all of that and more, which nothing refutes. The motion with the largest is
//! proposed (experiments that discriminate between models: Hunter and Reiner,
//! Technometrics 7 (1965) 307–323, doi:10.1080/00401706.1965.10490265).

use axis_sim::effects::{ActiveEffect, Scales};
use axis_sim::{Axis, ClosedLoop, Recorder, ReplayError};
use compensator::NoCompensation;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use trajectories::Program;

use super::motions::motions;
use crate::answers::{LogSet, State};
use crate::estimate::columns::Columns;
use crate::estimate::fit::Fitter;
use crate::estimate::known::known_deviations;
use crate::name::library::rooms;
use crate::name::search::{DECISIVE_EVIDENCE, Found};
use crate::noise::{LogNoise, noise_on};

/// A motion to run next.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// What it is, in words.
    pub what: &'static str,
    /// The motion.
    pub program: Program,
    /// Effects that it separates: the one named, and its rival.
    pub pair: [ActiveEffect; 2],
    /// Fall of D to be expected between the two.
    pub separation: f64,
}

/// The motion that best separates the first named effect with a class from
/// its nearest rival; `None` if no effect has one, where the rival does not run beside what else is
/// named (two changes of one resistance may leave less than none), or where no motion does.
pub fn propose(machine: &Axis, found: &Found, noise: &LogNoise) -> Option<Proposal> {
    let index = found.named.iter().position(|n| !n.alike.is_empty())?;
    let question = Question::new(machine, found, index).ok()?;
    tracing::debug!(pair = ?question.pair.each_ref().map(|e| (e.effect.name, &e.values)), "to be distinguished");
    let motions = motions(machine).ok()?;
    let answers: Vec<Proposal> = motions
        .into_par_iter()
        .filter_map(|(what, program)| {
            let separation = question.separation(&program, noise).ok()?;
            tracing::debug!(what, separation, "experiment");
            Some(Proposal {
                what,
                program,
                pair: question.pair.clone(),
                separation,
            })
        })
        .collect();
    // The first of equals, which is the shorter to describe.
    let best = answers.into_iter().reduce(|a, b| {
        if b.separation > 1.2 * a.separation {
            b
        } else {
            a
        }
    });
    best.filter(|p| p.separation >= DECISIVE_EVIDENCE)
}

/// Two explanations of the same logs.
struct Question<'a> {
    machine: &'a Axis,
    pair: [ActiveEffect; 2],
    states: [State; 2],
    /// Whitened columns of the known parameters and of the other effects, on
    /// the old logs, of the second explanation.
    old: Vec<DVector<f64>>,
    known: usize,
}

impl<'a> Question<'a> {
    fn new(machine: &'a Axis, found: &Found, index: usize) -> Result<Self, ReplayError> {
        let named = found.fit.clone();
        let mut state = named.state.clone();
        state.effects[index] = found.named[index].alike[0].fitted.clone();
        let fitter = Fitter {
            machine,
            set: &found.fit_logs,
        };
        let effect = |state: &State| state.effects[index].clone();
        let scales = Scales::of(machine);
        let sizes = |state: &State| rooms(effect(state).effect, &scales).len();
        let own = effect(&named.state);
        let (pair, first, second, known);
        if sizes(&state) > sizes(&named.state) {
            pair = [own, effect(&state)];
            known = fitter.known_columns(&named);
            (first, second) = (state, named);
        } else {
            let start = fitter.at(state)?;
            known = fitter.known_columns(&start);
            (first, second) = (named.state, fitter.refine(start, &known, 6));
            pair = [own, effect(&second.state)];
        }
        let layout = &found.fit_logs.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(&found.fit.rest));
        let columns: Columns = known
            .into_iter()
            .chain(fitter.effect_columns(&second, 0))
            .collect();
        Ok(Self {
            machine,
            pair,
            known: second.state.shares.len(),
            states: [first, second.state],
            old: columns
                .iter()
                .map(|c| layout.whiten(&whitener, c))
                .collect(),
        })
    }

    fn separation(&self, program: &Program, noise: &LogNoise) -> Result<f64, ReplayError> {
        let set = self.record(program)?;
        let fitter = Fitter {
            machine: self.machine,
            set: &set,
        };
        let first = set.simulate(self.machine, &self.states[0])?;
        let second = fitter.at(self.states[1].clone())?;
        let columns: Columns = fitter
            .known_columns(&second)
            .into_iter()
            .chain(fitter.effect_columns(&second, 0))
            .collect();
        let layout = &set.layout;
        let of_noise = noise_on(self.machine, &self.states[0], &set, &first, noise, 0)?;
        let whitener = layout.whitener(&layout.spectral_matrices(&of_noise));
        let apart = set.difference(&first, &second.traces, 1.0);
        let apart = layout.whiten(&whitener, &apart);
        let new: Vec<DVector<f64>> = columns
            .iter()
            .map(|c| layout.whiten(&whitener, c))
            .collect();
        Ok(self.left_of(&apart, &new))
    }

    /// Residual of a difference on the new motion, the second explanation
    /// fitted to both: on the old logs the two are alike.
    fn left_of(&self, apart: &DVector<f64>, new: &[DVector<f64>]) -> f64 {
        let n = new.len();
        let deviations = known_deviations(self.machine);
        let normal = DMatrix::from_fn(n, n, |i, j| {
            let prior = if i == j && i < self.known {
                deviations[i].powi(-2)
            } else {
                0.0
            };
            new[i].dot(&new[j]) + self.old[i].dot(&self.old[j]) + prior
        });
        let scale = DVector::from_fn(n, |i, _| normal[(i, i)].max(f64::MIN_POSITIVE).sqrt());
        let scaled = DMatrix::from_fn(n, n, |i, j| {
            normal[(i, j)] / (scale[i] * scale[j]) + if i == j { 1e-10 } else { 0.0 }
        });
        let right = DVector::from_fn(n, |i, _| new[i].dot(apart) / scale[i]);
        let solved = scaled.cholesky().map(|c| c.solve(&right));
        let explained = solved.map_or(0.0, |s| s.dot(&right));
        (apart.norm_squared() - explained).max(0.0)
    }

    /// A simulated log of the program, to replay.
    fn record(&self, program: &Program) -> Result<LogSet, ReplayError> {
        let mut axis = self.machine.with_known(&self.states[0].shares);
        axis.effects.extend_from_slice(&self.states[0].effects);
        let mut recorder = Recorder::new(&axis);
        ClosedLoop::new(&axis)?
            .run(program, &mut NoCompensation, |cycle| recorder.push(cycle))
            .completed()?;
        let logs = vec![("proposed".to_owned(), recorder.log()?, axis.period)];
        LogSet::prepared(logs, self.machine)
    }
}
