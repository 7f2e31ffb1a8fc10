//! Tests of the crate, one file a feature.

mod brute_force;
mod closed_forms;
mod explained;
mod growth;
mod identify;
mod predict;
mod refusals;
#[cfg(feature = "serde")]
mod stored;
