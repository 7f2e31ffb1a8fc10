//! A record in segments: their transforms, averaged.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use axis_fourier::{Complex, RealToComplex};

use crate::error::ResponseError;

/// How a record is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Averaging {
    /// Segments of so many samples under Hann's window, each half over the next: for any signal. The
    /// lines are the sampling rate over the segment apart.
    Welch {
        /// Samples of a segment.
        segment: usize,
    },
    /// Whole periods of a periodic excitation: no leakage, and the scatter from period to period
    /// shows the noise.
    Periods {
        /// Samples of a period.
        period: usize,
        /// Periods at the start that are left out, while the response settles.
        skip: usize,
    },
}

/// Averaged powers and cross powers of three signals on one line.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Powers {
    pub rr: f64,
    pub uu: f64,
    pub yy: f64,
    /// Of input and output with the excitation, S_ru = mean of R* U.
    pub ru: Complex<f64>,
    pub ry: Complex<f64>,
    /// Of the output with the input, mean of U* Y.
    pub uy: Complex<f64>,
}

/// Powers on all lines from 0, and how many independent averages they are of.
pub(crate) struct Averaged {
    pub powers: Vec<Powers>,
    pub averages: f64,
    /// Samples of a segment.
    pub segment: usize,
    /// Lowest line that the means taken off the segments leave as it is.
    pub lowest: usize,
}

/// Shortest segment, samples.
pub(crate) const SHORTEST: usize = 16;

impl Averaging {
    /// Length of a segment, distance of two, and where the first begins.
    fn cut(self) -> Result<[usize; 3], ResponseError> {
        let (segment, hop, from) = match self {
            Self::Welch { segment } => (segment, segment / 2, 0),
            Self::Periods { period, skip } => (period, period, skip.saturating_mul(period)),
        };
        match segment {
            SHORTEST.. => Ok([segment, hop, from]),
            _ => Err(ResponseError::Setting {
                name: "the segment",
                value: segment as f64,
                valid: "16 samples at least",
            }),
        }
    }

    fn window(self, n: usize) -> Vec<f64> {
        match self {
            Self::Welch { .. } => (0..n)
                .map(|k| 0.5 - 0.5 * (TAU * k as f64 / n as f64).cos())
                .collect(),
            Self::Periods { .. } => vec![1.0; n],
        }
    }

    /// Averages over records of three signals, each of equal length; those that hold no segment are
    /// left out.
    pub(crate) fn average(self, records: &[[&[f64]; 3]]) -> Result<Averaged, ResponseError> {
        let [n, hop, from] = self.cut()?;
        let count_of = |record: &[&[f64]; 3]| {
            let left = record[0].len().checked_sub(from.saturating_add(n));
            left.map_or(0, |left| left / hop + 1)
        };
        let total: usize = records.iter().map(count_of).sum();
        if total < 2 {
            let found = records.iter().map(|record| record[0].len()).max();
            return Err(ResponseError::TooShort {
                found: found.unwrap_or(0),
                wanted: from.saturating_add(n).saturating_add(hop),
            });
        }
        let window = self.window(n);
        let mut sums = Sums::new(n);
        let mut averages = 0.0;
        for record in records {
            let count = count_of(record);
            let drifts = record.map(|signal| match self {
                Self::Periods { .. } if count > 1 => drifts(signal, from, n, count),
                _ => vec![0.0; count],
            });
            let [r, u, y] = &drifts;
            for (k, ((r, u), y)) in r.iter().zip(u).zip(y).enumerate() {
                let begin = from + k * hop;
                let parts = record.map(|signal| &signal[begin..begin + n]);
                sums.add(parts, [*r, *u, *y], &window);
            }
            if count > 0 {
                averages += independent(&window, hop, count);
            }
        }
        Ok(Averaged {
            powers: sums.means(total),
            averages,
            segment: n,
            // Hann's window brings line 0 into line 1.
            lowest: match self {
                Self::Welch { .. } => 2,
                Self::Periods { .. } => 1,
            },
        })
    }
}

/// Sums of powers over segments.
struct Sums {
    plan: Arc<dyn RealToComplex<f64>>,
    part: Vec<f64>,
    lines: [Vec<Complex<f64>>; 3],
    powers: Vec<Powers>,
}

impl Sums {
    fn new(n: usize) -> Self {
        let plan = axis_fourier::forward(n);
        Self {
            part: vec![0.0; n],
            lines: [0; 3].map(|_| plan.make_output_vec()),
            powers: vec![Powers::default(); n / 2 + 1],
            plan,
        }
    }

    fn add(&mut self, parts: [&[f64]; 3], slopes: [f64; 3], window: &[f64]) {
        for ((part, slope), lines) in parts.iter().zip(slopes).zip(&mut self.lines) {
            trendless(part, slope, window, &mut self.part);
            // Its lengths are those of the plan.
            let _ = self.plan.process(&mut self.part, lines);
        }
        let [r, u, y] = &self.lines;
        for (i, p) in self.powers.iter_mut().enumerate() {
            p.rr += r[i].norm_sqr();
            p.uu += u[i].norm_sqr();
            p.yy += y[i].norm_sqr();
            p.ru += r[i].conj() * u[i];
            p.ry += r[i].conj() * y[i];
            p.uy += u[i].conj() * y[i];
        }
    }

    fn means(mut self, count: usize) -> Vec<Powers> {
        let scale = 1.0 / count as f64;
        for p in &mut self.powers {
            p.rr *= scale;
            p.uu *= scale;
            p.yy *= scale;
            p.ru *= scale;
            p.ry *= scale;
            p.uy *= scale;
        }
        self.powers
    }
}

/// A segment without its mean and, where that is not 0, a slope, under a window.
fn trendless(signal: &[f64], slope: f64, window: &[f64], out: &mut [f64]) {
    let n = signal.len() as f64;
    let (mean, middle) = (mean(signal), 0.5 * (n - 1.0));
    for (k, out) in out.iter_mut().enumerate() {
        *out = (signal[k] - mean - slope * (k as f64 - middle)) * window[k];
    }
}

fn mean(signal: &[f64]) -> f64 {
    signal.iter().sum::<f64>() / signal.len() as f64
}

/// Slope of the drift in each whole period: from the means of its neighbours, which drift alone changes.
/// A straight line fitted within a period would take a part of the response too.
fn drifts(signal: &[f64], from: usize, period: usize, count: usize) -> Vec<f64> {
    let period_at = |k: usize| &signal[from + k * period..from + (k + 1) * period];
    let means: Vec<f64> = (0..count).map(|k| mean(period_at(k))).collect();
    let slope = |k: usize| {
        let (low, high) = (k.saturating_sub(1), (k + 1).min(count - 1));
        (means[high] - means[low]) / ((high - low) * period) as f64
    };
    (0..count).map(slope).collect()
}

/// Independent averages that `count` segments are worth which overlap: P. D. Welch, IEEE Transactions
/// on Audio and Electroacoustics 15 (1967) 70–73, doi:10.1109/TAU.1967.1161901. With ρ_j the square
/// of the window's normalised product with itself j hops later, count/(1 + 2 Σ (1 − j/count) ρ_j).
fn independent(window: &[f64], hop: usize, count: usize) -> f64 {
    let n = window.len();
    let power: f64 = window.iter().map(|w| w * w).sum();
    let mut sum = 1.0;
    for j in 1..count {
        let shift = j * hop;
        if shift >= n {
            break;
        }
        let product: f64 = (0..n - shift).map(|k| window[k] * window[k + shift]).sum();
        let rho = (product / power).powi(2);
        sum += 2.0 * (1.0 - j as f64 / count as f64) * rho;
    }
    count as f64 / sum
}

/// What the differences of a signal are to the signal at a frequency: (1 − e^{−jωT})/T.
pub(crate) fn of_difference(frequency_hz: f64, period_s: f64) -> Complex<f64> {
    let half = PI * frequency_hz * period_s;
    // 1 − e^{−2jh} = 2j sin h e^{−jh}, without cancelling at low frequencies.
    Complex::from_polar(2.0 * half.sin() / period_s, 0.5 * PI - half)
}
