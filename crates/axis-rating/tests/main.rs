//! Tests of the crate, one file a kind of proof.

mod catalogue;
mod closed_forms;
mod laws;
mod refusals;
#[cfg(feature = "serde")]
mod stored;

/// Asserts that two numbers agree within a share.
#[track_caller]
fn near(found: f64, truth: f64, share: f64) {
    assert!(
        (found - truth).abs() <= share * truth.abs(),
        "{found} is not {truth}"
    );
}
