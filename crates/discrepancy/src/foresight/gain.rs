//! Expected fall of D.

use axis_sim::effects::{ActiveEffect, Effect};
use nalgebra::{DMatrix, DVector};

use super::Foresight;
use crate::answers::State;
use crate::estimate::bounded::bounded;
use crate::estimate::known::{known_deviations, tolerances};
use crate::name::search::needed;
use crate::spectrum::Amplitudes;

impl Foresight {
    /// Fall of D that naming an effect takes.
    pub(super) fn needed(&self, effect: &Effect) -> f64 {
        let tried = self.library.candidates.len();
        needed(&self.logs.layout, effect.parameters.len(), tried, 0.01)
    }

    /// Expected fall of D of a response beside others; the shares at which known
    /// parameters make up for most of it, and all columns beside it.
    pub(super) fn gain_of(
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

    pub(super) fn white(&self, amplitudes: &Amplitudes, noise: f64) -> DVector<f64> {
        self.logs.layout.whiten(&self.whitener, amplitudes) / noise
    }

    /// What an effect does to the nominal machine's logs, beside noise; `None` where that
    /// does not run, or the noise is no number above 0.
    pub(super) fn response(&self, effect: &ActiveEffect, noise: f64) -> Option<DVector<f64>> {
        if !(noise > 0.0 && noise.is_finite()) {
            return None;
        }
        let mut state = State::initial(&self.machine);
        state.effects.push(effect.clone());
        let traces = self.logs.simulate(&self.machine, &state).ok()?;
        let change = self.logs.difference(&traces, &self.nominal.traces, 1.0);
        Some(self.white(&change, noise))
    }
}
