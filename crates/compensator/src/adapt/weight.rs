//! Weights of residuals: how large they are nearby, and how many of them are independent.

use std::vec::Vec;

/// Values to either side over which a residual's size is judged.
const NEARBY: usize = 32;
/// Values that the Gaussian makes one of, half its deviation apart: 2 √π · 2.
const BY_SMOOTHING: f64 = 7.1;
/// Values after which it has left no correlation.
const SMOOTHED: usize = 16;
/// Mean over median of the variances of some nine independent values.
const TYPICAL: f64 = 1.1;
/// How many times the usual variance must be passed to count as more.
const MORE: f64 = 2.0;

/// Weight of each value of a series of residuals of which `free` coordinates were fitted:
/// one over the variance nearby, over the number of values that are one by correlation.
/// No deviation is taken for less than `floor`. Structure that the model does not have so
/// makes uncertain what is seen where it is, and nothing else. `even`: as if all were as
/// large as their mean square, for estimates that are still far off.
pub(super) fn weights(values: &[f64], floor: f64, free: usize, even: bool) -> Vec<f64> {
    if values.is_empty() {
        return Vec::new();
    }
    let nearby = match even {
        true => Vec::from([values.iter().map(|e| e * e).sum::<f64>() / values.len() as f64]),
        false => nearby(values),
    };
    let mut sorted = nearby.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = (TYPICAL * sorted[sorted.len() / 2])
        .max(floor * floor)
        .max(f64::MIN_POSITIVE);
    let all = nearby.iter().cycle().take(values.len());
    let variances: Vec<f64> = all.map(|v| (v / MORE).max(usual)).collect();
    let unit: Vec<f64> = values
        .iter()
        .zip(&variances)
        .map(|(e, v)| e / v.sqrt())
        .collect();
    // Residuals that are still far off are one long correlation, and would count as nothing.
    let correlated = match even {
        true => BY_SMOOTHING,
        false => long_run_variance(&unit, free).max(1.0),
    };
    variances.iter().map(|v| 1.0 / (v * correlated)).collect()
}

/// Mean square of the values around each.
fn nearby(values: &[f64]) -> Vec<f64> {
    let mut sums = Vec::from([0.0]);
    let mut sum = 0.0;
    for e in values {
        sum += e * e;
        sums.push(sum);
    }
    let at = |k: usize| {
        let (from, to) = (k.saturating_sub(NEARBY), (k + NEARBY + 1).min(values.len()));
        ((sums[to] - sums[from]) / (to - from) as f64).max(0.0)
    };
    (0..values.len()).map(at).collect()
}

/// Variance that the mean of a series times its length has, per value: the variance of
/// its values and twice all their covariances, so that correlated residuals count as the
/// fewer values that they are. The larger of two estimates: over as far as the smoothing
/// reaches (a flat-topped window: Politis and Romano, J. Time Ser. Anal. 16 (1995) 67–103),
/// which what was fitted disturbs little; and over longer times (Bartlett's window: Newey
/// and West, Econometrica 55 (1987) 703–708), for structure that the model does not have.
fn long_run_variance(values: &[f64], fitted: usize) -> f64 {
    let count = values.len();
    let covariance = |lag: usize| {
        let pairs = values.iter().zip(&values[lag..]);
        pairs.map(|(a, b)| a * b).sum::<f64>() / count as f64
    };
    let own = covariance(0);
    let most = ((2.0 * (count as f64).sqrt()) as usize).min(count / 4);
    let covariances: Vec<f64> = (0..=most.max(SMOOTHED).min(count - 1))
        .map(covariance)
        .collect();
    let total = |reach: usize, window: &dyn Fn(f64) -> f64| {
        let lags = covariances.iter().enumerate().skip(1).take(reach);
        let sum: f64 = lags
            .map(|(lag, c)| window(lag as f64 / (reach + 1) as f64) * c)
            .sum();
        own + 2.0 * sum
    };
    let near = total(SMOOTHED, &|share| (2.0 * (1.0 - share)).min(1.0));
    let far = total(most, &|share| 1.0 - share);
    // A variance that is itself estimated counts as one standard error more.
    let margin = 1.0 + (4.0 / 3.0 * SMOOTHED as f64 / count as f64).sqrt();
    let total = margin * near.max(far).max(own);
    // What was fitted has taken its share of the independent values.
    let independent = count as f64 * own / total.max(f64::MIN_POSITIVE);
    total * independent.max(fitted as f64 + 1.0) / (independent - fitted as f64).max(1.0)
}
