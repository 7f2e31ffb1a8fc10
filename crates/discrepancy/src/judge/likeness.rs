//! Which effects these logs show, from what size on, and which look alike in
//! them.

use axis_sim::Axis;
use axis_sim::effects::Scales;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::estimate::fit::Fitter;
use crate::estimate::known::pinned;
use crate::estimate::projector::Projector;
use crate::estimate::thin::Thin;
use crate::name::search::{Found, ONE_CLASS, needed};

/// What the logs can tell of an effect, whether it is there or not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Likeness {
    /// The effect.
    pub name: String,
    /// Smallest size that these logs show, of an effect with one size: from the
    /// response at half the typical size, taken for linear. `None` if ten
    /// times the typical size would not show.
    pub shown_from: Option<Shown>,
    /// Effects that do all that it does, with the sine of the largest angle
    /// between the two; the nearest first.
    pub alike: Vec<(String, f64)>,
}

/// A size of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Shown {
    /// Parameter.
    pub parameter: String,
    /// Value.
    pub value: f64,
    /// Unit.
    pub unit: String,
}

/// What a candidate can do, known parameters fitted out.
struct Reach {
    place: usize,
    /// Orthonormal columns, or 0.
    basis: DMatrix<f64>,
    /// D of its smallest response at typical size.
    least: f64,
}

/// Likenesses of all effects of the library on the fitted logs, in its order.
pub(super) fn likenesses(machine: &Axis, found: &Found) -> Vec<Likeness> {
    let fitter = Fitter {
        machine,
        set: &found.fit_logs,
    };
    let layout = &fitter.set.layout;
    let whitener = layout.whitener(&layout.spectral_matrices(&found.fit.rest));
    let shares = &found.fit.state.shares;
    let known = &found.columns[..shares.len()];
    let known: Vec<DVector<f64>> = known.iter().map(|c| layout.whiten(&whitener, c)).collect();
    let projector = Projector::new(machine, &known, &pinned(machine, shares));
    let library = &found.library.candidates;
    let scales = Scales::of(machine);
    let reach = |place: usize| {
        let columns = library[place].columns.iter();
        let seen: Vec<DVector<f64>> = columns
            .map(|c| projector.reject(&layout.whiten(&whitener, c)))
            .collect();
        let least = seen.iter().map(DVector::norm_squared);
        Reach {
            place,
            least: least.fold(f64::MAX, f64::min),
            basis: Thin::of(&seen).basis,
        }
    };
    let all: Vec<Reach> = (0..library.len()).into_par_iter().map(reach).collect();
    let mut names: Vec<&str> = library.iter().map(|c| c.effect.name).collect();
    names.dedup();
    let of = |name: &str| -> Vec<&Reach> {
        let own = |r: &&Reach| library[r.place].effect.name == name;
        all.iter().filter(own).collect()
    };
    let one = |name: &&str| -> Option<Likeness> {
        // Of several shapes, the one that is seen best.
        let own = of(name);
        let own = own.iter().max_by(|a, b| a.least.total_cmp(&b.least))?;
        let others = names.iter().filter(|other| other != &name);
        let angle = |other: &&str| -> Option<(String, f64)> {
            let sines = of(other).into_iter().map(|r| largest_sine(own, r));
            let sine = sines.fold(f64::MAX, f64::min);
            (sine < ONE_CLASS).then(|| ((*other).to_owned(), sine))
        };
        let effect = library[own.place].effect;
        let needed = needed(layout, effect.parameters.len(), library.len(), 0.01);
        // Of what ten times its typical size does not show, no angle says anything.
        let shown = |r: &Reach| 100.0 * r.least >= needed;
        let mut alike: Vec<(String, f64)> = others.filter_map(angle).collect();
        alike.retain(|_| shown(own));
        alike.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut sizes = effect.parameters.iter().filter(|p| p.is_size());
        let size = sizes.next().filter(|_| sizes.next().is_none());
        let shown_from = size.filter(|_| shown(own)).map(|p| Shown {
            parameter: p.name.to_owned(),
            value: p.typical(&scales).abs() * (needed / own.least).sqrt(),
            unit: p.unit(&scales).to_owned(),
        });
        Some(Likeness {
            name: (*name).to_owned(),
            shown_from,
            alike,
        })
    };
    names.par_iter().filter_map(one).collect()
}

/// Sine of the largest angle between what one can do and the nearest that
/// another can: the root of the largest eigenvalue of BᵀB − CᵀC, with the one's basis B and
/// its products C with the other's.
fn largest_sine(own: &Reach, other: &Reach) -> f64 {
    let common = other.basis.tr_mul(&own.basis);
    let own = own.basis.tr_mul(&own.basis);
    let left = (own - common.tr_mul(&common)).symmetric_eigenvalues();
    left.max().clamp(0.0, 1.0).sqrt()
}
