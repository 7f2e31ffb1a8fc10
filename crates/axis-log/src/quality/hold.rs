//! Sample-and-hold: values that are repeated in motion; and limits that a channel sits at.

/// Values that are repeated while the channel moves: it is updated more slowly than it is
/// recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// Share of the samples in motion that repeat the one before.
    pub repeated: f64,
    /// Mean time between changes in motion, s.
    pub period: f64,
}

/// A value that a channel runs into and stays at, as at a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saturation {
    /// The value, in the channel's unit.
    pub value: f64,
    /// Share of all samples that have it.
    pub share: f64,
    /// Samples of the longest stay.
    pub longest: usize,
}

/// Samples to each side that must differ for one to be in motion.
const HALVES: [usize; 3] = [8, 32, 128];
/// How many steps of quantisation these must be apart.
const STEPS: f64 = 4.0;
/// How many for each sample between: noise of a step must not repeat values.
const STEPS_A_SAMPLE: f64 = 3.0;
/// Share of repeated values that is told.
const LEAST: f64 = 0.2;

/// The hold of a channel with this sampling period and quantisation step (0 for none).
///
/// A sample is in motion where it lies more than four quanta, and three more for each sample
/// between, from those before and after. Finite samples.
pub(super) fn hold(x: &[f64], period: f64, quantum: f64) -> Option<Hold> {
    for half in HALVES {
        let apart = (STEPS + STEPS_A_SAMPLE * half as f64) * quantum;
        let moves = |k: usize| {
            let (before, after) = (x[k] - x[k - half], x[k + half] - x[k]);
            before * after > 0.0 && before.abs().min(after.abs()) > apart
        };
        let last = x.len().saturating_sub(half);
        let (mut moving, mut repeats) = (0_usize, 0_usize);
        for k in half..last {
            if moves(k) {
                moving += 1;
                repeats += usize::from(x[k] == x[k - 1]);
            }
        }
        let changes = moving - repeats;
        if moving < 50.max(x.len() / 100) || changes < 10 {
            continue;
        }
        let repeated = repeats as f64 / moving as f64;
        return (repeated > LEAST).then(|| Hold {
            repeated,
            period: period * moving as f64 / changes as f64,
        });
    }
    None
}

/// Samples in a row that make a stay.
const STAY: usize = 5;

/// The limits of a channel: its greatest or least value where the channel runs into it, at
/// a quarter of its usual speed or more, and stays for five samples. A flat top that a
/// command has by design looks the same. Finite samples.
pub(super) fn saturation(x: &[f64]) -> Vec<Saturation> {
    let steps = x.windows(2).map(|w| (w[1] - w[0]).powi(2));
    let (sum, count) = steps
        .filter(|d| *d > 0.0)
        .fold((0.0, 0.0), |(s, n), d| (s + d, n + 1.0));
    let usual = (sum / f64::max(count, 1.0)).sqrt();
    let (low, high) = x
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
    let limits = [low, high].into_iter();
    limits.filter_map(|value| limit(x, value, usual)).collect()
}

fn limit(x: &[f64], value: f64, usual: f64) -> Option<Saturation> {
    let (mut share, mut longest, mut hard, mut k) = (0, 0, 0, 0);
    while k < x.len() {
        let from = k;
        while k < x.len() && x[k] == value {
            k += 1;
        }
        let stay = k - from;
        share += stay;
        if stay >= STAY {
            longest = longest.max(stay);
            let entry = from
                .checked_sub(3)
                .map_or(0.0, |b| (x[from - 1] - x[b]).abs() / 2.0);
            hard += usize::from(entry > 0.25 * usual);
        }
        k = k.max(from + 1);
    }
    let share = share as f64 / x.len() as f64;
    (hard > 0 && usual > 0.0).then_some(Saturation {
        value,
        share,
        longest,
    })
}
