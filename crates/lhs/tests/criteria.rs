//! Criteria against published and hand-calculated values.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use lhs::criteria::{centred_discrepancy, minimum_distance, phi_p};
use lhs::{Design, LatinHypercube};
use proptest::prelude::*;

fn design(dims: usize, values: &[f64]) -> Design {
    Design::from_rows(dims, values.to_vec()).unwrap()
}

/// The formula as printed by Hickernell, without any rearrangement.
fn plain_formula(d: &Design) -> f64 {
    let n = d.len() as f64;
    let z = |x: f64| (x - 0.5).abs();
    let mean = |x: &f64| 1.0 + 0.5 * z(*x) - 0.5 * z(*x).powi(2);
    let means: f64 = d.rows().map(|a| a.iter().map(mean).product::<f64>()).sum();
    let pair = |(x, y): (&f64, &f64)| 1.0 + 0.5 * z(*x) + 0.5 * z(*y) - 0.5 * (x - y).abs();
    let row = |a: &[f64]| -> f64 {
        d.rows()
            .map(|b| a.iter().zip(b).map(pair).product::<f64>())
            .sum()
    };
    let pairs: f64 = d.rows().map(row).sum();
    (13.0_f64 / 12.0).powi(d.dims() as i32) - 2.0 * means / n + pairs / (n * n)
}

/// One point in the centre: (13/12)^m − 2 + 1.
#[test]
fn one_centred_point() {
    for m in 1..=8 {
        let cd2 = centred_discrepancy(&design(m, &vec![0.5; m]));
        let exact = (13.0_f64 / 12.0).powi(m as i32) - 1.0;
        // Equal measured; the power may round otherwise elsewhere.
        assert!((cd2 - exact).abs() <= f64::EPSILON, "m = {m}: {cd2}");
    }
}

/// In one variable the centred design has CD² = 1/(12 n²), the least there is.
#[test]
fn one_variable_has_a_closed_form() {
    for n in [1, 2, 3, 10, 63, 64, 65, 200] {
        let d = LatinHypercube::new(n, 1, 5)
            .unwrap()
            .centred()
            .design()
            .unwrap();
        let exact = 1.0 / (12.0 * (n * n) as f64);
        // Three sums of order 1 cancel: 7.8e-16 measured.
        assert!((centred_discrepancy(&d) - exact).abs() < 5e-15, "n = {n}");
    }
}

/// SciPy's documented example (`scipy.stats.qmc.discrepancy`, which prints
/// 0.008142039609053464): the exact fraction's nearest double, made by
/// `python3 crates/lhs/tests/golden/reference_numbers.py`.
#[test]
fn scipy_example() {
    let space = [1., 3., 2., 6., 3., 2., 4., 5., 5., 1., 6., 4.];
    let d = design(2, &space.map(|v| (v - 0.5) / 6.0));
    assert!((centred_discrepancy(&d) - 0.008_142_039_609_053_497).abs() < 1e-15);
}

proptest! {
    #[test]
    fn rearranged_formula_agrees_with_the_printed_one(
        n in 1..150_usize, m in 1..7_usize, seed: u64,
    ) {
        let d = LatinHypercube::new(n, m, seed).unwrap().design().unwrap();
        // Rounding of sums whose terms are up to 1.5^m: 0.7e-15 of that measured.
        let tolerance = 5e-15 * 1.5_f64.powi(m as i32);
        prop_assert!((centred_discrepancy(&d) - plain_formula(&d)).abs() < tolerance);
    }

    #[test]
    fn centred_discrepancy_is_blind_to_mirrors_and_order(n in 1..80_usize, seed: u64) {
        let d = LatinHypercube::new(n, 3, seed).unwrap().design().unwrap();
        let mirrored: Vec<f64> = d.rows().rev().flat_map(|r| [1.0 - r[2], r[0], r[1]]).collect();
        let other = centred_discrepancy(&design(3, &mirrored));
        // 2.2e-15 measured.
        prop_assert!((centred_discrepancy(&d) - other).abs() < 2e-14);
    }

    #[test]
    fn distances_agree_with_all_pairs(n in 2..120_usize, m in 1..5_usize, seed: u64) {
        let d = LatinHypercube::new(n, m, seed).unwrap().design().unwrap();
        let mut distances = Vec::new();
        for i in 0..n {
            for k in 0..i {
                let pairs = d.row(i).unwrap().iter().zip(d.row(k).unwrap());
                distances.push(pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt());
            }
        }
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        prop_assert_eq!(minimum_distance(&d), least);
        let phi = distances.iter().map(|d| d.powi(-5)).sum::<f64>().powf(0.2);
        // 1.6e-15 measured.
        prop_assert!((phi_p(&d, 5.0) / phi - 1.0).abs() < 1e-14);
        // φ_p lies between 1/d and (number of pairs)^(1/p) / d.
        let (phi, pairs) = (phi_p(&d, 50.0) * least, distances.len() as f64);
        prop_assert!(phi >= 1.0 - f64::EPSILON && phi <= pairs.powf(0.02) + f64::EPSILON);
    }
}

/// Corners of the unit square: four sides of 1, two diagonals of √2.
#[test]
fn corners_of_a_square() {
    let d = design(2, &[0., 0., 0., 1., 1., 0., 1., 1.]);
    assert_eq!(minimum_distance(&d), 1.0);
    let phi = (4.0 + 2.0 * 2.0_f64.powi(-2)).powf(0.25);
    // Equal measured.
    assert!((phi_p(&d, 4.0) - phi).abs() <= f64::EPSILON);
}

#[test]
fn edge_cases_of_distances() {
    let one = design(2, &[0.3, 0.4]);
    assert_eq!(
        (minimum_distance(&one), phi_p(&one, 2.0)),
        (f64::INFINITY, 0.0)
    );
    let twice = design(2, &[0.3, 0.4, 0.3, 0.4]);
    assert_eq!(
        (minimum_distance(&twice), phi_p(&twice, 2.0)),
        (0.0, f64::INFINITY)
    );
    assert!(phi_p(&one, -1.0).is_nan() && phi_p(&one, f64::NAN).is_nan());
    // d^-p alone would overflow: 10^(20·30).
    let close = design(1, &[0.0, 1e-30]);
    // 1.1e-16 measured.
    assert!((phi_p(&close, 20.0) / 1e30 - 1.0).abs() < 1e-15);
}

/// Triangles of 3, 4 and 5, from the least numbers of f64 to the greatest: no square may
/// overflow or vanish.
#[test]
fn distances_have_the_range_of_f64() {
    for unit in [5e-324, 1e-310, 1e-200, 1e-150, 1.0, 1e150, 1e200, 3e307] {
        let d = design(2, &[0.0, 0.0, 3.0 * unit, 0.0, 3.0 * unit, 4.0 * unit]);
        assert_eq!(minimum_distance(&d), 3.0 * unit, "{unit:e}");
        let hypotenuse = design(2, &[0.0, 0.0, 3.0 * unit, 4.0 * unit]);
        // The rounding of a quotient, a square, a sum, a root and a product.
        let off = minimum_distance(&hypotenuse) / (5.0 * unit) - 1.0;
        assert!(off.abs() <= 4.0 * f64::EPSILON, "{unit:e}: {off:e}");
        // In units of the least distance: 1 + (3/4)⁴ + (3/5)⁴.
        let phi = phi_p(&d, 4.0) * (3.0 * unit);
        let exact = (1.0 + 0.75_f64.powi(4) + 0.6_f64.powi(4)).powf(0.25);
        let finite = unit > 1e-309;
        assert!(
            !finite || (phi / exact - 1.0).abs() < 1e-15,
            "{unit:e}: {phi}"
        );
    }
    // Two near points among far ones: their squares are 10⁻⁴⁰⁰.
    let mixed = design(2, &[0.0, 0.0, 1e-200, 0.0, 1.0, 1.0]);
    assert_eq!(minimum_distance(&mixed), 1e-200);
}

#[test]
fn threads_do_not_change_a_bit() {
    let d = LatinHypercube::new(1500, 4, 3).unwrap().design().unwrap();
    let values = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| (centred_discrepancy(&d).to_bits(), phi_p(&d, 15.0).to_bits()))
    };
    assert_eq!(values(1), values(2));
    assert_eq!(values(1), values(4));
}
