//! Counts against the eigenvalues of the dense matrix.

use super::Ldlt;
use crate::SymmetricBanded;
use nalgebra::SymmetricEigen;
use proptest::prelude::*;

fn band(order: usize, p: usize, mut entry: impl FnMut(usize, usize) -> f64) -> SymmetricBanded {
    let mut matrix = SymmetricBanded::zeros(order, p).unwrap();
    for row in 0..order {
        for column in row.saturating_sub(p)..=row {
            matrix.add(row, column, entry(row, column)).unwrap();
        }
    }
    matrix
}

proptest! {
    /// Small whole numbers make leading parts of K − μM exactly singular all the
    /// time, and `off` nearly so. A count that stands must be that of the
    /// eigenvalues; one that does not is always found a little further on.
    #[test]
    fn a_count_that_stands_is_right(
        p in 1..6_usize,
        numbers in prop::collection::vec(-3..=3_i32, 20 * 6),
        mu in 1..4_i32,
        off in prop_oneof![Just(0.0), -1e-6..1e-6_f64, -1e-13..1e-13_f64],
    ) {
        let order = 20;
        let stiffness = band(order, p, |i, j| f64::from(numbers[6 * i + (i - j)]));
        let mass = band(order, 0, |_, _| 1.0);
        let dense = stiffness.to_dense().unwrap();
        let eigenvalues = SymmetricEigen::new(dense).eigenvalues;
        let mut factor = Ldlt::new(&mass, &stiffness);
        let mut stood = 0;
        for move_on in 0..32 {
            let mu = f64::from(mu) + off + 0.01 * f64::from(move_on);
            let Some(count) = factor.factorise(&mass, &stiffness, mu) else {
                continue;
            };
            stood += 1;
            // (p + 2) 2⁻⁵³ × GROWTH × (|K_ii| + μ) × the entries of a row: 1e-10.
            let below = |at: f64| eigenvalues.iter().filter(|e| **e < at).count();
            let (least, most) = (below(mu - 1e-10), below(mu + 1e-10));
            prop_assert!((least..=most).contains(&count), "{count} not in {least}..={most}");
        }
        prop_assert!(stood > 0);
    }
}
