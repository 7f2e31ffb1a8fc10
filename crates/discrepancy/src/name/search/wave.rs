//! At what period a force that repeats in time is sought.
//!
//! A log of the duration T tells frequencies apart that lie 1/T from each other, and D has a
//! minimum in nearly each of these steps: the few periods that a library starts at lead past the
//! truth. But a load that repeats leaves a line in the rest, so the frequencies of its strongest
//! lines are tried beside the library's.

use axis_sim::effects::Scales;
use nalgebra::Complex;

use super::evidence::HELD_OUT;
use super::refined::Refined;
use super::state::Search;
use crate::answers::Prepared;
use crate::estimate::fit::Columns;
use crate::name::library::{Candidate, responses};
use crate::name::screen::Screened;
use crate::spectrum::waves;

/// A load with a period of its own, which is its second number.
const REPEATS: &str = "cyclic-load";
const PERIOD: usize = 1;

/// Periods of it that a log must show for it to be named.
const REPEATED: f64 = 1.5;

/// Periods that a log must show of a line: what is slower may be anything, and is left to the
/// periods that the library starts at.
const OF_LINE: f64 = 3.0;

/// Share of the fall of D on the fitted logs, log for log of the same length, that it must bring
/// on others: it acts alike whatever the motion.
const HELD_OUT_OF_WAVE: f64 = 0.5;

/// Lines that are tried.
const LINES: usize = 3;

/// Frequencies of a balance's lines that are looked at, per resolved step.
const FINER: f64 = 2.0;

/// A frequency, Hz, and how far it stands out there.
type Line = (f64, f64);

impl Search<'_> {
    /// Loads that repeat with the strongest lines of the rest, beside the derivatives of the
    /// fit's own parameters.
    pub(super) fn waves(&self, own: &Columns) -> Vec<Screened> {
        let library = self.library.candidates.iter();
        let Some(known) = library.clone().find(|c| c.effect.name == REPEATS) else {
            return Vec::new();
        };
        if !self.wanted(known.effect, &[]) {
            return Vec::new();
        }
        let fitter = self.fitter();
        let scales = Scales::of(self.machine);
        let [shortest, longest] = known.effect.parameters[PERIOD].bounds(&scales);
        let periods = self
            .lines()
            .into_iter()
            .map(|(frequency, _)| 1.0 / frequency);
        let candidate = |period: f64| {
            let mut values = known.values.clone();
            values[PERIOD] = period;
            Candidate {
                columns: responses(&fitter, &self.fit, known.effect, &values),
                effect: known.effect,
                values,
                scales,
            }
        };
        let periods = periods.filter(|p| (shortest..=longest).contains(p));
        let waves: Vec<Candidate> = periods.map(candidate).collect();
        self.screened_beside(own, &waves, known.effect.parameters.len())
    }

    /// The strongest lines of the fitted logs' rest, the first the strongest.
    fn lines(&self) -> Vec<Line> {
        let set = &self.fit_logs;
        let longest = set.logs.iter().map(duration).fold(0.0, f64::max);
        let lines: Vec<Line> = match set.is_balanced() {
            true => self.lines_of_balances(longest),
            false => self.lines_of_replays(),
        };
        strongest(lines, OF_LINE / longest, 1.0 / longest)
    }

    /// Power of each bin beside that of its band, over all channels.
    fn lines_of_replays(&self) -> Vec<Line> {
        let layout = &self.fit_logs.layout;
        let matrices = layout.spectral_matrices(&self.fit.rest);
        let bands: Vec<[f64; 2]> = layout.bands().map(|(edges, _)| edges).collect();
        let of_bin = |(frequency, bin): (f64, &[Complex<f64>])| {
            let band = bands.iter().position(|[_, high]| frequency < *high)?;
            let power = |c: usize| matrices[band][(c, c)].re.max(f64::MIN_POSITIVE);
            let all = bin.iter().enumerate();
            let stands_out: f64 = all.map(|(c, value)| value.norm_sqr() / power(c)).sum();
            Some((frequency, stands_out))
        };
        layout.bins(&self.fit.rest).filter_map(of_bin).collect()
    }

    /// What a wave takes of the rest by least squares, logs and channels added up.
    fn lines_of_balances(&self, longest: f64) -> Vec<Line> {
        let set = &self.fit_logs;
        let rest = set.rest(&self.fit.traces);
        let periods = set.logs.iter().map(|l| l.period);
        let period = periods.fold(f64::INFINITY, f64::min);
        let length = (FINER * longest / period).ceil().max(1.0) as usize;
        let logs = set.logs.iter().zip(&rest);
        let channels = logs.flat_map(|(log, rest)| rest.iter().map(move |r| (log.log.time(), r)));
        let mut lines: Vec<Line> = Vec::new();
        for (times, rest) in channels {
            let waves = waves(times, rest, period, length);
            match lines.is_empty() {
                true => lines = waves.collect(),
                false => lines
                    .iter_mut()
                    .zip(waves)
                    .for_each(|(all, one)| all.1 += one.1),
            }
        }
        lines
    }

    /// Share of the fall of D on the fitted logs that a candidate must bring on others.
    pub(super) fn held_out_of(&self, candidate: &Refined) -> f64 {
        let is_wave = |part: &Screened| part.effect.name == REPEATS;
        match candidate.parts.iter().all(is_wave) {
            true => HELD_OUT_OF_WAVE,
            false => HELD_OUT,
        }
    }

    /// Whether a candidate is a load that would repeat, and no log goes on for long enough to show
    /// that it does: whatever is slow looks like a part of a wave.
    pub(super) fn hardly_repeats(&self, candidate: &Refined) -> bool {
        let all = self.fit_logs.logs.iter().chain(&self.check_logs.logs);
        let longest = all.map(duration).fold(0.0, f64::max);
        let effects = &candidate.fit.state.effects;
        let mut new = effects.iter().rev().take(candidate.parts.len());
        new.any(|a| a.effect.name == REPEATS && REPEATED * a.values[PERIOD] > longest)
    }
}

/// From the first sample to the last, s.
fn duration(log: &Prepared) -> f64 {
    match log.log.time() {
        [first, .., last] => last - first,
        _ => 0.0,
    }
}

/// The best few lines from the `slowest` frequency on, none nearer than `apart` to a better one.
fn strongest(mut lines: Vec<Line>, slowest: f64, apart: f64) -> Vec<Line> {
    lines.retain(|(frequency, _)| *frequency >= slowest);
    lines.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut best: Vec<Line> = Vec::new();
    for line in lines {
        if best.iter().all(|b| (b.0 - line.0).abs() > apart) {
            best.push(line);
        }
        if best.len() == LINES {
            break;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::strongest;

    #[test]
    fn lines_are_the_strongest_that_are_fast_enough_and_apart() {
        let lines = [
            (0.1, 9.0),
            (1.0, 5.0),
            (1.05, 4.0),
            (2.0, 1.0),
            (3.0, 2.0),
            (4.0, 0.5),
        ];
        let best = strongest(lines.to_vec(), 0.2, 0.1);
        assert_eq!(best, [(1.0, 5.0), (3.0, 2.0), (2.0, 1.0)]);
    }
}
