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
use crate::estimate::columns::Columns;
use crate::estimate::fit::Fitter;
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

/// What free curves explain beside a fit.
pub(super) struct FreeCurves<'a> {
    search: &'a Search<'a>,
    rest: Rest<'a>,
    /// Those that explain most first.
    all: Vec<Solved<'a>>,
}

/// A curve, fitted.
struct Solved<'a> {
    shape: &'a Shape,
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

    /// On what the curve depends that does most on the fitted and the check logs together, and by how much
    /// D falls with it there beyond chance; `None` without curves.
    pub(super) fn most_probable(&self) -> Option<(String, f64)> {
        let (set, check) = (&self.search.check_logs, &self.search.check);
        let together = |curve: &Solved<'_>| {
            let values = curve.values.as_slice();
            let told = || curve.shape.told(self.search.machine, set, check, values);
            (
                curve.shape.depends_on(),
                curve.gain + curve.told.get_or_init(told),
            )
        };
        let best = self.all.iter().take(TOLD).map(together);
        best.max_by(|a, b| a.1.total_cmp(&b.1))
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
