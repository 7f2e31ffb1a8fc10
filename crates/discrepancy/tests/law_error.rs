//! What is small beside another effect, and a formula with all of its numbers.

use discrepancy::{Discovery, Verdict};

use crate::bench::{beside, discover};

const NOISE: f64 = 5e-3;

fn names(found: &Discovery) -> Vec<&str> {
    found.effects.iter().map(|e| e.name.as_str()).collect()
}

/// A force that changes by a twentieth along the stroke is no spring beside a load, whatever the evidence for it: real loads are no
/// nearer to a law. What the axis file has a number for is named however small.
#[test]
fn a_law_that_is_small_beside_another_is_not_named() {
    let little = beside(|_, angle, _| 5.0 + 0.1 * angle, NOISE);
    let found = discover([little; 2]);
    assert_eq!(names(&found), ["constant-load"]);
    let told =
        |note: &String| note.starts_with("spring-force would explain more, but is not named");
    assert!(found.notes.iter().any(told), "{:?}", found.notes);
    let both = beside(|_, angle, _| 5.0 + 1.0 * angle, NOISE);
    let found = discover([both; 2]);
    assert_eq!(found.verdict, Verdict::Explained);
    assert_eq!(names(&found), ["constant-load", "spring-force"]);
    let viscous = beside(|_, _, speed| 2.0 * speed.signum() + 0.02 * speed, NOISE);
    let found = discover([viscous; 2]);
    assert_eq!(names(&found), ["coulomb-friction", "viscous-friction"]);
    // At frequencies of its own a small force is no error of a larger one's law.
    let apart = beside(|_, angle, _| 5.0 + 0.1 * (15.0 * angle).sin(), NOISE);
    assert_eq!(names(&discover([apart; 2])).len(), 2);
}

/// Dry friction of 2 N·m that grows by 2 % per radian: the law that is said has both numbers.
#[test]
fn the_formula_of_a_law_has_what_it_is_taken_with() {
    let law = beside(
        |_, angle, speed| 2.0 * (1.0 + 0.02 * angle) * speed.signum(),
        NOISE,
    );
    let found = discover([law; 2]);
    let formula = found.unknown.and_then(|unknown| unknown.formula).unwrap();
    assert!(formula.contains("c · x·sign v + b · sign v"), "{formula}");
    assert!(
        formula.contains("b = 2.00 N·m") && formula.contains("c = 0.039"),
        "{formula}"
    );
}
