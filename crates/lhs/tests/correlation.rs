//! Given rank correlations.

use crate::discrepancies::lattice;
use crate::is_latin;
use lhs::{CorrelationMatrix, Design, LatinHypercube, rank_correlated, rank_correlation};
use proptest::prelude::*;

fn plain(n: usize, dims: usize, seed: u64) -> Design {
    LatinHypercube::new(n, dims, seed)
        .unwrap()
        .design()
        .unwrap()
}

/// SciPy 1.17.1, `scipy.stats.spearmanr`: `docs/peers/lhs/run`.
#[test]
fn scipy_has_the_same_ranks() {
    let r = rank_correlation(&lattice());
    let (small, large) = (0.007518796992481202, -0.08270676691729321);
    for (j, k, theirs) in [
        (0, 1, small),
        (0, 2, small),
        (0, 3, large),
        (1, 2, large),
        (1, 3, small),
        (2, 3, small),
    ] {
        assert!((r[4 * j + k] - theirs).abs() < 1e-15);
        assert_eq!(r[4 * j + k], r[4 * k + j]);
    }
}

/// Ranks 1.5, 1.5, 3, 4 and 1, 2, 3, 4: 4.5/√(4.5 · 5).
#[test]
fn ties_share_their_rank() {
    let d = Design::from_rows(2, vec![5., 0., 5., 1., 6., 2., 9., 3.]).unwrap();
    let r = rank_correlation(&d)[1];
    assert!((r - 4.5 / 22.5_f64.sqrt()).abs() < 1e-15, "{r}");
    let constant = Design::from_rows(2, vec![1., 0., 1., 1.]).unwrap();
    assert!(rank_correlation(&constant)[1].is_nan());
}

/// G Gᵀ with rows of length 1 is a correlation matrix; times 0.8 off the diagonal it is
/// well away from the singular ones, of which not all are rank correlations.
fn matrix(dims: usize, rows: &[f64]) -> Option<CorrelationMatrix> {
    let unit: Vec<Vec<f64>> = rows
        .chunks_exact(dims)
        .map(|r| {
            let length = r.iter().map(|v| v * v).sum::<f64>().sqrt();
            r.iter().map(|v| v / length).collect()
        })
        .collect();
    let mut values = vec![1.0; dims * dims];
    for j in 0..dims {
        for k in 0..j {
            let r: f64 = unit[j].iter().zip(&unit[k]).map(|(a, b)| a * b).sum();
            (values[j * dims + k], values[k * dims + j]) = (0.8 * r, 0.8 * r);
        }
    }
    CorrelationMatrix::new(dims, &values).ok()
}

proptest! {
    #[test]
    fn columns_keep_their_values_and_get_their_correlation(
        rows in prop::collection::vec(-1.0..1.0f64, 9), n in 100..400_usize, seed: u64,
    ) {
        let Some(target) = matrix(3, &rows) else { return Ok(()) };
        let before = plain(n, 3, seed);
        let made = rank_correlated(&before, &target).unwrap();
        prop_assert!(is_latin(&made.design));
        for dim in 0..3 {
            let sorted = |d: &Design| {
                let mut column: Vec<u64> = d.column(dim).map(f64::to_bits).collect();
                column.sort();
                column
            };
            prop_assert_eq!(sorted(&before), sorted(&made.design));
        }
        prop_assert!(made.design.column(0).eq(before.column(0)));
        let r = rank_correlation(&made.design);
        prop_assert_eq!(&r, &made.correlation);
        let most = r.iter().zip(target.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        prop_assert_eq!(most, made.deviation);
        prop_assert!(most < 0.02, "{most}");
    }

    #[test]
    fn any_matrix_is_refused_or_taken(dims in 0..4_usize, values in prop::collection::vec(-1.2..1.2f64, 0..10)) {
        if let Err(e) = CorrelationMatrix::new(dims, &values) {
            prop_assert!(e.to_string().contains("must be"), "{e}");
        }
    }
}

/// Greatest of ten seeds measured: 2.2e-2, 1.2e-3, 1.4e-5.
#[test]
fn the_deviation_falls_with_n() {
    let target = CorrelationMatrix::new(3, &[1., 0.8, -0.3, 0.8, 1., 0., -0.3, 0., 1.]).unwrap();
    for (n, most) in [(20, 3e-2), (100, 3e-3), (1000, 3e-4)] {
        for seed in 0..10 {
            let made = rank_correlated(&plain(n, 3, seed), &target).unwrap();
            assert!(made.deviation < most, "{n} {seed}: {}", made.deviation);
        }
    }
}

#[test]
fn no_correlation_is_a_target_too() {
    let none = CorrelationMatrix::new(2, &[1., 0., 0., 1.]).unwrap();
    let made = rank_correlated(&plain(50, 2, 1), &none).unwrap();
    assert!(made.deviation < 0.01, "{}", made.deviation);
}

#[test]
fn refusals_say_what_is_valid() {
    let wrong = CorrelationMatrix::new(3, &[1., 0.9, -0.9, 0.9, 1., 0.9, -0.9, 0.9, 1.]);
    let message = wrong.unwrap_err().to_string();
    // 1 − 3 f² − 2 f³ > 0 for f = 0.9 · factor < ½: 0.55.
    assert!(
        message.contains("variable 2") && message.contains("by 0.55"),
        "{message}"
    );
    let scaled = [1., 0.495, -0.495, 0.495, 1., 0.495, -0.495, 0.495, 1.];
    assert!(CorrelationMatrix::new(3, &scaled).is_ok());
    for (values, part) in [
        (&[1., 0.5, 0.4, 1.][..], "across the diagonal"),
        (&[1., 1., 1., 1.], "below 1"),
        (&[1., f64::NAN, f64::NAN, 1.], "below 1"),
        (&[2., 0., 0., 1.], "1 on the diagonal"),
        (&[1., 0., 0.], "square"),
    ] {
        let message = CorrelationMatrix::new(2, values).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    }
    let pair = CorrelationMatrix::new(2, &[1., 0.5, 0.5, 1.]).unwrap();
    let refused = |d: Design| rank_correlated(&d, &pair).unwrap_err().to_string();
    assert!(refused(plain(2, 2, 1)).contains("more than"));
    assert!(refused(plain(9, 3, 1)).contains("number of columns"));
    let rows =
        |f: fn(usize) -> [f64; 2]| Design::from_rows(2, (0..9).flat_map(f).collect()).unwrap();
    assert!(refused(rows(|i| [i as f64, 1.0])).contains("different values"));
    assert!(refused(rows(|i| [i as f64, 2.0 * i as f64])).contains("linear combination"));
}
