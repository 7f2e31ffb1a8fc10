//! Designs from orthogonal arrays.

use crate::is_latin;
use lhs::{OrthogonalArray, Placement};
use proptest::prelude::*;

fn array(prime: usize, dims: usize, seed: u64) -> OrthogonalArray {
    OrthogonalArray {
        prime,
        dims,
        placement: Placement::Random,
        seed,
    }
}

proptest! {
    /// Strength 2, counted: each of the p² cells over every two columns holds
    /// one point; and the Latin property.
    #[test]
    fn every_two_variables_are_even(
        p in prop::sample::select(vec![2_usize, 3, 5, 7, 11, 13]), share in 0.0..1.0f64, seed: u64, centred: bool,
    ) {
        let dims = 1 + (share * (p + 1) as f64) as usize;
        let placement = if centred { Placement::Centred } else { Placement::Random };
        let design = OrthogonalArray { placement, ..array(p, dims, seed) }.design().unwrap();
        prop_assert_eq!((design.len(), design.dims()), (p * p, dims));
        prop_assert!(is_latin(&design));
        for j in 0..dims {
            for k in 0..j {
                let mut seen = vec![0; p * p];
                for row in design.rows() {
                    seen[(row[j] * p as f64) as usize * p + (row[k] * p as f64) as usize] += 1;
                }
                prop_assert!(seen.iter().all(|&s| s == 1), "columns {} and {}", j, k);
            }
        }
    }
}

#[test]
fn wrong_shapes_are_refused() {
    for (p, dims) in [
        (0, 1),
        (1, 1),
        (4, 2),
        (9, 3),
        (65_537, 2),
        (usize::MAX, 2),
        (5, 7),
        (5, 0),
        (2000, 2),
        (2003, 1025),
    ] {
        let refused = array(p, dims, 1).design().unwrap_err().to_string();
        assert!(refused.contains("must be"), "{refused}");
    }
    assert!(array(5, 6, 1).design().is_ok());
}

#[test]
fn seeds_differ_and_repeat() {
    let made = |seed| array(7, 4, seed).design().unwrap();
    assert_eq!(made(1), made(1));
    assert_ne!(made(1), made(2));
}
