//! The linearised problem, and how far its solution may be followed.

use axis_sim::effects::{Nature, Scales};
use nalgebra::{DMatrix, DVector};

use crate::answers::State;
use crate::estimate::bounded::{bounded, inverse_of};
use crate::estimate::columns::{Columns, free_parameters};
use crate::estimate::fit::{Fit, Fitter};
use crate::estimate::known::{known_deviations, tolerances};
use crate::estimate::smooth::Smooth;
use crate::estimate::thin::products;
use crate::spectrum::Amplitudes;

/// The linearised problem, solved.
pub struct Solved {
    /// To its minimum inside the known parameters' tolerance.
    pub step: DVector<f64>,
    /// The same where the parameters of effects, too, move no farther than their derivatives hold;
    /// `None` if they do so anyway. Of two that do nearly the same, as a force and the way over
    /// which it comes, one that is cut short afterwards leaves the other where it is of no use.
    pub inside: Option<DVector<f64>>,
    /// By how much D falls on the way, if the problem is as linear as that.
    pub promised: f64,
    /// Of all parameters.
    pub covariance: DMatrix<f64>,
}

impl Fitter<'_> {
    /// Step and covariance of all parameters from the linearised problem: the
    /// rest's own spectral matrices as weights, the tolerances as priors.
    pub fn solve(&self, fit: &Fit, columns: &Columns) -> Solved {
        self.solve_beside(&fit.rest, fit, columns, None)
    }

    /// The same with the spectral matrices of another rest as weights, and where a curve is among the parameters, with that as a
    /// Gaussian process.
    pub(crate) fn solve_beside(
        &self,
        weighing: &Amplitudes,
        fit: &Fit,
        columns: &Columns,
        curve: Option<&Smooth<'_>>,
    ) -> Solved {
        let layout = &self.set.layout;
        let whitener = layout.whitener(&layout.spectral_matrices(weighing));
        let rest = layout.whiten(&whitener, &fit.rest);
        let known = fit.state.shares.len();
        let n = columns.len();
        let mut jacobian = DMatrix::zeros(rest.len(), n);
        for (i, column) in columns.iter().enumerate() {
            jacobian.set_column(i, &layout.whiten(&whitener, column));
        }
        let mut normal = products(&jacobian);
        let mut right = jacobian.tr_mul(&rest);
        for (i, deviation) in known_deviations(self.machine).into_iter().enumerate() {
            let weight = deviation.powi(-2);
            normal[(i, i)] += weight;
            right[i] -= weight * fit.state.shares[i];
        }
        if let Some(curve) = curve {
            curve.add_to(&mut normal, &mut right);
        }
        let tolerances = tolerances(self.machine);
        let of_effects = self.rooms_of_effects(&fit.state);
        let of_known = |i: usize| {
            let (share, most) = (fit.state.shares.get(i)?, tolerances[i]);
            Some([-most - share, most - share])
        };
        let step = bounded(&normal, &right, of_known);
        let mut pairs = of_effects.iter().zip(step.iter().skip(known));
        let leaves = |([low, high], by): (&[f64; 2], &f64)| !(low..=high).contains(&by);
        let inside = pairs.any(leaves).then(|| {
            let of_effect = |i: usize| of_effects.get(i.checked_sub(known)?).copied();
            bounded(&normal, &right, |i| of_known(i).or_else(|| of_effect(i)))
        });
        Solved {
            promised: 2.0 * step.dot(&right) - step.dot(&(&normal * &step)),
            inside,
            step,
            covariance: inverse_of(&normal),
        }
    }

    /// The standard deviation of the first number of an effect that was added to those whose derivatives `own` are.
    pub(crate) fn deviation_of_added(&self, fit: &Fit, own: &Columns) -> f64 {
        let new = self.effect_columns(fit, own.len() - fit.state.shares.len());
        let columns: Columns = own.iter().cloned().chain(new).collect();
        let at = own.len();
        self.solve(fit, &columns).covariance[(at, at)].sqrt()
    }

    /// A state so far along a step of all its parameters, inside their bounds.
    pub(crate) fn moved(&self, state: &State, step: &DVector<f64>, length: f64) -> State {
        let scales = Scales::of(self.machine);
        let rooms = self.rooms_of_effects(state);
        let mut state = state.clone();
        let known = state.shares.len();
        for (share, by) in state.shares.iter_mut().zip(step.iter()) {
            *share += length * by;
        }
        let free = free_parameters(&state).into_iter().zip(rooms);
        for (i, ((e, p), [least, most])) in free.enumerate() {
            let [low, high] = state.effects[e].effect.parameters[p].bounds(&scales);
            let value = &mut state.effects[e].values[p];
            let by = (length * step[known + i]).clamp(least, most);
            *value = (*value + by).clamp(low, high);
        }
        state
    }

    /// By how much one step may change each free parameter of the effects, down and up: inside its
    /// bounds, and of a shape not so far that its derivative is another one.
    fn rooms_of_effects(&self, state: &State) -> Vec<[f64; 2]> {
        let scales = Scales::of(self.machine);
        let room = |(e, p): (usize, usize)| {
            let parameter = &state.effects[e].effect.parameters[p];
            let value = state.effects[e].values[p];
            let most = match parameter.nature {
                _ if parameter.is_size() => f64::INFINITY,
                Nature::Phase => 1.0,
                // Of one of any order of magnitude, where it is.
                Nature::Speed(..) => 0.5 * value.abs(),
                _ => 0.3 * parameter.typical(&scales).abs().max(value.abs()),
            };
            let [low, high] = parameter.bounds(&scales);
            [
                (low - value).clamp(-most, 0.0),
                (high - value).clamp(0.0, most),
            ]
        };
        free_parameters(state).into_iter().map(room).collect()
    }
}
