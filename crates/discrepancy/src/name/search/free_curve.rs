//! What is named must do about as well as a free curve.
//!
//! A law that is not in the library can be imitated a little by what is: a friction bump
//! takes away some of a damping that grows along the stroke. A curve over the variables that
//! the effect could stand for, which knows nothing of any law, then does far better.

use std::sync::OnceLock;

use nalgebra::DVector;
use rayon::prelude::*;

use super::refined::Refined;
use super::state::Search;
use crate::answers::{Rest as Residual, State};
use crate::estimate::columns::Columns;
use crate::estimate::fit::{Fit, Fitter};
use crate::name::curves::{Rest, Shape};
use crate::spectrum::Amplitudes;

/// Share of what the best curve explains that an effect must explain. An effect that is there
/// does about as well as its curve or better, as it has fewer numbers to be found; half leaves
/// room for a law whose form differs.
const SHARE: f64 = 0.5;

/// The same of two effects that are named at once, as neither is worth anything alone: together they
/// imitate much that is neither of them, a step along the way as a spring against a load. Two that are
/// there do as well as any curve; the rest is for noise.
const SHARE_OF_TWO: f64 = 0.9;

/// Fall of D that a number brings by chance, a knot of a curve or a size: as S is estimated from the same
/// data, more than the 1 of χ².
pub(super) const BY_CHANCE: f64 = 4.0;

/// Curves over what an effect depends on, the best of them, of which it is seen how much they tell of
/// check motion.
const TOLD: usize = 4;

/// A law over one variable in the place of effects.
#[derive(Debug)]
pub(super) struct Rival {
    /// On what it depends.
    pub(super) over: String,
    /// Fall of D on the fitted logs, beyond chance.
    pub(super) fit: f64,
    /// The same on the check logs, as far as the fitted motion went: of the law itself, not only of the
    /// parameters that were fitted beside it.
    pub(super) check: f64,
    /// The same of the effects, on the same samples.
    pub(super) of_effects: f64,
}

/// What free curves explain beside a fit.
pub(super) struct FreeCurves<'a> {
    search: &'a Search<'a>,
    rest: Rest<'a>,
    /// Those that explain most first.
    all: Vec<Solved<'a>>,
}

/// Rounds of a law's fit, each weighed by what the last one left.
const ROUNDS: usize = 6;

/// Shares of a step that are tried one after the other.
const SHORTER: [f64; 4] = [1.0, 0.35, 0.12, 0.0];

/// Fall of D that is worth another round with simulations.
const ENOUGH: f64 = 0.5;

/// A law fitted beside all parameters in the linearised model.
struct Beside {
    /// Where that began.
    from: State,
    /// By how much all parameters move, and the law's values.
    step: DVector<f64>,
    /// D of what it leaves, with what its numbers bring by chance.
    deviance: f64,
}

impl Beside {
    /// Weighed in each round by what the last one left, as of a large gap the first is weighed by the gap itself.
    fn of(curve: &Solved<'_>, own: &Columns, fitter: &Fitter<'_>, fit: &Fit) -> Self {
        let columns: Columns = own.iter().chain(curve.columns).cloned().collect();
        let mut left = fit.rest.clone();
        let mut step = DVector::zeros(columns.len());
        for _ in 0..ROUNDS {
            step = fitter.solve_beside(&left, fit, &columns).step;
            left.clone_from(&fit.rest);
            for (column, by) in columns.iter().zip(step.iter()) {
                let pairs = left.iter_mut().flatten().zip(column.iter().flatten());
                pairs.for_each(|(l, c)| *l -= c * *by);
            }
        }
        Self {
            from: fit.state.clone(),
            deviance: fitter.set.layout.deviance(&left)
                + fitter.departure(&fitter.moved(&fit.state, &step, 1.0))
                + BY_CHANCE * curve.columns.len() as f64,
            step,
        }
    }
}

/// A curve, fitted.
struct Solved<'a> {
    shape: &'a Shape,
    /// What its hats do.
    columns: &'a Columns,
    values: DVector<f64>,
    /// By how much D of the fitted logs falls beyond chance, as the linearised model has it.
    gain: f64,
    /// By how much D of the check logs falls, by simulation; once that was asked.
    told: OnceLock<f64>,
}

impl<'a> FreeCurves<'a> {
    /// Beside the derivatives of the fit's own parameters.
    pub(super) fn new(search: &'a Search<'a>, fitter: &'a Fitter<'a>, own: &Columns) -> Self {
        let rest = Rest::new(fitter, &search.fit, own, &[]);
        let solved = |(shape, columns): &'a (Shape, Columns)| {
            let solved = rest.solve(columns);
            Solved {
                shape,
                columns,
                gain: solved.gain - BY_CHANCE * columns.len() as f64,
                values: solved.values,
                told: OnceLock::new(),
            }
        };
        let curves = &search.library.curves.shapes;
        let mut all: Vec<Solved<'a>> = curves.par_iter().map(solved).collect();
        all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        Self { search, rest, all }
    }

    /// By how much D falls with the best curves over something that an effect depends on: on the fitted
    /// logs, no more than on the check logs, as what does not hold on other motion explains nothing; and
    /// on these.
    fn best_over(&self, is_its_own: impl Fn(&Shape) -> bool) -> [f64; 2] {
        let (set, check) = (&self.search.check_logs, &self.search.check);
        let told = |curve: &Solved<'_>| {
            let values = curve.values.as_slice();
            *(curve.told).get_or_init(|| curve.shape.told(self.search.machine, set, check, values))
        };
        let own = self.all.iter().filter(|curve| is_its_own(curve.shape));
        own.take(TOLD).fold([0.0_f64; 2], |[gain, most], curve| {
            let told = told(curve);
            [gain.max(curve.gain.min(told)), most.max(told)]
        })
    }

    /// Number of curves.
    pub(super) fn count(&self) -> usize {
        self.all.len()
    }

    /// The law over one variable that does most on the fitted and the check logs together, beside what all
    /// effects of a search do on the same samples; `None` without curves.
    pub(super) fn most_probable(&self, own: &Columns, effects: &Search<'_>) -> Option<Rival> {
        let (search, fitter) = (self.search, self.search.fitter());
        // Without effects known parameters make up for them, and with them they are where they belong, which may be
        // too far for a linearised model.
        let mut state = search.fit.state.clone();
        state.shares.clone_from(&effects.fit.state.shares);
        let starts = [Some(search.fit.clone()), fitter.at(state).ok()];
        let starts: Vec<Fit> = starts.into_iter().flatten().collect();
        let pairs = self
            .all
            .iter()
            .flat_map(|c| starts.iter().map(move |s| (c, s)));
        let beside = |(curve, start): (_, &Fit)| (curve, Beside::of(curve, own, &fitter, start));
        let mut all: Vec<_> = pairs
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(beside)
            .collect();
        all.sort_by(|(_, a), (_, b)| a.deviance.total_cmp(&b.deviance));
        let rivals = all.iter().take(TOLD * starts.len());
        let rivals = rivals.filter_map(|(curve, beside)| self.rival(curve, own, beside, effects));
        let rivals = rivals.filter(|rival| (rival.fit + rival.check).is_finite());
        rivals.max_by(|a, b| (a.fit + a.check).total_cmp(&(b.fit + b.check)))
    }

    /// The law over the variable of a curve, simulated. `None` if the machine does not run so.
    fn rival(
        &self,
        curve: &Solved<'_>,
        own: &Columns,
        beside: &Beside,
        effects: &Search<'_>,
    ) -> Option<Rival> {
        let Search {
            machine,
            fit,
            check,
            ..
        } = self.search;
        let checker = self.search.checker();
        let (fitted, values) = self.refitted(curve.shape, own.len(), beside)?;
        let shape = curve.shape;
        let on_fit = fit.deviance - fitted.deviance;
        // Beyond the outermost knots nothing is known of the law, so nothing counts there of either.
        let set = checker.set;
        let moved = checker.at(fitted.state).ok()?;
        let fall = |after: &mut Residual| {
            let mut before = set.rest(&check.traces);
            shape.fall_inside(machine, set, check, [&mut before, after])
        };
        let mut with_law = shape.rest(machine, set, &moved, &values).ok()?;
        let mut with_effects = set.rest(&effects.check.traces);
        Some(Rival {
            over: shape.depends_on(),
            fit: on_fit - BY_CHANCE * curve.columns.len() as f64,
            // With other parameters the rest may be nearer by itself; the law must do it.
            check: fall(&mut with_law).min(shape.told(machine, set, &moved, &values)),
            of_effects: fall(&mut with_effects),
        })
    }

    /// A law fitted together with all that is there, from where the linearised model leads on with simulations, as
    /// effects are: known parameters may have moved far to make up for it. The law's values, and the fit with it.
    fn refitted(&self, shape: &Shape, own: usize, beside: &Beside) -> Option<(Fit, Vec<f64>)> {
        let (search, fitter) = (self.search, self.search.fitter());
        let at = |from: &State, values: &[f64], step: &DVector<f64>, length: f64| {
            let alone = fitter.at(fitter.moved(from, step, length)).ok()?;
            let values: Vec<f64> = (values.iter().zip(step.iter().skip(own)))
                .map(|(value, by)| value + length * by)
                .collect();
            let rest = shape.rest(search.machine, fitter.set, &alone, &values);
            let rest = fitter.set.amplitudes(&rest.ok()?);
            let deviance = fitter.set.layout.deviance(&rest) + fitter.departure(&alone.state);
            let fit = Fit {
                rest,
                deviance,
                ..alone
            };
            Some((fit, values))
        };
        let none = vec![0.0; shape.knots.len()];
        let mut best =
            (SHORTER.iter()).find_map(|length| at(&beside.from, &none, &beside.step, *length))?;
        for _ in 0..ROUNDS {
            let (fit, values) = &best;
            let mut columns = fitter.known_columns(fit);
            columns.extend(fitter.effect_columns(fit, 0));
            columns.extend(shape.columns(&fitter, fit));
            let step = fitter.solve_beside(&fit.rest, fit, &columns).step;
            let next = (SHORTER.iter()).find_map(|length| {
                let next = at(&fit.state, values, &step, *length)?;
                (next.0.deviance < fit.deviance - ENOUGH).then_some(next)
            });
            match next {
                Some(next) => best = next,
                None => break,
            }
        }
        Some(best)
    }

    /// Whether what was refined explains about as much as the best curve over what it
    /// depends on, or more: in the linearised model, as the curves are solved, or by what is
    /// simulated on the check logs, where D of the effect falls by `held_out`. Of a gap that is
    /// large the linearised model is a poor one, of both. Of two effects at once both are asked.
    pub(super) fn are_matched_by(&self, refined: &Refined, held_out: f64) -> bool {
        let pair = self.search.fit.rest.iter().zip(&refined.fit.rest);
        let does: Amplitudes = pair
            .map(|(before, after)| before.iter().zip(after).map(|(b, a)| b - a).collect())
            .collect();
        let gain = self.rest.solve(&vec![does]).gain;
        let stands_for = |shape: &Shape| {
            let mut parts = refined.parts.iter();
            parts.any(|part| shape.is_over(part.effect.shown_over))
        };
        let [curve, told] = self.best_over(stands_for);
        let name = refined.parts.first().map_or("", |p| p.effect.name);
        tracing::debug!(name, gain, curve, held_out, told, "beside a free curve");
        match refined.parts.as_slice() {
            [_] => gain >= SHARE * curve || held_out >= told,
            _ => gain >= SHARE_OF_TWO * curve && held_out >= SHARE_OF_TWO * told,
        }
    }
}
