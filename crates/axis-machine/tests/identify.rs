//! Squareness and cross-talk from circles that a generator of this file makes.

use axis_machine::{CircleFitError, MeasuredCircle, fit_circles};
use toolpath::iso230_4::NominalCircle;
use toolpath::named::Direction;

const RADIUS: f64 = 0.05;

/// A generator of its own: positions in time, moved by the matrix of a skew machine and by Newton's acceleration from differences.
fn points(feed: f64, direction: Direction, [phi, k, lag, noise]: [f64; 4]) -> Vec<[f64; 2]> {
    let sign = if direction == Direction::Clockwise {
        -1.0
    } else {
        1.0
    };
    let at = |t: f64| {
        let angle = sign * feed / RADIUS * t;
        let late = sign * feed / RADIUS * (t - lag);
        [RADIUS * angle.cos() + 3e-6, RADIUS * late.sin() - 2e-6]
    };
    let turn = std::f64::consts::TAU * RADIUS / feed;
    let mut seed = 12_345_u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        noise * ((seed >> 33) as f64 / (1_u64 << 31) as f64 - 0.5) * 12_f64.sqrt()
    };
    let step = 1e-3;
    let of = |i: u32| {
        let t = turn * f64::from(i) / 3000.0;
        let [before, now, after] = [t - step, t, t + step].map(at);
        let a = (before[1] - 2.0 * now[1] + after[1]) / (step * step);
        [now[0] + phi * now[1] + k * a + random(), now[1] + random()]
    };
    (0..3000).map(of).collect()
}

fn found(
    cases: &[(f64, Direction)],
    phi: f64,
    k: f64,
    lag: f64,
    noise: f64,
) -> Result<axis_machine::CirclesFound, CircleFitError> {
    let all: Vec<Vec<[f64; 2]>> = cases
        .iter()
        .map(|&(feed, d)| points(feed, d, [phi, k, lag, noise]))
        .collect();
    let circles: Vec<_> = (cases.iter().zip(&all))
        .map(|(&(feed, direction), points)| MeasuredCircle {
            nominal: NominalCircle {
                centre: [0.0; 2],
                radius: RADIUS,
            },
            feed,
            direction,
            points,
        })
        .collect();
    fit_circles(&circles)
}

use Direction::{Clockwise, Counterclockwise};

#[test]
fn two_feeds_tell_squareness_from_crosstalk() {
    let (slow, fast) = (0.05, 10.0 / 60.0);
    let cases = [
        (slow, Clockwise),
        (slow, Counterclockwise),
        (fast, Clockwise),
        (fast, Counterclockwise),
    ];
    let all = found(&cases, 20e-6, 20e-6, 3e-6, 0.1e-6).unwrap();
    // Measured: 19.994 µm/m and 20.000 µm/(m/s²) under noise of 0.1 µm, standard errors 0.08 and 0.01.
    assert!((all.squareness.value - 20e-6).abs() < 0.25e-6, "{all:?}");
    assert!((all.crosstalk.value - 20e-6).abs() < 0.03e-6, "{all:?}");
    assert!((all.lag.unwrap().value - 3e-6).abs() < 0.1e-6, "{all:?}");
    assert!(
        (all.centre[0].value - 3e-6).abs() < 2e-8 && (all.centre[1].value + 2e-6).abs() < 2e-8,
        "{all:?}"
    );
    assert!(
        all.squareness.standard_error < 0.1e-6 && all.crosstalk.standard_error < 0.02e-6,
        "{all:?}"
    );
    assert!((all.residual - 0.1e-6).abs() < 0.02e-6, "{all:?}");
    // One direction does, if there is no lag.
    let one = found(
        &[(slow, Clockwise), (fast, Clockwise)],
        -30e-6,
        15e-6,
        0.0,
        0.0,
    )
    .unwrap();
    assert!(
        (one.squareness.value + 30e-6).abs() < 1e-8 && (one.crosstalk.value - 15e-6).abs() < 1e-8,
        "{one:?}"
    );
    assert_eq!(one.lag, None);
}

#[test]
fn one_feed_does_not() {
    let error = found(
        &[(0.05, Clockwise), (0.05, Counterclockwise)],
        20e-6,
        0.0,
        0.0,
        0.0,
    )
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "the circles determine 5 of 6 unknowns: at one feed squareness and cross-talk deform a circle alike; valid: circles of at least two feeds, or radii, so that feed/radius differs"
    );
    assert!(matches!(
        found(&[(0.05, Clockwise)], 0.0, 0.0, 0.0, 0.0),
        Err(CircleFitError::Rank {
            rank: 4,
            unknowns: 5,
            ..
        })
    ));
    assert_eq!(fit_circles(&[]), Err(CircleFitError::None));
}

#[test]
fn what_cannot_be_is_refused() {
    let good = points(0.05, Clockwise, [0.0; 4]);
    let circle = |feed, radius, points| MeasuredCircle {
        nominal: NominalCircle {
            centre: [0.0; 2],
            radius,
        },
        feed,
        direction: Clockwise,
        points,
    };
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        for circle in [circle(bad, RADIUS, &good), circle(0.05, bad, &good)] {
            let text = fit_circles(&[circle]).unwrap_err().to_string();
            assert!(
                text.contains("of circle 1") && text.contains("valid"),
                "{text}"
            );
        }
    }
    assert!(fit_circles(&[circle(0.05, RADIUS, &[[0.0; 2]; 3])]).is_err());
    assert!(fit_circles(&[circle(0.05, RADIUS, &[[f64::NAN; 2]; 9])]).is_err());
    // All in one place: none of the unknowns that depend on the angle can be determined.
    let same = [[RADIUS, 0.0]; 9];
    let error =
        fit_circles(&[circle(0.05, RADIUS, &same), circle(0.1, RADIUS, &same)]).unwrap_err();
    assert!(
        error.to_string().contains("too little of the circle"),
        "{error}"
    );
}
