//! The step in which a channel is quantised.

/// A grid that samples lie on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantum {
    /// Distance of the grid's values, in the channel's unit.
    pub step: f64,
    /// Share of the changes from sample to sample that are whole numbers of steps, to a
    /// twentieth of one.
    pub on_grid: f64,
}

/// Share of the changes that must be whole steps.
const LEAST: f64 = 0.9;
/// Distance from the grid, in steps.
const NEAR: f64 = 0.05;
/// Relative distance of differences that recur.
const SAME: f64 = 0.02;
/// Smallest step over the rounding of the greatest value.
const ABOVE_ROUNDING: f64 = 64.0;
/// Most samples that are looked at, evenly spread in stretches.
const MOST: usize = 1 << 18;

/// The quantisation step: the smallest recurring difference of neighbours, or a whole part
/// of it (to an eighth), of which nine tenths of the changes are multiples. It is refined
/// on ever larger differences. Finite samples.
pub(super) fn quantum(samples: &[f64]) -> Option<Quantum> {
    let x = &samples[..samples.len().min(MOST)];
    let largest = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let least = ABOVE_ROUNDING * f64::EPSILON * largest;
    let steps = x.windows(2).map(|w| (w[1] - w[0]).abs());
    let mut steps: Vec<f64> = steps.filter(|d| *d > least).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let recur = [5, (steps.len() / 100).max(5)].into_iter();
    let firsts = recur.filter_map(|often| recurring(&steps, often));
    let parts = firsts.flat_map(|first| (1..=8).map(move |part| first / f64::from(part)));
    parts
        .map(|step| refined(&steps, step))
        .filter(|step| *step > least)
        .map(|step| Quantum {
            step,
            on_grid: on_grid(x, step),
        })
        .find(|q| q.on_grid >= LEAST)
}

/// The smallest value that so many of the sorted differences have.
fn recurring(steps: &[f64], often: usize) -> Option<f64> {
    let from = (0..steps.len().checked_sub(often)? + 1)
        .find(|&k| steps[k + often - 1] <= steps[k] * (1.0 + SAME))?;
    let same = steps[from..]
        .iter()
        .take_while(|d| **d <= steps[from] * (1.0 + SAME));
    let (sum, count) = same.fold((0.0, 0.0), |(s, n), d| (s + d, n + 1.0));
    Some(sum / count)
}

/// Least squares over differences of up to 2, 4, 8, … steps, as far as each is surely a
/// whole number of them.
fn refined(steps: &[f64], mut step: f64) -> f64 {
    let mut most = 2.0;
    while most <= 4096.0 {
        let (mut cross, mut square) = (0.0, 0.0);
        for d in steps.iter().take_while(|d| **d < (most + 0.5) * step) {
            let n = (d / step).round();
            if n > 0.0 && (d / step - n).abs() < 0.1 {
                cross += n * d;
                square += n * n;
            }
        }
        if square > 0.0 {
            step = cross / square;
        }
        most *= 2.0;
    }
    step
}

/// Share of neighbours a whole number of steps apart, 0 steps counted: a grid may drift
/// against the step over a long way, but not from one sample to the next.
fn on_grid(x: &[f64], step: f64) -> f64 {
    let on = |w: &&[f64]| {
        let n = (w[1] - w[0]) / step;
        (n - n.round()).abs() < NEAR * (1.0 + 1e-3 * n.abs())
    };
    let moved = x.windows(2).filter(|w| w[1] != w[0]).count();
    let fits = x.windows(2).filter(|w| w[1] != w[0]).filter(on).count();
    if moved == 0 {
        0.0
    } else {
        fits as f64 / moved as f64
    }
}
