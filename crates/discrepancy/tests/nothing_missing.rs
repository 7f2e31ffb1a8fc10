//! That nothing is missing has to hold of every log.

use std::f64::consts::TAU;

use discrepancy::Verdict;

use crate::bench::{beside, discover};

const NOISY: f64 = 0.2;
/// Of the torque, 10 N·m RMS, 5e-4.
const QUIET: f64 = 0.005;

/// What is in the fitted log alone holds on no other, and has no name; but it is there, however quiet the check log is.
#[test]
fn what_only_a_fitted_log_shows_is_not_nothing() {
    let wave = |t: f64, _, _| (TAU * 0.7 * t + 1.0).sin();
    for noise in [NOISY, QUIET] {
        let clean = beside(|_, _, _| 0.0, noise);
        assert_eq!(discover([clean, clean]).verdict, Verdict::NothingMissing);
        let discovery = discover([beside(wave, noise), clean]);
        assert_eq!(discovery.verdict, Verdict::Unknown);
        let mut notes = discovery.notes.iter();
        let note = notes.find(|note| note.contains("times its noise"));
        assert!(
            note.is_some_and(|note| note.starts_with("fit.csv")),
            "{:?}",
            discovery.notes
        );
    }
}

/// A law of the angle of a thousandth of the torque is no lack of the model, and is not hidden; one of a hundredth is.
#[test]
fn a_thousandth_of_the_torque_is_immaterial() {
    let small = beside(|_, angle, _| 0.002 * angle * angle, 2e-4);
    let found = discover([small; 2]);
    assert_eq!(found.verdict, Verdict::NothingMissing);
    assert!(found.sentence.contains("immaterial"), "{}", found.sentence);
    let told = |note: &String| note.contains("times its noise, but within 0.2 %");
    assert!(found.notes.iter().any(told), "{:?}", found.notes);
    let large = beside(|_, angle, _| 0.02 * angle * angle, 2e-4);
    assert_ne!(discover([large; 2]).verdict, Verdict::NothingMissing);
}
