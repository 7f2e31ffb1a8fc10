//! Runs of NaN among samples.

use std::ops::Range;

/// The runs of NaN.
pub(crate) fn runs(samples: &[f64]) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for (k, _) in samples.iter().enumerate().filter(|(_, v)| v.is_nan()) {
        match found.last_mut() {
            Some(run) if run.end == k => run.end = k + 1,
            _ => found.push(k..k + 1),
        }
    }
    found
}

/// Puts a straight line across each run, and the nearest value where one reaches an end;
/// 0 if there is no value at all.
pub(crate) fn bridge(samples: &mut [f64], runs: &[Range<usize>]) {
    for run in runs {
        let before = run.start.checked_sub(1).map(|k| samples[k]);
        let after = samples.get(run.end).copied();
        let (a, b) = match (before, after) {
            (Some(a), Some(b)) => (a, b),
            (Some(a), None) => (a, a),
            (None, Some(b)) => (b, b),
            (None, None) => (0.0, 0.0),
        };
        let steps = (run.len() + 1) as f64;
        for (i, value) in samples[run.clone()].iter_mut().enumerate() {
            *value = a + (b - a) * ((i + 1) as f64 / steps);
        }
    }
}
