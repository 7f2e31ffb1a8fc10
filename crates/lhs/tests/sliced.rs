//! Sliced designs.

use crate::is_latin;
use lhs::{Placement, SlicedHypercube};
use proptest::prelude::*;

fn shape(slices: usize, points: usize, dims: usize, seed: u64) -> SlicedHypercube {
    SlicedHypercube {
        slices,
        points,
        dims,
        placement: Placement::Random,
        seed,
    }
}

proptest! {
    #[test]
    fn the_whole_and_each_slice_are_latin(
        slices in 1..8_usize, points in 1..60_usize, dims in 1..5_usize, seed: u64, centred: bool,
    ) {
        let placement = if centred { Placement::Centred } else { Placement::Random };
        let made = SlicedHypercube { placement, ..shape(slices, points, dims, seed) }.design().unwrap();
        prop_assert_eq!(made.design.len(), slices * points);
        prop_assert!(is_latin(&made.design));
        let mut values = Vec::new();
        for t in 0..slices {
            let slice = made.slice(t).unwrap();
            prop_assert!(is_latin(&slice));
            values.extend_from_slice(slice.values());
        }
        prop_assert_eq!(&values[..], made.design.values());
        prop_assert_eq!(made.slice(slices), None);
        prop_assert_eq!(made.slice(usize::MAX), None);
    }
}

/// The fine stratum of a coarse one goes to each slice as often: over 6000
/// seeds 2000 ± 6 · 36.5 (binomial).
#[test]
fn slices_are_dealt_evenly() {
    let mut counts = [0_i32; 3];
    for seed in 0..6000 {
        let made = shape(3, 1, 1, seed).design().unwrap();
        let v = made.slice(0).unwrap().values()[0];
        counts[(v * 3.0) as usize] += 1;
    }
    assert!(counts.iter().all(|c| (c - 2000).abs() < 219), "{counts:?}");
}

#[test]
fn wrong_shapes_are_refused() {
    for (slices, points, dims) in [
        (0, 3, 1),
        (3, 0, 1),
        (3, 3, 0),
        (3, 3, 1025),
        (usize::MAX, 2, 1),
        (1 << 30, 1 << 20, 1000),
    ] {
        let refused = shape(slices, points, dims, 1)
            .design()
            .unwrap_err()
            .to_string();
        assert!(
            refused.contains("must be") || refused.contains("memory"),
            "{refused}"
        );
    }
}
