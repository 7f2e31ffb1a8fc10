//! How near some effects together come to what another does.

use axis_sim::effects::Effect;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::response::{Response, responses_in};
use crate::estimate::bounded::bounded;
use crate::estimate::linear::Room;
use crate::name::library::{Candidate, rooms};
use crate::spectrum::Amplitudes;

/// The effects, `most` of them, that together come nearest to what is `seen`, chosen one
/// after another, their sizes inside their bounds; and what they leave of it.
pub fn imitate(
    library: &[Candidate],
    has: impl Fn(&Effect) -> bool + Sync,
    through: impl Fn(&Amplitudes) -> DVector<f64> + Sync,
    seen: &DVector<f64>,
    most: usize,
) -> (Vec<String>, f64) {
    let mut chosen: Vec<Response> = Vec::new();
    let mut rest = seen.clone();
    for _ in 0..most {
        let free = |e: &Effect| has(e) && chosen.iter().all(|c| c.effect.name != e.name);
        let with = |candidate: Response| {
            let together: Vec<&Response> = chosen.iter().chain([&candidate]).collect();
            let rest = left_by(&together, seen);
            (rest.norm_squared(), rest, candidate)
        };
        let tried = responses_in(library, free, &through, &rest);
        let tried: Vec<_> = tried.into_par_iter().map(with).collect();
        let best = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, left, candidate)) = best else {
            break;
        };
        chosen.push(candidate);
        rest = left;
    }
    let names = chosen.iter().map(|c| c.effect.name.to_owned());
    (names.collect(), rest.norm_squared())
}

/// What sizes inside their bounds leave of what is seen.
fn left_by(responses: &[&Response], seen: &DVector<f64>) -> DVector<f64> {
    let columns: Vec<&DVector<f64>> = responses.iter().flat_map(|r| &r.columns).collect();
    let rooms: Vec<Room> = responses
        .iter()
        .flat_map(|r| rooms(r.effect, &r.scales))
        .collect();
    let n = columns.len();
    let normal = DMatrix::from_fn(n, n, |i, j| columns[i].dot(columns[j]));
    let right = DVector::from_fn(n, |i, _| columns[i].dot(seen));
    let x = bounded(&normal, &right, |i| rooms[i]);
    let done = columns.iter().zip(x.iter());
    done.fold(seen.clone(), |rest, (c, &x)| rest - *c * x)
}
