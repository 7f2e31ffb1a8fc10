//! Uneven time stamps: values on an even grid.
//!
//! Stamps are uneven for one of two reasons. A computer that polls a drive takes samples when it
//! comes to it: stamps are right, samples uneven. Or a drive samples evenly, and what stamps its
//! messages is late by turns: samples are even, stamps wrong. Or a program stamps what it read the
//! round before: samples are those of the row before, or of the next. Which it is shows in what
//! moves smoothly: each sample is predicted from its neighbours, at the instants that are stamped,
//! at those of the rows beside it, and at even ones, and the instants that predict best are right.

use crate::channel::Channel;
use crate::numeric::grid::Grid;
use crate::numeric::order::median;
use crate::quality::MAX_JITTER;

/// Farthest from an even grid at which rows have a clear place on it, periods.
const CLEAR: f64 = 0.25;
/// Longest step inside which there is something to interpolate, typical steps.
const LONGEST: f64 = 2.5;
/// How much better (logarithm of the RMS) one kind of instants must predict to be trusted.
const CLEARLY: f64 = 0.1;
/// Steps whose standard deviation is more than this share of a period have no grid,
const MOST_SPREAD: f64 = 0.75;
/// nor have steps of which more than this share is longer.
const MOST_LONG: f64 = 0.05;

/// What uneven stamps are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stamps {
    /// The instants of the samples.
    Samples,
    /// Those of the samples so many rows on, which come late by as many.
    Row(i64),
    /// Those of messages about samples that are even.
    Messages,
}

/// Instants and what they are of.
pub(super) struct Evened {
    pub stamps: Stamps,
    /// Greatest distance of a stamp from the grid, periods.
    pub jitter: f64,
    /// s.
    pub period: f64,
    pub time: Vec<f64>,
}

/// Puts channels (NaN if there is no value) with uneven stamps on an even grid; `None`,
/// and nothing changed, where stamps are even, too wild, or mostly missing.
pub(super) fn even_out(time: &[f64], channels: &mut [Channel]) -> Option<Evened> {
    let found = Grid::of(time)?;
    if found.jitter[0] <= MAX_JITTER {
        return None;
    }
    let steps = Steps::of(time, &found)?;
    match stamps(time, &steps, channels) {
        stamps @ (Stamps::Samples | Stamps::Row(_)) => {
            let rows = match stamps {
                Stamps::Row(rows) => rows,
                _ => 0,
            };
            let time = moved(time, channels, rows);
            let steps = Steps::of(time, &Grid::of(time)?)?;
            let (start, period) = (time[0], steps.period);
            // Rounding must not cost the last row.
            let last = ((time[time.len() - 1] - start) / period + 1e-6).floor() as usize;
            let rows = last.saturating_add(1);
            if rows > MOST_EMPTY.saturating_mul(time.len()) {
                return None;
            }
            let even: Vec<f64> = (0..rows).map(|k| start + k as f64 * period).collect();
            for channel in channels {
                channel.samples = interpolated(time, &steps, &channel.samples, &even);
            }
            Some(Evened {
                stamps,
                jitter: found.jitter[0],
                period,
                time: even,
            })
        }
        Stamps::Messages => {
            let grid = Grid::fit(time, steps.places.clone());
            let at = |&place: &usize| grid.start + place as f64 * grid.period;
            Some(Evened {
                stamps: Stamps::Messages,
                jitter: grid.jitter[0],
                period: grid.period,
                time: grid.places.iter().map(at).collect(),
            })
        }
    }
}

/// Steps from row to row.
struct Steps {
    /// s.
    period: f64,
    longest: f64,
    /// Index of each row on the grid.
    places: Vec<usize>,
}

impl Steps {
    fn of(time: &[f64], found: &Grid) -> Option<Self> {
        let steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
        let longest = LONGEST * median(&mut steps.clone());
        if found.jitter[0] <= CLEAR {
            return Some(Self {
                period: found.period,
                longest,
                places: found.places.clone(),
            });
        }
        let ordinary: Vec<f64> = steps.iter().copied().filter(|s| *s <= longest).collect();
        let count = ordinary.len() as f64;
        let period = ordinary.iter().sum::<f64>() / count;
        let square = |step: &f64| (step - period).powi(2);
        let spread = (ordinary.iter().map(square).sum::<f64>() / count).sqrt();
        let long = (steps.len() - ordinary.len()) as f64;
        if spread > MOST_SPREAD * period || long > MOST_LONG * steps.len() as f64 {
            return None;
        }
        let mut place = 0_usize;
        let next = steps.iter().map(|&step| {
            place = place.saturating_add(match step > longest {
                true => (step / period).round() as usize,
                false => 1,
            });
            place
        });
        Some(Self {
            period,
            longest,
            places: std::iter::once(0).chain(next).collect(),
        })
    }

    /// Whether no step from row `from` to row `to` is a gap.
    fn joined(&self, time: &[f64], from: usize, to: usize) -> bool {
        time[from..=to]
            .windows(2)
            .all(|w| w[1] - w[0] <= self.longest)
    }
}

/// Gives each sample the stamp of the row that it is of, where samples come so many rows late:
/// rows at the ends that have no stamp or no sample go. The stamps that are left.
fn moved<'a>(time: &'a [f64], channels: &mut [Channel], rows: i64) -> &'a [f64] {
    let gone = rows.unsigned_abs() as usize;
    let left = time.len().saturating_sub(gone);
    for channel in channels {
        match rows > 0 {
            true => drop(channel.samples.drain(..gone)),
            false => channel.samples.truncate(left),
        }
    }
    match rows > 0 {
        true => &time[..left],
        false => &time[gone..],
    }
}

/// Rows by which samples may stand beside their stamps.
const ROWS: [i64; 2] = [1, -1];

/// What the channel says that tells most.
fn stamps(time: &[f64], steps: &Steps, channels: &[Channel]) -> Stamps {
    let even: Vec<f64> = steps.places.iter().map(|&p| p as f64).collect();
    let told = channels.iter().filter_map(|channel| {
        let even = surprise(time, &even, steps, &channel.samples)?;
        let ratio = |instants: &[f64]| {
            let stamped = surprise(time, instants, steps, &channel.samples)?;
            Some((stamped / even).ln()).filter(|ratio| ratio.is_finite())
        };
        let own = ratio(time)?;
        let beside = ROWS.map(|rows| Some((ratio(&beside(time, rows))?, Stamps::Row(rows))));
        let best = beside.into_iter().flatten();
        let best = best.min_by(|a, b| a.0.total_cmp(&b.0));
        // The row's own stamp unless another is clearly better.
        Some(match best {
            Some((ratio, stamps)) if ratio < own - CLEARLY => (ratio, stamps),
            _ => (own, Stamps::Samples),
        })
    });
    let most = told.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    match most {
        Some((ratio, stamps)) if ratio < -CLEARLY => stamps,
        // Where nothing tells, values stay as they are.
        _ => Stamps::Messages,
    }
}

/// The stamps of the rows that samples are of which come so many rows late; at the ends, where there
/// is none, as far before and behind as the first and last steps.
fn beside(time: &[f64], rows: i64) -> Vec<f64> {
    let last = time.len() as i64 - 1;
    let at = |k: i64| {
        let inside = k.clamp(0, last);
        let step = match k < 0 {
            true => time[1] - time[0],
            false => time[last as usize] - time[last as usize - 1],
        };
        time[inside as usize] + (k - inside) as f64 * step
    };
    (0..=last).map(|k| at(k - rows)).collect()
}

/// RMS of what the two neighbours on each side, at those instants, do not predict.
fn surprise(time: &[f64], instants: &[f64], steps: &Steps, samples: &[f64]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for k in 2..samples.len().saturating_sub(2) {
        if !steps.joined(time, k - 2, k + 2) {
            continue;
        }
        let around = [k - 2, k - 1, k + 1, k + 2];
        let off = samples[k] - lagrange(instants, samples, &around, instants[k]);
        if off.is_finite() {
            sum += off * off;
            count += 1.0;
        }
    }
    (sum > 0.0).then(|| (sum / count).sqrt())
}

/// The polynomial through the values of these rows, at an instant.
fn lagrange(time: &[f64], samples: &[f64], rows: &[usize], at: f64) -> f64 {
    let term = |&row: &usize| {
        let others = rows.iter().filter(|&&other| other != row);
        let factor = |&other: &usize| (at - time[other]) / (time[row] - time[other]);
        samples[row] * others.map(factor).product::<f64>()
    };
    rows.iter().map(term).sum()
}

/// Values at even instants: by a cubic through the two rows on either side, by fewer beside a
/// gap; NaN inside one.
fn interpolated(time: &[f64], steps: &Steps, samples: &[f64], even: &[f64]) -> Vec<f64> {
    let one = |&at: &f64| {
        let after = time.partition_point(|t| *t <= at).clamp(1, time.len() - 1);
        let before = after - 1;
        if !steps.joined(time, before, after) || samples[before].is_nan() || samples[after].is_nan()
        {
            return f64::NAN;
        }
        let is_near = |row: usize, next: usize| {
            !samples[row].is_nan() && steps.joined(time, row.min(next), row.max(next))
        };
        let mut rows = vec![before, after];
        if before > 0 && is_near(before - 1, before) {
            rows.push(before - 1);
        }
        if after + 1 < time.len() && is_near(after + 1, after) {
            rows.push(after + 1);
        }
        lagrange(time, samples, &rows, at)
    };
    even.iter().map(one).collect()
}

/// Rows of the grid for each row there is.
pub(super) const MOST_EMPTY: usize = 4;
