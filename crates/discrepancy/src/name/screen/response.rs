//! What candidates do, once other parameters are fitted out.

use std::ops::Range;

use axis_sim::effects::{Effect, Scales};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::name::library::{Candidate, is_force_in_time};
use crate::spectrum::Amplitudes;

/// What a candidate does, in a space where other parameters are fitted out.
pub struct Response {
    /// Which.
    pub effect: &'static Effect,
    /// As of its [`Candidate`].
    pub values: Vec<f64>,
    /// How large things are on the axis.
    pub scales: Scales,
    /// Place of that in the library; `None` of a sum of several.
    pub candidate: Option<usize>,
    /// One entry a size; two of an effect with a phase.
    pub columns: Vec<DVector<f64>>,
}

/// Responses of those candidates that are `wanted`, `seen` through some
/// projection; of a force in time, the stretches that explain most of `rest`.
pub fn responses_in(
    library: &[Candidate],
    wanted: impl Fn(&Effect) -> bool + Sync,
    seen: impl Fn(&Amplitudes) -> DVector<f64> + Sync,
    rest: &DVector<f64>,
) -> Vec<Response> {
    let one = |(place, c): (usize, &Candidate)| Response {
        effect: c.effect,
        values: c.values.clone(),
        scales: c.scales,
        candidate: Some(place),
        columns: c.columns.iter().map(&seen).collect(),
    };
    let all: Vec<Response> = library
        .par_iter()
        .enumerate()
        .filter(|(_, c)| wanted(c.effect))
        .map(one)
        .collect();
    let (slots, mut all): (Vec<_>, Vec<_>) =
        all.into_iter().partition(|r| is_force_in_time(r.effect));
    all.extend(windows(&slots, rest));
    all
}

/// The stretches of neighbouring slots in which a force explains most, the best
/// first: what a force does over several is the sum of what it does in each. None
/// of them is the whole motion, as it is a constant load then.
fn windows(slots: &[Response], rest: &DVector<f64>) -> Vec<Response> {
    let columns: Vec<&DVector<f64>> = slots.iter().filter_map(|s| s.columns.first()).collect();
    let n = columns.len();
    let along: Vec<f64> = columns.iter().map(|c| c.dot(rest)).collect();
    let mut gram = DMatrix::zeros(n, n);
    for j in 0..n {
        for i in 0..=j {
            gram[(i, j)] = columns[i].dot(columns[j]);
        }
    }
    let mut all = Vec::new();
    for first in 0..n {
        let (mut explained, mut size) = (0.0, 0.0);
        for last in first..n {
            explained += along[last];
            let cross: f64 = (first..last).map(|i| gram[(i, last)]).sum();
            size += gram[(last, last)] + 2.0 * cross;
            let gain: f64 = explained * explained / size.max(f64::MIN_POSITIVE);
            if last + 1 - first < n {
                all.push((gain, first..last + 1));
            }
        }
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut chosen: Vec<Range<usize>> = Vec::new();
    for (_, window) in all {
        if chosen.iter().all(|c| !mostly_same(c, &window)) {
            chosen.push(window);
        }
        if chosen.len() == WINDOWS {
            break;
        }
    }
    let response = |window: Range<usize>| {
        let mut values = slots[window.start].values.clone();
        values[2] = slots[window.end - 1].values[2];
        let zero = DVector::zeros(rest.len());
        Response {
            effect: slots[window.start].effect,
            values,
            scales: slots[window.start].scales,
            candidate: None,
            columns: vec![columns[window].iter().fold(zero, |sum, c| sum + *c)],
        }
    };
    chosen.into_iter().map(response).collect()
}

/// Whether two stretches have half of what they cover in common.
pub fn mostly_same(a: &Range<usize>, b: &Range<usize>) -> bool {
    let common = a.end.min(b.end).saturating_sub(a.start.max(b.start));
    2 * common > a.len() + b.len() - common
}

/// Stretches of time that a screening of a force in time gives.
const WINDOWS: usize = 4;
