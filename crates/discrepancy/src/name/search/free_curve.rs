//! What is named must do about as well as a free curve.
//!
//! A law that is not in the library can be imitated a little by what is: a friction bump
//! takes away some of a damping that grows along the stroke. A curve over the variables that
//! the effect could stand for, which knows nothing of any law, then does far better.

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

/// Fall of D that a curve brings by chance, a knot.
const BY_CHANCE: f64 = 4.0;

/// Curves of which it is seen how much they tell of check motion.
const TOLD: usize = 4;

/// What free curves explain beside a fit.
pub(super) struct FreeCurves<'a> {
    search: &'a Search<'a>,
    rest: Rest<'a>,
    best: Vec<Best<'a>>,
}

/// One of the curves that explain most.
struct Best<'a> {
    shape: &'a Shape,
    /// By how much D falls beyond chance: as the linearised model of the fitted logs has it, and
    /// no more than by simulation of the check logs.
    gain: f64,
    /// By how much D of the check logs falls, by simulation.
    told: f64,
}

impl<'a> FreeCurves<'a> {
    /// Beside the derivatives of the fit's own parameters.
    pub(super) fn new(search: &'a Search<'a>, fitter: &'a Fitter<'a>, own: &Columns) -> Self {
        let rest = Rest::new(fitter, &search.fit, own, &[]);
        let solved = |(shape, columns): &'a (Shape, Columns)| {
            let solved = rest.solve(columns);
            let gain = solved.gain - BY_CHANCE * columns.len() as f64;
            (shape, gain, solved.values)
        };
        let curves = &search.library.curves.shapes;
        let mut all: Vec<_> = curves.par_iter().map(solved).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        all.truncate(TOLD);
        // What does not hold on other motion explains nothing.
        let told = |(shape, gain, values): (&'a Shape, f64, DVector<f64>)| {
            let (set, fit) = (&search.check_logs, &search.check);
            let told = shape.told(search.machine, set, fit, values.as_slice());
            Best {
                shape,
                gain: gain.min(told),
                told,
            }
        };
        let best = all.into_iter().map(told).collect();
        Self { search, rest, best }
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
        let of_its_own = self.best.iter().filter(|best| stands_for(best.shape));
        let [curve, told] = of_its_own.fold([0.0_f64; 2], |[gain, told], best| {
            [gain.max(best.gain), told.max(best.told)]
        });
        let name = refined.parts.first().map_or("", |p| p.effect.name);
        tracing::debug!(name, gain, curve, held_out, told, "beside a free curve");
        match refined.parts.as_slice() {
            [_] => gain >= SHARE * curve || held_out >= told,
            _ => gain >= SHARE_OF_TWO * curve && held_out >= SHARE_OF_TWO * told,
        }
    }
}
