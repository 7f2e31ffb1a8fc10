//! One sequence as a multiple of another that is moved in time, by least squares.

use super::lag::peak;
use super::resample::Resampler;

/// `y(t) ≈ factor · x(t − delay) + offset + drift · t`, and how sure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fit {
    pub factor: f64,
    pub factor_error: f64,
    /// At the first sample, in units of y.
    pub offset: f64,
    pub offset_error: f64,
    /// Units of y a sample.
    pub drift: f64,
    /// Samples; positive where y comes late.
    pub delay: f64,
    pub delay_error: f64,
    /// Correlation of what is fitted with y, both without offset and drift.
    pub correlation: f64,
}

/// What of the fit is free besides factor and offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Free {
    /// Greatest delay looked for, samples; `None` for none.
    pub delay: Option<usize>,
    pub drift: bool,
}

/// Most samples that are aligned: of longer sequences, the stretch in which y moves most.
pub(crate) const MOST: usize = 1 << 16;
/// Rounds of Gauss and Newton about the delay.
const ROUNDS: usize = 12;

/// Fits the multiple, with the delay from the peak of the cross-correlation on, refined by
/// Gauss–Newton steps with x between samples by a windowed sinc. Standard errors allow for
/// rests that are not white: with gradients g and rests e,
/// `G⁻¹ (Σ_|l|≤L w_l Σ_k g_k e_k e_{k+l} g_{k+l}ᵀ) G⁻¹`, w Bartlett's
/// (W. Newey, K. West, Econometrica 55 (1987) 703–708, doi:10.2307/1913610).
/// `None` if x or y does not vary.
pub(crate) fn align(x: &[f64], y: &[f64], free: Free) -> Option<Fit> {
    let range = busiest(x, y);
    let (x, y) = (&x[range.clone()], &y[range]);
    let (varies_x, varies_y) = (spread(x)?, spread(y)?);
    if varies_x == 0.0 || varies_y == 0.0 {
        return None;
    }
    let start = match free.delay {
        Some(most) => {
            let most = most.min(x.len() / 2);
            let level = |v: &[f64]| {
                if free.drift {
                    differences(v)
                } else {
                    v.to_vec()
                }
            };
            peak(&level(x), &level(y), most, x.len() / 4)?.lag
        }
        None => 0.0,
    };
    let sinc = Resampler::new(1.0);
    let mut delay = start;
    let mut fit = solve(x, y, delay, free, &sinc)?;
    if let Some(most) = free.delay {
        for _ in 0..ROUNDS {
            let step = fit.delay - delay;
            if step.abs() < 1e-6 {
                break;
            }
            delay += step.clamp(-1.0, 1.0);
            if delay.abs() > most as f64 {
                return None;
            }
            fit = solve(x, y, delay, free, &sinc)?;
        }
    }
    Some(fit)
}

fn differences(v: &[f64]) -> Vec<f64> {
    v.windows(2).map(|w| w[1] - w[0]).collect()
}

fn spread(v: &[f64]) -> Option<f64> {
    let (low, high) = (v.iter()).fold((f64::MAX, f64::MIN), |(a, b), &v| (a.min(v), b.max(v)));
    (v.len() >= 16 && (high - low).is_finite()).then_some(high - low)
}

/// The stretch of at most [`MOST`] samples in which y moves most.
fn busiest(x: &[f64], y: &[f64]) -> std::ops::Range<usize> {
    let length = x.len().min(y.len());
    if length <= MOST {
        return 0..length;
    }
    let travel = |from: usize| -> f64 {
        let part = &y[from..from + MOST];
        part.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum()
    };
    let starts = (0..=length - MOST).step_by(MOST / 4);
    let from = starts.max_by(|&a, &b| travel(a).total_cmp(&travel(b)));
    let from = from.unwrap_or(0);
    from..from + MOST
}

/// One least-squares step about a delay.
fn solve(x: &[f64], y: &[f64], delay: f64, free: Free, sinc: &Resampler) -> Option<Fit> {
    let n = x.len();
    // Where x is known on both sides; a margin for the kernel's reach, where there is room.
    let margin = if free.delay.is_some() {
        (n / 8).min(16) as f64
    } else {
        0.0
    };
    let from = (delay + margin).ceil().max(0.0) as usize;
    let to = ((n as f64 + delay - margin).floor().max(0.0) as usize).min(n);
    if to <= from + 12 {
        return None;
    }
    let count = to - from;
    let moved: Vec<f64> = (from..to).map(|k| sinc.at(x, k as f64 - delay)).collect();
    let slopes = match free.delay {
        Some(_) => slopes(&moved, &y[from..to]),
        None => vec![0.0; count],
    };
    let mean_x = moved.iter().sum::<f64>() / count as f64;
    let scale_x = moved.iter().map(|v| (v - mean_x).abs()).fold(0.0, f64::max);
    if scale_x == 0.0 {
        return None;
    }
    // The delay's column is scaled by the factor of a first solution without it.
    let base = |i: usize| -> [f64; 3] {
        let along = (2 * i) as f64 / (count - 1) as f64 - 1.0;
        [(moved[i] - mean_x) / scale_x, 1.0, along]
    };
    let used: Vec<usize> = match (free.drift, free.delay.is_some()) {
        (false, false) => vec![0, 1],
        (true, false) => vec![0, 1, 2],
        (false, true) => vec![0, 1, 3],
        (true, true) => vec![0, 1, 2, 3],
    };
    let row = |i: usize| -> [f64; 4] {
        let [a, b, c] = base(i);
        [a, b, c, -slopes[i] / scale_x]
    };
    let rows: Vec<[f64; 4]> = (0..count).map(row).collect();
    let target = &y[from..to];
    let inverse = inverse(&gram(&rows, &used))?;
    let right: Vec<f64> = (used.iter())
        .map(|&c| rows.iter().zip(target).map(|(r, y)| r[c] * y).sum())
        .collect();
    let solved: Vec<f64> = (inverse.iter())
        .map(|line| line.iter().zip(&right).map(|(a, b)| a * b).sum())
        .collect();
    let part = |c: usize| used.iter().position(|&u| u == c).map_or(0.0, |i| solved[i]);
    let rests: Vec<f64> = (rows.iter().zip(target))
        .map(|(r, y)| {
            y - used
                .iter()
                .zip(&solved)
                .map(|(&c, s)| r[c] * s)
                .sum::<f64>()
        })
        .collect();
    let errors = errors(&rows, &used, &rests, &inverse);
    let error = |c: usize| used.iter().position(|&u| u == c).map_or(0.0, |i| errors[i]);
    let factor = part(0) / scale_x;
    if factor == 0.0 {
        return None;
    }
    let drift = 2.0 * part(2) / (count - 1) as f64;
    Some(Fit {
        factor,
        factor_error: error(0) / scale_x,
        offset: part(1) - part(2) - factor * mean_x - drift * from as f64,
        offset_error: error(1).hypot(error(0) / scale_x * mean_x),
        drift,
        delay: delay + part(3) / scale_x / factor,
        delay_error: (error(3) / scale_x / factor).abs(),
        correlation: correlation(&rows, target, &rests, free.drift),
    })
}

/// The slope of x at each sample, as smooth as it must be to be the same as y's.
///
/// It is that of the line through the samples around; being odd about its sample, it
/// shares no noise with that sample's own rest, so smoothing costs no bias.
fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let mut best = (f64::MIN, Vec::new());
    for half in [1_usize, 2, 4, 8, 16, 32] {
        if x.len() < 8 * half {
            break;
        }
        let (a, b) = (line_slopes(x, half), line_slopes(y, half));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let alike = dot(&a, &b).abs() / (dot(&a, &a) * dot(&b, &b)).sqrt();
        if alike > best.0 {
            best = (alike, a);
        }
        if alike > ALIKE {
            break;
        }
    }
    best.1
}

/// Correlation of the two slopes that is good enough.
const ALIKE: f64 = 0.97;

/// Slopes of the lines through 2 `half` + 1 samples each.
fn line_slopes(x: &[f64], half: usize) -> Vec<f64> {
    let last = x.len() as i64 - 1;
    let norm: f64 = (1..=half).map(|j| 2.0 * (j * j) as f64).sum();
    let value = |k: i64| x[k.clamp(0, last) as usize];
    let slope = |k: i64| -> f64 {
        let pair = |j: i64| j as f64 * (value(k + j) - value(k - j));
        (1..=half as i64).map(pair).sum::<f64>() / norm
    };
    (0..=last).map(slope).collect()
}

fn gram(rows: &[[f64; 4]], used: &[usize]) -> Vec<Vec<f64>> {
    let entry = |&a: &usize, &b: &usize| rows.iter().map(|r| r[a] * r[b]).sum();
    (used.iter())
        .map(|a| used.iter().map(|b| entry(a, b)).collect())
        .collect()
}

/// Share of what varies in y, about its mean or line, that is explained: a multiple
/// correlation.
fn correlation(rows: &[[f64; 4]], y: &[f64], rests: &[f64], drift: bool) -> f64 {
    let about: &[usize] = if drift { &[1, 2] } else { &[1] };
    let Some(inverse) = inverse(&gram(rows, about)) else {
        return 0.0;
    };
    let right: Vec<f64> = (about.iter())
        .map(|&c| rows.iter().zip(y).map(|(r, y)| r[c] * y).sum())
        .collect();
    let line: Vec<f64> = (inverse.iter())
        .map(|l| l.iter().zip(&right).map(|(a, b)| a * b).sum())
        .collect();
    let varies: f64 = (rows.iter().zip(y))
        .map(|(r, y)| (y - about.iter().zip(&line).map(|(&c, s)| r[c] * s).sum::<f64>()).powi(2))
        .sum();
    let left: f64 = rests.iter().map(|e| e * e).sum();
    (1.0 - left / varies).max(0.0).sqrt()
}

fn errors(rows: &[[f64; 4]], used: &[usize], rests: &[f64], inverse: &[Vec<f64>]) -> Vec<f64> {
    let n = rows.len();
    let reach = (4.0 * (n as f64).cbrt()) as usize;
    let scores: Vec<Vec<f64>> = (used.iter())
        .map(|&c| rows.iter().zip(rests).map(|(r, e)| r[c] * e).collect())
        .collect();
    let one = |line: &Vec<f64>| {
        let score: Vec<f64> = (0..n)
            .map(|k| line.iter().zip(&scores).map(|(a, s)| a * s[k]).sum())
            .collect();
        let lagged = |l: usize| -> f64 { score[l..].iter().zip(&score).map(|(a, b)| a * b).sum() };
        let bartlett = |l: usize| 1.0 - l as f64 / (reach + 1) as f64;
        let beside: f64 = (1..=reach.min(n - 1))
            .map(|l| 2.0 * bartlett(l) * lagged(l))
            .sum();
        (lagged(0) + beside).max(0.0).sqrt()
    };
    inverse.iter().map(one).collect()
}

/// By elimination with the greatest pivot; `None` of a singular matrix.
fn inverse(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let n = matrix.len();
    let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let mut rows: Vec<Vec<f64>> = (matrix.iter().enumerate())
        .map(|(i, row)| {
            row.iter()
                .copied()
                .chain((0..n).map(|j| unit(i, j)))
                .collect()
        })
        .collect();
    let size = (0..n).map(|i| matrix[i][i]).fold(0.0, f64::max);
    for c in 0..n {
        let pivot = (c..n).max_by(|&a, &b| rows[a][c].abs().total_cmp(&rows[b][c].abs()))?;
        rows.swap(c, pivot);
        let head = rows[c][c];
        if head.abs() <= 1e-14 * size {
            return None;
        }
        rows[c].iter_mut().for_each(|v| *v /= head);
        let line = rows[c].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(r, _)| *r != c) {
            let by = row[c];
            row.iter_mut().zip(&line).for_each(|(v, l)| *v -= by * l);
        }
    }
    Some(rows.into_iter().map(|row| row[n..].to_vec()).collect())
}

/// The sum by the trapezoidal rule, per sample: without phase.
pub(crate) fn integral(x: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut last = x.first().copied().unwrap_or(0.0);
    let step = |v: &f64| {
        sum += 0.5 * (v + last);
        last = *v;
        sum
    };
    // The first adds its own value; an offset is free wherever this is used.
    x.iter().map(step).collect()
}
