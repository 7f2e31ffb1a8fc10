//! Marginals: round trips, order, published quantiles, refusals.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use lhs::{
    Cumulative, Design, LatinHypercube, LhsError, LogUniform, Marginal, Mixture, Normal, Tabulated,
    Triangular, Truncated, Uniform, map,
};
use proptest::prelude::*;

const TABLE: [(f64, f64); 5] = [(-1.0, 0.0), (0.0, 0.2), (0.5, 0.7), (2.0, 0.9), (4.0, 1.0)];

fn two_humps() -> Mixture {
    let humps: Vec<(f64, Box<dyn Cumulative>)> = vec![
        (2.0, Box::new(Normal::new(-1.0, 0.3).unwrap())),
        (1.0, Box::new(Uniform::new(0.0, 4.0).unwrap())),
    ];
    Mixture::new(humps).unwrap()
}

/// One of each kind, all continuous and rising on their support.
fn all() -> Vec<(&'static str, Box<dyn Cumulative>)> {
    let normal = Normal::new(3.0, 2.0).unwrap();
    let standard = Normal::new(0.0, 1.0).unwrap();
    vec![
        ("uniform", Box::new(Uniform::new(-0.333, 0.333).unwrap())),
        ("log-uniform", Box::new(LogUniform::new(1e-4, 1e3).unwrap())),
        (
            "triangular",
            Box::new(Triangular::new(1.0, 1.5, 4.0).unwrap()),
        ),
        (
            "left triangle",
            Box::new(Triangular::new(0.0, 0.0, 1.0).unwrap()),
        ),
        (
            "right triangle",
            Box::new(Triangular::new(0.0, 1.0, 1.0).unwrap()),
        ),
        ("normal", Box::new(normal)),
        (
            "truncated",
            Box::new(Truncated::new(normal, 0.0, 5.0).unwrap()),
        ),
        (
            "one-sided",
            Box::new(Truncated::new(normal, 4.0, f64::INFINITY).unwrap()),
        ),
        (
            "far tail",
            Box::new(Truncated::new(standard, 9.0, 12.0).unwrap()),
        ),
        (
            "far lower tail",
            Box::new(Truncated::new(standard, -12.0, -9.0).unwrap()),
        ),
        ("table", Box::new(Tabulated::new(&TABLE).unwrap())),
        ("mixture", Box::new(two_humps())),
    ]
}

proptest! {
    #[test]
    fn cdf_undoes_its_inverse(p in 1e-12..1.0_f64) {
        for (name, marginal) in all() {
            let x = marginal.inverse_cdf(p);
            prop_assert!(x.is_finite(), "{name}: {x}");
            // p itself, a few operations, and the rounding of x seen through
            // the slope of the distribution function: x·g(x) is below 150 for
            // all of these (the far tails are the steepest).
            let error = (marginal.cdf(x) - p).abs();
            prop_assert!(error < 5e-14, "{name}: p = {p}, error {error:e}");
            let error = (marginal.survival(x) - (1.0 - p)).abs();
            prop_assert!(error < 5e-14, "{name}: 1 - p, error {error:e}");
            let back = marginal.inverse_survival(marginal.survival(x));
            // Out in the tails a rounding of the survival is a step of x.
            let inner = (0.01..0.99).contains(&p);
            prop_assert!((back - x).abs() < 2e-14 * (1.0 + x.abs()) || !inner,
                "{name}: {back} for {x}");
        }
    }

    #[test]
    fn inverses_never_fall(p in 0.0..1.0_f64, q in 0.0..1.0_f64, tiny in 0.0..1e-13_f64) {
        for (name, marginal) in all() {
            let (low, high) = (p.min(q), p.max(q));
            prop_assert!(marginal.inverse_cdf(low) <= marginal.inverse_cdf(high), "{name}");
            // Neighbouring probabilities may swap by rounding, not by more.
            let (x, y) = (marginal.inverse_cdf(p), marginal.inverse_cdf((p + tiny).min(1.0)));
            prop_assert!(y >= x - 2.0 * f64::EPSILON * (1.0 + x.abs()), "{name}: {x} then {y}");
        }
    }

    /// Relative error in the lower tail, down to the smallest normal p. With
    /// x = Φ⁻¹(p), an error ε in x is one of about x² ε in p.
    #[test]
    fn normal_tail_is_accurate_relatively(exponent in -307.0..-0.31_f64) {
        let normal = Normal::new(0.0, 1.0).unwrap();
        let p = 10.0_f64.powf(exponent);
        let x = normal.inverse_cdf(p);
        let error = (normal.cdf(x) / p - 1.0).abs();
        prop_assert!(error < 4.0 * f64::EPSILON * (2.0 + x * x), "p = {p:e}: {error:e}");
        prop_assert_eq!(normal.inverse_survival(p), -x);
    }
}

/// A marginal that ends at 0 and its mirror image that begins there, cut to a thin slice at 0.
struct Slice {
    name: &'static str,
    /// Whether the density rises from 0 at the end; constant if not.
    is_slope: bool,
    below: Box<dyn Marginal>,
    above: Box<dyn Marginal>,
}

impl Slice {
    fn new<M: Cumulative + 'static>(
        name: &'static str,
        [below, above]: [M; 2],
        width: f64,
    ) -> Self {
        Self {
            name,
            is_slope: name == "triangle",
            below: Box::new(Truncated::new(below, -width, 0.0).unwrap()),
            above: Box::new(Truncated::new(above, 0.0, width).unwrap()),
        }
    }
}

/// Every marginal, cut to slices of that width.
fn slices(width: f64) -> [Slice; 5] {
    let humps = |at: f64| {
        let parts: Vec<(f64, Box<dyn Cumulative>)> = vec![
            (1.0, Box::new(Uniform::new(at - 1.0, at).unwrap())),
            (1.0, Box::new(Uniform::new(at, at + 1.0).unwrap())),
        ];
        Mixture::new(parts).unwrap()
    };
    let table = |points: &[(f64, f64)]| Tabulated::new(points).unwrap();
    let uniform = [
        Uniform::new(-1.0, 0.0).unwrap(),
        Uniform::new(0.0, 1.0).unwrap(),
    ];
    let twice = [
        Truncated::new(uniform[0], -3.0 * width, 0.0).unwrap(),
        Truncated::new(uniform[1], 0.0, 3.0 * width).unwrap(),
    ];
    let triangle = [
        Triangular::new(-1.0, -1.0, 0.0).unwrap(),
        Triangular::new(0.0, 1.0, 1.0).unwrap(),
    ];
    let ramp = [
        table(&[(-1.0, 0.0), (0.0, 1.0)]),
        table(&[(0.0, 0.0), (1.0, 1.0)]),
    ];
    [
        Slice::new("uniform", uniform, width),
        Slice::new("twice", twice, width),
        Slice::new("triangle", triangle, width),
        Slice::new("table", ramp, width),
        Slice::new("mixture", [-1.0, 1.0].map(humps), width),
    ]
}

/// A thin slice below an upper end, and its mirror image at a lower one: 1000 strata give 1000
/// values, which are those of the density there, and mirror images of each other.
#[test]
fn thin_tails_keep_their_strata() {
    for width in [1e-7, 1e-12] {
        for slice in slices(width) {
            let (name, mut before) = (slice.name, f64::NEG_INFINITY);
            for stratum in 0..1000 {
                let p = (f64::from(stratum) + 0.5) / 1000.0;
                let x = slice.below.inverse_cdf(p);
                assert!(x > before, "{name} {width:e}: {x:e} after {before:e}");
                before = x;
                let share = if slice.is_slope {
                    (1.0 - p).sqrt()
                } else {
                    1.0 - p
                };
                let off = x / (-width * share) - 1.0;
                assert!(off.abs() < 1e-12, "{name} {width:e} at {p}: off by {off:e}");
                let mirror = slice.above.inverse_cdf(1.0 - p);
                assert!(
                    (mirror / -x - 1.0).abs() < 1e-12,
                    "{name} {width:e}: {mirror:e} {x:e}"
                );
            }
        }
    }
}

/// The slice of the report: as many values as strata, √ of what is above.
#[test]
fn the_upper_end_of_a_triangle_keeps_its_strata() {
    let triangle = Triangular::new(0.0, 0.0, 1.0).unwrap();
    let slice = Truncated::new(triangle, 1.0 - 1e-7, 1.0).unwrap();
    let mut values: Vec<f64> = (0..1000)
        .map(|stratum| slice.inverse_cdf((f64::from(stratum) + 0.5) / 1000.0))
        .collect();
    let width = 1.0 - (1.0 - 1e-7);
    for (stratum, x) in values.iter().enumerate() {
        let share = 1.0 - (stratum as f64 + 0.5) / 1000.0;
        // One place of x, 1.1e-16.
        assert!(
            (1.0 - x - width * share.sqrt()).abs() < 3e-16,
            "{stratum}: {x}"
        );
    }
    values.dedup();
    assert_eq!(values.len(), 1000);
}

/// A log-uniform and a normal tail, from their definitions: ln(hi/x) and the mirror image.
#[test]
fn survival_has_the_digits_of_thin_tails() {
    let decades = LogUniform::new(1e-3, 1e3).unwrap();
    for tail in [1e-3, 1e-8, 1e-12] {
        let x = 1e3 * (1.0 - tail);
        let exact = -((x - 1e3) / 1e3_f64).ln_1p() / 1e6_f64.ln();
        assert!(
            (decades.survival(x) / exact - 1.0).abs() < 1e-14,
            "{tail:e}"
        );
        let back = decades.inverse_survival(exact);
        assert!(
            (back / x - 1.0).abs() < 1e-15,
            "{tail:e}: {back:e} for {x:e}"
        );
        let y = 1e-3 * (1.0 + tail);
        let exact = ((y - 1e-3) / 1e-3).ln_1p() / 1e6_f64.ln();
        assert!((decades.cdf(y) / exact - 1.0).abs() < 1e-14, "{tail:e}");
    }
    // Half a normal: its far tail is that of the whole one, twice as likely.
    let normal = Normal::new(0.0, 1.0).unwrap();
    let half = Truncated::new(normal, 0.0, f64::INFINITY).unwrap();
    let mixed: Vec<(f64, Box<dyn Cumulative>)> = vec![(3.0, Box::new(normal))];
    let mixed = Mixture::new(mixed).unwrap();
    for q in [0.25, 1e-3, 1e-10, 1e-15] {
        let x = half.inverse_cdf(1.0 - q);
        let above = 1.0 - (1.0 - q);
        assert!(
            (x / normal.inverse_survival(0.5 * above) - 1.0).abs() < 1e-14,
            "{q:e}: {x}"
        );
        assert!((half.survival(x) / above - 1.0).abs() < 1e-13, "{q:e}: {x}");
        let y = mixed.inverse_cdf(1.0 - q);
        assert!(
            (y / normal.inverse_survival(above) - 1.0).abs() < 1e-14,
            "{q:e}: {y}"
        );
    }
}

/// Quantiles of the standard normal in 40 digits, rounded, made by
/// `python3 crates/lhs/tests/golden/reference_numbers.py`.
#[test]
fn normal_quantiles() {
    let normal = Normal::new(0.0, 1.0).unwrap();
    for (p, x) in [
        (0.5, 0.0),
        (0.75, 0.674_489_750_196_081_7),
        (0.975, 1.959_963_984_540_054),
        (0.99, 2.326_347_874_040_841),
        (1e-10, -6.361_340_902_404_056),
    ] {
        assert!(
            (normal.inverse_cdf(p) - x).abs() < 2e-15 * (1.0 + x.abs()),
            "p = {p}"
        );
    }
}

#[test]
fn ends_of_the_support() {
    for (name, marginal) in all() {
        let (a, b) = (marginal.inverse_cdf(0.0), marginal.inverse_cdf(1.0));
        let expected = match name {
            "uniform" => (-0.333, 0.333),
            "log-uniform" => (1e-4, 1e3),
            "triangular" => (1.0, 4.0),
            "left triangle" | "right triangle" => (0.0, 1.0),
            "truncated" => (0.0, 5.0),
            "one-sided" => (4.0, f64::INFINITY),
            "far tail" => (9.0, 12.0),
            "far lower tail" => (-12.0, -9.0),
            "table" => (-1.0, 4.0),
            _ => (f64::NEG_INFINITY, f64::INFINITY),
        };
        assert_eq!((a, b), expected, "{name}");
        for outside in [-1e-9, 1.0 + 1e-9, f64::NAN] {
            assert!(
                marginal.inverse_cdf(outside).is_nan(),
                "{name} at {outside}"
            );
        }
    }
}

/// Medians that can be written down.
#[test]
fn hand_calculated_medians() {
    let median = |m: &dyn Marginal| m.inverse_cdf(0.5);
    assert_eq!(median(&Uniform::new(-2.0, 6.0).unwrap()), 2.0);
    // √(1e-4 · 1e4) = 1.
    // 8.9e-16 measured: the logarithms' rounding.
    assert!((median(&LogUniform::new(1e-4, 1e4).unwrap()) - 1.0).abs() < 5e-15);
    // Mode at lo: (1 − x)² = 1/2.
    let left = Triangular::new(0.0, 0.0, 1.0).unwrap();
    assert_eq!(median(&left), 1.0 - 0.5_f64.sqrt());
    // 0.2 + (x/0.5)·0.5 = 0.5.
    // 5.6e-17 measured: one rounding.
    assert!((median(&Tabulated::new(&TABLE).unwrap()) - 0.3).abs() < 3e-16);
}

/// Flat parts are skipped, jumps are hit with their probability.
#[test]
fn tables_with_gaps_and_jumps() {
    let points = [
        (0.0, 0.0),
        (1.0, 0.0),
        (2.0, 0.25),
        (5.0, 0.25),
        (5.0, 0.75),
        (6.0, 1.0),
        (9.0, 1.0),
    ];
    let table = Tabulated::new(&points).unwrap();
    assert_eq!((table.inverse_cdf(0.0), table.inverse_cdf(1.0)), (1.0, 6.0));
    assert_eq!(table.inverse_cdf(0.25), 2.0);
    assert_eq!(table.inverse_cdf(0.5), 5.0);
    assert_eq!(table.inverse_cdf(0.875), 5.5);
    assert_eq!(
        (
            table.cdf(0.5),
            table.cdf(3.0),
            table.cdf(5.0),
            table.cdf(7.0)
        ),
        (0.0, 0.25, 0.75, 1.0)
    );
}

#[test]
fn a_mapped_design_follows_its_marginals() {
    let n = 2000;
    let design = LatinHypercube::new(n, 3, 8).unwrap().design().unwrap();
    let normal = Normal::new(10.0, 2.0).unwrap();
    let square = |p: f64| p * p;
    let mapped = map(&design, &[&normal, &square, &|_: f64| 7.0]).unwrap();
    let mean = mapped.column(0).sum::<f64>() / n as f64;
    // A stratified mean: its error, 1.8e-4 measured, is far below the 0.045 of
    // random sampling.
    assert!((mean - 10.0).abs() < 1e-3, "{mean}");
    for (row, p) in mapped.rows().zip(design.rows()) {
        assert_eq!(row, [normal.inverse_cdf(p[0]), p[1] * p[1], 7.0]);
    }
}

#[test]
fn refusals_name_the_field() {
    let parameter = |r: Result<(), LhsError>, field: &str| {
        let message = r.unwrap_err().to_string();
        assert!(message.contains(field), "{message}");
    };
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    parameter(Uniform::new(1.0, 1.0).map(drop), "Uniform: hi = 1");
    parameter(Uniform::new(nan, 1.0).map(drop), "Uniform: lo = NaN");
    parameter(Uniform::new(f64::MIN, f64::MAX).map(drop), "hi - lo finite");
    parameter(LogUniform::new(0.0, 1.0).map(drop), "LogUniform: lo = 0");
    parameter(Triangular::new(0.0, 2.0, 1.0).map(drop), "mode = 2");
    parameter(Normal::new(inf, 1.0).map(drop), "mean = inf");
    parameter(Normal::new(0.0, 0.0).map(drop), "standard_deviation = 0");
    let normal = Normal::new(0.0, 1.0).unwrap();
    parameter(Truncated::new(normal, 2.0, 1.0).map(drop), "hi = 1");
    parameter(
        Truncated::new(normal, 50.0, 60.0).map(drop),
        "has probability",
    );
    parameter(Mixture::new(vec![]).map(drop), "at least 1");
    parameter(
        Mixture::new(vec![(-1.0, Box::new(normal))]).map(drop),
        "weight = -1",
    );
    for (points, valid) in [
        (&[(0.0, 0.0)][..], "at least 2"),
        (&[(0.0, 0.1), (1.0, 1.0)], "must be 0"),
        (&[(0.0, 0.0), (1.0, 0.9)], "must be 1"),
        (&[(0.0, 0.0), (1.0, nan), (2.0, 1.0)], "point 1"),
        (
            &[(0.0, 0.0), (1.0, 0.6), (2.0, 0.5), (3.0, 1.0)],
            "must not fall",
        ),
        (&[(0.0, 0.0), (-1.0, 1.0)], "x must not fall"),
        (&[(0.0, 0.0), (inf, 1.0)], "finite"),
        (&[(0.0, 0.0), (1.0, 1.5), (2.0, 1.0)], "nor pass 1"),
    ] {
        parameter(Tabulated::new(points).map(drop), valid);
    }
    let design = Design::from_rows(1, vec![0.5, 1.0]).unwrap();
    parameter(map(&design, &[]).map(drop), "0 marginals for 1 columns");
    parameter(map(&design, &[&normal]).map(drop), "row 1, column 0: 1");
    let half = Design::from_rows(1, vec![0.25, 0.5]).unwrap();
    let broken = |p: f64| if p > 0.3 { f64::NAN } else { p };
    parameter(
        map(&half, &[&broken]).map(drop),
        "row 1, column 0: value NaN",
    );
}
