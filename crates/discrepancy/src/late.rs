//! A reference that is late in its log.
//!
//! Channels of one row are seldom taken at one instant: a reference may be logged some part of a sample, or
//! some samples, after or before the position beside it. A loop with the gain k_v from way to speed then
//! seems to lack k_v δ of velocity feed-forward, to first order the same. That is a state of the logs, not of
//! the machine: it is looked for beside what a search has found, and told.

use axis_sim::{Axis, ReplayError};

use crate::answers::{Answer, LogSet, State};
use crate::estimate::fit::{Fit, Fitter};
use crate::name::search::Found;

/// Samples by which a reference is late or early at most, and steps in which that is sought first.
const MOST: f64 = 4.0;
const STEP: f64 = 0.5;

/// Parabolas through three points, each a third as wide.
const PARABOLAS: usize = 4;

/// Fall of D that a delay has to bring beside what was found, or a search beside it: one number by chance.
const BY_CHANCE: f64 = 25.0;

/// Difference of D within which two explanations are one class.
const EQUAL: f64 = 15.0;

/// What of a controller a delay of its reference looks like.
const LOOKS_LIKE: [&str; 4] = [
    "velocity-feedforward",
    "controller-gain",
    "speed-controller-gain",
    "control-delay",
];

/// Rounds in which known parameters and effects follow.
const ROUNDS: usize = 3;

/// A reference that is late in its logs.
#[derive(Clone, Debug)]
pub(crate) enum Late {
    /// By so much, s; early where that is negative. It explains more than what was found without it.
    Plainly(f64),
    /// By so much, s, or else that effect is there: these logs cannot tell.
    OrEffect(f64, &'static str),
}

impl LogSet {
    /// The same logs with their references read so much later in the log (s), and defects as they were.
    pub(crate) fn with_references_late(&self, by: f64) -> Self {
        let mut set = self.clone();
        for log in &mut set.logs {
            if let Answer::Replay(replay) = &log.answer {
                log.answer = Answer::Replay(replay.clone().with_late_reference(by));
            }
        }
        set
    }
}

/// Whether the references of logs are late, beside what was found in them.
///
/// # Errors
/// [`ReplayError`] where the machine as it was found does not run.
pub(crate) fn late_reference(machine: &Axis, found: &Found) -> Result<Option<Late>, ReplayError> {
    let set = &found.fit_logs;
    if set.is_balanced() {
        return Ok(None);
    }
    let mut state = found.fit.state.clone();
    let mut effects = state.effects.iter();
    let place = effects.position(|active| LOOKS_LIKE.contains(&active.effect.name));
    let instead = place.map(|place| state.effects[place].effect.name);
    if let Some(place) = place {
        state.remove(place);
    }
    let Some((by, fit)) = best(machine, set, &state)? else {
        return Ok(None);
    };
    let fall = found.fit.deviance - fit.deviance;
    let check = |set: &LogSet, state: &State| -> Result<f64, ReplayError> {
        Ok(Fitter { machine, set }.at(state.clone())?.deviance)
    };
    let without = check(&found.check_logs, &found.fit.state)?;
    let with = check(&found.check_logs.with_references_late(by), &fit.state)?;
    tracing::debug!(
        by,
        fall,
        held_out = without - with,
        ?instead,
        "a late reference"
    );
    Ok(match instead {
        _ if fall > BY_CHANCE && without - with > 0.0 => Some(Late::Plainly(by)),
        Some(effect) if fall > -EQUAL => Some(Late::OrEffect(by, effect)),
        _ => None,
    })
}

/// Whether an effect of the controller was named that a delay of its reference looks like.
pub(crate) fn looks_late(state: &State) -> bool {
    let mut effects = state.effects.iter();
    effects.any(|active| LOOKS_LIKE.contains(&active.effect.name))
}

/// The delay of the references with the lowest D, known parameters and effects fitted beside it; `None`
/// where that is none.
fn best(machine: &Axis, set: &LogSet, state: &State) -> Result<Option<(f64, Fit)>, ReplayError> {
    let period = set.logs.iter().map(|log| log.period);
    let period = period.fold(0.0, f64::max);
    let deviance = |by: f64| {
        let set = set.with_references_late(by * period);
        let fit = Fitter { machine, set: &set }.at(state.clone());
        fit.map_or(f64::INFINITY, |fit| fit.deviance)
    };
    let steps = (MOST / STEP) as i32;
    let tried = (-steps..=steps).map(|k| STEP * f64::from(k));
    let tried = tried.map(|by| (by, deviance(by)));
    let Some(mut here) = tried.min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Ok(None);
    };
    let mut step = STEP;
    for _ in 0..PARABOLAS {
        let [below, above] = [-step, step].map(|by| deviance(here.0 + by));
        let bend = above + below - 2.0 * here.1;
        let by = match bend > 0.0 && bend.is_finite() {
            true => (0.5 * step * (below - above) / bend).clamp(-step, step),
            false => 0.0,
        };
        let there = (here.0 + by, deviance(here.0 + by));
        if there.1 < here.1 {
            here = there;
        }
        step /= 3.0;
    }
    if here.0 == 0.0 || !here.1.is_finite() {
        return Ok(None);
    }
    let by = here.0 * period;
    let set = set.with_references_late(by);
    let fitter = Fitter { machine, set: &set };
    let fit = fitter.at(state.clone())?;
    let known = fitter.known_columns(&fit);
    Ok(Some((by, fitter.refine(fit, &known, ROUNDS))))
}

/// Fall of D beside a late reference from which on a search with it counts.
pub(crate) fn is_better(before: &Fit, after: &Fit) -> bool {
    before.deviance - after.deviance > BY_CHANCE
}

/// What must be known of it.
pub(crate) fn note(by: f64, set: &LogSet) -> String {
    let samples = set.logs.first().map_or(0.0, |log| by / log.period).abs();
    let way = if by > 0.0 { "late" } else { "early" };
    format!(
        "the reference is {way} in these logs, by {:.3} ms or {samples:.2} samples against what was measured: it was read so much {}; delay_ms = {:.3} in its [[log.column]] says so, and a delay that is none of the logs would show as velocity feed-forward",
        1e3 * by.abs(),
        if by > 0.0 { "earlier" } else { "later" },
        1e3 * by
    )
}

/// What must be known of it where an effect does as much.
pub(crate) fn note_beside(by: f64, effect: &str, set: &LogSet) -> String {
    let samples = set.logs.first().map_or(0.0, |log| by / log.period).abs();
    let way = if by > 0.0 { "late" } else { "early" };
    format!(
        "{effect}, or a reference that is {way} in these logs, by {:.3} ms or {samples:.2} samples: these logs cannot tell; where the logger is known, delay_ms in the reference's [[log.column]] decides",
        1e3 * by.abs()
    )
}
