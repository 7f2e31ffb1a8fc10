//! Blends in place of corners: within the tolerance, and limits kept along them.

use proptest::prelude::*;
use toolpath::{Blend, FeedLimits, FeedProfile, Path, PathBlending, PathSegment};

use crate::feed::within_limits;

const SHAPES: [Blend; 3] = [Blend::Arc, Blend::Parabola, Blend::Quintic];

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// Distance of a point from a chain of lines, by brute force over them.
fn from_chain(p: [f64; 2], chain: &[[f64; 2]]) -> f64 {
    let from_line = |pair: &[[f64; 2]]| {
        let [a, b] = [pair[0], pair[1]];
        let along = [b[0] - a[0], b[1] - a[1]];
        let share = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1])
            / (along[0] * along[0] + along[1] * along[1]);
        let share = share.clamp(0.0, 1.0);
        distance(p, [a[0] + share * along[0], a[1] + share * along[1]])
    };
    chain
        .windows(2)
        .map(from_line)
        .fold(f64::INFINITY, f64::min)
}

/// Points along a segment, its middle among them.
fn along(segment: &PathSegment<2>) -> Vec<[f64; 2]> {
    let step = segment.length() / 400.0;
    (0..=400)
        .map(|k| segment.at(step * f64::from(k)).position)
        .collect()
}

/// A right angle with sides of 20 mm; lengths of arc and parabola in closed form.
#[test]
fn a_right_angle_is_blended_as_its_closed_form_says() {
    let corner = Path::polyline(&[[0.0, 0.0], [0.02, 0.0], [0.02, 0.02]]).unwrap();
    let tolerance = 1e-3;
    let of = |shape| corner.blended(&PathBlending { tolerance, shape }).unwrap();
    let r = tolerance / (2_f64.sqrt() - 1.0);
    let arc = of(Blend::Arc);
    let length = 0.04 - 2.0 * r + std::f64::consts::FRAC_PI_2 * r;
    assert!((arc.length() - length).abs() < 1e-12);
    let d = 2.0 * 2_f64.sqrt() * tolerance;
    let curve = d * (1.0 + (3.0 + 2.0 * 2_f64.sqrt()).ln() / (2.0 * 2_f64.sqrt()));
    let parabola = of(Blend::Parabola);
    assert!((parabola.length() - (0.04 - 2.0 * d + curve)).abs() < 1e-12);
    for path in [arc, parabola, of(Blend::Quintic)] {
        assert!(path.corners().is_empty() && path.segments().len() == 3);
        let middle = &path.segments()[1];
        let near = distance(middle.at(0.5 * middle.length()).position, [0.02, 0.0]);
        assert!((near - tolerance).abs() < 1e-12, "{near}");
    }
}

/// A path that turns back stays, as does one without a corner.
#[test]
fn what_is_no_corner_stays() {
    let blending = PathBlending {
        tolerance: 1e-3,
        shape: Blend::Quintic,
    };
    let back = Path::polyline(&[[0.0, 0.0], [0.02, 0.0], [0.01, 0.0]]).unwrap();
    assert_eq!(back.blended(&blending).unwrap(), back);
    let straight = Path::polyline(&[[0.0, 0.0], [0.02, 0.0], [0.04, 0.0]]).unwrap();
    assert_eq!(straight.blended(&blending).unwrap(), straight);
    let refused = back.blended(&PathBlending {
        tolerance: 0.0,
        ..blending
    });
    assert!(refused.unwrap_err().to_string().contains("tolerance"));
    let corner = Path::polyline(&[[0.0, 0.0], [0.02, 0.0], [0.02, 0.02]]).unwrap();
    let refused = corner.blended(&PathBlending {
        tolerance: -1.0,
        ..blending
    });
    assert!(refused.unwrap_err().to_string().contains("tolerance"));
}

/// Lines and arcs one after the other, each pair with a corner or, of the last two, a jump of curvature alone.
fn with_arcs() -> Path<2> {
    let line = |from, to| PathSegment::from(toolpath::Line::new(from, to).unwrap());
    let arc = |centre, start, towards, sweep| {
        PathSegment::from(toolpath::Arc::new(centre, start, towards, sweep).unwrap())
    };
    let half = std::f64::consts::PI;
    let across = 0.01 * 0.5_f64.sqrt();
    let top = 2.0 * across;
    let segments = vec![
        line([0.0, 0.0], [0.02, 0.0]),
        arc([0.02 - across, across], [0.02, 0.0], [1.0, 1.0], 0.5 * half),
        line([0.02, top], [0.04, top + 0.02]),
        arc([0.05, top + 0.02], [0.04, top + 0.02], [0.0, 1.0], half),
        arc(
            [0.06, top + 0.03],
            [0.06, top + 0.02],
            [1.0, 0.0],
            0.5 * half,
        ),
        line([0.07, top + 0.03], [0.07, top + 0.05]),
    ];
    Path::new(segments).unwrap()
}

/// Every blend passes its corner at the tolerance and stays within it of the path, its ends have the path's tangent and, of
/// degree 5, its curvature; nothing stops the feed any more.
#[test]
fn corners_at_arcs_are_blended_within_the_tolerance() {
    let path = with_arcs();
    let dense: Vec<[f64; 2]> = path.segments().iter().flat_map(along).collect();
    let corners: Vec<[f64; 2]> = path.segments()[1..]
        .iter()
        .map(|segment| segment.at(0.0).position)
        .collect();
    assert_eq!(path.corners().len(), 4);
    for shape in SHAPES {
        for tolerance in [1e-5, 1e-4] {
            let blended = path.blended(&PathBlending { tolerance, shape }).unwrap();
            let all = blended.segments();
            // The curvature alone jumps at the last one.
            let blends = if shape == Blend::Quintic { 5 } else { 4 };
            assert_eq!(all.len(), 6 + blends, "{shape:?}");
            assert!(blended.corners().is_empty());
            for corner in &corners[..4] {
                let near = all.iter().flat_map(along).map(|p| distance(p, *corner));
                let near = near.fold(f64::INFINITY, f64::min);
                assert!((near / tolerance - 1.0).abs() < 0.02, "{near} {tolerance}");
            }
            for segment in all {
                let far = along(segment).into_iter().map(|p| from_chain(p, &dense));
                let far = far.fold(0.0, f64::max);
                assert!(far < 1.02 * tolerance + 1e-7, "{far} {tolerance} {shape:?}");
            }
            for pair in all.windows(2) {
                let [a, b] = [pair[0].at(f64::INFINITY), pair[1].at(0.0)];
                assert!(distance(a.position, b.position) < 1e-12);
                assert!(distance(a.tangent, b.tangent) < 1e-9);
                if shape == Blend::Quintic {
                    assert!(distance(a.curvature, b.curvature) < 1e-3, "{a:?} {b:?}");
                }
            }
        }
    }
}

/// What blends at arcs save: no limit is passed, and the feed need not stop.
#[test]
fn a_blend_at_an_arc_is_faster_than_a_stop() {
    let path = with_arcs();
    let limits = FeedLimits::equal(0.05, 0.05, 1.0, 20.0);
    let time = |path: &Path<2>| {
        let profile = FeedProfile::plan(path, &limits).unwrap();
        within_limits(&profile, &limits, 4000);
        profile.duration()
    };
    let of = |tolerance| {
        let shape = Blend::Quintic;
        time(&path.blended(&PathBlending { tolerance, shape }).unwrap())
    };
    let (stops, [fine, coarse]) = (time(&path), [1e-4, 1e-3].map(of));
    println!("{stops} {fine} {coarse}");
    assert!(coarse < 0.9 * stops, "{stops} {fine} {coarse}");
}

fn chains(points: std::ops::Range<usize>) -> impl Strategy<Value = Vec<[f64; 2]>> {
    let steps = prop::collection::vec((2e-3..2e-2, -2.8_f64..2.8), points);
    steps.prop_map(|steps| {
        let (mut at, mut angle) = ([0.0, 0.0], 0.0_f64);
        let mut chain = vec![at];
        for (length, turn) in steps {
            angle += turn;
            at = [at[0] + length * angle.cos(), at[1] + length * angle.sin()];
            chain.push(at);
        }
        chain
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// No point of a blend is farther from the lines than the tolerance, the path passes each corner within it, ends stay, and no
    /// corner is left.
    #[test]
    fn a_blended_path_stays_within_its_tolerance(chain in chains(2..8), tolerance in 1e-6..3e-3, which in 0..3_usize) {
        let path = Path::polyline(&chain).unwrap();
        let blended = path.blended(&PathBlending { tolerance, shape: SHAPES[which] }).unwrap();
        let most = tolerance * (1.0 + 1e-9) + 1e-12;
        let mut near = vec![f64::INFINITY; chain.len()];
        for segment in blended.segments() {
            for p in along(segment) {
                prop_assert!(from_chain(p, &chain) <= most);
                for (near, corner) in near.iter_mut().zip(&chain) {
                    *near = near.min(distance(p, *corner));
                }
            }
        }
        prop_assert!(near.iter().all(|near| *near <= most), "{near:?}");
        prop_assert_eq!(blended.at(0.0).position, chain[0]);
        prop_assert!(distance(blended.at(f64::INFINITY).position, chain[chain.len() - 1]) < 1e-12);
        let sharp = chain.windows(3).filter(|w| {
            let turn = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]).atan2(b[0] - a[0]);
            let angle = (turn(w[1], w[2]) - turn(w[0], w[1])).rem_euclid(std::f64::consts::TAU);
            (angle - std::f64::consts::PI).abs() < 1e-3
        });
        prop_assert_eq!(blended.corners().len(), sharp.count());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None, ..ProptestConfig::default() })]

    /// Along blends of each shape no limit of an axis is passed by more than 1e-9; a step of acceleration that is allowed is within
    /// the limit of acceleration.
    #[test]
    fn limits_are_kept_along_blends(chain in chains(2..4), tolerance in 1e-5..1e-3) {
        let path = Path::polyline(&chain).unwrap();
        for shape in SHAPES {
            let blended = path.blended(&PathBlending { tolerance, shape }).unwrap();
            for step in [0.0, 0.8] {
                let limits = FeedLimits {
                    acceleration_step: [step; 2],
                    ..FeedLimits::equal(0.05, 0.05, 1.0, 20.0)
                };
                let profile = FeedProfile::plan(&blended, &limits).unwrap();
                within_limits(&profile, &limits, 4000);
            }
        }
    }
}

/// A blend is of use if the feed need not stop: with a step that is allowed an arc is faster than the exact stop, as is the quintic
/// without one.
#[test]
fn a_blend_is_faster_than_a_stop() {
    let corner = Path::polyline(&[[0.0, 0.0], [0.02, 0.0], [0.02, 0.02]]).unwrap();
    let time = |path: &Path<2>, step: f64| {
        let limits = FeedLimits {
            acceleration_step: [step; 2],
            ..FeedLimits::equal(0.05, 0.05, 1.0, 20.0)
        };
        FeedProfile::plan(path, &limits).unwrap().duration()
    };
    let of = |shape| {
        corner
            .blended(&PathBlending {
                tolerance: 1e-3,
                shape,
            })
            .unwrap()
    };
    let stop = time(&corner, 0.0);
    let times = [
        time(&of(Blend::Quintic), 0.0),
        time(&of(Blend::Arc), 0.8),
        time(&of(Blend::Parabola), 0.8),
    ];
    assert!(times.iter().all(|t| *t < stop), "{stop} {times:?}");
    // An arc at whose ends the feed must stop is slower.
    assert!(time(&of(Blend::Arc), 0.0) > stop);
}
