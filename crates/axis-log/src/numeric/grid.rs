//! The even grid behind time stamps, whatever rows are missing.

use super::order::median;

/// Steps longer than this many periods have rows missing inside.
const GAP_PERIODS: f64 = 1.5;

/// The grid `t_k ≈ start + k · period`, and the place of each row on it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grid {
    /// First instant, s.
    pub start: f64,
    /// s; the least-squares slope.
    pub period: f64,
    /// Distance of the rows from the grid, in periods: the greatest and RMS.
    pub jitter: [f64; 2],
    /// The row that is farthest off.
    pub worst: usize,
    /// Index of each row, from 0; increasing.
    pub places: Vec<usize>,
}

impl Grid {
    /// Of two strictly increasing instants or more.
    pub(crate) fn of(time: &[f64]) -> Option<Self> {
        let (first, last) = (*time.first()?, *time.last()?);
        let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
        if steps.is_empty() || !(last - first).is_finite() {
            return None;
        }
        let typical = median(&mut steps);
        // Stamps that are rounded coarsely have a median that is off; the mean of all
        // ordinary steps is not.
        let (sum, count) = (steps.iter())
            .filter(|&&s| s <= GAP_PERIODS * typical)
            .fold((0.0, 0.0), |(sum, count), s| (sum + s, count + 1.0));
        let mean: f64 = sum / count;
        let mut places = Vec::with_capacity(time.len());
        let mut place = 0_usize;
        places.push(place);
        for w in time.windows(2) {
            let step = w[1] - w[0];
            let periods = if step > GAP_PERIODS * typical {
                (step / mean).round().max(2.0)
            } else {
                1.0
            };
            place = place.saturating_add(periods as usize);
            places.push(place);
        }
        Some(Self::fit(time, places))
    }

    /// Least squares of time over place, both taken from their middle so that long logs
    /// with large time stamps keep their digits.
    pub(crate) fn fit(time: &[f64], places: Vec<usize>) -> Self {
        let n = time.len() as f64;
        let middle = places.iter().map(|&p| p as f64).sum::<f64>() / n;
        let elapsed = |t: f64| t - time[0];
        let mean = time.iter().map(|&t| elapsed(t)).sum::<f64>() / n;
        let (mut cross, mut square) = (0.0, 0.0);
        for (&t, &place) in time.iter().zip(&places) {
            let index = place as f64 - middle;
            cross += index * (elapsed(t) - mean);
            square += index * index;
        }
        let period = cross / square;
        let (mut most, mut sum, mut worst) = (0.0, 0.0, 0);
        for (k, (&t, &place)) in time.iter().zip(&places).enumerate() {
            let off = (elapsed(t) - mean - (place as f64 - middle) * period) / period;
            sum += off * off;
            if off.abs() > most {
                (most, worst) = (off.abs(), k);
            }
        }
        Self {
            start: time[0] + mean - middle * period,
            period,
            jitter: [most, (sum / n).sqrt()],
            worst,
            places,
        }
    }

    /// Rows of the grid, those that are missing too.
    pub(crate) fn length(&self) -> usize {
        self.places.last().map_or(0, |p| p.saturating_add(1))
    }
}
