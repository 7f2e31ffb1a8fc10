//! Samples without their noise, for derivatives.
//!
//! A reference is written with so many digits, and steps of them, harmless in the position,
//! are large in its second derivative: micrometres at 1 kHz are 1 m/s². How large they are is
//! taken from differences of the samples (Moré, Wild: Estimating computational noise, SIAM
//! J. Sci. Comput. 33 (2011) 1292–1314); then the smoothest series is sought whose distance
//! from the samples is that in root mean square (Reinsch: Smoothing by spline functions,
//! Numer. Math. 10 (1967) 177–183).

/// Highest order of the differences: by then a wave of 90 Hz at 1 kHz counts as noise of
/// 1e-4 of its amplitude, and shorter series still have some.
const ORDERS: usize = 8;
/// Median of the size of a normal variable of variance 1.
const MEDIAN: f64 = 0.674_489_750_196_081_7;
/// Corner of the strongest smoothing, rad a sample: of white noise it leaves
/// 0.01^2.5 = 1e-5 in a second derivative.
const SLOWEST: f64 = 0.01;
/// Halvings of the span in which the smoothing is sought: 12 decades and 20 above 1 to a
/// hundredth of a decade.
const HALVINGS: usize = 12;

/// The samples without noise, for a derivative of the order `order` − 1, at most 2.
pub(super) fn smooth(samples: &[f64], order: usize) -> Vec<f64> {
    let noise = noise(samples);
    let moving = samples.windows(2).filter(|w| w[0] != w[1]).count();
    if noise == 0.0 || samples.len() <= 2 * order {
        return samples.to_vec();
    }
    let most = noise * noise * moving as f64;
    let removed = |strength: f64| removed(samples, order, strength.exp());
    let power = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>();
    // A strength λ has its corner at λ^(−1/2d); at e^-20 nothing is taken.
    let mut span = [-20.0, -2.0 * order as f64 * SLOWEST.ln()];
    if power(&removed(span[1])) <= most {
        span[0] = span[1];
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (span[0] + span[1]);
        let is_within = power(&removed(middle)) <= most;
        span[usize::from(!is_within)] = middle;
    }
    let removed = removed(span[0]);
    samples.iter().zip(removed).map(|(y, r)| y - r).collect()
}

/// Upper bound of the samples' noise in root mean square: the least, over the orders k, of
/// what the k-th differences would be of noise alone. Where these are nothing but rounding (at
/// rest, and where a motion goes on by whole steps) the samples say nothing of it.
fn noise(samples: &[f64]) -> f64 {
    let most = samples.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
    let mut differences = samples.to_vec();
    let mut least = f64::INFINITY;
    // Of a k-th difference: variance of white noise of variance 1, (2k over k), and what the
    // rounding of its samples adds up to, 2^k of them.
    let (mut variance, mut rounding) = (1.0, f64::EPSILON * most);
    for k in 1..=ORDERS.min(samples.len().saturating_sub(1)) {
        difference(&mut differences);
        variance *= (4 * k - 2) as f64 / k as f64;
        rounding *= 2.0;
        let sizes = differences.iter().map(|d| d.abs());
        let mut sizes: Vec<f64> = sizes.filter(|size| *size > rounding).collect();
        if sizes.is_empty() {
            return 0.0;
        }
        let middle = sizes.len() / 2;
        let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
        least = least.min(*median / (MEDIAN * variance.sqrt()));
    }
    if least.is_finite() { least } else { 0.0 }
}

/// Differences of neighbours, one less.
fn difference(series: &mut Vec<f64>) {
    for k in 1..series.len() {
        series[k - 1] = series[k] - series[k - 1];
    }
    series.pop();
}

/// What smoothing takes from samples y: r = y − s of the s with the least
/// Σ(s − y)² + λ Σ(Δᵈ s)², in Reinsch's form
///
/// ```text
/// r = Dᵀ u,   (D Dᵀ + 1/λ) u = D y
/// ```
///
/// in which rounding is that of the noise and not that of the position.
fn removed(samples: &[f64], order: usize, strength: f64) -> Vec<f64> {
    let mut u = samples.to_vec();
    (0..order).for_each(|_| difference(&mut u));
    // D's row, (1 − z)ᵈ, and the band of D Dᵀ, its products with itself moved.
    let mut row = vec![1.0];
    for _ in 0..order {
        let shifted = row.iter().copied().chain([0.0]);
        let before = [0.0].into_iter().chain(row.iter().copied());
        row = shifted.zip(before).map(|(a, b)| a - b).collect();
    }
    let product = |m: usize| row.iter().zip(&row[m..]).map(|(a, b)| a * b).sum::<f64>();
    let mut band: Vec<f64> = (0..=order).map(product).collect();
    band[0] += 1.0 / strength;
    solve(&band, &mut u);
    // Dᵀ u; D's signs are those of Δᵈ read from its end.
    let mut removed = vec![0.0; samples.len()];
    for (k, u) in u.iter().enumerate() {
        for (m, factor) in row.iter().rev().enumerate() {
            removed[k + m] += factor * u;
        }
    }
    removed
}

/// A pivot, then what its row has to the left of it, the nearest first.
type Row = [f64; 4];

/// Solves a symmetric system, positive definite, whose bands are constant (the diagonal
/// first, at most three beside it), by L D Lᵀ without pivoting.
fn solve(band: &[f64], x: &mut [f64]) {
    let width = band.len() - 1;
    let mut rows: Vec<Row> = Vec::with_capacity(x.len());
    for k in 0..x.len() {
        let mut row: Row = [0.0; 4];
        for m in (1..=width.min(k)).rev() {
            let left = rows[k - m];
            let further = 1..=(width - m).min(k - m);
            let known: f64 = further
                .map(|j| row[m + j] * rows[k - m - j][0] * left[j])
                .sum();
            row[m] = (band[m] - known) / left[0];
        }
        let known: f64 = (1..=width.min(k))
            .map(|m| row[m] * row[m] * rows[k - m][0])
            .sum();
        row[0] = band[0] - known;
        rows.push(row);
    }
    for (k, row) in rows.iter().enumerate() {
        for m in 1..=width.min(k) {
            x[k] -= row[m] * x[k - m];
        }
    }
    for (x, row) in x.iter_mut().zip(&rows) {
        *x /= row[0];
    }
    for (k, row) in rows.iter().enumerate().rev() {
        for m in 1..=width.min(k) {
            x[k - m] -= row[m] * x[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{noise, removed, smooth};

    /// A sine of 2 Hz at 1 kHz, and the same in steps.
    fn wave(step: f64) -> Vec<f64> {
        let at = |k: u32| 0.05 * (std::f64::consts::TAU * 2e-3 * f64::from(k)).sin();
        let stepped = |y: f64| {
            if step > 0.0 {
                step * (y / step).round()
            } else {
                y
            }
        };
        (0..2000).map(|k| stepped(at(k))).collect()
    }

    #[test]
    fn steps_are_told_from_motion() {
        // Rounding to steps has a twelfth of their square; where differences are whole steps it
        // is less, and they do not count.
        for step in [1e-7, 1e-6, 1e-5] {
            let share = noise(&wave(step)) / step;
            assert!((0.2..0.5).contains(&share), "{share}");
        }
        assert!(noise(&wave(0.0)) < 1e-15);
        assert_eq!(noise(&[0.3; 50]), 0.0);
        assert_eq!(noise(&[]), 0.0);
        // What stands most of the time is not without noise while it moves.
        let mut standing = vec![0.0; 5000];
        standing.extend(wave(1e-6));
        assert!((0.2e-6..0.5e-6).contains(&noise(&standing)));
    }

    #[test]
    fn the_smoothed_series_solves_its_normal_equations() {
        let samples = wave(1e-4);
        for (order, strength) in [(2, 3.0), (3, 40.0)] {
            let removed = removed(&samples[..50], order, strength);
            // r = λ Dᵀ D (y − r).
            let mut rough: Vec<f64> = (0..50).map(|k| samples[k] - removed[k]).collect();
            let binomial: &[f64] = [&[1.0, -2.0, 1.0][..], &[-1.0, 3.0, -3.0, 1.0]][order - 2];
            rough = rough
                .windows(order + 1)
                .map(|w| w.iter().zip(binomial).map(|(a, b)| a * b).sum())
                .collect();
            let mut right = vec![0.0; 50];
            for (k, rough) in rough.iter().enumerate() {
                for (m, b) in binomial.iter().enumerate() {
                    right[k + m] += strength * b * rough;
                }
            }
            for (r, right) in removed.iter().zip(&right) {
                assert!((r - right).abs() < 1e-14, "{r} {right}");
            }
        }
    }

    #[test]
    fn short_and_exact_series_stay_as_they_are() {
        for samples in [vec![], vec![1.0], vec![1.0, 2.0, 5.0], vec![0.3; 40]] {
            assert_eq!(smooth(&samples, 3), samples);
        }
        let moved = |(a, b): (f64, &f64)| (a - b).abs();
        let wave = wave(0.0);
        assert!(
            smooth(&wave, 3)
                .into_iter()
                .zip(&wave)
                .map(moved)
                .all(|d| d < 1e-14)
        );
    }
}
