//! Correlated, added, sliced and orthogonal points, levels and figures of any numbers: an
//! answer, or an error that says what would be valid.

use lhs::criteria::{
    coverage, l2_star_discrepancy, mesh_ratio, mixture_discrepancy, spanning_tree,
    wrap_around_discrepancy,
};
use lhs::{
    Augmentation, CorrelationMatrix, Design, DesignVariable, Integers, LhsError, OrthogonalArray,
    Placement, SlicedHypercube, map_balanced, rank_correlated, rank_correlation,
};
use proptest::prelude::*;

fn any_value() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => 0.0..1.0f64,
        1 => any::<f64>().prop_filter("not finite", |v| v.is_finite()),
        1 => prop::sample::select(vec![0.0, -0.0, 1.0, 0.5, f64::MAX, f64::MIN, 5e-324, 1.0 - f64::EPSILON / 2.0]),
    ]
}

/// Small, or so large that it is refused before anything is made.
fn any_size() -> impl Strategy<Value = usize> {
    prop_oneof![
        8 => 0..9_usize,
        1 => prop::sample::select(vec![usize::MAX, usize::MAX / 2 + 1, (1 << 53) + 1, 1 << 60]),
    ]
}

fn says_what_is_valid<T>(made: Result<T, LhsError>) -> Option<T> {
    match made {
        Ok(made) => Some(made),
        Err(error) => {
            let message = error.to_string();
            let valid = ["must be", "must lie", "exactly one", "memory"];
            assert!(valid.iter().any(|v| message.contains(v)), "{message}");
            None
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_design(
        dims in 1..4_usize, values in prop::collection::vec(any_value(), 3..30),
        r in prop::array::uniform3(-1.0..1.0f64), points in any_size(), candidates in 0..4_usize, seed: u64,
    ) {
        let rows = values.len() / dims;
        let design = Design::from_rows(dims, values[..rows * dims].to_vec()).unwrap();
        for value in [coverage(&design), mesh_ratio(&design)].into_iter().flatten() {
            prop_assert!(value >= 0.0, "{value}");
        }
        if let Some(tree) = spanning_tree(&design) {
            prop_assert!(tree.mean >= 0.0 && tree.deviation >= 0.0, "{tree:?}");
        }
        wrap_around_discrepancy(&design);
        mixture_discrepancy(&design);
        l2_star_discrepancy(&design);
        let own = rank_correlation(&design);
        prop_assert!(own.iter().all(|v| v.is_nan() || (-1.0..=1.0).contains(v)));
        let of = |j: usize, k: usize| if j == k { 1.0 } else { r[j + k - 1] };
        let matrix: Vec<f64> = (0..dims * dims).map(|at| of(at / dims, at % dims)).collect();
        if let Some(target) = says_what_is_valid(CorrelationMatrix::new(dims, &matrix))
            && let Some(made) = says_what_is_valid(rank_correlated(&design, &target))
        {
            prop_assert!(made.deviation < 2.0, "{}", made.deviation);
        }
        let add = Augmentation { points, placement: Placement::Random, candidates, seed };
        if let Some(made) = says_what_is_valid(add.of(&design)) {
            prop_assert_eq!(made.design.len(), rows + points);
            prop_assert!(made.design.values()[rows * dims..].iter().all(|v| *v > 0.0 && *v < 1.0));
        }
        let level = DesignVariable::Integers(Integers::new(1, 1 + (seed >> 12) as i64).unwrap());
        says_what_is_valid(map_balanced(&design, &vec![level; dims]));
    }

    #[test]
    fn any_shape(slices in any_size(), points in any_size(), dims in any_size(), seed: u64) {
        let placement = Placement::Random;
        let sliced = SlicedHypercube { slices, points, dims, placement, seed };
        if let Some(made) = says_what_is_valid(sliced.design()) {
            prop_assert_eq!((made.design.len(), made.design.dims()), (slices * points, dims));
        }
        let array = OrthogonalArray { prime: points, dims, placement, seed };
        if let Some(made) = says_what_is_valid(array.design()) {
            prop_assert_eq!((made.len(), made.dims()), (points * points, dims));
        }
    }
}
