//! A hypothesis about its own solution: shapes and sizes free, simulated anew in each round.

use axis_sim::effects::{ActiveEffect, EffectParameter, Nature, Scales};
use nalgebra::{Complex, DMatrix};

use super::base::{Base, add, prior_of, size_over_typical};
use super::evidence::{CHOICE, Prior, between, evidence};
use super::hypotheses::{Explanation, Law, Space};
use super::likelihood::Likelihood;
use super::products::Reference;
use crate::answers::{Prepared, State};
use crate::estimate::columns::{Columns, free_parameters};
use crate::estimate::known::{known_deviations, tolerances};
use crate::name::library::{RESONANCE_PERIODS, values_at};
use crate::spectrum::Amplitudes;

/// A hypothesis at its solution.
#[derive(Clone, Debug)]
pub struct Solution {
    /// ln of prior probability times evidence.
    pub ln: f64,
    pub state: State,
    /// What is left with it.
    pub left: Amplitudes,
}

const ROUNDS: usize = 6;

/// Moves of all free numbers, in their deviations, below which it ends, and above which the rounds have
/// not come there.
const STILL: f64 = 0.3;
const ARRIVED: f64 = 1.0;

/// Share of its tolerance to which a known parameter is moved.
const INSIDE: f64 = 0.999;

/// Where the rounds begin.
pub struct Begun {
    pub state: State,
    pub law: Option<Law>,
    pub form: Option<usize>,
    /// Deviations of effects and of a law over their typical sizes.
    pub deviations: Vec<f64>,
    /// ln of the prior, but for shapes and sizes.
    pub ln_prior: f64,
}

impl Base<'_> {
    /// What is known of an explanation, to begin with.
    pub fn begun(&self, of: &Explanation, space: &Space) -> Begun {
        let scales = Scales::of(self.machine);
        let deviations = known_deviations(self.machine);
        let known = deviations.len();
        let before = &self.fit.state.shares;
        let shares = (0..known).map(|i| before[i] + of.evidence.x[i] * deviations[i]);
        let form = of.form.map_or(0, |f| space.forms[f].priors.len());
        let mut effects = self.fit.state.effects.clone();
        let free = free_parameters(&self.fit.state).into_iter();
        for (i, ((e, p), unit)) in free.zip(self.kept_units()).enumerate() {
            let [low, high] = effects[e].effect.parameters[p].bounds(&scales);
            let value = &mut effects[e].values[p];
            *value = (*value + of.evidence.x[known + i] * unit).clamp(low, high);
        }
        let mut at = space.always.len() + form;
        for shaped in &of.effects {
            let sizes = &of.evidence.x.as_slice()[at..at + shaped.columns.len()];
            at += shaped.columns.len();
            effects.push(ActiveEffect {
                effect: shaped.effect,
                values: values_at(shaped.effect, &shaped.values, sizes, &scales),
            });
        }
        Begun {
            state: State {
                shares: shares.collect(),
                effects,
            },
            law: of.law,
            form: of.form,
            deviations: of.evidence.deviations.clone(),
            ln_prior: of.ln - of.evidence.ln_z + of.ln_shapes(),
        }
    }

    /// Natural frequencies that these logs show, Hz; `None` of any other number.
    fn shown(&self, parameter: &EffectParameter) -> Option<[f64; 2]> {
        let is_frequency = matches!(parameter.nature, Nature::Frequency(..));
        let logs = || self.set.logs.iter();
        let longest = logs().map(Prepared::duration).fold(0.0, f64::max);
        let highest = logs().map(|l| 0.5 / l.period).fold(0.0, f64::max);
        is_frequency.then(|| [RESONANCE_PERIODS / longest, highest])
    }

    /// `None` where the machine does not run with it.
    pub fn relinearised(
        &self,
        of: Begun,
        spectra: &[DMatrix<Complex<f64>>],
        space: &Space,
    ) -> Option<Solution> {
        let scales = Scales::of(self.machine);
        let (deviations, most) = (known_deviations(self.machine), tolerances(self.machine));
        let known = deviations.len();
        let inside = |share: f64, i: usize| share.clamp(-INSIDE * most[i], INSIDE * most[i]);
        let mut state = of.state;
        for (i, share) in state.shares.iter_mut().enumerate() {
            *share = inside(*share, i);
        }
        let form = of.form.map_or(0, |f| space.forms[f].priors.len());
        let there = self.fit.state.effects.len();
        let linear = space.always.len() - known - self.kept_units().len() + form;
        let begun = state.clone();
        let mut always: Columns = self.known_per_deviation();
        always.extend(self.small_laws());
        always.extend(of.form.map_or(Vec::new(), |f| self.form(f)));
        let law = of
            .law
            .map_or(Vec::new(), |(law, length)| self.law(law, length));
        let fitter = self.fitter();
        let mut best: Option<(Solution, f64)> = None;
        for _ in 0..ROUNDS {
            let fit = fitter.at(state.clone()).ok()?;
            let slopes = fitter.effect_columns(&fit, 0);
            let free = free_parameters(&state);
            let mut columns: Vec<&Amplitudes> = vec![&fit.rest];
            columns.extend(&always);
            let mut priors = self.of_known(&state.shares, 1);
            let unit = |column: usize| Prior {
                column,
                mean: 0.0,
                precision: 1.0,
                room: None,
            };
            priors.extend((0..linear).map(|i| unit(1 + known + i)));
            let mut units = Vec::new();
            let mut scaled: Columns = Vec::new();
            let mut normal = 0.0;
            for (&(e, p), slope) in free.iter().zip(&slopes) {
                let parameter = &state.effects[e].effect.parameters[p];
                let value = state.effects[e].values[p];
                let first = begun.effects[e].values[p];
                let deviation = match e.checked_sub(there) {
                    Some(new) => {
                        let own = first.abs() / parameter.typical(&scales).abs();
                        of.deviations[new].max(own)
                    }
                    None => size_over_typical(&begun.effects[e], &scales),
                };
                let (unit, mut prior) = prior_of(&state.effects[e], p, first, deviation, &scales);
                if let Some(shown) = self.shown(parameter) {
                    let room = shown.map(|edge| (edge - value) / unit);
                    prior.room = Some([room[0].min(0.0), room[1].max(0.0)]);
                }
                if parameter.is_size() && e >= there {
                    let edges = parameter
                        .bounds(&scales)
                        .map(|edge| edge / (deviation * unit));
                    normal -= between(edges[0], edges[1]).ln();
                }
                priors.push(Prior {
                    column: columns.len() + scaled.len(),
                    ..prior
                });
                units.push(unit);
                let mut column = slope.clone();
                column.iter_mut().flatten().for_each(|v| *v *= unit);
                scaled.push(column);
            }
            columns.extend(&scaled);
            for column in &law {
                let precision = of.deviations[state.effects.len() - there].powi(-2);
                priors.push(Prior {
                    precision,
                    ..unit(columns.len())
                });
                columns.push(column);
            }
            let products = Reference::new(self.layout(), spectra).products(&columns);
            let found = evidence(&products, Likelihood::Referenced, &priors, &[]);
            let ln = found.ln_z + of.ln_prior + normal - CHOICE * of.deviations.len() as f64;
            let first = known + linear;
            let step = found.x.rows(first, free.len()).into_owned();
            let moves = (0..free.len()).map(|i| {
                let own = found.covariance[(first + i, first + i)].sqrt();
                step[i].abs() / own.max(1e-150)
            });
            let moved = moves.fold(0.0, f64::max);
            let mut left = fit.rest.clone();
            for (column, x) in columns[1..].iter().zip(found.x.iter()) {
                add(&mut left, column, -x);
            }
            let solution = Solution {
                ln,
                state: state.clone(),
                left,
            };
            let is_better = best.as_ref().is_none_or(|(b, before)| {
                moved < ARRIVED && moved < *before || *before >= ARRIVED && ln > b.ln
            });
            if is_better {
                best = Some((solution, moved));
            }
            for (i, share) in state.shares.iter_mut().enumerate() {
                *share = inside(*share + found.x[i] * deviations[i], i);
            }
            for (i, &(e, p)) in free.iter().enumerate() {
                let parameter = &state.effects[e].effect.parameters[p];
                let [low, high] = parameter.bounds(&scales);
                let value = &mut state.effects[e].values[p];
                let most = match parameter.is_size() {
                    true => 3.0 * value.abs() + 0.02 * units[i],
                    false => 0.7 * units[i],
                };
                *value = (*value + (step[i] * units[i]).clamp(-most, most)).clamp(low, high);
            }
            if moved < STILL {
                break;
            }
        }
        best.map(|(solution, _)| solution)
    }
}
