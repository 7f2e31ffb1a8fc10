//! Feeds within the limits of axes, on what comes out.

use std::f64::consts::{FRAC_PI_2, TAU};

use proptest::prelude::*;
use toolpath::named::{CircleTest, butterfly, rounded_rectangle};
use toolpath::{Blend, FeedLimits, FeedProfile, Nurbs, NurbsData, Path, PathSegment};

/// Greatest velocity, acceleration and jerk of an axis, over their limits, at `n` times that are
/// no multiple of anything.
fn extremes<const D: usize>(profile: &FeedProfile<D>, limits: &FeedLimits<D>, n: u32) -> [f64; 3] {
    let mut most = [0.0f64; 3];
    for i in 0..n {
        let share = (f64::from(i) * 0.618_033_988_749_894_9).fract();
        let axes = profile.axes(share * profile.duration());
        for k in 0..D {
            most[0] = most[0].max(axes.velocity[k].abs() / limits.velocity[k]);
            most[1] = most[1].max(axes.acceleration[k].abs() / limits.acceleration[k]);
            most[2] = most[2].max(axes.jerk[k].abs() / limits.jerk[k]);
        }
        assert!(profile.at(share * profile.duration()).feed <= limits.feed * (1.0 + 1e-9));
    }
    most
}

pub fn within_limits<const D: usize>(profile: &FeedProfile<D>, limits: &FeedLimits<D>, n: u32) {
    let most = extremes(profile, limits, n);
    assert!(most.iter().all(|m| *m <= 1.0 + 1e-9), "{most:?}");
}

/// A curve that is a straight line, of degree 1, so that it is planned as a curve.
fn line_as_curve(to: [f64; 2]) -> Path<2> {
    Path::new(vec![PathSegment::bezier(vec![[0.0, 0.0], to]).unwrap()]).unwrap()
}

#[test]
fn the_butterfly_keeps_every_limit() {
    let path = butterfly().unwrap();
    let limits = FeedLimits::equal(0.05, 1.0, 1.0, 20.0);
    let profile = FeedProfile::plan(&path, &limits).unwrap();
    within_limits(&profile, &limits, 100_000);
    // Not less than the length at the feed; tips cost less than 10 % of that.
    let least = path.length() / 0.05;
    assert!(
        profile.duration() > least && profile.duration() < 1.1 * least,
        "{}",
        profile.duration()
    );
    assert_eq!(profile.stops().len(), 2);
}

/// d/V + V/A + A/J with the limits of the axis that has the least room, in closed form.
#[test]
fn a_line_takes_its_least_time() {
    let limits = FeedLimits {
        feed: 0.05,
        velocity: [0.04, 0.03],
        acceleration: [1.0, 0.4],
        jerk: [20.0, 20.0],
        acceleration_step: [0.0; 2],
    };
    // Along (0.6, 0.8): V = min(0.05, 0.04/0.6, 0.03/0.8), A = 0.4/0.8, J = 20/0.8.
    let exact = 0.3 / 0.0375 + 0.0375 / 0.5 + 0.5 / 25.0;
    let path = Path::polyline(&[[0.0, 0.0], [0.18, 0.24]]).unwrap();
    let profile = FeedProfile::plan(&path, &limits).unwrap();
    assert!((profile.duration() - exact).abs() < 1e-12);
    within_limits(&profile, &limits, 10_000);
    // The planner of curves knows no line, and comes close from above.
    let curve = line_as_curve([0.18, 0.24]);
    let planned = FeedProfile::plan(&curve, &limits).unwrap();
    within_limits(&planned, &limits, 40_000);
    let ratio = planned.duration() / exact;
    assert!(ratio > 1.0 && ratio < 1.003, "{ratio}");
    // Short: four phases of full jerk, (32 d/J)^(1/3).
    let curve = line_as_curve([3e-4, 4e-4]);
    let planned = FeedProfile::plan(&curve, &limits).unwrap();
    within_limits(&planned, &limits, 40_000);
    let ratio = planned.duration() / (32.0 * 5e-4 / 25.0f64).cbrt();
    assert!(ratio > 1.0 && ratio < 1.02, "{ratio}");
}

/// A turn as an arc, by an S-curve in closed form, and as four rational quadratics, by the planner.
#[test]
fn a_circle_both_ways() {
    let limits = FeedLimits::equal(0.1, 1.0, 1.0, 20.0);
    let test = CircleTest {
        run_in: 0.0,
        run_out: 0.0,
        ..CircleTest::new(0.02)
    };
    let path = test.path().unwrap().path;
    let arc = FeedProfile::plan(&path, &limits).unwrap();
    within_limits(&arc, &limits, 40_000);
    let quarter = |a: [f64; 2], b: [f64; 2]| {
        let corner = [a[0] + b[0], a[1] + b[1]];
        let weights = vec![1.0, 0.5f64.sqrt(), 1.0];
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let points = [a, corner, b].iter().map(|p| p.map(|x| 0.02 * x)).collect();
        PathSegment::from(
            Nurbs::new(&NurbsData {
                degree: 2,
                points,
                weights,
                knots,
            })
            .unwrap(),
        )
    };
    let ring = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0]];
    let quarters = ring.windows(2).map(|r| quarter(r[0], r[1])).collect();
    let path = Path::new(quarters).unwrap();
    assert!((path.length() - 0.02 * TAU).abs() < 1e-15);
    let curve = FeedProfile::plan(&path, &limits).unwrap();
    assert_eq!(curve.stops().len(), 2);
    within_limits(&curve, &limits, 40_000);
    let ratio = curve.duration() / arc.duration();
    assert!((0.95..1.003).contains(&ratio), "{ratio}");
    let circle = CircleTest::new(0.05).path_tilted(0.6).unwrap();
    let limits = FeedLimits {
        feed: 0.05,
        velocity: [1.0; 3],
        acceleration: [1.0, 0.5, 2.0],
        jerk: [20.0, 30.0, 10.0],
        acceleration_step: [0.0; 3],
    };
    let profile = FeedProfile::plan(&circle.path, &limits).unwrap();
    within_limits(&profile, &limits, 40_000);
    // The counted turn is at the feed.
    let middle = profile.at(0.5 * profile.duration());
    assert!((middle.feed - 0.05).abs() < 1e-12);
}

#[test]
fn stops_at_corners_and_jumps_of_curvature() {
    let square = Path::polyline(&[[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]]).unwrap();
    let limits = FeedLimits::equal(0.1, 1.0, 1.0, 20.0);
    let profile = FeedProfile::plan(&square, &limits).unwrap();
    assert_eq!(profile.stops().len(), 4);
    for (i, &t) in profile.stops().iter().enumerate() {
        let point = profile.at(t);
        assert!(
            point.feed.abs() < 1e-12 && (point.s - 0.1 * i as f64).abs() < 1e-12,
            "{point:?}"
        );
    }
    let one = 0.1 / 0.1 + 0.1 / 1.0 + 1.0 / 20.0;
    assert!((profile.duration() - 3.0 * one).abs() < 1e-12);
    // Arcs: ten stops; with a step of 0.5 m/s² none, and the step is no greater than that.
    let arcs = rounded_rectangle([0.2, 0.1], 0.01, Blend::Arc).unwrap();
    let stopping = FeedProfile::plan(&arcs, &limits).unwrap();
    assert_eq!(stopping.stops().len(), 10);
    let limits = FeedLimits {
        acceleration_step: [0.5; 2],
        ..limits
    };
    let running = FeedProfile::plan(&arcs, &limits).unwrap();
    assert_eq!(running.stops().len(), 2);
    within_limits(&running, &limits, 40_000);
    // v²/R = 0.5 at most at the begin of the first arc, by bisection for its time.
    let s = arcs.junctions()[0].s;
    let (mut a, mut b) = (0.0, running.duration());
    for _ in 0..60 {
        let t = 0.5 * (a + b);
        if running.at(t).s > s { b = t } else { a = t }
    }
    let v = running.at(a).feed;
    assert!(v * v / 0.01 <= 0.5 * (1.0 + 1e-9), "{v}");
    assert!(running.duration() < stopping.duration());
    let smooth = rounded_rectangle([0.2, 0.1], 0.01, Blend::Quintic).unwrap();
    let profile = FeedProfile::plan(&smooth, &limits).unwrap();
    within_limits(&profile, &limits, 40_000);
    assert!(profile.duration() < stopping.duration());
}

/// All outputs are derivatives of one another, by differences.
#[test]
fn what_comes_out_is_one_motion() {
    let path = rounded_rectangle([0.05, 0.03], 0.005, Blend::Quintic).unwrap();
    let limits = FeedLimits::equal(0.1, 0.06, 0.7, 15.0);
    let profile = FeedProfile::plan(&path, &limits).unwrap();
    assert_eq!(profile, FeedProfile::plan(&path, &limits).unwrap());
    let h = 1e-6;
    let mut before = 0.0;
    for i in 1..2000 {
        let t = profile.duration() * f64::from(i) / 2000.0;
        let (low, here, high) = (profile.axes(t - h), profile.axes(t), profile.axes(t + h));
        for k in 0..2 {
            let slope = |f: [f64; 2]| (f[1] - f[0]) / (2.0 * h);
            let v = slope([low.position[k], high.position[k]]);
            let a = slope([low.velocity[k], high.velocity[k]]);
            let j = slope([low.acceleration[k], high.acceleration[k]]);
            assert!((v - here.velocity[k]).abs() < 1e-9, "{t}: {v} {here:?}");
            assert!(
                (a - here.acceleration[k]).abs() < 1e-6 * 15.0,
                "{t}: {a} {here:?}"
            );
            // Jerk jumps at knots of the spline: there the mean of both sides is seen.
            let sides = [low.jerk[k], here.jerk[k], high.jerk[k]];
            let (min, max) = (
                sides.iter().copied().fold(f64::MAX, f64::min),
                sides.iter().copied().fold(f64::MIN, f64::max),
            );
            assert!(j > min - 0.02 && j < max + 0.02, "{t}: {j} {sides:?}");
        }
        let s = profile.at(t).s;
        assert!(s > before);
        before = s;
    }
    assert_eq!(profile.at(-1.0).s, 0.0);
    assert_eq!(profile.at(1e9).s, path.length());
    assert_eq!(profile.at(f64::NAN).s, 0.0);
}

/// Time scaled by λ: velocities, accelerations and jerks by 1/λ, 1/λ², 1/λ³.
#[test]
fn limits_scaled_in_time_scale_the_time() {
    let path = rounded_rectangle([0.05, 0.03], 0.005, Blend::Quintic).unwrap();
    let one = FeedLimits::equal(0.1, 0.06, 0.7, 15.0);
    let two = FeedLimits::equal(0.2, 0.12, 2.8, 120.0);
    let (one, two) = (
        FeedProfile::plan(&path, &one).unwrap(),
        FeedProfile::plan(&path, &two).unwrap(),
    );
    assert!((one.duration() / two.duration() - 2.0).abs() < 1e-3);
}

#[test]
fn what_is_wrong_is_said() {
    let path = Path::polyline(&[[0.0, 0.0], [1.0, 0.0]]).unwrap();
    let limits = FeedLimits {
        jerk: [20.0, -1.0],
        ..FeedLimits::equal(0.05, 1.0, 1.0, 20.0)
    };
    let text = FeedProfile::plan(&path, &limits).unwrap_err().to_string();
    assert_eq!(text, "jerk is -1 m/s³, but must be from 1e-9 to 1e9");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3))]

    /// Random curves, random limits per axis.
    #[test]
    fn any_curve_keeps_its_limits(
        points in prop::collection::vec([-0.05..0.05f64, -0.05..0.05f64, -0.05..0.05f64], 5..9),
        acceleration in [0.2..5.0f64, 0.2..5.0f64, 0.2..5.0f64],
        jerk in [5.0..200.0f64, 5.0..200.0f64, 5.0..200.0f64],
        feed in 0.01..0.3f64,
    ) {
        let n = points.len();
        let mut knots = vec![0.0; 4];
        knots.extend((1..n - 3).map(|i| i as f64));
        knots.extend(vec![(n - 3) as f64; 4]);
        let data = NurbsData { degree: 3, points, weights: vec![], knots };
        let path = Path::new(vec![Nurbs::new(&data).unwrap().into()]).unwrap();
        let limits = FeedLimits { feed, velocity: [0.2; 3], acceleration, jerk, acceleration_step: [0.0; 3] };
        let profile = FeedProfile::plan(&path, &limits).unwrap();
        let most = extremes(&profile, &limits, 20_000);
        prop_assert!(most.iter().all(|m| *m <= 1.0 + 1e-9), "{most:?}");
        // Something is at its limit.
        let feed = (0..1000).map(|i| profile.at(profile.duration() * f64::from(i) / 1e3).feed / limits.feed);
        let most = most.into_iter().chain(feed).fold(0.0, f64::max);
        prop_assert!(most > 0.99, "{most}");
    }

    /// Limits of any size: a motion or an error.
    #[test]
    fn any_limits_are_taken(sizes in prop::collection::vec(-9..9i32, 4)) {
        let value = |i: usize| 10f64.powi(sizes[i]);
        let path = Path::new(vec![PathSegment::bezier(vec![[0.0, 0.0], [0.01, 0.0], [0.01, 0.01]]).unwrap()]).unwrap();
        let limits = FeedLimits::equal(value(0), value(1), value(2), value(3));
        if let Ok(profile) = FeedProfile::plan(&path, &limits) {
            let most = extremes(&profile, &limits, 2_000);
            prop_assert!(most.iter().all(|m| *m <= 1.0 + 1e-9), "{limits:?} {most:?}");
        }
        let arc = CircleTest { run_in: FRAC_PI_2, ..CircleTest::new(0.05) }.path().unwrap().path;
        if let Ok(profile) = FeedProfile::plan(&arc, &limits) {
            let most = extremes(&profile, &limits, 2_000);
            prop_assert!(most.iter().all(|m| *m <= 1.0 + 1e-9), "{limits:?} {most:?}");
        }
    }
}
