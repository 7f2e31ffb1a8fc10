//! What a search could see of effects and tell apart, from simulated fingerprints,
//! before any search.

mod gain;
mod types;

use std::sync::Arc;

use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, ReplayError};
use nalgebra::DVector;
use rayon::prelude::*;

pub use self::types::{Hypothesis, Imitation, PredictedEffect};
use crate::answers::{LogSet, State};
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::known::pinned;
use crate::estimate::projector::{Projector, sine};
use crate::estimate::spread::size_over_noise;
use crate::name::library::Library;
use crate::name::screen::{Screened, Screening, imitate};
use crate::name::search::{ABOVE_NOISE, ONE_CLASS, Settings};
use crate::noise::SensorNoise;
use crate::noise::{LogNoise, noise_on};
use crate::spectrum::{Amplitudes, Whitener};

/// What a set of logs will show of effects: what is the same for all of them.
#[derive(Debug)]
pub struct Prediction {
    machine: Axis,
    logs: LogSet,
    nominal: Fit,
    known: Columns,
    library: Arc<Library>,
    /// Of the noise it was made with.
    whitener: Whitener,
    /// That noise, whitened: several runs.
    noise: Vec<DVector<f64>>,
    /// Its mean power in each channel.
    power: Vec<f64>,
}

/// Runs of noise.
const RUNS: u64 = 16;

/// Left of an effect beside another, in D, below which the search may take the
/// other: it takes the simpler of two within 25.
const TELLS_APART: f64 = 40.0;

impl Prediction {
    /// Simulates what these logs need: known parameters, the library, and sensors with
    /// this noise. Of the logs only motion, length and channels count.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine as its file says does not run them.
    pub fn new(machine: &Axis, logs: &LogSet, noise: SensorNoise) -> Result<Self, ReplayError> {
        let fitter = Fitter { machine, set: logs };
        let nominal = fitter.at(State::initial(machine))?;
        let known = fitter.known_columns(&nominal);
        let library = Arc::new(Library::new(&fitter, &nominal, known.clone()));
        let (state, quiet) = (&nominal.state, &nominal.traces);
        let noise = LogNoise::of_sensors(noise);
        let run = |seed| noise_on(machine, state, logs, quiet, &noise, seed);
        let layout = &logs.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(&run(0)?));
        let noise = (1..=RUNS).into_par_iter().map(run);
        let noise: Vec<Amplitudes> = noise.collect::<Result<_, ReplayError>>()?;
        let power = layout.power(&noise);
        let noise = noise.iter().map(|n| layout.whiten(&whitener, n)).collect();
        Ok(Self {
            machine: machine.clone(),
            logs: logs.clone(),
            nominal,
            known,
            library,
            whitener,
            noise,
            power,
        })
    }

    /// What each effect of the library does on these motions, for
    /// [`crate::search_with`].
    pub fn library(&self) -> Arc<Library> {
        self.library.clone()
    }

    /// What can be known of each effect that is supposed; `None` for one that does not
    /// run on the nominal machine, and where the noise is no number above 0.
    pub fn predict(&self, supposed: &Hypothesis) -> Vec<Option<PredictedEffect>> {
        let effects = &supposed.effects;
        let responses: Vec<Option<Amplitudes>> = match is_above_zero(supposed.noise) {
            true => effects.par_iter().map(|e| self.response(e)).collect(),
            false => effects.iter().map(|_| None).collect(),
        };
        let one = |i: usize| {
            let own = responses[i].as_ref()?;
            let others = (0..responses.len()).filter(|&j| j != i);
            let others: Vec<&Amplitudes> = others.filter_map(|j| responses[j].as_ref()).collect();
            Some(self.judge(supposed, &effects[i], own, &others))
        };
        (0..responses.len()).map(one).collect()
    }

    /// Expected fall of D of the first effect that is supposed, alone, over what naming it
    /// takes, or, where that is less, the power by which it brings a channel nearer, over what
    /// is material; infinite if there is none, or none that runs.
    pub fn gain_over_needed(&self, supposed: &Hypothesis) -> f64 {
        let only = supposed.effects.first().and_then(|active| {
            let response = self.response(active)?;
            let beside = self.beside(supposed, &response, &[]);
            let evidence = beside.gain / self.needed(active.effect);
            Some(evidence.min(beside.material))
        });
        only.filter(|_| is_above_zero(supposed.noise))
            .unwrap_or(f64::INFINITY)
    }

    /// One share a known parameter.
    fn shares(&self, supposed: &Hypothesis) -> Vec<f64> {
        let all = supposed.shares.iter().copied();
        let padded = all.chain(std::iter::repeat(0.0));
        padded.take(self.known.len()).collect()
    }

    fn judge(
        &self,
        supposed: &Hypothesis,
        active: &ActiveEffect,
        own: &Amplitudes,
        others: &[&Amplitudes],
    ) -> PredictedEffect {
        let (noise, effect) = (supposed.noise, active.effect);
        let beside = self.beside(supposed, own, others);
        let pinned = pinned(&self.machine, &beside.shares);
        let fitted = Projector::new(&self.machine, &beside.columns, &pinned);
        let seen = fitted.reject(&self.white(own, noise));
        let needed = self.needed(effect);
        let through = |column: &Amplitudes| fitted.reject(&self.white(column, noise));
        let above_noise = size_over_noise(&seen, &self.noise);
        let seen_above = above_noise >= 2f64.sqrt() * ABOVE_NOISE;
        let enough = beside.gain >= 2.0 * needed && beside.material >= 2.0;
        PredictedEffect {
            gain: beside.gain,
            above_noise,
            detectable: enough && seen_above,
            class: self.class_of(effect, &seen, through),
            imitation: self.imitation_of(effect, &seen, through, &supposed.rejected),
        }
    }

    /// Effects that do nearly what is `seen` of one, `through` what is fitted out.
    fn class_of(
        &self,
        effect: &Effect,
        seen: &DVector<f64>,
        through: impl Fn(&Amplitudes) -> DVector<f64> + Sync,
    ) -> Vec<String> {
        let others = |e: &Effect| e.name != effect.name;
        let size = seen.norm_squared();
        let near = |screened: &Screened| {
            let sine = sine(seen, &screened.basis);
            let alike = sine < ONE_CLASS || size * sine * sine < TELLS_APART;
            alike.then(|| screened.effect.name.to_owned())
        };
        let candidates = &self.library.candidates;
        let all = Screening::of(candidates, others, through, seen.clone()).one_by_one();
        let mut class: Vec<String> = all.iter().filter_map(near).collect();
        class.dedup();
        class
    }

    /// What the others make of an effect that the search does not have; `None` if it
    /// has it.
    fn imitation_of(
        &self,
        effect: &Effect,
        seen: &DVector<f64>,
        through: impl Fn(&Amplitudes) -> DVector<f64> + Sync,
        rejected: &[String],
    ) -> Option<Imitation> {
        let is_rejected = |e: &Effect| rejected.iter().any(|r| r == e.name);
        let absent = Effect::named(effect.name).is_none() || is_rejected(effect);
        absent.then(|| {
            let has = |e: &Effect| !is_rejected(e);
            let most = Settings::default().most_effects;
            let (by, left) = imitate(&self.library.candidates, has, through, seen, most);
            Imitation {
                by,
                left,
                complete: left < 2.0 * self.needed(effect),
            }
        })
    }
}

fn is_above_zero(noise: f64) -> bool {
    noise > 0.0 && noise.is_finite()
}
