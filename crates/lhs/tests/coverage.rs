//! Nearest neighbours and spanning trees against SciPy, grids and all trees.

use crate::discrepancies::{documented, lattice};
use lhs::Design;
use lhs::criteria::{coverage, mesh_ratio, minimum_distance, spanning_tree};
use proptest::prelude::*;

/// SciPy 1.17.1, `geometric_discrepancy`: `docs/peers/lhs/run`.
#[test]
fn scipy_has_the_same_numbers() {
    for (design, distance, mean) in [
        (documented(), 0.3726779962499649, 0.4035516523389179),
        (lattice(), 0.44721359549995787, 0.4790823951115505),
    ] {
        assert!((minimum_distance(&design) - distance).abs() < 1e-15);
        let tree = spanning_tree(&design).unwrap();
        assert!((tree.mean - mean).abs() < 1e-15, "{tree:?}");
    }
}

#[test]
fn grids_are_regular() {
    let cells = (0..4).flat_map(|i| (0..5).flat_map(move |j| [f64::from(i), f64::from(j)]));
    let grid = Design::from_rows(2, cells.collect()).unwrap();
    assert_eq!(coverage(&grid), Some(0.0));
    assert_eq!(mesh_ratio(&grid), Some(1.0));
    let tree = spanning_tree(&grid).unwrap();
    assert_eq!((tree.mean, tree.deviation), (1.0, 0.0));
}

/// Points 0, 1, 3, 7 of a line: edges 1, 2, 4; nearest 1, 1, 2, 4.
#[test]
fn a_line_by_hand() {
    let line = Design::from_rows(1, vec![7.0, 0.0, 3.0, 1.0]).unwrap();
    let tree = spanning_tree(&line).unwrap();
    assert!((tree.mean - 7.0 / 3.0).abs() < 1e-15);
    assert!((tree.deviation - (14.0_f64 / 9.0).sqrt()).abs() < 1e-15);
    assert_eq!(mesh_ratio(&line), Some(4.0));
    // Mean 2, variance (1 + 1 + 0 + 4)/4.
    assert!((coverage(&line).unwrap() - 1.5_f64.sqrt() / 2.0).abs() < 1e-15);
}

#[test]
fn degenerate_designs_have_none() {
    let one = Design::from_rows(2, vec![0.1, 0.2]).unwrap();
    assert_eq!((spanning_tree(&one), coverage(&one)), (None, None));
    assert_eq!(mesh_ratio(&one), None);
    let same = Design::from_rows(1, vec![0.5; 3]).unwrap();
    assert_eq!((coverage(&same), mesh_ratio(&same)), (None, None));
    assert_eq!(spanning_tree(&same).unwrap().mean, 0.0);
    let some = Design::from_rows(1, vec![0.5, 0.5, 0.7]).unwrap();
    assert_eq!(mesh_ratio(&some), Some(f64::INFINITY));
}

proptest! {
    /// The tree of four points against all 16 (those of three edges without a
    /// cycle among the six).
    #[test]
    fn the_shortest_of_all_trees(values in prop::collection::vec(0.0..1.0f64, 8)) {
        let design = Design::from_rows(2, values.clone()).unwrap();
        let gap = |a: usize, b: usize| {
            let d = [0, 1].map(|j| values[2 * a + j] - values[2 * b + j]);
            (d[0] * d[0] + d[1] * d[1]).sqrt()
        };
        let edges: Vec<(usize, usize)> = (0..4).flat_map(|a| (0..a).map(move |b| (a, b))).collect();
        let mut least = f64::INFINITY;
        for mask in 0_u32..64 {
            let tree: Vec<_> = (0..6).filter(|k| mask >> k & 1 == 1).map(|k| edges[k]).collect();
            let mut group = [0, 1, 2, 3];
            for &(a, b) in &tree {
                let (from, to) = (group[a], group[b]);
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
            }
            if tree.len() == 3 && group.iter().all(|&g| g == group[0]) {
                least = least.min(tree.iter().map(|&(a, b)| gap(a, b)).sum());
            }
        }
        let found = 3.0 * spanning_tree(&design).unwrap().mean;
        prop_assert!((found - least).abs() < 1e-14, "{found} {least}");
    }
}
