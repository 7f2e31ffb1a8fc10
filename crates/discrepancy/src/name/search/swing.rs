//! At what frequency a body that swings by itself is sought.

use axis_sim::effects::Nature;
use rayon::prelude::*;

use super::lines::{Line, Spectral, duration, strongest};
use super::state::Search;
use crate::estimate::columns::Columns;
use crate::name::library::{Candidate, RESONANCE_PERIODS};
use crate::name::screen::Screened;

/// Width of the line of a body that swings, as a share of its frequency.
const WIDTH: f64 = 0.1;

impl Search<'_> {
    /// Bodies that swing at the frequencies at which the replayed logs' rest stands out most, beside
    /// the derivatives of the fit's own parameters: what the library starts at lies too far apart
    /// for a resonance. Beside balances it starts at all frequencies.
    ///
    /// `noise` is its spectral matrices, where they are known: a body with some damping fills a band
    /// of its own, and stands out beside them alone.
    pub(super) fn resonances(&self, own: &Columns, noise: &[Spectral]) -> Vec<Screened> {
        let mut library = self.library.candidates.iter();
        let known = library.find_map(|c| Some((c, c.effect.place_of(is_frequency)?)));
        let awaited = self.awaited();
        let known =
            known.filter(|(c, _)| !self.fit_logs.is_balanced() && self.wanted(c.effect, &awaited));
        let Some((known, at)) = known else {
            return Vec::new();
        };
        let longest = self.fit_logs.logs.iter().map(duration).fold(0.0, f64::max);
        let [least, _] = known.effect.parameters[at].bounds(&known.scales);
        let slowest = (RESONANCE_PERIODS / longest).max(least);
        let lines = strongest(self.lines_of_replays(noise), slowest, |f| WIDTH * f);
        tracing::debug!(?lines, "where a body may swing");
        let candidate = |(frequency, _): Line| self.begun_at(known, at, frequency);
        let bodies: Vec<Candidate> = lines.into_par_iter().map(candidate).collect();
        self.screened_beside(own, &bodies, known.effect.parameters.len())
    }
}

/// Whether a number is the frequency of a body that swings.
pub(super) fn is_frequency(nature: &Nature) -> bool {
    matches!(nature, Nature::Frequency(..))
}
