//! Points added to a design.

use crate::is_latin;
use lhs::criteria::centred_discrepancy;
use lhs::{Augmentation, Design, LatinHypercube, Placement};
use proptest::prelude::*;

fn more(points: usize, seed: u64) -> Augmentation {
    Augmentation {
        points,
        placement: Placement::Random,
        candidates: 1,
        seed,
    }
}

fn plain(n: usize, dims: usize, seed: u64) -> Design {
    LatinHypercube::new(n, dims, seed)
        .unwrap()
        .design()
        .unwrap()
}

proptest! {
    #[test]
    fn multiples_are_latin_again(
        n in 1..200_usize, times in 1..5_usize, dims in 1..4_usize, seed: u64, centred: bool,
    ) {
        let before = plain(n, dims, seed);
        let placement = if centred { Placement::Centred } else { Placement::Random };
        let made = Augmentation { placement, ..more(n * times, seed) }.of(&before).unwrap();
        prop_assert!(made.is_latin() && is_latin(&made.design));
        prop_assert_eq!(&made.design.values()[..n * dims], before.values());
        // Again, without a repeated point.
        let twice = more(made.design.len(), seed).of(&made.design).unwrap();
        prop_assert!(is_latin(&twice.design));
    }

    /// Whatever the numbers: new points never share a stratum, and the empty
    /// ones are as many as old points share strata.
    #[test]
    fn as_near_as_possible(
        values in prop::collection::vec(0.0..1.0f64, 1..60), points in 1..100_usize, seed: u64,
    ) {
        let before = Design::from_rows(1, values.clone()).unwrap();
        let made = more(points, seed).of(&before).unwrap();
        let n = values.len() + points;
        let mut counts = vec![0_usize; n];
        for v in made.design.column(0) {
            counts[(v * n as f64) as usize] += 1;
        }
        let mut old: Vec<usize> = values.iter().map(|v| (v * n as f64) as usize).collect();
        old.sort();
        old.dedup();
        let empty = counts.iter().filter(|c| **c == 0).count();
        prop_assert_eq!(&made.empty_strata, &vec![empty]);
        prop_assert_eq!(empty, values.len() - old.len());
        prop_assert_eq!(made.is_latin(), is_latin(&made.design));
        let fresh = values.len()..n;
        prop_assert!(fresh.map(|i| made.design.row(i).unwrap()[0]).all(|v| counts[(v * n as f64) as usize] == 1));
    }
}

#[test]
fn more_candidates_are_not_worse() {
    let before = plain(10, 3, 4);
    let value = |candidates| {
        let made = Augmentation {
            candidates,
            ..more(10, 9)
        }
        .of(&before)
        .unwrap();
        centred_discrepancy(&made.design)
    };
    assert!(value(50) < value(2));
    assert!(value(2) <= value(1));
}

#[test]
fn refusals_say_what_is_valid() {
    let before = plain(4, 2, 1);
    assert!(
        more(0, 1)
            .of(&before)
            .unwrap_err()
            .to_string()
            .contains("at least 1")
    );
    let none = Augmentation {
        candidates: 0,
        ..more(4, 1)
    };
    assert!(
        none.of(&before)
            .unwrap_err()
            .to_string()
            .contains("candidates")
    );
    assert!(more(usize::MAX, 1).of(&before).is_err());
    assert!(more(1 << 52, 1).of(&before).is_err());
    for bad in [1.0, -0.1, 7.0] {
        let outside = Design::from_rows(1, vec![0.5, bad]).unwrap();
        let message = more(2, 1).of(&outside).unwrap_err().to_string();
        assert!(
            message.contains("row 1") && message.contains("[0, 1)"),
            "{message}"
        );
    }
}
