//! Paths against closed forms and against differences of their own lower derivatives.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::prelude::*;
use toolpath::named::{CircleTest, Direction, butterfly, rounded_rectangle};
use toolpath::{
    Arc, Blend, JunctionKind, Line, Nurbs, NurbsData, Path, PathPoint, PathSegment, ToolpathError,
};

fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(x, y)| (x - y) * (x - y))
        .sum::<f64>()
        .sqrt()
}

/// x′, x″ and x‴ against central differences of x, x′ and x″ over ± h.
fn differences_agree<const D: usize>(at: impl Fn(f64) -> PathPoint<D>, s: f64, h: f64, part: f64) {
    let (low, here, high) = (at(s - h), at(s), at(s + h));
    let pairs = [
        (low.position, high.position, here.tangent),
        (low.tangent, high.tangent, here.curvature),
        (low.curvature, high.curvature, here.third),
    ];
    let kappa = here.curvature_size();
    for (order, (a, b, value)) in pairs.into_iter().enumerate() {
        let slope: [f64; D] = std::array::from_fn(|i| (b[i] - a[i]) / (2.0 * h));
        let size = distance(&value, &[0.0; D]).max(kappa.powi(order as i32));
        assert!(
            distance(&slope, &value) <= part * size,
            "order {} at {s}: {slope:?} for {value:?}",
            order + 1
        );
    }
}

// By tests/independent_geometry.py.
const BUTTERFLY_LENGTH: f64 = 0.3828603111073453;
const BUTTERFLY_RADIUS: f64 = 2.3120695865923483e-05;

/// A quarter of the unit circle as a rational quadratic (Piegl and Tiller, section 7.3).
fn quarter() -> Nurbs<2> {
    Nurbs::new(&NurbsData {
        degree: 2,
        points: vec![[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        weights: vec![1.0, 0.5f64.sqrt(), 1.0],
        knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
    })
    .unwrap()
}

#[test]
fn a_rational_quadratic_is_a_circle() {
    let curve = quarter();
    assert!((curve.length() - FRAC_PI_2).abs() < 1e-15);
    let arc = Arc::new([0.0; 2], [1.0, 0.0], [0.0, 1.0], FRAC_PI_2).unwrap();
    for i in 0..=100 {
        let s = FRAC_PI_2 * f64::from(i) / 100.0;
        let (a, b) = (curve.at(s), arc.at(s));
        let (sin, cos) = s.sin_cos();
        assert!(distance(&a.position, &[cos, sin]) < 3e-15, "{s}");
        assert!(distance(&b.position, &[cos, sin]) < 3e-16, "{s}");
        assert!(distance(&a.tangent, &[-sin, cos]) < 4e-15, "{s}");
        assert!(distance(&a.curvature, &[-cos, -sin]) < 3e-14, "{s}");
        assert!(distance(&a.third, &[sin, -cos]) < 3e-13, "{s}");
        assert!(distance(&b.third, &[sin, -cos]) < 1e-15, "{s}");
    }
}

/// y = x² from 0 to 1: length √5/2 + asinh(2)/4; raised to degree 5 by hand it is the same.
#[test]
fn length_of_a_parabola() {
    let exact = 0.5 * 5f64.sqrt() + 0.25 * 2f64.asinh();
    let b2 = vec![[0.0, 0.0], [0.5, 0.0], [1.0, 1.0]];
    let b5 = (0..6)
        .map(|i| [f64::from(i) / 5.0, f64::from(i * (i - 1)) / 20.0])
        .collect();
    for points in [b2, b5] {
        let segment = PathSegment::bezier(points).unwrap();
        assert!(
            (segment.length() - exact).abs() < 2e-15,
            "{}",
            segment.length() - exact
        );
        // At x = 1/2: s = √2/4 + asinh(1)/4, κ = 2/(1 + 4x²)^1.5.
        let s = 2f64.sqrt() / 4.0 + 0.25 * 1f64.asinh();
        let point = segment.at(s);
        assert!(distance(&point.position, &[0.5, 0.25]) < 1e-15);
        assert!((point.curvature_size() - 2.0 / 8f64.sqrt()).abs() < 3e-15);
    }
}

#[test]
fn derivatives_of_the_butterfly() {
    let path = butterfly().unwrap();
    // Length and least radius by an independent program: tests/independent_geometry.py.
    assert!(
        (path.length() - BUTTERFLY_LENGTH).abs() < 1e-12,
        "{:?}",
        path.length()
    );
    let least = (0..400_000).map(|i| path.at(f64::from(i) * path.length() / 4e5));
    let least = least
        .map(|p| 1.0 / p.curvature_size())
        .fold(f64::INFINITY, f64::min);
    assert!((least / BUTTERFLY_RADIUS - 1.0).abs() < 1e-3, "{least:?}");
    for i in 0..1000 {
        let s = path.length() * (f64::from(i) + 0.37) / 1000.0;
        // Away from knots, where x‴ jumps.
        if path.junctions().iter().all(|j| (j.s - s).abs() > 1e-6) {
            differences_agree(|s| path.at(s), s, 2e-8, 2e-4);
        }
    }
    assert!(
        path.junctions()
            .iter()
            .all(|j| j.kind == JunctionKind::Third)
    );
    assert_eq!(path.junctions().len(), 47);
    assert!(distance(&path.at(0.0).position, &path.at(1.0).position) < 1e-16);
}

#[test]
fn a_tilted_helix_has_its_curvature() {
    let circle = CircleTest {
        start: 0.4,
        ..CircleTest::new(0.03)
    };
    let tilted = circle.path_tilted(0.6).unwrap();
    assert!((tilted.path.length() - 0.06 * TAU).abs() < 1e-15);
    assert!((tilted.counted.1 - tilted.counted.0 - 0.03 * TAU).abs() < 1e-15);
    let first = tilted.path.at(tilted.counted.0).position;
    let expected = [
        0.03 * 0.4f64.cos(),
        0.03 * 0.4f64.sin() * 0.6f64.cos(),
        0.03 * 0.4f64.sin() * 0.6f64.sin(),
    ];
    assert!(distance(&first, &expected) < 1e-16);
    // Curvature r/(r² + p²) and torsion p/(r² + p²) of a helix that rises p per rad.
    let arc = Arc::new([0.0; 3], [0.02, 0.0, 0.0], [0.0, 1.0, 0.0], TAU).unwrap();
    let helix = arc.helix([0.0, 0.0, 0.01 * TAU]).unwrap();
    let point = helix.at(0.05);
    assert!((point.curvature_size() - 0.02 / 5e-4).abs() < 1e-12);
    differences_agree(|s| helix.at(s), 0.05, 1e-5, 1e-6);
    assert!(distance(&helix.at(helix.length()).position, &[0.02, 0.0, 0.01 * TAU]) < 1e-16);
    assert!(arc.helix([0.01, 0.0, 0.0]).is_err());
}

#[test]
fn circles_run_both_ways() {
    for direction in [Direction::Clockwise, Direction::Counterclockwise] {
        let test = CircleTest {
            direction,
            centre: [0.1, -0.2],
            ..CircleTest::new(0.05)
        };
        let circle = test.path().unwrap();
        let first = circle.path.at(circle.counted.0);
        assert!(distance(&first.position, &[0.15, -0.2]) < 1e-15);
        let up = if direction == Direction::Clockwise {
            -1.0
        } else {
            1.0
        };
        assert!((first.tangent[1] - up).abs() < 1e-15);
    }
}

/// Distance of the blend from the corner: the tolerance, by a search along the blend.
#[test]
fn blends_keep_their_tolerance() {
    for shape in [Blend::Arc, Blend::Quintic] {
        for turn in [0.01f64, 0.8, FRAC_PI_2, 2.5, 3.1] {
            let before = Line::new([-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]).unwrap();
            let end = [turn.cos(), turn.sin() * 0.8, turn.sin() * 0.6];
            let after = Line::new([0.0, 0.0, 0.0], end).unwrap();
            let (a, curve, b) = shape.between(&before, &after, 1e-4).unwrap();
            let length = curve.length();
            let nearest = (0..=20_000)
                .map(|i| distance(&curve.at(length * f64::from(i) / 2e4).position, &[0.0; 3]))
                .fold(f64::INFINITY, f64::min);
            assert!(
                (nearest - 1e-4).abs() < 1e-10,
                "{shape:?} {turn}: {nearest}"
            );
            let path = Path::new(vec![a.unwrap().into(), curve, b.unwrap().into()]).unwrap();
            assert!(path.corners().is_empty(), "{shape:?} {turn}");
            let breaks = path
                .junctions()
                .iter()
                .filter(|j| j.kind == JunctionKind::Curvature);
            let expected = if shape == Blend::Arc { 2 } else { 0 };
            assert_eq!(breaks.count(), expected, "{shape:?} {turn}");
        }
        // No more than half of a line, and no blend of a reversal.
        let before = Line::new([-1.0, 0.0], [0.0, 0.0]).unwrap();
        let after = Line::new([0.0, 0.0], [0.0, 1e-3]).unwrap();
        let (_, _, b) = shape.between(&before, &after, 1.0).unwrap();
        assert!((b.unwrap().length() - 0.5e-3).abs() < 1e-12);
        let back = Line::new([0.0, 0.0], [-1.0, 0.0]).unwrap();
        assert!(matches!(
            shape.between(&before, &back, 1e-4),
            Err(ToolpathError::Blend { .. })
        ));
    }
}

#[test]
fn a_rounded_rectangle_is_closed() {
    let path = rounded_rectangle([0.2, 0.1], 0.01, Blend::Arc).unwrap();
    let exact = 2.0 * (0.18 + 0.08) + 0.01 * TAU;
    assert!((path.length() - exact).abs() < 1e-14);
    assert!(path.corners().is_empty());
    let smooth = rounded_rectangle([0.2, 0.1], 0.01, Blend::Quintic).unwrap();
    assert!(
        smooth
            .junctions()
            .iter()
            .all(|j| j.kind == JunctionKind::Third)
    );
    assert!(rounded_rectangle([0.2, 0.1], 0.05, Blend::Arc).is_err());
}

#[test]
fn corners_and_repeated_knots_are_found() {
    let square = Path::polyline(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0]]).unwrap();
    assert_eq!(square.corners(), vec![1.0, 2.0]);
    assert!((square.junctions()[0].angle() - FRAC_PI_2).abs() < 1e-15);
    let straight = Path::polyline(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]).unwrap();
    assert_eq!(straight.junctions()[0].kind, JunctionKind::Third);
    // A cubic with a knot three times has a corner, with one twice a jump of curvature.
    let curve = |knots: &[f64]| {
        let points = (0..knots.len() - 4).map(|i| [i as f64, [0.0, 1.0, 3.0, 2.0][i % 4]]);
        let points = points.collect();
        let data = NurbsData {
            degree: 3,
            points,
            weights: vec![],
            knots: knots.to_vec(),
        };
        Path::new(vec![Nurbs::new(&data).unwrap().into()]).unwrap()
    };
    let kinds = |knots: &[f64]| {
        curve(knots)
            .junctions()
            .iter()
            .map(|j| j.kind)
            .collect::<Vec<_>>()
    };
    let (a, b) = ([0.0; 4], [1.0; 4]);
    assert_eq!(
        kinds(&[&a[..], &[0.5; 3], &b].concat()),
        vec![JunctionKind::Corner]
    );
    assert_eq!(
        kinds(&[&a[..], &[0.5; 2], &b].concat()),
        vec![JunctionKind::Curvature]
    );
    assert_eq!(
        kinds(&[&a[..], &[0.5; 1], &b].concat()),
        vec![JunctionKind::Third]
    );
}

#[test]
fn what_is_wrong_is_said() {
    let line = |a, b| PathSegment::from(Line::<2>::new(a, b).unwrap());
    let gap = Path::new(vec![
        line([0.0, 0.0], [1.0, 0.0]),
        line([1.0, 1e-6], [2.0, 0.0]),
    ]);
    let text = gap.unwrap_err().to_string();
    assert!(
        text.contains("segment 2") && text.contains("at most 0.000000001 m"),
        "{text}"
    );
    assert!(
        Path::<2>::new(vec![])
            .unwrap_err()
            .to_string()
            .contains("at least one")
    );
    assert!(Line::new([0.0], [0.0]).is_err());
    assert!(Line::new([f64::NAN, 0.0], [0.0, 1.0]).is_err());
    assert!(Arc::new([0.0; 2], [1.0, 0.0], [1.0, 0.0], PI).is_err());
    // Two control points in one place: no tangent at the begin.
    let cusp = PathSegment::bezier(vec![[0.0, 0.0], [0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]);
    assert!(
        matches!(cusp, Err(ToolpathError::Cusp { u: 0.0 })),
        "{cusp:?}"
    );
    // A semicubical cusp inside, x = τ², y = τ³ with τ = t − ½, and with τ = t − 0.3.
    let inside = |c: f64| {
        let x = [
            c * c,
            c * c - 2.0 / 3.0 * c,
            c * c - 4.0 / 3.0 * c + 1.0 / 3.0,
            (1.0 - c) * (1.0 - c),
        ];
        let y = [
            -c * c * c,
            -c * c * c + c * c,
            -c * c * c + 2.0 * c * c - c,
            (1.0 - c).powi(3),
        ];
        PathSegment::bezier((0..4).map(|i| [x[i], y[i]]).collect())
    };
    for c in [0.5, 0.3] {
        let refused = inside(c).unwrap_err();
        let ToolpathError::Cusp { u } = refused else {
            panic!("{refused}")
        };
        assert!((u - c).abs() < 1e-8, "{u} for {c}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any numbers: a curve or an error, never a panic; and s → u → s is the identity.
    #[test]
    fn any_nurbs_is_a_curve_or_refused(
        points in prop::collection::vec([-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64], 1..12),
        degree in 0..6usize,
        steps in prop::collection::vec(prop_oneof![Just(0.0), 0.1..1.0f64, Just(f64::NAN)], 0..20),
        share in 0.0..1.0f64,
    ) {
        let n = points.len();
        let mut knots = vec![0.0; degree + 1];
        for i in 0..n.saturating_sub(degree + 1) {
            let step = steps.get(i).copied().unwrap_or(0.3);
            knots.push(knots[knots.len() - 1] + step);
        }
        let last = knots[knots.len() - 1] + 1.0;
        knots.extend(vec![last; degree + 1]);
        let weights = (0..n).map(|i| 1.0 + (i % 3) as f64).collect();
        if let Ok(curve) = Nurbs::new(&NurbsData { degree, points, weights, knots }) {
            let s = share * curve.length();
            let back = curve.length_at(curve.parameter(s));
            prop_assert!((back - s).abs() <= 1e-12 * curve.length(), "{back} for {s}");
            let point = curve.at(s);
            prop_assert!((distance(&point.tangent, &[0.0; 3]) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn any_number_is_taken(values in prop::collection::vec(any::<f64>(), 8)) {
        let v = |i: usize| [values[i], values[i + 1]];
        let line = Line::new(v(0), v(2));
        let arc = Arc::new(v(0), v(2), v(4), values[6]);
        let segments = line.map(PathSegment::from).into_iter().chain(arc.map(PathSegment::from));
        if let Ok(path) = Path::new(segments.collect()) {
            path.at(values[7]);
        }
        let test = CircleTest { centre: v(0), start: values[2], run_in: values[3], ..CircleTest::new(values[4]) };
        let _ = test.path();
        let _ = rounded_rectangle(v(0), values[2], Blend::Quintic);
    }
}
