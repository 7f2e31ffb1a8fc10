//! Feet on paths against a walk along the path that shares no step with the follower.

use proptest::prelude::*;
use toolpath::named::{CircleTest, butterfly};
use toolpath::{Arc, Follower, Path, nearest_point, tangent_estimate};

fn distance<const D: usize>(path: &Path<D>, s: f64, p: &[f64; D]) -> f64 {
    let x = path.at(s).position;
    x.iter()
        .zip(p)
        .map(|(x, y)| (x - y) * (x - y))
        .sum::<f64>()
        .sqrt()
}

/// The first minimum of the distance from `s`, walked to in steps of `step` and refined by the
/// golden section.
fn walk<const D: usize>(path: &Path<D>, s: f64, p: &[f64; D], step: f64) -> f64 {
    let d = |s: f64| distance(path, s.clamp(0.0, path.length()), p);
    let sign = if d(s + step * 1e-3) < d(s) { 1.0 } else { -1.0 };
    let mut here = s;
    while d(here + sign * step) < d(here) && here >= 0.0 && here <= path.length() {
        here += sign * step;
    }
    let (mut a, mut b) = (here - step, here + step);
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    while b - a > 1e-10 {
        let (c, e) = (b - golden * (b - a), a + golden * (b - a));
        if d(c) < d(e) { b = e } else { a = c }
    }
    (0.5 * (a + b)).clamp(0.0, path.length())
}

/// The position of an axis pair with a first-order lag and an offset that wanders by 0.15 mm, so
/// that it passes far inside the tips.
fn measured(path: &Path<2>, samples: usize) -> Vec<[f64; 2]> {
    let mut p = path.at(0.0).position;
    (0..samples)
        .map(|i| {
            let share = i as f64 / (samples - 1) as f64;
            let reference = path.at(share * path.length()).position;
            let wander = [1.5e-4 * (share * 90.0).sin(), 1.5e-4 * (share * 70.0).cos()];
            for k in 0..2 {
                p[k] += 0.05 * (reference[k] - p[k]);
            }
            [p[0] + wander[0], p[1] + wander[1]]
        })
        .collect()
}

#[test]
fn the_foot_is_that_of_a_walk_at_tips_of_20_um() {
    let path = butterfly().unwrap();
    let mut follower = Follower::new(&path, 0.0);
    let mut walked = 0.0;
    let mut other_branch = 0;
    for (i, p) in measured(&path, 3_000).into_iter().enumerate() {
        let foot = follower.follow(p);
        walked = walk(&path, walked, &p, 1e-6);
        let truth = distance(&path, walked, &p);
        assert!(
            (foot.length() - truth).abs() < 1e-9,
            "{} m: {} for {truth}",
            foot.s,
            foot.length()
        );
        assert!((foot.s - walked).abs() < 2e-6, "{} for {walked}", foot.s);
        assert!((foot.signed().abs() - truth).abs() < 1e-9);
        if i % 30 == 0 {
            other_branch += usize::from(nearest_point(&path, p, 3000).length() < truth - 1e-6);
        }
    }
    // The nearest point of all is another: what the follower is for.
    assert!(other_branch > 3, "{other_branch}");
}

/// A point at the radius r of a circle is r − R off, whatever its angle; positive to the left,
/// that is inside of a circle that runs counterclockwise.
#[test]
fn a_circle_has_a_closed_form() {
    let circle = CircleTest::new(0.05).path().unwrap();
    let mut follower = Follower::new(&circle.path, 0.0);
    for i in 0..=2000 {
        let phi = 4.0 * std::f64::consts::PI * f64::from(i) / 2000.0;
        let r = 0.05 + 1e-3 * (5.0 * phi).sin();
        let angle = std::f64::consts::PI + phi;
        let foot = follower.follow([r * angle.cos(), r * angle.sin()]);
        assert!((foot.signed() - (0.05 - r)).abs() < 1e-16, "{phi}");
        assert!((foot.s - 0.05 * phi).abs() < 1e-13, "{phi}");
    }
}

/// A lag of 1.07 mm on a circle of 50 mm, on the circle's chord: the error is 11.4 µm, the
/// tangent at the set point says twice as much or nothing.
#[test]
fn the_tangent_estimate_is_wrong_by_half_the_curvature() {
    let circle = CircleTest::new(0.05).path().unwrap();
    let (radius, lag) = (0.05f64, 0.05 / 46.7);
    let reference = circle.path.at(0.1);
    // First-order lag: on the circle of radius R cos δ behind by δ = atan(lag/R).
    let delta = (lag / radius).atan();
    let [x, y] = reference.position;
    let (sin, cos) = delta.sin_cos();
    let p = [cos * (cos * x + sin * y), cos * (cos * y - sin * x)];
    let truth = radius * (1.0 - cos);
    let foot = Follower::new(&circle.path, 0.1).follow(p);
    assert!((foot.signed() - truth).abs() < 1e-15);
    assert!((truth - 11.46e-6).abs() < 0.01e-6, "{truth}");
    let estimate = tangent_estimate(&reference, p);
    assert!((estimate - radius * sin * sin).abs() < 1e-15, "{estimate}");
    assert!((estimate / truth - 2.0).abs() < 1e-3, "{estimate}");
}

#[test]
fn the_nearest_point_is_on_another_branch() {
    // A hairpin: two lines 0.2 mm apart joined by a half circle; the position lies 0.15 mm off
    // the first, 0.05 mm off the second.
    let half = Arc::new([0.01, 1e-4], [0.01, 0.0], [1.0, 0.0], std::f64::consts::PI).unwrap();
    let there = toolpath::Line::new([0.0, 0.0], [0.01, 0.0]).unwrap();
    let back = toolpath::Line::new([0.01, 2e-4], [0.0, 2e-4]).unwrap();
    let path = Path::new(vec![there.into(), half.into(), back.into()]).unwrap();
    let p = [0.004, 1.5e-4];
    let foot = Follower::new(&path, 0.0).follow(p);
    assert!((foot.s - 0.004).abs() < 1e-15 && (foot.signed() - 1.5e-4).abs() < 1e-18);
    assert!((nearest_point(&path, p, 1000).length() - 0.5e-4).abs() < 1e-15);
}

#[test]
fn corners_hold_the_foot() {
    let path = Path::polyline(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]).unwrap();
    let mut follower = Follower::new(&path, 0.5);
    // Outside of the corner: the corner is nearest.
    let foot = follower.follow([1.3, -0.4]);
    assert!((foot.s - 1.0).abs() < 1e-12 && (foot.length() - 0.5).abs() < 1e-12);
    // On and back again.
    assert!((follower.follow([1.2, 0.6]).s - 1.6).abs() < 1e-12);
    assert!((follower.follow([0.4, -0.1]).s - 0.4).abs() < 1e-12);
    // Beyond the ends.
    assert_eq!(follower.follow([-5.0, 1.0]).s, 0.0);
    assert_eq!(
        follower.follow([-1.0, 9.0]).s,
        0.0,
        "the distance rises first"
    );
    let mut late = Follower::new(&path, 1.5);
    assert_eq!(late.follow([1.0, 9.0]).s, 2.0);
    assert!(late.follow([f64::NAN, 0.0]).length().is_nan());
    assert_eq!(late.s(), 2.0);
}

#[test]
fn three_dimensions_have_two_components() {
    let circle = CircleTest::new(0.05).path_tilted(0.0).unwrap();
    let mut follower = Follower::new(&circle.path, 0.0);
    let foot = follower.follow([-0.05 - 3e-6, 0.0, 4e-6]);
    assert!((foot.length() - 5e-6).abs() < 1e-17);
    // Up is +Z; tangent (−Y) × up is −X, outward here.
    let [up, out] = foot.components([0.0, 0.0, 2.0]).unwrap();
    assert!(
        (up - 4e-6).abs() < 1e-17 && (out - 3e-6).abs() < 1e-16,
        "{up} {out}"
    );
    assert_eq!(foot.components([0.0, 1.0, 0.0]), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// From anywhere to anywhere: the first minimum downhill.
    #[test]
    fn any_start_any_position(s in 0.0..0.38f64, x in 0.0..0.11f64, y in 0.0..0.07f64) {
        let path = butterfly().unwrap();
        let foot = Follower::new(&path, s).follow([x, y]);
        let walked = walk(&path, s, &[x, y], 1e-6);
        let truth = distance(&path, walked, &[x, y]);
        prop_assert!((foot.length() - truth).abs() < 1e-9, "{} {} for {} {}", foot.s, foot.length(), walked, truth);
    }

    #[test]
    fn any_number_is_followed(p in [any::<f64>(), any::<f64>()], s in any::<f64>()) {
        let path = CircleTest::new(0.05).path().unwrap().path;
        Follower::new(&path, s).follow(p);
        nearest_point(&path, p, 10);
    }
}
