//! The discrepancies against SciPy, closed forms and what must not change them.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use lhs::criteria::{
    centred_discrepancy, l2_star_discrepancy, mixture_discrepancy, wrap_around_discrepancy,
};
use lhs::{Design, LatinHypercube};
use proptest::prelude::*;

/// SciPy's documented example.
pub fn documented() -> Design {
    let space = [1., 3., 2., 6., 3., 2., 4., 5., 5., 1., 6., 4.];
    Design::from_rows(2, space.map(|v| (v - 0.5) / 6.0).to_vec()).unwrap()
}

/// 20 points in 4 variables: ((i·a + 3) mod 20 + ½)/20 for a = 1, 3, 7, 9.
pub fn lattice() -> Design {
    let values = (0..20).flat_map(|i| [1, 3, 7, 9].map(|a| (i * a + 3) % 20));
    let values = values.map(|cell| (f64::from(cell) + 0.5) / 20.0).collect();
    Design::from_rows(4, values).unwrap()
}

/// Exact fractions, to the nearest double, by
/// `python3 crates/lhs/tests/golden/reference_numbers.py`. SciPy 1.17.1 has the same but for
/// its own rounding of up to 1.6e-14: `docs/peers/lhs/run`.
#[test]
fn exact_fractions() {
    let all = |d: &Design| {
        [
            centred_discrepancy(d),
            wrap_around_discrepancy(d),
            mixture_discrepancy(d),
            l2_star_discrepancy(d),
        ]
    };
    let exact = [
        [
            0.008142039609053497,
            0.01684670781893004,
            0.014895592206790124,
            0.06833606212558108,
        ],
        [
            0.006583700074548556,
            0.014211259296537423,
            0.018357024149536025,
            0.025498605843474714,
        ],
    ];
    for (design, exact) in [documented(), lattice()].iter().zip(exact) {
        for (ours, exact) in all(design).into_iter().zip(exact) {
            // Terms of up to (19/12)^4 = 6.3 cancel.
            assert!((ours - exact).abs() < 1e-14, "{ours} {exact}");
        }
    }
}

/// One point, by hand: WD² = (3/2)^m − (4/3)^m anywhere; MD² in the centre
/// (19/12)^m − 2 (5/3)^m + (15/8)^m; D² at 0: 3⁻ᵐ − 2·2⁻ᵐ + 1.
#[test]
fn one_point_has_closed_forms() {
    for m in 1..=8 {
        let at = |x| Design::from_rows(m, vec![x; m]).unwrap();
        let e = m as i32;
        let wd = 1.5_f64.powi(e) - (4.0_f64 / 3.0).powi(e);
        // Sums of up to 150 with a few roundings each.
        for x in [0.0, 0.3, 0.5, 1.0] {
            assert!((wrap_around_discrepancy(&at(x)) - wd).abs() < 1e-13);
        }
        let md = (19.0_f64 / 12.0).powi(e) - 2.0 * (5.0_f64 / 3.0).powi(e) + 1.875_f64.powi(e);
        assert!((mixture_discrepancy(&at(0.5)) - md).abs() < 1e-12);
        let star = (3.0_f64.powi(-e) - 2.0 * 0.5_f64.powi(e) + 1.0).sqrt();
        assert!((l2_star_discrepancy(&at(0.0)) - star).abs() < 1e-15);
    }
}

/// In one variable the star discrepancy of the centred design is
/// D² = 1/(12 n²), and WD² = 1/(6 n²) for any equidistant points.
#[test]
fn one_variable_has_closed_forms() {
    for n in [1, 2, 3, 10, 64, 200] {
        let d = LatinHypercube::new(n, 1, 5).unwrap().centred();
        let d = d.design().unwrap();
        let n2 = (n * n) as f64;
        let star = l2_star_discrepancy(&d);
        assert!((star * star - 1.0 / (12.0 * n2)).abs() < 5e-15, "n = {n}");
        let wd = wrap_around_discrepancy(&d);
        assert!((wd - 1.0 / (6.0 * n2)).abs() < 5e-15, "n = {n}: {wd}");
    }
}

proptest! {
    /// WD² does not change on a move round the torus, MD² not on a mirror, none
    /// with the order of points or variables.
    #[test]
    fn symmetries(values in prop::collection::vec(0.0..1.0f64, 3 * 12), step in 0.0..1.0f64) {
        let design = |f: &dyn Fn(usize, f64) -> f64| {
            let moved = values.iter().enumerate().map(|(k, &v)| f(k % 3, v));
            Design::from_rows(3, moved.collect()).unwrap()
        };
        let plain = design(&|_, v| v);
        let round = design(&|j, v| if j == 1 { (v + step).fract() } else { v });
        let mirrored = design(&|j, v| if j == 2 { 1.0 - v } else { v });
        let turned: Vec<f64> = plain.rows().rev().flat_map(|r| [r[2], r[0], r[1]]).collect();
        let turned = Design::from_rows(3, turned).unwrap();
        let close = |a: f64, b: f64| (a - b).abs() < 1e-13;
        prop_assert!(close(wrap_around_discrepancy(&plain), wrap_around_discrepancy(&round)));
        prop_assert!(close(mixture_discrepancy(&plain), mixture_discrepancy(&mirrored)));
        prop_assert!(close(wrap_around_discrepancy(&plain), wrap_around_discrepancy(&turned)));
        prop_assert!(close(mixture_discrepancy(&plain), mixture_discrepancy(&turned)));
        let square = |d| l2_star_discrepancy(d) * l2_star_discrepancy(d);
        prop_assert!(close(square(&plain), square(&turned)));
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let d = LatinHypercube::new(700, 4, 3).unwrap().design().unwrap();
    let values = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let all = || {
            let all = [
                wrap_around_discrepancy(&d),
                mixture_discrepancy(&d),
                l2_star_discrepancy(&d),
            ];
            all.map(f64::to_bits)
        };
        pool.build().unwrap().install(all)
    };
    assert_eq!(values(1), values(3));
}

/// The largest products stay finite.
#[test]
fn the_most_variables_are_judged() {
    let d = LatinHypercube::new(3, lhs::MAX_DIMS, 1).unwrap();
    let d = d.design().unwrap();
    for value in [
        wrap_around_discrepancy(&d),
        mixture_discrepancy(&d),
        l2_star_discrepancy(&d),
    ] {
        assert!(value.is_finite() && value >= 0.0, "{value}");
    }
}
