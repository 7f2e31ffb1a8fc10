//! By how much one file's clock is late against another's, from channels of one quantity.

use super::done::FileDelay;
use super::recording::{Even, Recording};
use crate::channel::Channel;
use crate::numeric::align::{Fit, Free, align, integral};
use crate::numeric::holes::{bridge, runs};
use crate::numeric::resample::Resampler;
use crate::unit::stem_of;

/// Correlation below which two channels do not tell a delay.
pub(super) const SURE: f64 = 0.95;

/// How one channel follows from another.
#[derive(Clone, Copy, PartialEq)]
enum Law {
    Same,
    /// The second is the first's derivative.
    Derivative,
    /// The second is the first's integral.
    Integral,
}

/// The best-correlated pair of channels that show one quantity, on a grid of `period`.
pub(super) fn between(first: &Recording, other: &Recording, period: f64) -> Option<FileDelay> {
    let (grid_a, grid_b) = (first.even().ok()?, other.even().ok()?);
    let mut best: Option<FileDelay> = None;
    for (a, late_a) in first.channels.iter().zip(&first.delays) {
        for (b, late_b) in other.channels.iter().zip(&other.delays) {
            let Some(law) = law(&a.name, &b.name) else {
                continue;
            };
            let moved = |grid: Even, late: &f64| Even {
                start: grid.start - late,
                ..grid
            };
            let pair = [(a, moved(grid_a, late_a)), (b, moved(grid_b, late_b))];
            let found = estimate(pair, period, law);
            let Some(fit) = found.filter(|f| f.correlation > SURE && f.factor > 0.0) else {
                continue;
            };
            if best
                .as_ref()
                .is_none_or(|b| fit.delay_error * period < b.standard_error)
            {
                best = Some(FileDelay {
                    channels: [a.name.clone(), b.name.clone()],
                    delay: fit.delay * period,
                    standard_error: fit.delay_error * period,
                    correlation: fit.correlation,
                });
            }
        }
    }
    best
}

/// Whether two channels are one quantity or one is the derivative of the other: by name,
/// position, speed and acceleration taken for the same word.
fn law(a: &str, b: &str) -> Option<Law> {
    if a == b {
        return Some(Law::Same);
    }
    let (a, b) = (quantity(a)?, quantity(b)?);
    match (a.0 == b.0 && a.1 == b.1, b.2 - a.2) {
        (true, 1) => Some(Law::Derivative),
        (true, -1) => Some(Law::Integral),
        _ => None,
    }
}

/// The stem without the word for the derivative, whether it turns, and the derivative.
fn quantity(name: &str) -> Option<(String, bool, i32)> {
    const WORDS: [(&str, i32); 5] = [
        ("position", 0),
        ("angle", 0),
        ("velocity", 1),
        ("speed", 1),
        ("acceleration", 2),
    ];
    let (stem, unit) = stem_of(name)?;
    let (order, turns) = match unit {
        "m" => (0, false),
        "m/s" => (1, false),
        "m/s²" => (2, false),
        "rad" => (0, true),
        "rad/s" => (1, true),
        "rad/s²" => (2, true),
        _ => return None,
    };
    let (word, _) = WORDS
        .iter()
        .find(|(w, o)| *o == order && stem.contains(w))?;
    Some((stem.replace(word, "*"), turns, order))
}

/// How late the second channel is against the first, each with its instants, in periods of a common grid.
fn estimate([(a, at_a), (b, at_b)]: [(&Channel, Even); 2], period: f64, law: Law) -> Option<Fit> {
    let end = |grid: Even, c: &Channel| grid.start + (c.samples.len() - 1) as f64 * grid.period;
    let from = at_a.start.max(at_b.start);
    let to = end(at_a, a).min(end(at_b, b));
    let count = ((to - from) / period).floor();
    if count.is_nan() || count < 32.0 {
        return None;
    }
    let on_grid = |c: &Channel, grid: Even| -> Vec<f64> {
        let mut samples = c.samples.clone();
        let holes = runs(&samples);
        bridge(&mut samples, &holes);
        let resampler = Resampler::new(period / grid.period);
        let at = |k: usize| (from + k as f64 * period - grid.start) / grid.period;
        (0..count as usize)
            .map(|k| resampler.at(&samples, at(k)))
            .collect()
    };
    let (x, y) = (on_grid(a, at_a), on_grid(b, at_b));
    let drift = law != Law::Same;
    let (x, y) = match law {
        Law::Same => (x, y),
        Law::Derivative => (x, integral(&y)),
        Law::Integral => (integral(&x), y),
    };
    let delay = Some(count as usize / 2);
    align(&x, &y, Free { delay, drift })
}
