//! What can be seen in a torque balance, beforehand: [`discrepancy::Prediction`] asks how
//! noise goes round a loop, and a balance has none.
//!
//! The noise is that of the log of the clean machine. Responses are linear, sizes of known
//! parameters have their tolerance as a prior, and of the library each effect has its usual
//! shape only.

use axis_sim::effects::{ActiveEffect, Nature, Scales};
use axis_sim::{Axis, ReplayError};
use discrepancy::{
    Fitter, Imitation, LogSet, MATERIAL_OF_NOISE, ONE_CLASS, PredictedEffect, State,
    known_deviations,
};
use nalgebra::{Complex, DMatrix, DVector};

use super::case::Channels;
use super::design::shown;

/// A response, whitened and as it is.
#[derive(Clone)]
struct Response {
    white: DVector<f64>,
    plain: DVector<f64>,
}

/// Response to an effect; `None` where the machine does not run with it.
type Responding = dyn Fn(&ActiveEffect) -> Option<Response> + Send + Sync;

/// What a torque balance of these logs shows.
pub(super) struct Sight {
    machine: Axis,
    set: LogSet,
    known: Vec<Response>,
    /// Name and columns of each effect.
    library: Vec<(&'static str, Vec<Response>)>,
    response: Box<Responding>,
    /// Of the balance of the clean machine.
    noise: f64,
}

/// Left of an effect beside another, in D, below which the search may take the other.
const TELLS_APART: f64 = 40.0;

/// Effects that a search names at most.
const MOST: usize = 4;

impl Sight {
    /// Of the noisy log of a clean machine.
    pub(super) fn new(machine: &Axis, set: &LogSet) -> Result<Self, ReplayError> {
        let fitter = Fitter { machine, set };
        let nominal = fitter.at(State::initial(machine))?;
        let layout = set.layout.clone();
        let whitener = layout.whitener(&layout.spectral_matrices(&nominal.rest));
        let noise = plain(&nominal.rest).norm_squared();
        let response = move |amplitudes: &Vec<Vec<Complex<f64>>>| Response {
            white: layout.whiten(&whitener, amplitudes),
            plain: plain(amplitudes),
        };
        let known = fitter.known_columns(&nominal);
        let known = known.iter().map(&response).collect();
        let (own, logs) = (machine.clone(), set.clone());
        let response = move |active: &ActiveEffect| {
            let mut state = State::initial(&own);
            state.effects.push(active.clone());
            let traces = logs.simulate(&own, &state).ok()?;
            let response = response(&logs.difference(&traces, &nominal.traces, 1.0));
            // A law may run away before the machine is stopped.
            (response.plain.iter().all(|v| v.is_finite())).then_some(response)
        };
        let columns = |active: &ActiveEffect| alone(active).iter().filter_map(&response).collect();
        let scales = Scales::of(machine);
        let library = shown(machine, Channels::Balance);
        let library = library.into_iter().map(|effect| {
            let values = effect.typical(&scales);
            (effect.name, columns(&ActiveEffect { effect, values }))
        });
        Ok(Self {
            library: library.collect(),
            machine: machine.clone(),
            set: set.clone(),
            known,
            noise,
            response: Box::new(response),
        })
    }

    /// Expected fall of D of an effect alone, over what naming it takes, or, where that is
    /// less, the power that it has in the balance, over what is material.
    pub(super) fn gain_over_needed(&self, active: &ActiveEffect) -> f64 {
        let Some(own) = (self.response)(active) else {
            return f64::INFINITY;
        };
        let left = self.beside(&[]).left(&own);
        (left.gain / self.needed(active)).min(self.material(&left))
    }

    /// Power that is left over what is material.
    fn material(&self, left: &Left) -> f64 {
        left.power / (MATERIAL_OF_NOISE.powi(2) * self.noise)
    }

    /// What can be known of each of these effects.
    pub(super) fn predict(
        &self,
        all: &[ActiveEffect],
        rejected: &[String],
    ) -> Vec<Option<PredictedEffect>> {
        let responses: Vec<Option<Response>> = all.iter().map(|a| (self.response)(a)).collect();
        let one = |i: usize| {
            let own = responses[i].as_ref()?;
            let others = (0..all.len()).filter(|j| *j != i);
            let others: Vec<&Response> = others.filter_map(|j| responses[j].as_ref()).collect();
            Some(self.judge(&all[i], own, &others, rejected))
        };
        (0..all.len()).map(one).collect()
    }

    fn judge(
        &self,
        active: &ActiveEffect,
        own: &Response,
        others: &[&Response],
        rejected: &[String],
    ) -> PredictedEffect {
        let name = active.effect.name;
        let (left, needed) = (self.beside(others).left(own), self.needed(active));
        let gain = left.gain;
        let is_other = |n: &str| n != name && !rejected.iter().any(|r| r == n);
        let left_by = |columns: &[Response]| {
            let beside: Vec<&Response> = others.iter().copied().chain(columns).collect();
            self.beside(&beside).left(own).gain
        };
        let alike = |left: f64| left < TELLS_APART || left < ONE_CLASS * ONE_CLASS * gain;
        let others_of = || self.library.iter().filter(|(n, _)| is_other(n));
        let class = others_of().filter(|(_, columns)| alike(left_by(columns)));
        let absent = !self.library.iter().any(|(n, _)| *n == name) || !is_known(name, rejected);
        PredictedEffect {
            gain,
            above_noise: gain.max(0.0).sqrt(),
            detectable: gain >= 2.0 * needed && self.material(&left) >= 2.0,
            class: class.map(|(n, _)| (*n).to_owned()).collect(),
            imitation: absent.then(|| self.imitation(own, rejected, needed)),
        }
    }

    /// Effects that leave the least, taken one after another.
    fn imitation(&self, own: &Response, rejected: &[String], needed: f64) -> Imitation {
        let (mut by, mut taken): (Vec<String>, Vec<Response>) = (Vec::new(), Vec::new());
        let mut left = self.beside(&[]).left(own).gain;
        while by.len() < MOST && left >= 2.0 * needed {
            let free = self.library.iter().filter(|(n, _)| is_known(n, rejected));
            let with = |columns: &[Response]| {
                let beside: Vec<&Response> = taken.iter().chain(columns).collect();
                self.beside(&beside).left(own).gain
            };
            let scored = free.map(|(n, columns)| (with(columns), *n, columns));
            let Some((least, name, columns)) = scored.min_by(|a, b| a.0.total_cmp(&b.0)) else {
                break;
            };
            by.push(name.to_owned());
            taken.extend(columns.iter().cloned());
            left = least;
        }
        Imitation {
            complete: left < 2.0 * needed,
            by,
            left,
        }
    }

    /// max(2 χ²_{1 − α/K}(p), 0.005 N) of docs/theory/discrepancy.md, K taken as 100: the
    /// quantile by Wilson and Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684,
    /// doi:10.1073/pnas.17.12.684.
    fn needed(&self, active: &ActiveEffect) -> f64 {
        const NORMAL_AT_1E_4: f64 = 3.719;
        let p = active.effect.parameters.len().min(3) as f64;
        let spread = 2.0 / (9.0 * p);
        let quantile = p * (1.0 - spread + NORMAL_AT_1E_4 * spread.sqrt()).powi(3);
        (2.0 * quantile).max(0.005 * self.set.layout.size() as f64)
    }

    fn beside<'a>(&'a self, others: &[&'a Response]) -> Beside<'a> {
        let columns: Vec<&Response> = self.known.iter().chain(others.iter().copied()).collect();
        let deviations = known_deviations(&self.machine);
        let normal = DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            let [one, other] = [i, j].map(|k| &columns[k].white);
            let own = match deviations.get(i) {
                _ if i != j => 0.0,
                Some(deviation) => deviation.powi(-2),
                None => 1e-9 * one.norm_squared() + f64::MIN_POSITIVE,
            };
            one.dot(other) + own
        });
        Beside { columns, normal }
    }
}

/// Amplitudes as a vector of real numbers.
fn plain(amplitudes: &[Vec<Complex<f64>>]) -> DVector<f64> {
    let all = amplitudes.iter().flatten().flat_map(|a| [a.re, a.im]);
    DVector::from_vec(all.collect())
}

fn is_known(name: &str, rejected: &[String]) -> bool {
    !rejected.iter().any(|r| r == name)
}

/// An effect by each of its sizes alone, one with a phase at 0 and π/2.
fn alone(active: &ActiveEffect) -> Vec<ActiveEffect> {
    let parameters = active.effect.parameters;
    let sizes = (0..parameters.len()).filter(|&i| parameters[i].is_size());
    let phase = active.effect.place_of(|n| matches!(n, Nature::Phase));
    let one = |size: usize| {
        let mut own = active.clone();
        let others = (0..parameters.len()).filter(|&i| i != size && parameters[i].is_size());
        others.for_each(|i| own.values[i] = 0.0);
        let turned = phase.map(|at| {
            let mut turned = own.clone();
            turned.values[at] += std::f64::consts::FRAC_PI_2;
            turned
        });
        std::iter::once(own).chain(turned)
    };
    sizes.flat_map(one).collect()
}

/// Least squares on columns, the known parameters' with their priors.
struct Beside<'a> {
    columns: Vec<&'a Response>,
    normal: DMatrix<f64>,
}

/// What columns leave of a response.
struct Left {
    /// In D.
    gain: f64,
    /// Of its amplitudes as they are.
    power: f64,
}

impl Beside<'_> {
    fn left(&self, own: &Response) -> Left {
        let of = |i: usize| self.columns[i].white.dot(&own.white);
        let right = DVector::from_fn(self.columns.len(), |i, _| of(i));
        let solved = self.normal.clone().cholesky().map(|c| c.solve(&right));
        let by = solved.unwrap_or_else(|| DVector::zeros(right.len()));
        let mut plain = own.plain.clone();
        for (column, by) in self.columns.iter().zip(by.iter()) {
            plain.axpy(-by, &column.plain, 1.0);
        }
        Left {
            gain: own.white.norm_squared() - by.dot(&right),
            power: plain.norm_squared(),
        }
    }
}

#[cfg(test)]
mod tests {
    use axis_sim::effects::Effect;

    use super::super::bench::mean_square;
    use super::*;
    use crate::hidden::{Exercise, Rough, Truth};
    use crate::matrix2::{Bench, CaseSetting};

    /// Of a linear response the fall of D goes with the square of its size, and what known
    /// parameters do costs their tolerance and no more: a payload is a part of the load.
    #[test]
    fn a_gain_grows_with_the_square_of_the_size() {
        let file = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../data/axes/linear-motor.toml"
        );
        let axis = Axis::read(file.as_ref()).unwrap();
        let setting = CaseSetting {
            machine: axis.name.clone(),
            exercise: Exercise::ThereAndBack,
            start: 0.2,
            tolerance: 0.05,
            channels: Channels::Balance,
        };
        let bench = Bench::new(&axis, &setting).unwrap();
        let truth = Truth {
            effects: Vec::new(),
            shares: Vec::new(),
            noise: Rough::white(1.0),
            wound: 0.0,
            seed: 1,
        };
        let [noisy, _] = truth
            .noise_logs(&bench.axis, &bench.motions[0], bench.every)
            .unwrap();
        let set = bench.set(0, &noisy).unwrap();
        // The machine is the model: what the balance leaves is small beside the current.
        let traces = set.simulate(&bench.machine, &State::initial(&bench.machine));
        let rest = mean_square(&set.rest(&traces.unwrap()), 0);
        let all = mean_square(&vec![set.logs[0].measured.clone()], 0);
        assert!(rest < 1e-3 * all, "{rest} of {all}");

        let sight = Sight::new(&bench.machine, &set).unwrap();
        let gain = |name: &str, size: f64| {
            let active = ActiveEffect {
                effect: Effect::named(name).unwrap(),
                values: vec![size],
            };
            let own = (sight.response)(&active).unwrap();
            sight.beside(&[]).left(&own).gain
        };
        let ratio = gain("constant-load", 2.0) / gain("constant-load", 1.0);
        assert!((ratio - 4.0).abs() < 1e-6, "{ratio}");
        // The slide's 40 kg are known to 5 % / √3; half of it off is 17 deviations.
        let most = (20.0 / (40.0 * 0.05 / 3f64.sqrt())).powi(2);
        let payload = gain("payload-mass", 20.0);
        assert!(payload > 0.0 && payload <= 1.001 * most, "{payload} {most}");
    }
}
