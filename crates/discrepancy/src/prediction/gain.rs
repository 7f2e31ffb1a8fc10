//! Expected fall of D.

use axis_sim::effects::{ActiveEffect, Effect};
use nalgebra::{DMatrix, DVector};

use super::{Hypothesis, Prediction};
use crate::answers::State;
use crate::estimate::bounded::bounded;
use crate::estimate::known::{known_deviations, tolerances};
use crate::name::gap::MATERIAL_OF_NOISE;
use crate::name::search::needed;
use crate::spectrum::Amplitudes;

impl Prediction {
    /// Fall of D that naming an effect takes.
    pub(super) fn needed(&self, effect: &Effect) -> f64 {
        let tried = self.library.candidates.len();
        needed(&self.logs.layout, effect.parameters.len(), tried, 0.01)
    }

    /// Residual of a response beside others and known parameters.
    pub(super) fn beside(
        &self,
        supposed: &Hypothesis,
        own: &Amplitudes,
        others: &[&Amplitudes],
    ) -> Beside {
        let (noise, shares) = (supposed.noise, &self.shares(supposed)[..]);
        let all: Vec<&Amplitudes> = self.known.iter().chain(others.iter().copied()).collect();
        let columns: Vec<DVector<f64>> = all.iter().map(|c| self.white(c, noise)).collect();
        let off = |own: DVector<f64>| {
            let pairs = columns.iter().zip(shares);
            pairs.fold(own, |sum, (c, &s)| sum + c * s)
        };
        let (gain, fitted) = self.gain(&columns, &off(self.white(own, noise)), shares);
        let mut left = own.clone();
        for (i, column) in all.into_iter().enumerate() {
            let by = shares.get(i).copied().unwrap_or(0.0) - fitted[i];
            add(&mut left, column, by);
        }
        Beside {
            gain,
            material: self.material(&left, supposed),
            shares: fitted[..shares.len()].to_vec(),
            columns,
        }
    }

    /// Power of a residual in the channel that shows it most, over what is material beside noise.
    fn material(&self, rest: &Amplitudes, supposed: &Hypothesis) -> f64 {
        let powers = self.logs.layout.power(std::slice::from_ref(rest));
        let over = |(c, own): (usize, f64)| {
            let by = supposed.of_channels.get(c).copied();
            own / ((MATERIAL_OF_NOISE * by.unwrap_or(supposed.noise)).powi(2) * self.power[c])
        };
        let shares = powers.into_iter().enumerate().map(over);
        shares.filter(|share| share.is_finite()).fold(0.0, f64::max)
    }

    /// D of what the columns leave of a change, the first of them known
    /// parameters' and kept inside their tolerance, less D of the truth, at whose
    /// shares nothing is left; and the columns' factors at which that is.
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
        (left - price, x.iter().copied().collect())
    }

    pub(super) fn white(&self, amplitudes: &Amplitudes, noise: f64) -> DVector<f64> {
        self.logs.layout.whiten(&self.whitener, amplitudes) / noise
    }

    /// What an effect does to the nominal machine's logs; `None` if that does not run.
    pub(super) fn response(&self, effect: &ActiveEffect) -> Option<Amplitudes> {
        let mut state = State::initial(&self.machine);
        state.effects.push(effect.clone());
        let traces = self.logs.simulate(&self.machine, &state).ok()?;
        Some(self.logs.difference(&traces, &self.nominal.traces, 1.0))
    }
}

/// Residual of a response beside others.
pub(super) struct Beside {
    /// Expected fall of D.
    pub(super) gain: f64,
    /// Its power in the channel that shows it most, over what the search calls material.
    pub(super) material: f64,
    /// Shares at which known parameters make up for most of it.
    pub(super) shares: Vec<f64>,
    /// Known parameters and the others, whitened.
    pub(super) columns: Vec<DVector<f64>>,
}

fn add(sum: &mut Amplitudes, column: &Amplitudes, by: f64) {
    for (sum, column) in sum.iter_mut().zip(column) {
        sum.iter_mut().zip(column).for_each(|(s, c)| *s += *c * by);
    }
}
