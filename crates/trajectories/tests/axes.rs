//! Several axes that start and end together. Durations beside ruckig's: `transfers_against_ruckig.py`, kind `together`.

use proptest::prelude::*;
use trajectories::{Axes, AxisTask, Motion, Setpoint, Transfer};

use crate::transfer_cases::{Case, cases, check_motion, limits, state};

fn task(case: &Case) -> AxisTask {
    AxisTask {
        start: case.start,
        target: case.target,
        limits: case.limits,
    }
}

#[test]
fn the_slowest_axis_sets_the_time() {
    let own = limits([-1.0, 1.0], [-5.0, 5.0], 100.0);
    let to = |x: f64| AxisTask {
        start: Setpoint::at_rest(0.0),
        target: Setpoint::at_rest(x),
        limits: own,
    };
    let axes = Axes::together(&[to(0.1), to(-2.0), to(0.0)]).unwrap();
    // d/V + V/A + A/J
    assert!((axes.duration() - (2.0 + 0.2 + 0.05)).abs() < 1e-14);
    let [x, y, z] = axes.at(axes.duration());
    assert_eq!([x.position, y.position, z.position], [0.1, -2.0, 0.0]);
    let [x, y, z] = axes.at(0.5 * axes.duration());
    assert!((x.position - 0.05).abs() < 1e-12 && (y.position + 1.0).abs() < 1e-12);
    assert!(z.position.abs() < 1e-12);

    // An axis that is refused is named.
    let mut wrong = [to(0.1), to(0.2), to(0.3)];
    wrong[2].target.velocity = 2.0;
    let refused = Axes::together(&wrong).unwrap_err();
    assert_eq!(refused.axis, 2);
    let words = "axis 2: target velocity is 2 m/s, but must be within the velocity limits";
    assert_eq!(refused.to_string(), words);
    assert_eq!(Axes::straight(&wrong).unwrap_err(), refused);
}

#[test]
fn a_line_is_kept_only_where_the_states_point_along_it() {
    let own = limits([-1.0, 1.0], [-5.0, 5.0], 100.0);
    let slow = limits([-0.1, 0.1], [-5.0, 5.0], 100.0);
    let tasks = |v: f64| {
        [
            AxisTask {
                start: state(0.0, 2.0 * v, 0.0),
                target: state(0.4, 0.0, 0.0),
                limits: own,
            },
            AxisTask {
                start: state(1.0, -v, 0.0),
                target: state(0.8, 0.0, 0.0),
                limits: slow,
            },
        ]
    };
    let line = Axes::straight(&tasks(0.05)).unwrap().unwrap();
    let alone = Axes::together(&tasks(0.05)).unwrap();
    assert!(line.duration() >= alone.duration());
    for i in 0..=100 {
        let [x, y] = line.at(line.duration() * f64::from(i) / 100.0);
        assert!((x.position + 2.0 * (y.position - 1.0)).abs() < 1e-14);
        assert!(y.velocity.abs() <= 0.1 && x.velocity.abs() <= 1.0);
    }
    let mut bent = tasks(0.05);
    bent[1].start.velocity = 0.05;
    assert!(Axes::straight(&bent).unwrap().is_none());
    let either = Axes::straight_or_together(&bent).unwrap();
    assert_eq!(either, Axes::together(&bent).unwrap());
    // Where nothing is to be done, nothing is.
    let still = [0.0, 1.0].map(|x| AxisTask {
        start: Setpoint::at_rest(x),
        target: Setpoint::at_rest(x),
        limits: own,
    });
    assert_eq!(Axes::straight(&still).unwrap().unwrap().duration(), 0.0);
}

proptest! {
    #[test]
    fn all_axes_end_together(three in [cases(), cases(), cases()]) {
        let axes = Axes::together(&three.each_ref().map(task)).unwrap();
        let end = axes.duration();
        for (axis, case) in axes.axes().iter().zip(&three) {
            prop_assert!((axis.duration() - end).abs() <= 1e-12 * end);
            check_motion(axis, case)?;
            let least = Transfer::plan(&case.start, &case.target, &case.limits).unwrap();
            prop_assert!(least.duration() <= end * (1.0 + 1e-12));
        }
        let last = axes.at(end).map(|s| (s.position, s.velocity, s.acceleration));
        let wanted = three.map(|c| (c.target.position, c.target.velocity, c.target.acceleration));
        prop_assert_eq!(last, wanted);
    }
}
