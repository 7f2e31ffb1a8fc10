//! S-curves: limits, ends, continuity, time optimality, and published values.

use proptest::prelude::*;
use trajectories::{Limits, Motion, SCurve, Setpoint, TrajectoryError, maximum};

/// A number between `10^low` and `10^high`, all magnitudes alike.
fn magnitude(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|x| 10f64.powf(x))
}

fn any_limits() -> impl Strategy<Value = Limits> {
    (
        magnitude(-4.0, 2.0),
        magnitude(-3.0, 3.0),
        magnitude(-2.0, 6.0),
    )
        .prop_map(|(v, a, j)| Limits::new(v, a, j).unwrap())
}

/// Distances that take every way through the planner, in both directions.
fn any_distance() -> impl Strategy<Value = f64> {
    (magnitude(-9.0, 2.0), any::<bool>()).prop_map(|(d, back)| if back { -d } else { d })
}

/// Moves on the border between two of the planner's ways, give or take a few roundings.
fn border() -> impl Strategy<Value = (f64, Limits)> {
    (any_limits(), 0..4, -4..=4).prop_filter_map("a speed too high", |(limits, which, ulps)| {
        let (v, a, j) = (limits.velocity(), limits.acceleration(), limits.jerk());
        let nudge = 1.0 + f64::from(ulps) * f64::EPSILON;
        let fast = Limits::new(a * a / j * nudge, a, j).ok()?;
        Some(match which {
            // The acceleration limit is only just reached.
            0 => (2.0 * a * a * a / (j * j) * nudge, limits),
            // The speed limit is only just reached.
            1 => (v * ramp_time(v, &limits) * nudge, limits),
            // Both limits are reached at the same instant: long moves, then the shortest such.
            2 => (v, fast),
            _ => (2.0 * a * a * a / (j * j), fast),
        })
    })
}

fn any_curve() -> impl Strategy<Value = (f64, f64, Limits, SCurve)> {
    let move_and_limits = prop_oneof![
        3 => (any_distance(), any_limits()),
        1 => border(),
    ];
    (prop_oneof![Just(0.0), -10.0..10.0], move_and_limits).prop_filter_map(
        "no move, or too far or long",
        |(from, (distance, limits))| {
            let to = from + distance;
            if distance.abs() > 100.0 || searched_duration(distance.abs(), &limits) > 9.9e6 {
                return None;
            }
            let curve = SCurve::plan(from, to, &limits).unwrap();
            (to != from).then_some((from, to, limits, curve))
        },
    )
}

/// Instants worth looking at: spread over the curve, and on and beside each switch.
fn instants(curve: &SCurve) -> Vec<f64> {
    let duration = curve.duration();
    let spread = (-3..=203).map(|i| duration * f64::from(i) / 200.0);
    let switches = curve.segments().into_iter().map(|s| s.start);
    let beside = switches.flat_map(|s| [s.next_down(), s, s.next_up()]);
    spread
        .chain(beside)
        .chain([duration.next_down(), duration, duration.next_up()])
        .collect()
}

/// How far a position may be off by the rounding of positions and of the time.
fn position_rounding(from: f64, to: f64, limits: &Limits, curve: &SCurve) -> f64 {
    // A few operations on numbers as large as the ends, and the switching times' own rounding
    // (a few parts in 2^53 of the duration) travelled at the peak speed.
    let scale =
        from.abs().max(to.abs()) + curve.peak_velocity().min(limits.velocity()) * curve.duration();
    8.0 * f64::EPSILON * scale
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    /// Without any tolerance: not by one unit in the last place.
    #[test]
    fn no_limit_is_ever_passed((from, to, limits, curve) in any_curve()) {
        for t in instants(&curve) {
            let s = curve.at(t);
            prop_assert!(s.velocity.abs() <= limits.velocity(), "{s:?} at {t}");
            prop_assert!(s.acceleration.abs() <= limits.acceleration(), "{s:?} at {t}");
            prop_assert!(s.jerk.abs() <= limits.jerk(), "{s:?} at {t}");
            prop_assert!(s.position >= from.min(to) && s.position <= from.max(to), "{s:?} at {t}");
            prop_assert!(s.velocity.abs() <= curve.peak_velocity());
            prop_assert!(s.acceleration.abs() <= curve.peak_acceleration());
        }
    }

    #[test]
    fn ends_are_met((from, to, limits, curve) in any_curve()) {
        let duration = curve.duration();
        prop_assert_eq!(curve.at(-1.0), Setpoint::at_rest(from));
        prop_assert_eq!(curve.at(f64::NEG_INFINITY), Setpoint::at_rest(from));
        prop_assert_eq!(curve.at(f64::NAN), Setpoint::at_rest(from));
        prop_assert_eq!(curve.at(duration), Setpoint::at_rest(to));
        prop_assert_eq!(curve.at(duration + 1.0), Setpoint::at_rest(to));
        prop_assert_eq!(curve.at(f64::INFINITY), Setpoint::at_rest(to));

        // The start is rest too, but the jerk has set in.
        let start = curve.at(0.0);
        prop_assert_eq!((start.position, start.velocity, start.acceleration), (from, 0.0, 0.0));
        prop_assert_eq!(start.jerk, limits.jerk().copysign(to - from));
        prop_assert_eq!(curve.at(-0.0), start);
        prop_assert_eq!(curve.at(-f64::NAN), Setpoint::at_rest(from));

        // The last instant before the end is nearly rest: the end is reached, not jumped to.
        let last = curve.at(duration.next_down());
        let left = duration - duration.next_down();
        // Equal measured.
        prop_assert!((last.position - to).abs() <= f64::EPSILON * to.abs());
        prop_assert!(last.velocity.abs() <= limits.jerk() * left * left);
        prop_assert!(last.acceleration.abs() <= limits.jerk() * left);
    }

    /// Position, velocity and acceleration do not jump where segments meet.
    #[test]
    fn switches_are_continuous((from, to, limits, curve) in any_curve()) {
        let time_rounding = 4.0 * f64::EPSILON * curve.duration();
        for segment in curve.segments() {
            let (before, after) = (curve.at(segment.start.next_down()), curve.at(segment.start));
            let position = position_rounding(from, to, &limits, &curve);
            let velocity = 8.0 * f64::EPSILON * curve.peak_velocity()
                + curve.peak_acceleration() * time_rounding;
            let acceleration = 8.0 * f64::EPSILON * curve.peak_acceleration()
                + limits.jerk() * time_rounding;
            prop_assert!((before.position - after.position).abs() <= position, "{before:?} {after:?}");
            prop_assert!((before.velocity - after.velocity).abs() <= velocity, "{before:?} {after:?}");
            prop_assert!(
                (before.acceleration - after.acceleration).abs() <= acceleration,
                "{before:?} {after:?}"
            );
        }
    }

    /// Within a segment the four values are each other's derivatives: the state at one instant,
    /// carried on as a cubic, is the state at another.
    #[test]
    fn segments_are_cubics(
        (from, to, limits, curve) in any_curve(), u in 0.0..1.0f64, w in 0.0..1.0f64
    ) {
        for segment in curve.segments().into_iter().filter(|s| s.duration > 0.0) {
            let instant = |x: f64| (segment.start + x * segment.duration)
                .min((segment.start + segment.duration).next_down());
            let (t0, t1) = (instant(u), instant(w));
            let (s0, s1, h) = (curve.at(t0), curve.at(t1), t1 - t0);
            prop_assert_eq!(s0.jerk, segment.jerk);
            let position = s0.position
                + h * (s0.velocity + h * (s0.acceleration / 2.0 + h * s0.jerk / 6.0));
            let velocity = s0.velocity + h * (s0.acceleration + h * s0.jerk / 2.0);
            let acceleration = s0.acceleration + h * s0.jerk;
            // 0.13, 0.22 and 0.25 of these measured.
            let time_rounding = f64::EPSILON * curve.duration();
            prop_assert!((s1.position - position).abs() <= position_rounding(from, to, &limits, &curve));
            prop_assert!((s1.velocity - velocity).abs()
                <= 4.0 * f64::EPSILON * curve.peak_velocity() + curve.peak_acceleration() * time_rounding);
            prop_assert!((s1.acceleration - acceleration).abs()
                <= 2.0 * f64::EPSILON * curve.peak_acceleration() + 0.5 * limits.jerk() * time_rounding);
        }
    }

    /// The structure Pontryagin's principle asks for: full jerk where the jerk is not zero, and a
    /// segment without jerk only at the limit it waits on.
    #[test]
    fn each_phase_saturates_what_it_can((from, to, limits, curve) in any_curve()) {
        let segments = curve.segments();
        let jerk = limits.jerk().copysign(to - from);
        prop_assert_eq!(segments.map(|s| s.jerk), [jerk, 0.0, -jerk, 0.0, -jerk, 0.0, jerk]);
        if segments[1].duration > 0.0 {
            prop_assert_eq!(curve.peak_acceleration(), limits.acceleration());
        }
        if let Some((begin, end)) = curve.cruise() {
            prop_assert_eq!(curve.peak_velocity(), limits.velocity());
            prop_assert_eq!(curve.at(0.5 * (begin + end)).velocity.abs(), limits.velocity());
        }
        prop_assert!(segments.iter().all(|s| s.duration >= 0.0));
        // At a switch the later segment counts.
        for segment in segments.iter().filter(|s| s.duration > 0.0) {
            prop_assert_eq!(curve.at(segment.start).jerk, segment.jerk);
        }
        // Equal ramps up and down.
        let rounding = 4.0 * f64::EPSILON * curve.duration();
        for (up, down) in [(0, 6), (1, 5), (2, 4), (0, 2)] {
            prop_assert!((segments[up].duration - segments[down].duration).abs() <= rounding);
        }
    }

    /// The duration against an independent route: bisection on the peak speed, the fastest ramp
    /// to it, and the rest of the way at that speed.
    #[test]
    fn duration_matches_a_search_over_peak_speeds((from, to, limits, curve) in any_curve()) {
        let expected = searched_duration((to - from).abs(), &limits);
        // Bisection runs to the last bit; the formulas then round some ten times: 2 units
        // measured.
        let tolerance = 8.0 * f64::EPSILON * expected;
        prop_assert!((curve.duration() - expected).abs() <= tolerance, "{} {expected}", curve.duration());
    }

    /// Looser limits never take longer, and no move within tighter limits is faster.
    #[test]
    fn looser_limits_are_no_slower(
        (from, to, limits, curve) in any_curve(),
        (v, a, j) in (1.0..10.0f64, 1.0..10.0f64, 1.0..10.0f64)
    ) {
        let fast = (limits.velocity() * v).min(maximum::VELOCITY);
        let looser = Limits::new(fast, limits.acceleration() * a, limits.jerk() * j).unwrap();
        let faster = SCurve::plan(from, to, &looser).unwrap();
        prop_assert!(faster.duration() <= curve.duration() * (1.0 + 8.0 * f64::EPSILON));
    }

    #[test]
    fn the_way_back_mirrors_the_way_there(d in magnitude(-6.0, 1.0), limits in any_limits(), u in 0.0..1.0f64) {
        let (there, back) = (
            SCurve::plan(0.0, d, &limits).unwrap(),
            SCurve::plan(0.0, -d, &limits).unwrap(),
        );
        prop_assert_eq!(there.duration(), back.duration());
        if there.cruise().is_none() {
            // The halves meet in the middle, exactly.
            prop_assert_eq!(there.at(there.segments()[4].start).position, 0.5 * d);
        }
        let t = u * there.duration();
        let (s, m) = (there.at(t), back.at(t));
        prop_assert_eq!(s.position, -m.position);
        prop_assert_eq!(s.velocity, -m.velocity);
        prop_assert_eq!(s.acceleration, -m.acceleration);
        prop_assert_eq!(s.jerk, -m.jerk);
    }
}

/// Time of the fastest ramp from rest to speed `v`, s.
fn ramp_time(v: f64, limits: &Limits) -> f64 {
    let (a, j) = (limits.acceleration(), limits.jerk());
    if v * j <= a * a {
        2.0 * (v / j).sqrt()
    } else {
        v / a + a / j
    }
}

/// Least duration of a symmetric move over `distance`: the greatest peak speed whose two ramps
/// fit, found by bisection, and the time at that speed.
fn searched_duration(distance: f64, limits: &Limits) -> f64 {
    let fits = |v: f64| v * ramp_time(v, limits) <= distance;
    let (mut low, mut high) = (0.0, limits.velocity());
    if fits(high) {
        return distance / high + ramp_time(high, limits);
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if fits(middle) {
            low = middle
        } else {
            high = middle
        }
    }
    2.0 * ramp_time(low, limits)
}

/// Table 12 of Liu, Guo, Liu, Niu, Machines 2025, 13(5), 433, doi 10.3390/machines13050433:
/// maximum velocity (mm/s), acceleration (mm/s²) and jerk (mm/s³) over 300 mm.
const TABLE_12: [[f64; 3]; 6] = [
    [100.0, 225.0, 1200.0],
    [100.0, 225.0, 1400.0],
    [100.0, 120.0, 1000.0],
    [100.0, 140.0, 1000.0],
    [110.0, 160.0, 1000.0],
    [120.0, 160.0, 1000.0],
];

#[test]
fn published_trajectories_reach_every_limit() {
    for row in TABLE_12 {
        let [v, a, j] = row.map(|x| x / 1000.0);
        let curve = SCurve::plan(0.6, 0.9, &Limits::new(v, a, j).unwrap()).unwrap();
        assert_eq!((curve.peak_velocity(), curve.peak_acceleration()), (v, a));
        // All three limits reached: T = d/V + V/A + A/J; 4 ulp of 4 s.
        let closed_form = 0.3 / v + v / a + a / j;
        assert!((curve.duration() - closed_form).abs() <= 4.0 * 4.0 * f64::EPSILON);
    }
}

/// Positions of trajectory 1 of Table 12 in exact fractions, to 12 decimals, made by
/// `python3 crates/trajectories/tests/golden/trajectory_1.py`.
#[test]
fn trajectory_1_matches_an_independent_program() {
    let limits = Limits::<f64>::new(0.1, 0.225, 1.2).unwrap();
    let curve = SCurve::plan(0.6, 0.9, &limits).unwrap();
    // 3 + 4/9 + 3/16 s; equal measured.
    assert!((curve.duration() - (3.0 + 4.0 / 9.0 + 3.0 / 16.0)).abs() <= 2.0 * f64::EPSILON);
    let expected = [
        (0.050, 0.600_025_000_000),
        (0.187, 0.601_307_840_600),
        (0.188, 0.601_328_934_375),
        (0.400, 0.610_880_859_375),
        (0.631, 0.631_502_777_946),
        (0.632, 0.631_602_777_778),
        (1.800, 0.748_402_777_778),
        (3.000, 0.868_402_777_778),
        (3.190, 0.886_030_980_903),
        (3.444, 0.898_672_243_403),
        (3.600, 0.899_993_480_474),
        (3.631, 0.899_999_999_832),
    ];
    for (t, position) in expected {
        // Half a unit of the last printed decimal, and a little for our own rounding.
        assert!(
            (curve.at(t).position - position).abs() <= 0.51e-12,
            "at {t} s: {}",
            curve.at(t).position
        );
    }
}

/// One hand-computed example for each way through the planner.
#[test]
fn every_case_has_its_closed_form() {
    let plan = |d, v, a, j| SCurve::plan(0.0, d, &Limits::new(v, a, j).unwrap()).unwrap();
    let durations = |c: &SCurve| c.segments().map(|s| s.duration);

    // Jerk alone: d = 2 J τ³ with J = 1, τ = 1.
    let curve = plan(2.0, 10.0, 10.0, 1.0);
    assert_eq!(durations(&curve), [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0]);
    assert_eq!(
        (curve.peak_velocity(), curve.peak_acceleration()),
        (1.0, 1.0)
    );

    // Acceleration limit, not the speed limit: τ = 1, α = 1, v = 2, d = v (2τ + α) = 6.
    let curve = plan(6.0, 10.0, 1.0, 1.0);
    assert_eq!(durations(&curve), [1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0]);
    assert_eq!(
        (curve.peak_velocity(), curve.peak_acceleration()),
        (2.0, 1.0)
    );

    // Speed limit, not the acceleration limit: τ = √(v/J) = 1, ramps 2 m, 3 m at 1 m/s.
    let curve = plan(5.0, 1.0, 10.0, 1.0);
    assert_eq!(durations(&curve), [1.0, 0.0, 1.0, 3.0, 1.0, 0.0, 1.0]);
    assert_eq!(
        (curve.peak_velocity(), curve.peak_acceleration()),
        (1.0, 1.0)
    );

    // Both: τ = 1, α = 1, v = 2, ramps 6 m, 4 m at 2 m/s.
    let curve = plan(10.0, 2.0, 1.0, 1.0);
    assert_eq!(durations(&curve), [1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0]);
    assert_eq!(
        (curve.peak_velocity(), curve.peak_acceleration()),
        (2.0, 1.0)
    );
    assert_eq!(curve.cruise(), Some((3.0, 5.0)));
}

#[test]
fn no_distance_is_no_motion() {
    let curve = SCurve::plan(0.7, 0.7, &Limits::new(0.1, 1.0, 10.0).unwrap()).unwrap();
    assert_eq!(curve.duration(), 0.0);
    for t in [-1.0, 0.0, 1.0, f64::NAN] {
        assert_eq!(curve.at(t), Setpoint::at_rest(0.7));
    }
    let extremes = curve.extremes();
    assert_eq!(
        (extremes.velocity, extremes.acceleration, extremes.jerk),
        (0.0, 0.0, 0.0)
    );
}

#[test]
fn misuse_is_named() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = Limits::new(1.0, bad, 1.0).unwrap_err();
        assert!(
            matches!(
                error,
                TrajectoryError::Invalid {
                    field: "acceleration",
                    ..
                }
            ),
            "{error}"
        );
    }
    let limits = Limits::new(1.0, 1.0, 1.0).unwrap();
    let error = SCurve::plan(0.0, f64::NAN, &limits).unwrap_err();
    assert_eq!(
        error.to_string(),
        "to is NaN m, but must be from -1e9 to 1e9"
    );
    let slow = Limits::new(1e-3, 1.0, 1.0).unwrap();
    let error = SCurve::plan(0.0, 1e5, &slow).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("greater than zero and at most 1e7"),
        "{error}"
    );
    // τ = ∛(d/2J) is below the least f64.
    let stiff = Limits::new(1.0, 1.0, 1e15).unwrap();
    let error = SCurve::plan(0.0, 5e-324, &stiff).unwrap_err();
    assert!(
        matches!(error, TrajectoryError::Unrepresentable { .. }),
        "{error}"
    );
}

/// In counts of an encoder with 20 bits: 30 turns at 50 turns/s. With a constant stretch of the
/// velocity and of the acceleration the least time is d/v + v/a + a/j.
#[test]
fn counts_of_an_encoder_are_positions() {
    let turn = f64::from(1 << 20);
    let (d, v, a, j) = (30.0 * turn, 50.0 * turn, 950.0 * turn, 5e4 * turn);
    let limits = Limits::new(v, a, j).unwrap();
    let motion = SCurve::plan(-1.5e6, -1.5e6 + d, &limits).unwrap();
    let least = d / v + v / a + a / j;
    assert!(
        (motion.duration() - least).abs() < 1e-14 * least,
        "{}",
        motion.duration()
    );
    assert_eq!(motion.at(motion.duration()).position, -1.5e6 + d);
}
