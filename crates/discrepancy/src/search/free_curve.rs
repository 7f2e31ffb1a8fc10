//! What is named must do about as well as a free curve.
//!
//! A law that is not in the library can be imitated a little by what is: a friction bump
//! takes away some of a damping that grows along the stroke. A curve over the variables that
//! the effect could stand for, which knows nothing of any law, then does far better.

use rayon::prelude::*;

use super::refined::Refined;
use super::state::Search;
use crate::fit::Columns;
use crate::lack::Rest;
use crate::spectrum::Amplitudes;

/// Share of what the best curve explains that an effect must explain. Of effects that were
/// there it was 0.9 and more, of those that were not and were imitated 0.1 to 0.3.
const SHARE: f64 = 0.5;

/// Fall of D that a curve brings by chance, a knot.
const BY_CHANCE: f64 = 4.0;

/// What the best of the free curves explains beside a fit.
pub(super) struct FreeCurve<'a> {
    search: &'a Search<'a>,
    rest: Rest<'a>,
    /// Fall of D, beyond chance.
    gain: f64,
}

impl<'a> FreeCurve<'a> {
    /// Beside the derivatives of the fit's own parameters.
    pub(super) fn new(
        search: &'a Search<'a>,
        fitter: &'a crate::fit::Fitter<'a>,
        own: &Columns,
    ) -> Self {
        let rest = Rest::of(fitter, &search.fit, own, &[]);
        let gain = |columns: &Columns| rest.solve(columns).gain - BY_CHANCE * columns.len() as f64;
        let curves = &search.library.curves.shapes;
        let gains = curves.par_iter().map(|(_, columns)| gain(columns));
        let gain = gains.reduce(|| 0.0, f64::max);
        Self { search, rest, gain }
    }

    /// Whether what was refined explains about as much as the best curve, or more.
    pub(super) fn is_matched_by(&self, refined: &Refined) -> bool {
        let pair = self.search.fit.rest.iter().zip(&refined.fit.rest);
        let does: Amplitudes = pair
            .map(|(before, after)| before.iter().zip(after).map(|(b, a)| b - a).collect())
            .collect();
        let gain = self.rest.solve(&vec![does]).gain;
        let name = refined.parts.first().map_or("", |p| p.effect.name);
        tracing::debug!(name, gain, curve = self.gain, "beside a free curve");
        gain >= SHARE * self.gain
    }
}
