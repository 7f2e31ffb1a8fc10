//! Transfers from any state to any other. Right durations are those of ruckig 0.19.4, in `golden/transfers.txt`, which
//! `transfers_against_ruckig.py golden` writes; the states are each checked as the other's integral.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use trajectories::{
    Follow, Limits, Motion, Setpoint, TrajectoryError, Transfer, TransferLimits, VelocityChange,
    VelocityLimits,
};

use crate::transfer_cases::{Case, cases, check_motion, limits, state};

#[test]
fn durations_are_those_of_ruckig() {
    let mut count = 0;
    for line in include_str!("golden/transfers.txt").lines() {
        let numbers: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
        let [
            v0,
            a0,
            p1,
            v1,
            a1,
            back,
            fast,
            least,
            greatest,
            jerk,
            lasting,
            theirs,
        ] = numbers[..]
        else {
            panic!("{line}")
        };
        let limits = limits([back, fast], [least, greatest], jerk);
        let plan = Transfer::lasting(&state(0.0, v0, a0), &state(p1, v1, a1), &limits, lasting);
        let ours = plan.unwrap().duration();
        // At limits of both velocity and acceleration ruckig finds a longer one, or is off by 4e-8.
        let corner = jerk.fract() == 0.0;
        let longer = ours - theirs <= 1e-9 * theirs;
        let equal = (ours - theirs).abs() <= 1e-9 * theirs;
        assert!(if corner { longer } else { equal }, "{ours} {line}");
        count += usize::from(equal);
    }
    assert!(count > 950, "{count}");
}

/// Where velocity and acceleration are the same at both ends, no change of velocity is the shortest.
#[test]
fn the_same_velocity_and_acceleration_at_both_ends_take_a_turn() {
    // v, a; limits of v and a; duration by ruckig 0.19.4. Over 1 m, at 1 m/s³.
    for (v, a, fast, most, theirs) in [
        (0.5, 1.0, [-1.0, 2.0], [-2.0, 1.0], 5.150_770_243_157_544),
        (0.5, -1.0, [-1.0, 2.0], [-1.0, 1.0], 5.236_067_977_499_79),
    ] {
        let case = Case {
            start: state(0.0, v, a),
            target: state(1.0, v, a),
            limits: limits(fast, most, 1.0),
        };
        let plan = Transfer::plan(&case.start, &case.target, &case.limits).unwrap();
        assert!(
            (plan.duration() - theirs).abs() < 1e-12,
            "{}",
            plan.duration()
        );
        check_motion(&plan, &case).unwrap();
    }
}

#[test]
fn rest_to_rest_is_the_s_curve() {
    let limits = Limits::<f64>::new(0.1, 0.225, 1.2).unwrap();
    for distance in [0.3, 0.04, 1e-3, -0.2, 0.0] {
        let curve = trajectories::SCurve::plan(0.6, 0.6 + distance, &limits).unwrap();
        let ends = [0.6, 0.6 + distance].map(Setpoint::at_rest);
        let transfer = Transfer::plan(&ends[0], &ends[1], &limits.into()).unwrap();
        assert!((transfer.duration() - curve.duration()).abs() <= 1e-14 * curve.duration());
        for i in 0..=100 {
            let t = f64::from(i) / 100.0 * curve.duration();
            let off = transfer.at(t).position - curve.at(t).position;
            assert!(off.abs() < 1e-15, "{off:e}");
        }
    }
}

/// From standstill to 0.1 m/s over 5 mm with 1 m/s² at both ends: 0.1 s at 1 m/s². Any longer time needs a dip of the
/// acceleration to −x m/s² and back, of (1 + x)/5 s at 10 m/s³, which gains (1 − x²)/10 m/s; x²/10 s at 1 m/s² gain
/// what is missing. If these come last, the distance is the least that can be had in the time: (1 + x)²(1 − x)/100 + x²/100
/// − x⁴/200 m, above 5 mm for 0 ≤ x < 1, and 5 mm at x = 1: after 0.5 s. For x < 0 the time is too short for the gain.
#[test]
fn a_duration_that_is_not_possible_gives_the_next() {
    let limits = limits([-2.0, 2.0], [-1.0, 1.0], 10.0);
    let (start, target) = (state(0.0, 0.0, 1.0), state(0.005, 0.1, 1.0));
    let least = Transfer::plan(&start, &target, &limits).unwrap();
    assert!((least.duration() - 0.1).abs() < 1e-15);
    let next = Transfer::lasting(&start, &target, &limits, 0.11).unwrap();
    assert!((next.duration() - 0.5).abs() < 1e-12);
    let gap = 0.5 * (0.11 + next.duration());
    for shorter in [0.12, gap, next.duration() * (1.0 - 1e-9)] {
        let same = Transfer::lasting(&start, &target, &limits, shorter).unwrap();
        assert!((same.duration() - next.duration()).abs() < 1e-9);
    }
    let longer = 5.0;
    let exact = Transfer::lasting(&start, &target, &limits, longer).unwrap();
    assert!((exact.duration() - longer).abs() < 1e-14);
}

#[test]
fn a_stop_is_that_of_a_change_of_velocity() {
    let change = VelocityLimits::new(-4.0, 2.0, 40.0).unwrap();
    for (v, a) in [(0.8, 0.0), (-3.0, 1.5), (0.5, 6.0), (0.0, 0.0)] {
        let start = state(1.0, v, a);
        let stop = Transfer::stop(&start, &change).unwrap();
        let expected = VelocityChange::stop(&start, &change).unwrap();
        let place = VelocityChange::stopping_place(&start, &change).unwrap();
        assert_eq!(stop.end().position, place);
        assert_eq!(stop.duration(), expected.duration());
        for i in 0..50 {
            let t = f64::from(i) * 0.02 * stop.duration();
            let (x, y) = (stop.at(t), expected.at(t));
            assert!((x.position - y.position).abs() < 1e-14, "{x:?} {y:?}");
            assert!((x.velocity - y.velocity).abs() < 1e-14, "{x:?} {y:?}");
            assert!((x.acceleration - y.acceleration).abs() < 1e-13);
        }
    }
    // With an infinite jerk: v²/2A.
    let jumps = VelocityLimits::new(-4.0, 2.0, f64::INFINITY).unwrap();
    let stop = Transfer::stop(&state(1.0, 0.8, 9.0), &jumps).unwrap();
    assert!((stop.at(0.1).velocity - 0.4).abs() < 1e-15);
    assert!((stop.end().position - 1.08).abs() < 1e-15);
}

#[test]
fn positions_that_are_left_are_named() {
    let limits = Limits::new(1.0, 2.0, 40.0).unwrap().into();
    let start = state(0.0, 0.5, 0.0);
    let plan = Transfer::plan(&start, &Setpoint::at_rest(0.0), &limits).unwrap();
    // Down to −2 m/s² in 0.05 s, and on at that: 0.5 · 0.05 − 2 · 0.05²/6, and 0.45²/(2 · 2).
    let found = plan.extremes();
    let most = 0.025 - 0.005 / 6.0 + 0.050_625;
    assert!((found.position_max - most).abs() < 1e-15, "{found:?}");
    assert_eq!(
        (found.velocity, found.acceleration, found.jerk),
        (0.5_f64.max(found.velocity), 2.0, 40.0)
    );
    assert!(plan.between(-1.0, found.position_max).is_ok());
    let refused = plan.between(-1.0, 0.05).unwrap_err();
    assert!(matches!(refused, TrajectoryError::LeavesRange { .. }));
    assert_eq!(
        refused.to_string(),
        format!(
            "the motion reaches {} m, but must stay from -1 to 0.05 m",
            found.position_max
        )
    );
}

/// By hand: no jerk limit to speak of, 1 m/s², from standstill to a part that is there and moves at 0.3 m/s.
/// It is caught up with at 0.3 + v m/s, v²/2 + v²/2 = 0.3²/2 behind which the start has come.
#[test]
fn a_part_that_moves_is_met() {
    let limits = limits([-2.0, 2.0], [-1.0, 1.0], 1e9);
    let part = state(0.0, 0.3, 0.0);
    let meet = Transfer::meet(&Setpoint::at_rest(0.0), &part, &limits).unwrap();
    let over = 0.3 / 2.0_f64.sqrt();
    assert!((meet.duration() - (0.3 + 2.0 * over)).abs() < 1e-6);
    for t in [0.0, 0.1, 0.7] {
        let then = meet.at(meet.duration() + t);
        assert!((then.position - 0.3 * (meet.duration() + t)).abs() < 1e-12);
        assert_eq!(then.velocity, 0.3);
    }
    let jerks = Transfer::meet(&state(0.0, 0.0, 1.0), &state(0.0, 0.3, 1.0), &limits);
    assert!(jerks.is_err());
}

#[test]
fn targets_that_cannot_be_reached_are_refused() {
    let limits = limits([-1.0, 1.0], [-2.0, 2.0], 10.0);
    let rest = Setpoint::at_rest(0.0);
    let refused = |target| {
        Transfer::plan(&rest, &target, &limits)
            .unwrap_err()
            .to_string()
    };
    assert!(refused(state(0.0, 1.5, 0.0)).starts_with("target velocity is 1.5 m/s"));
    assert!(refused(state(0.0, 0.0, 2.5)).starts_with("target acceleration is 2.5 m/s²"));
    // −0.9 m/s with 2 m/s² was −1.1 m/s before.
    assert!(refused(state(0.0, -0.9, 2.0)).starts_with("target acceleration is 2 m/s²"));
    assert!(refused(state(f64::NAN, 0.0, 0.0)).starts_with("target position is NaN m"));
    let negative = Transfer::lasting(&rest, &rest, &limits, -1.0).unwrap_err();
    assert!(negative.to_string().starts_with("duration is -1 s"));
}

/// A controller that plans anew from each setpoint.
#[test]
fn planning_anew_in_each_cycle_lasts_no_longer() {
    let mut random = proptest::test_runner::TestRunner::deterministic();
    for _ in 0..400 {
        let case = cases().new_tree(&mut random).unwrap().current();
        let Case {
            mut start,
            target,
            limits,
        } = case;
        let plan = Transfer::plan(&start, &target, &limits).unwrap();
        let end = plan.duration();
        // While it is brought back the limits are not yet those of the plan.
        let first = plan.within_limits_after();
        for i in 1..100 {
            let step = 0.01 * end;
            let plan = Transfer::plan(&start, &target, &limits).unwrap();
            start = plan.at(step);
            let t = f64::from(i) * step;
            if t >= first {
                let left = Transfer::plan(&start, &target, &limits).unwrap().duration();
                let off = (t + left - end).abs();
                assert!(
                    off <= 1e-9 * end,
                    "{off:e} at {t} of {end}: {target:?} {limits:?}"
                );
            }
        }
    }
}

#[test]
fn a_target_that_changes_is_followed() {
    let limits: TransferLimits = Limits::new(1.0, 5.0, 100.0).unwrap().into();
    let cycle = 1e-3;
    let mut follow = Follow::new(Setpoint::at_rest(0.0), limits, cycle).unwrap();
    let mut before = follow.state();
    // Moves on at 0.2 m/s, and jumps back once.
    let part = |i: i32| state(0.3 + 0.2 * f64::from(i) * cycle, 0.2, 0.0);
    for i in 0..3000 {
        let now = follow
            .track(&part(if i < 400 { i } else { i - 1500 }))
            .unwrap();
        assert!(now.velocity.abs() <= 1.0 && now.acceleration.abs() <= 5.0 + 1e-12);
        assert!((now.acceleration - before.acceleration).abs() <= 100.0 * cycle + 1e-9);
        before = now;
        if i == 1000 {
            assert!(follow.step(&state(0.0, 1.5, 0.0)).is_err());
            assert!(follow.track(&state(0.0, 1.0, 0.0)).is_err());
            assert_eq!(follow.state(), now);
        }
    }
    // The setpoint is that of the end of the cycle, at which the part has moved on.
    assert!((before.velocity - 0.2).abs() < 1e-12, "{before:?}");
    assert!((before.position - part(1500).position).abs() < 1e-12);

    let target = Setpoint::at_rest(0.0);
    let first = follow.step(&target).unwrap();
    let left = follow.remaining();
    let plan = *follow.transfer().unwrap();
    assert_eq!(first, plan.at(cycle));
    for i in 1..=50 {
        follow.step(&target).unwrap();
        assert!((follow.remaining() + f64::from(i) * cycle - left).abs() < 1e-12);
    }
    follow.set_limits(Limits::new(0.5, 5.0, 100.0).unwrap().into());
    while follow.remaining() > 0.0 || follow.transfer().is_none() {
        follow.step(&target).unwrap();
    }
    assert_eq!(follow.state(), target);
    follow.restart(Setpoint::at_rest(1.0));
    assert!(follow.transfer().is_none());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]
    #[test]
    fn limits_hold_and_the_end_is_met(case in cases()) {
        let plan = Transfer::plan(&case.start, &case.target, &case.limits).unwrap();
        check_motion(&plan, &case)?;
        // The extremes are those of dense samples.
        let found = plan.extremes();
        let mut greatest = [f64::NEG_INFINITY; 2];
        for i in 0..=1000 {
            let s = plan.at(plan.duration() * f64::from(i) / 1000.0);
            prop_assert!(s.position >= found.position_min - 1e-12);
            prop_assert!(s.position <= found.position_max + 1e-12);
            prop_assert!(s.velocity.abs() <= found.velocity + 1e-12);
            greatest = [greatest[0].max(s.position), greatest[1].max(s.velocity.abs())];
        }
        let coarse = 1e-2 * plan.duration() * (1.0 + found.velocity + found.acceleration + plan.duration());
        prop_assert!(found.position_max - greatest[0] <= coarse);
        prop_assert!(found.velocity - greatest[1] <= coarse * (1.0 + found.acceleration + found.jerk));
    }

    #[test]
    fn a_given_duration_is_kept(case in cases(), longer in 1.0..3.0_f64) {
        let Case { start, target, limits } = &case;
        let least = Transfer::plan(start, target, limits).unwrap();
        let wanted = longer * least.duration();
        let plan = Transfer::lasting(start, target, limits, wanted).unwrap();
        check_motion(&plan, &case)?;
        prop_assert!(plan.duration() >= wanted * (1.0 - 1e-12));
        // The one it gives is the least for itself too.
        let again = Transfer::lasting(start, target, limits, plan.duration()).unwrap();
        prop_assert!((again.duration() - plan.duration()).abs() <= 1e-9 * (1e-3 + plan.duration()));
    }

    #[test]
    fn mirrored_turned_and_scaled_it_lasts_the_same(case in cases(), length in 0.01..100.0_f64, time in 0.01..100.0_f64) {
        let Case { start, target, limits: own } = &case;
        let end = Transfer::plan(start, target, own).unwrap().duration();
        let change = own.change();
        let (a, j) = ([change.acceleration_min(), change.acceleration_max()], change.jerk());
        let v = [own.velocity_min(), own.velocity_max()];
        let near = |plan: Result<Transfer, TrajectoryError>, wanted: f64| {
            let got = plan.unwrap().duration();
            prop_assert!((got - wanted).abs() <= 1e-9 * wanted, "{got} {wanted}");
            Ok(())
        };
        let turn = |s: &Setpoint| state(-s.position, -s.velocity, -s.acceleration);
        let mirror = limits([-v[1], -v[0]], [-a[1], -a[0]], j);
        near(Transfer::plan(&turn(start), &turn(target), &mirror), end)?;

        let scale = |s: &Setpoint| state(
            s.position * length, s.velocity * length / time, s.acceleration * length / (time * time));
        let scaled = limits(
            v.map(|x| x * length / time), a.map(|x| x * length / (time * time)), j * length / (time * time * time));
        near(Transfer::plan(&scale(start), &scale(target), &scaled), end * time)?;

        // Backwards in time, if the start is one that can be an end.
        let back = |s: &Setpoint| state(s.position, -s.velocity, s.acceleration);
        let other = limits([-v[1], -v[0]], a, j);
        let after = target.velocity + target.acceleration * target.acceleration.abs() / (2.0 * j);
        let inside = after > v[0] && after < v[1];
        if inside && let Ok(plan) = Transfer::plan(&back(target), &back(start), &other) {
            near(Ok(plan), end)?;
        }
    }

    #[test]
    fn in_single_precision_too(case in cases()) {
        let Case { start, target, limits } = &case;
        let cast = |s: &Setpoint| Setpoint {
            position: s.position as f32, velocity: s.velocity as f32,
            acceleration: s.acceleration as f32, jerk: 0.0_f32 };
        let change = limits.change();
        let single = TransferLimits::new(
            limits.velocity_min() as f32, limits.velocity_max() as f32,
            VelocityLimits::new(change.acceleration_min() as f32, change.acceleration_max() as f32, change.jerk() as f32).unwrap()).unwrap();
        let plan = Transfer::plan(&cast(start), &cast(target), &single).unwrap();
        let end = plan.duration();
        for i in 0..=200 {
            let t = end * (i as f32) / 200.0;
            let s = plan.at(t);
            if t >= plan.within_limits_after() {
                prop_assert!(s.velocity <= single.velocity_max() && s.velocity >= single.velocity_min());
            }
        }
        let last = plan.at(end.next_down());
        let jerk = single.change().jerk();
        let off = (last.position - target.position as f32).abs();
        prop_assert!(off <= 1e-5 * (1.0 + end * 3.0), "{off:e}");
        prop_assert!((last.velocity - target.velocity as f32).abs() <= 1e-5 * (1.0 + jerk * end));
    }

    #[test]
    fn jumps_of_acceleration_keep_the_limits(case in cases(), longer in 0.5..2.0_f64) {
        let change = case.limits.change();
        let a = [change.acceleration_min(), change.acceleration_max()];
        let limits = limits([case.limits.velocity_min(), case.limits.velocity_max()], a, f64::INFINITY);
        let least = Transfer::plan(&case.start, &case.target, &limits).unwrap().duration();
        let plan = Transfer::lasting(&case.start, &case.target, &limits, longer * least).unwrap();
        let end = plan.duration();
        prop_assert!(end >= least.max(longer * least) * (1.0 - 1e-12));
        let (mut before, dt) = (plan.at(0.0), end / 500.0);
        for i in 1..500 {
            let now = plan.at(dt * f64::from(i));
            let slope = (now.velocity - before.velocity) / dt;
            prop_assert!(slope <= a[1] + 1e-9 && slope >= a[0] - 1e-9);
            let way = 0.5 * dt * (now.velocity + before.velocity);
            let off = (now.position - before.position - way).abs();
            prop_assert!(off <= 0.5 * (a[1] - a[0]) * dt * dt + 1e-12);
            before = now;
        }
        let last = plan.at(end.next_down());
        prop_assert!((last.position - case.target.position).abs() < 1e-11);
        prop_assert!((last.velocity - case.target.velocity).abs() < 1e-11);
    }

    #[test]
    fn no_number_panics(x in prop::array::uniform12(any::<f64>()), t in any::<f64>(), y in prop::array::uniform6(any::<f32>())) {
        let change = VelocityLimits::new(-x[0].abs(), x[1].abs(), x[2].abs());
        if let Ok(change) = change && let Ok(limits) = TransferLimits::new(-x[3].abs(), x[4].abs(), change) {
            let plan = Transfer::lasting(&state(x[5], x[6], x[7]), &state(x[8], x[9], x[10]), &limits, x[11]);
            if let Ok(plan) = plan {
                prop_assert!(plan.duration().is_finite() && plan.duration() >= 0.0);
                prop_assert!(plan.at(t).velocity.is_finite());
                let _ = plan.extremes();
            }
        }
        // Any exponents, so that most are taken.
        let tame = |y: f32, most: f32| if y.is_finite() { y.abs().min(most).max(1e-30) } else { 1.0 };
        let change = VelocityLimits::new(-tame(y[0], 1e9), tame(y[1], 1e9), tame(y[2], 1e15)).unwrap();
        let limits = TransferLimits::new(-tame(y[3], 1e9), tame(y[3], 1e9), change).unwrap();
        let start = Setpoint { position: 0.0_f32, velocity: tame(y[4], 1e9), ..Setpoint::default() };
        if let Ok(plan) = Transfer::plan(&start, &Setpoint::at_rest(tame(y[5], 1e9)), &limits) {
            prop_assert!(plan.duration().is_finite());
            prop_assert!(!plan.at(0.5 * plan.duration()).position.is_nan());
        }
    }
}
