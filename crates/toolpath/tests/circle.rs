//! Figures of circles against closed forms and a search that knows no exchange.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use proptest::prelude::*;
use toolpath::iso230_4::{
    NominalCircle, figures, least_squares_circle, minimum_zone_circle, quadrant_glitches,
};

const R: f64 = 0.05;
const NOMINAL: NominalCircle = NominalCircle {
    centre: [0.01, -0.02],
    radius: R,
};

fn trace(n: usize, radial: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    (0..n)
        .map(|i| {
            let angle = TAU * i as f64 / n as f64;
            let r = R + radial(angle);
            [
                NOMINAL.centre[0] + r * angle.cos(),
                NOMINAL.centre[1] + r * angle.sin(),
            ]
        })
        .collect()
}

fn back(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.reverse();
    points
}

/// Squareness φ: x += φ y makes an ellipse of half axes R (1 ± φ/2): G = φR, F = ± ½ φR.
#[test]
fn squareness_is_an_ellipse() {
    let phi = 20e-6;
    let square = trace(3600, |_| 0.0)
        .into_iter()
        .map(|[x, y]| [x + phi * (y - NOMINAL.centre[1]), y]);
    let points: Vec<[f64; 2]> = square.collect();
    let f = figures(&NOMINAL, &back(points.clone()), &points).unwrap();
    for side in [f.clockwise, f.counterclockwise] {
        assert!((side.g - phi * R).abs() < 1e-5 * phi * R, "{side:?}");
        assert!(
            (side.f_max - 0.5 * phi * R).abs() < 3e-5 * phi * R,
            "{side:?}"
        );
        assert!(
            (side.f_min + 0.5 * phi * R).abs() < 3e-5 * phi * R,
            "{side:?}"
        );
    }
    assert!(f.h < 1e-15 && f.d.abs() < phi * phi * R, "{f:?}");
}

/// A scale of (1 + a) in X and (1 + b) in Y: G = |a − b| R, D = (a + b) R/2.
#[test]
fn scales_that_differ() {
    let (a, b) = (30e-6, -10e-6);
    let [cx, cy] = NOMINAL.centre;
    let points: Vec<[f64; 2]> = trace(3600, |_| 0.0)
        .into_iter()
        .map(|[x, y]| [cx + (1.0 + a) * (x - cx), cy + (1.0 + b) * (y - cy)])
        .collect();
    let f = figures(&NOMINAL, &points, &back(points.clone())).unwrap();
    assert!(
        (f.g_bidirectional - 40e-6 * R).abs() < 1e-5 * 40e-6 * R,
        "{f:?}"
    );
    assert!((f.d - 10e-6 * R).abs() < 1e-4 * 10e-6 * R, "{f:?}");
    assert!((f.clockwise.f_max - a * R).abs() < 1e-12 && (f.clockwise.f_min - b * R).abs() < 1e-12);
}

/// Another centre changes F by its distance, and G not at all; backlash is H.
#[test]
fn a_shifted_centre_and_backlash() {
    let form = |angle: f64| 1e-6 * (3.0 * angle).cos() + 0.5e-6 * (7.0 * angle).sin();
    let points = trace(2000, form);
    let still = minimum_zone_circle(&NOMINAL, &points).unwrap();
    let shifted: Vec<[f64; 2]> = points.iter().map(|p| [p[0] + 2e-4, p[1] - 1e-4]).collect();
    let moved = minimum_zone_circle(&NOMINAL, &shifted).unwrap();
    assert!(
        (moved.range - still.range).abs() < 1e-15,
        "{moved:?} {still:?}"
    );
    assert!((moved.centre[0] - still.centre[0] - 2e-4).abs() < 1e-14);
    let f = figures(
        &NOMINAL,
        &trace(1000, |_| 2e-6),
        &trace(1500, |a| 2e-6 * a.cos()),
    )
    .unwrap();
    assert!((f.h - 4e-6).abs() < 1e-11, "{}", f.h);
    // Radius of both together: 2 µm on 1000 points, on the others a mere shift of the centre.
    assert!((f.counterclockwise.g) < 1e-10, "{f:?}");
}

/// Lobes: k waves of amplitude A have the zone 2A about the nominal centre, for k > 1.
#[test]
fn lobes_have_twice_their_amplitude() {
    for k in [2.0, 3.0, 5.0, 8.0] {
        let zone = minimum_zone_circle(&NOMINAL, &trace(1680, |a| 1e-6 * (k * a).cos())).unwrap();
        assert!((zone.range - 2e-6).abs() < 1e-15, "{k}: {zone:?}");
        assert!((zone.radius - R).abs() < 1e-15);
    }
}

/// Least range over the centre by a nested search in two directions.
fn searched(points: &[[f64; 2]]) -> f64 {
    let range = |c: [f64; 2]| {
        let radii = points
            .iter()
            .map(|p| ((p[0] - c[0]).powi(2) + (p[1] - c[1]).powi(2)).sqrt());
        let (a, b) = radii.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), r| {
            (a.min(r), b.max(r))
        });
        b - a
    };
    let golden = |f: &dyn Fn(f64) -> f64, middle: f64| {
        let (mut a, mut b) = (middle - 2e-5, middle + 2e-5);
        while b - a > 1e-13 {
            let (c, d) = (b - 0.618034 * (b - a), a + 0.618034 * (b - a));
            if f(c) < f(d) { b = d } else { a = c }
        }
        f(0.5 * (a + b))
    };
    golden(
        &|x| golden(&|y| range([x, y]), NOMINAL.centre[1]),
        NOMINAL.centre[0],
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_zone_is_the_least(noise in prop::collection::vec(-2e-6..2e-6f64, 60), shift in -5e-6..5e-6f64) {
        let points = trace(60, |a| noise[(a * 60.0 / TAU).round() as usize % 60] + shift * a.cos());
        let zone = minimum_zone_circle(&NOMINAL, &points).unwrap();
        let least = searched(&points);
        prop_assert!((zone.range - least).abs() < 1e-12, "{} for {least}", zone.range);
        let squares = least_squares_circle(&NOMINAL, &points).unwrap();
        prop_assert!(zone.range <= squares.range);
    }

    #[test]
    fn any_number_is_taken(points in prop::collection::vec([any::<f64>(), any::<f64>()], 0..40), r in any::<f64>(), window in any::<f64>()) {
        let nominal = NominalCircle { centre: [0.0; 2], radius: r };
        let _ = figures(&nominal, &points, &points);
        let _ = quadrant_glitches(&nominal, &points, window);
    }

    /// Points anywhere, all finite and around.
    #[test]
    fn any_shape_is_taken(radii in prop::collection::vec(0.1..10.0f64, 8..40)) {
        let n = radii.len() as f64;
        let points: Vec<[f64; 2]> = radii.iter().enumerate().map(|(i, r)| {
            let angle = TAU * i as f64 / n;
            [r * angle.cos(), r * angle.sin()]
        }).collect();
        let nominal = NominalCircle { centre: [0.0; 2], radius: 1.0 };
        let f = figures(&nominal, &points, &points).unwrap();
        prop_assert!(f.h < 1e-12);
    }
}

/// Peaks that decay after each reversal, of known height by axis, in both directions.
#[test]
fn glitches_by_axis_and_quadrant() {
    let heights = [4e-6, 7e-6, -3e-6, 5e-6]; // at 0, π/2, π, 3π/2
    for sign in [1.0, -1.0] {
        let points: Vec<[f64; 2]> = (0..=72_000)
            .map(|i| {
                let angle = sign * (-PI / 3.0 + (TAU + 0.7 * PI) * f64::from(i) / 72_000.0);
                let after = |at: f64| (sign * (angle - at)).rem_euclid(TAU);
                let bump = |d: f64| {
                    if d < 0.2 {
                        (PI * d / 0.2).sin().powi(2)
                    } else {
                        0.0
                    }
                };
                let r = R
                    + (0..4)
                        .map(|k| heights[k] * bump(after(k as f64 * PI / 2.0)))
                        .sum::<f64>();
                [
                    NOMINAL.centre[0] + r * angle.cos(),
                    NOMINAL.centre[1] + r * angle.sin(),
                ]
            })
            .collect();
        let glitches = quadrant_glitches(&NOMINAL, &points, FRAC_PI_4).unwrap();
        let expected: [usize; 5] = if sign > 0.0 {
            [0, 1, 2, 3, 0]
        } else {
            [0, 3, 2, 1, 0]
        };
        assert_eq!(glitches.len(), 5, "{glitches:?}");
        for (g, k) in glitches.iter().zip(expected) {
            assert_eq!(g.axis, k % 2);
            let quadrant = if sign > 0.0 {
                [1, 2, 3, 4][k]
            } else {
                [4, 1, 2, 3][k]
            };
            assert_eq!(g.quadrant, quadrant, "{g:?}");
            // The peak lies within half of a step of 90 µrad: h (π δ/0.2)² lower at most.
            assert!((g.peak - heights[k]).abs() < 4e-12, "{g:?}");
            assert!((g.delay - 0.1).abs() < 2e-4, "{g:?}");
        }
    }
}

#[test]
fn what_is_wrong_is_said() {
    let half: Vec<[f64; 2]> = trace(100, |_| 0.0).into_iter().take(50).collect();
    let text = figures(&NOMINAL, &half, &half).unwrap_err().to_string();
    assert!(
        text.contains("clockwise") && text.contains("an eighth"),
        "{text}"
    );
    assert!(
        quadrant_glitches(&NOMINAL, &half, 1.0)
            .unwrap_err()
            .to_string()
            .contains("pi/4")
    );
}
