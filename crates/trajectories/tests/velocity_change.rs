//! Changes of velocity: closed forms, limits, ends, and a bound that no motion can beat.

use proptest::prelude::*;
use trajectories::{Setpoint, TrajectoryError, VelocityChange, VelocityLimits};

fn state(position: f64, velocity: f64, acceleration: f64) -> Setpoint {
    Setpoint {
        position,
        velocity,
        acceleration,
        jerk: 0.0,
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-13 * (1.0 + b.abs())
}

#[test]
fn stops_are_those_of_closed_forms() {
    let limits = VelocityLimits::new(-4.0, 2.0, 40.0).unwrap();
    // Braking limit reached: v/a + a/J; half the speed on average.
    let stop = VelocityChange::stop(&state(1.0, 0.8, 0.0), &limits).unwrap();
    assert!(close(stop.duration(), 0.3) && close(stop.end().position, 1.12));
    // Backwards it is the other limit that brakes: 0.8/2 + 2/40.
    let stop = VelocityChange::stop(&state(1.0, -0.8, 0.0), &limits).unwrap();
    assert!(close(stop.duration(), 0.45) && close(stop.end().position, 0.82));
    // Not reached: 2 √(v/J).
    let stop = VelocityChange::stop(&state(0.0, 0.1, 0.0), &limits).unwrap();
    assert!(close(stop.duration(), 0.1) && close(stop.end().position, 0.005));
    // Speeding up at 2 m/s² with a velocity that falls to zero just as the acceleration does:
    // v = −a²/2J; the distance is that of a cubic, −a³/6J².
    let stop = VelocityChange::stop(&state(0.0, -0.05, 2.0), &limits).unwrap();
    assert!(close(stop.duration(), 0.05) && close(stop.end().position, -8.0 / 9600.0));
    // Beyond the limit: 6 to 2 m/s² takes 0.1 s and gains 0.4 m/s; 0.1 s at 2 m/s² gains 0.2 m/s, and 2 to 0 takes
    // 0.05 s and gains 0.05 m/s.
    let change = VelocityChange::plan(&state(0.0, 0.0, 6.0), 0.65, &limits).unwrap();
    assert!(close(change.duration(), 0.25));
    // Nothing to do.
    let still = VelocityChange::stop(&state(3.0, 0.0, 0.0), &limits).unwrap();
    assert_eq!((still.duration(), still.at(0.0).position), (0.0, 3.0));
}

#[test]
fn without_a_jerk_limit_the_velocity_is_a_ramp() {
    let limits = VelocityLimits::new(-4.0, 2.0, f64::INFINITY).unwrap();
    let stop = VelocityChange::stop(&state(0.0, 0.8, 1.5), &limits).unwrap();
    assert!(close(stop.duration(), 0.2) && close(stop.end().position, 0.08));
    let half = stop.at(0.1);
    assert!(close(half.velocity, 0.4) && half.acceleration == -4.0 && half.jerk == 0.0);
    let faster = VelocityChange::plan(&state(0.0, 0.8, 0.0), 1.0, &limits).unwrap();
    assert!(close(faster.duration(), 0.1));
}

#[test]
fn outside_its_time_it_is_the_start_and_the_wanted_velocity() {
    let limits = VelocityLimits::new(-4.0, 2.0, 40.0).unwrap();
    let change = VelocityChange::plan(&state(0.5, 0.1, -1.0), 0.7, &limits).unwrap();
    for t in [-1.0, f64::NAN, f64::NEG_INFINITY] {
        assert_eq!(change.at(t), state(0.5, 0.1, -1.0));
    }
    let later = change.at(change.duration() + 2.0);
    assert_eq!((later.velocity, later.acceleration), (0.7, 0.0));
    assert!(close(later.position, change.end().position + 1.4));
    let stop = VelocityChange::stop(&state(0.0, 0.1, 0.0), &limits).unwrap();
    assert_eq!(stop.at(f64::INFINITY), stop.end());
}

#[test]
fn what_is_not_valid_is_refused_in_words() {
    for (a, b, j, field) in [
        (0.0, 1.0, 1.0, "acceleration_min"),
        (-1.0, -1.0, 1.0, "acceleration_max"),
        (-1.0, 1.0, f64::NAN, "jerk"),
        (-f64::INFINITY, 1.0, 1.0, "acceleration_min"),
    ] {
        let error = VelocityLimits::new(a, b, j).unwrap_err();
        assert!(error.to_string().starts_with(field), "{error}");
    }
    let limits = VelocityLimits::new(-1.0, 1.0, 1.0).unwrap();
    for s in [
        state(f64::NAN, 0.0, 0.0),
        state(0.0, 2e9, 0.0),
        state(0.0, 0.0, f64::INFINITY),
    ] {
        let refused = VelocityChange::stop(&s, &limits);
        assert!(
            matches!(refused, Err(TrajectoryError::Invalid { .. })),
            "{s:?}"
        );
    }
    let slow = VelocityLimits::new(-1e-9, 1.0, 1.0).unwrap();
    let error = VelocityChange::stop(&state(0.0, 1e6, 0.0), &slow).unwrap_err();
    assert!(error.to_string().starts_with("duration"), "{error}");
}

/// A velocity that no admissible motion from acceleration `a` can gain more of in the time `end`:
/// the integral of the upper envelope of all accelerations, by the midpoint rule.
///
/// At most J of slope from the start and to the end bounds the acceleration by a + J t and J (T − t);
/// the limit bounds it by A, or by a − J t while that is still above A.
fn greatest_gain(a: f64, most: f64, jerk: f64, end: f64) -> f64 {
    let steps = 20_000;
    let dt = end / f64::from(steps);
    (0..steps)
        .map(|i| {
            let t = (f64::from(i) + 0.5) * dt;
            let limit = most.max(a - jerk * t);
            (a + jerk * t).min(limit).min(jerk * (end - t)) * dt
        })
        .sum()
}

proptest! {
    #[test]
    fn limits_hold_the_end_is_met_and_nothing_is_faster(
        v in -2.0..2.0_f64, a in -6.0..6.0_f64, wanted in -2.0..2.0_f64,
        least in 0.5..5.0_f64, greatest in 0.5..5.0_f64, jerk in 1.0..50.0_f64,
    ) {
        let limits = VelocityLimits::new(-least, greatest, jerk).unwrap();
        let change = VelocityChange::plan(&state(0.3, v, a), wanted, &limits).unwrap();
        let end = change.duration();

        let (mut before, dt) = (change.at(0.0), end / 1000.0);
        let (mut velocity, mut position) = (v, 0.3);
        for i in 1..=1000 {
            let t = dt * f64::from(i);
            let now = change.at(t);
            // Beyond the limit only while it is brought back.
            let back = a.abs() - jerk * t + 1e-12;
            let (above, below) = if a > 0.0 { (back, 0.0) } else { (0.0, back) };
            prop_assert!(now.acceleration <= greatest.max(above));
            prop_assert!(-now.acceleration <= least.max(below));
            prop_assert!((now.acceleration - before.acceleration).abs() <= jerk * dt + 1e-12);
            // The states are each other's integrals: trapezoids, off by J dt² where the jerk jumps.
            velocity += 0.5 * (now.acceleration + before.acceleration) * dt;
            position += 0.5 * (now.velocity + before.velocity) * dt;
            before = now;
        }
        prop_assert!((velocity - wanted).abs() <= 4.0 * jerk * dt * dt + 1e-12);
        prop_assert!((position - change.end().position).abs() <= (12.0 + 4.0 * jerk * end) * dt * dt * (1.0 + end) + 1e-11);
        // The last sample may lie a rounding before the end; the end itself is exact.
        prop_assert!((change.at(end.next_down()).velocity - wanted).abs() < 1e-12);
        prop_assert!((change.at(end.next_down()).acceleration).abs() < 1e-6);

        // In 1 % less time the velocity cannot be had, in one of the two directions.
        let short = 0.99 * end;
        let gain = wanted - v;
        let up = greatest_gain(a, greatest, jerk, short);
        let down = -greatest_gain(-a, least, jerk, short);
        let forced = short * jerk < a.abs();
        prop_assert!(forced || gain > up || gain < down, "{gain} is between {down} and {up}");

        // Mirrored, the same.
        let mirror = VelocityLimits::new(-greatest, least, jerk).unwrap();
        let other = VelocityChange::plan(&state(-0.3, -v, -a), -wanted, &mirror).unwrap();
        prop_assert!((other.duration() - end).abs() <= 1e-12 * end);

        // In f32 as well, to its rounding; near a change of direction the time goes as a root.
        let cast = |x: f64| x as f32;
        let single = VelocityLimits::new(cast(-least), cast(greatest), cast(jerk)).unwrap();
        let start = Setpoint { position: 0.3_f32, velocity: cast(v), acceleration: cast(a), jerk: 0.0 };
        let single = VelocityChange::plan(&start, cast(wanted), &single).unwrap();
        prop_assert!((f64::from(single.duration()) - end).abs() < 2e-2);
    }

    #[test]
    fn no_number_panics(x in prop::array::uniform7(any::<f64>()), t in any::<f64>()) {
        if let Ok(limits) = VelocityLimits::new(-x[0].abs(), x[1].abs(), x[2].abs())
            && let Ok(change) = VelocityChange::plan(&state(x[3], x[4], x[5]), x[6], &limits)
        {
            let _ = change.at(t);
        }
    }
}
