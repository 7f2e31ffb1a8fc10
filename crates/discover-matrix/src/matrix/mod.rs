//! A matrix of machines with something hidden in them, and how the search
//! does on it, blind.
//!
//! [`cases`] lays out the machines: Latin hypercubes over effect, size, noise
//! and motion. A [`Bench`] holds what is the same for all cases on one motion;
//! [`Bench::try_case`] makes a case's logs, says beforehand what can be seen in
//! them ([`discrepancy::PredictedEffect`]), runs the search without that knowledge, and keeps
//! both. [`Score`] counts.

mod bench;
mod case;
mod design;
mod outcome;
mod score;
mod scored;
mod trial;

pub use bench::{Bench, BenchError};
pub(crate) use bench::{active, scale_at, times_size};
pub use case::{Case, CaseKind, HiddenEffect};
pub(crate) use design::values;
pub use design::{Sizes, cases};
pub use outcome::{CaseOutcome, NamedEffect, ScoredEstimate, Split};
pub(crate) use score::covered;
pub use score::{OfEffect, Rate, Score};
pub(crate) use trial::{estimates, is_a_rival, named};
