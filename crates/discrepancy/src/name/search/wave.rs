//! At what period a force that repeats in time is sought.
//!
//! A log of the duration T tells frequencies apart that lie 1/T from each other, and D has a
//! minimum in nearly each of these steps: the few periods that a library starts at lead past the
//! truth. But a load that repeats leaves a line in the rest, so the frequencies of its strongest
//! lines are tried beside the library's.

use axis_sim::Trace;

use super::evidence::HELD_OUT;
use super::lines::{Line, duration, strongest};
use super::refined::Refined;
use super::state::Search;
use crate::answers::Prepared;
use crate::estimate::columns::{Columns, free_parameters};
use crate::estimate::fit::Fit;
use crate::estimate::thin::Thin;
use crate::name::library::Candidate;
use crate::name::screen::Screened;
use crate::spectrum::share_of_wave;

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

/// Share of the speed's power in a wave from which the motion is that wave: most of it.
const DRIVEN: f64 = 0.5;

/// Fall of D on check logs by another amplitude and phase there, beside which a hum is no load: of two
/// numbers by chance, or this share of what the load brings, which is a phase off by 13 degrees.
const OTHER_PHASE: f64 = 25.0;
const SHARE_OF_PHASE: f64 = 0.05;

impl Search<'_> {
    /// Loads that repeat with the strongest lines of the rest, beside the derivatives of the
    /// fit's own parameters.
    pub(super) fn waves(&self, own: &Columns) -> Vec<Screened> {
        let library = self.library.candidates.iter();
        let Some(known) = library.clone().find(|c| c.effect.name == REPEATS) else {
            return Vec::new();
        };
        if !self.wanted(known.effect, &self.awaited()) {
            return Vec::new();
        }
        let [shortest, longest] = known.effect.parameters[PERIOD].bounds(&known.scales);
        let periods = self
            .lines()
            .into_iter()
            .map(|(frequency, _)| 1.0 / frequency);
        let candidate = |period: f64| self.begun_at(known, PERIOD, period);
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
            false => self.lines_of_replays(&set.layout.spectral_matrices(&self.fit.rest)),
        };
        strongest(lines, OF_LINE / longest, |_| 1.0 / longest)
    }

    /// Share of the fall of D on the fitted logs that a candidate must bring on others. None is asked of an effect beside a form: most
    /// of what they bring together may be the form's, on the slow motion of one log.
    pub(super) fn held_out_of(&self, candidate: &Refined) -> f64 {
        let is_wave = |part: &Screened| part.effect.name == REPEATS;
        if candidate.has_form() && !candidate.is_form() {
            0.0
        } else if candidate.parts.iter().all(is_wave) {
            HELD_OUT_OF_WAVE
        } else {
            HELD_OUT
        }
    }

    /// Whether a candidate is a load that would repeat, and no log goes on for long enough to show
    /// that it does: whatever is slow looks like a part of a wave.
    pub(super) fn hardly_repeats(&self, candidate: &Refined) -> bool {
        let all = self.fit_logs.logs.iter().chain(&self.check_logs.logs);
        let longest = all.map(duration).fold(0.0, f64::max);
        let mut added = candidate.added().iter();
        added.any(|a| a.effect.name == REPEATS && REPEATED * a.values[PERIOD] > longest)
    }

    /// Whether a candidate is a load that would repeat with the motion of all logs: whatever depends on
    /// that, as friction and inertia, is then the same wave.
    pub(super) fn repeats_with_the_drive(&self, candidate: &Refined) -> bool {
        let sets = [
            (&self.fit_logs, &self.fit.traces),
            (&self.check_logs, &self.check.traces),
        ];
        let logs = || {
            sets.iter()
                .flat_map(|(set, traces)| set.logs.iter().zip(*traces))
        };
        let is_driven = |frequency: f64| {
            let share = |(log, trace): (&Prepared, &Trace)| {
                share_of_wave(log.log.time(), &trace.speed, frequency)
            };
            logs().all(|one| share(one) > DRIVEN)
        };
        let mut added = candidate.added().iter();
        added.any(|a| a.effect.name == REPEATS && is_driven(1.0 / a.values[PERIOD]))
    }

    /// Whether a candidate is a load that would repeat faster than motion does, and has another phase or
    /// size on check logs, where its fall of D is `held_out`: noise may hum, with a phase of its own in each log.
    pub(super) fn is_out_of_phase(&self, candidate: &Refined, check: &Fit, held_out: f64) -> bool {
        let effects = &check.state.effects;
        let new = effects.iter().enumerate().rev();
        let mut new = new.take(candidate.parts.len());
        let Some((place, load)) = new.find(|(_, a)| a.effect.name == REPEATS) else {
            return false;
        };
        let set = &self.check_logs;
        let motion = set.layout.bands().next().map_or(0.0, |([_, high], _)| high);
        if load.values[PERIOD] * motion > 1.0 {
            return false;
        }
        let numbers = free_parameters(&check.state);
        let is_own = |(effect, parameter): (usize, usize)| effect == place && parameter != PERIOD;
        let columns = self.checker().effect_columns(check, 0);
        let own = columns.into_iter().zip(numbers);
        let own: Columns = own.filter(|(_, n)| is_own(*n)).map(|(c, _)| c).collect();
        let whitener = (set.layout).whitener(&set.layout.spectral_matrices(&check.rest));
        let white = |a| set.layout.whiten(&whitener, a);
        let thin = Thin::of(&own.iter().map(white).collect::<Vec<_>>());
        let (rest, does) = (white(&check.rest), &thin.basis);
        let other = does.tr_mul(&rest).norm_squared();
        tracing::debug!(other, held_out, "of another phase on check logs");
        other > OTHER_PHASE.max(SHARE_OF_PHASE * held_out)
    }
}
