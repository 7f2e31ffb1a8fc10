//! Programs, sines and chirps.
#![cfg(feature = "alloc")]

use proptest::prelude::*;
use trajectories::{
    Chirp, Limits, Motion, Oscillation, Program, Setpoint, Sine, Step, Sweep, TrajectoryError,
};

fn magnitude(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|x| 10f64.powf(x))
}

fn any_limits() -> impl Strategy<Value = Limits> {
    (
        magnitude(-2.0, 0.0),
        magnitude(-1.0, 1.0),
        magnitude(0.0, 2.0),
    )
        .prop_map(|(v, a, j)| Limits::new(v, a, j).unwrap())
}

fn any_sine() -> impl Strategy<Value = Sine> {
    (-1e-2..1e-2f64, magnitude(-1.0, 2.0), 1u32..20).prop_map(|(amplitude, frequency, cycles)| {
        Sine {
            amplitude,
            frequency,
            cycles,
        }
    })
}

fn any_chirp() -> impl Strategy<Value = Chirp> {
    let sweep = prop_oneof![Just(Sweep::Linear), Just(Sweep::Logarithmic)];
    (
        -1e-2..1e-2f64,
        magnitude(-1.0, 2.0),
        magnitude(-1.0, 2.0),
        magnitude(-1.0, 1.0),
        0.02..0.5f64,
        sweep,
    )
        .prop_map(
            |(amplitude, from_frequency, to_frequency, duration, ramp, sweep)| Chirp {
                amplitude,
                from_frequency,
                to_frequency,
                duration,
                ramp: ramp * duration,
                sweep,
            },
        )
}

fn any_oscillation() -> impl Strategy<Value = Oscillation> {
    prop_oneof![
        (-1.0..1.0f64, any_sine()).prop_map(|(about, s)| Oscillation::sine(about, &s).unwrap()),
        (-1.0..1.0f64, any_chirp()).prop_map(|(about, c)| Oscillation::chirp(about, &c).unwrap()),
    ]
}

fn any_step() -> impl Strategy<Value = Step> {
    prop_oneof![
        (-1.0..1.0f64, any_limits()).prop_map(|(to, limits)| Step::Move { to, limits }),
        (-0.1..0.1f64, any_limits()).prop_map(|(by, limits)| Step::MoveBy { by, limits }),
        prop_oneof![Just(0.0), 0.0..1.0f64].prop_map(|duration| Step::Dwell { duration }),
        any_sine().prop_map(Step::Sine),
        any_chirp().prop_map(Step::Chirp),
    ]
}

fn any_program() -> impl Strategy<Value = Program> {
    (-1.0..1.0f64, prop::collection::vec(any_step(), 0..8))
        .prop_map(|(start, steps)| Program::new(start, steps).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn extremes_are_never_passed(program in any_program()) {
        let extremes = program.extremes();
        for i in -1..=3000 {
            let s = program.at(program.duration() * f64::from(i) / 2999.0);
            prop_assert!(s.position >= extremes.position_min && s.position <= extremes.position_max);
            prop_assert!(s.velocity.abs() <= extremes.velocity);
            prop_assert!(s.acceleration.abs() <= extremes.acceleration);
            prop_assert!(s.jerk.abs() <= extremes.jerk);
        }
    }

    /// Each step starts where the last one ended, at rest, and time runs on without a gap.
    #[test]
    fn steps_join_at_rest(program in any_program()) {
        let rounding = 8.0 * f64::EPSILON * program.duration();
        for &t in program.step_times() {
            let (before, after) = (program.at(t - rounding), program.at(t));
            // The step before has all but come to rest: equal measured.
            prop_assert!((before.position - after.position).abs() <= f64::EPSILON);
            prop_assert_eq!((after.velocity, after.acceleration), (0.0, 0.0));
        }
        prop_assert_eq!(program.at(-1.0), Setpoint::at_rest(program.start()));
        prop_assert_eq!(program.at(f64::NAN), Setpoint::at_rest(program.start()));
        prop_assert_eq!(program.at(program.duration()), Setpoint::at_rest(program.end()));
        prop_assert_eq!(program.at(f64::INFINITY), Setpoint::at_rest(program.end()));
    }

    /// Binary search finds what a walk over the steps finds.
    #[test]
    fn search_agrees_with_a_walk(program in any_program(), u in 0.0..1.0f64) {
        let t = u * program.duration();
        let mut present = program.start();
        let mut expected = Setpoint::at_rest(present);
        for (step, &begin) in program.steps().iter().zip(program.step_times()) {
            let alone = Program::new(present, vec![*step]).unwrap();
            if begin <= t {
                expected = alone.at(t - begin);
            }
            present = alone.end();
        }
        if t < program.duration() {
            prop_assert_eq!(program.at(t), expected);
        }
    }

    /// Velocity, acceleration and jerk are the derivatives of position, velocity, acceleration.
    #[test]
    fn oscillations_are_consistent(oscillation in any_oscillation(), u in 0.0..1.0f64) {
        let (begin, end) = oscillation.full_amplitude();
        let duration = oscillation.duration();
        let extremes = oscillation.extremes();
        // A thousandth of the shortest time scale in the motion.
        let h = 1e-3 * (extremes.velocity / extremes.acceleration).min(extremes.acceleration / extremes.jerk);
        let t = h + u * (duration - 2.0 * h);
        // At the ends of the ramps the jerk jumps, and a difference across them means nothing.
        prop_assume!(h > 0.0 && (t - begin).abs() > h && (t - end).abs() > h);
        let (m, s, p) = (oscillation.at(t - h), oscillation.at(t), oscillation.at(t + h));
        // Central differences err by h²/6 of the third derivative, 0.3e-6 of the extreme measured;
        // positions of about 1 m round at 1e-16, which 2h divides.
        let close = |difference: f64, value: f64, scale: f64, rounding: f64| {
            (difference / (2.0 * h) - value).abs() <= 1e-6 * scale + 4.0 * f64::EPSILON * rounding / h
        };
        prop_assert!(close(p.position - m.position, s.velocity, extremes.velocity, 1.0));
        prop_assert!(close(p.velocity - m.velocity, s.acceleration, extremes.acceleration, extremes.velocity));
        prop_assert!(close(p.acceleration - m.acceleration, s.jerk, extremes.jerk, extremes.acceleration));
    }

    /// Position, velocity and acceleration set out from rest and come back to it without a jump.
    #[test]
    fn oscillations_start_and_end_at_rest(oscillation in any_oscillation()) {
        let extremes = oscillation.extremes();
        let duration = oscillation.duration();
        for t in [0.0, duration.next_down()] {
            // Time between this instant and the end, at most one unit in the last place.
            let left = f64::EPSILON * duration;
            let s = oscillation.at(t);
            // Equal measured.
            prop_assert!((s.position - oscillation.about()).abs() <= f64::EPSILON);
            prop_assert!(s.velocity.abs() <= extremes.jerk * left * left);
            prop_assert!(s.acceleration.abs() <= extremes.jerk * left);
        }
        prop_assert_eq!(oscillation.at(duration), Setpoint::at_rest(oscillation.about()));
    }

    /// The safe bounds are not so safe as to be useless.
    #[test]
    fn sine_extremes_are_close(sine in any_sine()) {
        prop_assume!(sine.amplitude != 0.0);
        let oscillation = Oscillation::sine(0.0, &sine).unwrap();
        let mut seen = [0.0f64; 4];
        for i in 0..20_000 {
            let s = oscillation.at(oscillation.duration() * f64::from(i) / 20_000.0);
            let values = [s.position, s.velocity, s.acceleration, s.jerk];
            for (most, value) in seen.iter_mut().zip(values) {
                *most = most.max(value.abs());
            }
        }
        let e = oscillation.extremes();
        let bounds = [e.position_max, e.velocity, e.acceleration, e.jerk];
        // Position and velocity to the sampling (some 1000 a cycle), 3.2e-6 and 6.7e-6
        // measured; the others 0.016 and 0.096, rounded up as documented.
        for ((most, bound), slack) in seen.iter().zip(bounds).zip([2e-5, 3e-5, 0.02, 0.10]) {
            prop_assert!(bound / most - 1.0 <= slack, "{bound} {most}");
        }
    }
}

#[test]
fn sine_at_full_amplitude_is_the_sine() {
    let (amplitude, frequency) = (1e-3, 5.0);
    let sine = Sine {
        amplitude,
        frequency,
        cycles: 10,
    };
    let oscillation = Oscillation::sine(0.6, &sine).unwrap();
    assert_eq!(oscillation.duration(), 2.4);
    let omega = std::f64::consts::TAU * frequency;
    for t in [0.2, 0.25, 0.731, 1.234, 2.19] {
        let s = oscillation.at(t);
        let (sin, cos) = (omega * t).sin_cos();
        // ωt is up to 70 rad, rounded at 1e-14; measured 4.7e-17, 0.3e-14, 0.7e-14, 0.3e-14.
        assert!((s.position - 0.6 - amplitude * sin).abs() < 3e-16);
        assert!((s.velocity - amplitude * omega * cos).abs() < 2e-14 * omega * amplitude);
        assert!(
            (s.acceleration + amplitude * omega.powi(2) * sin).abs()
                < 5e-14 * omega.powi(2) * amplitude
        );
        assert!(
            (s.jerk + amplitude * omega.powi(3) * cos).abs() < 2e-14 * omega.powi(3) * amplitude
        );
    }
}

/// The frequency, counted from zero crossings of the position, follows the sweep.
#[test]
fn chirps_count_the_right_cycles() {
    for (sweep, cycles) in [
        // Means of the frequency over the time: (1 + 9)/2, and (9 − 1)/ln 9; times 10 s.
        (Sweep::Linear, 50.0),
        (Sweep::Logarithmic, 80.0 / 9f64.ln()),
    ] {
        let chirp = Chirp {
            amplitude: 1.0,
            from_frequency: 1.0,
            to_frequency: 9.0,
            duration: 10.0,
            ramp: 1.0,
            sweep,
        };
        let oscillation = Oscillation::chirp(0.0, &chirp).unwrap();
        let signs: Vec<bool> = (1..100_000)
            .map(|i| oscillation.at(f64::from(i) * 1e-4).position > 0.0)
            .collect();
        let crossings = signs.windows(2).filter(|w| w[0] != w[1]).count();
        let half_cycles = 2.0 * cycles;
        // The start is not counted as a crossing; at the end there may be one more or less.
        assert!(
            (crossings as f64 - half_cycles).abs() <= 1.0,
            "{sweep:?}: {crossings} for {half_cycles}"
        );
    }
}

#[test]
fn sweep_between_equal_frequencies_is_a_sine() {
    let mut chirp = Chirp::<f64> {
        amplitude: 1.0,
        from_frequency: 2.0,
        to_frequency: 2.0,
        duration: 10.0,
        ramp: 0.5,
        sweep: Sweep::Linear,
    };
    let linear = Oscillation::chirp(0.0, &chirp).unwrap();
    chirp.sweep = Sweep::Logarithmic;
    let logarithmic = Oscillation::chirp(0.0, &chirp).unwrap();
    assert_eq!(linear.at(3.3), logarithmic.at(3.3));
    // A ratio of 1 + 1e-12 must not lose its digits either.
    chirp.to_frequency = 2.0 * (1.0 + 1e-12);
    let nearly = Oscillation::chirp(0.0, &chirp).unwrap();
    // The phase truly differs by 2π · 1e-12 · 3.3²/10 Hz s²: 5.5e-12 measured.
    assert!((linear.at(3.3).position - nearly.at(3.3).position).abs() < 4e-11);
}

/// Ten thousand dwells of 0.1 s, which is no binary fraction, still last 1000 s.
#[test]
fn many_steps_do_not_drift() {
    let program = Program::new(0.0, vec![Step::Dwell { duration: 0.1 }; 10_000]).unwrap();
    assert_eq!(program.duration(), 1000.0);
}

#[test]
fn empty_program_rests() {
    let program = Program::new(0.5, vec![]).unwrap();
    assert_eq!(program.duration(), 0.0);
    assert_eq!(program.at(0.0), Setpoint::at_rest(0.5));
    assert_eq!(program.at(-1.0), Setpoint::at_rest(0.5));
}

#[test]
fn refusals_name_step_and_field() {
    let message = |step| {
        Program::new(0.0, vec![Step::Dwell { duration: 1.0 }, step])
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        message(Step::Dwell { duration: -1.0 }),
        "step 2 (dwell): duration is -1 s, but must be from 0 to 1e7"
    );
    assert_eq!(
        message(Step::Sine(Sine {
            amplitude: 1.0,
            frequency: 0.0,
            cycles: 1
        })),
        "step 2 (sine): frequency is 0 Hz, but must be from 1e-9 to 1e6"
    );
    let chirp = Chirp {
        amplitude: 1.0,
        from_frequency: 1.0,
        to_frequency: 2.0,
        duration: 1.0,
        ramp: 0.6,
        sweep: Sweep::Linear,
    };
    assert_eq!(
        message(Step::Chirp(chirp)),
        "step 2 (chirp): ramp is 0.6 s, but must be greater than zero and at most half the duration"
    );
    let limits = Limits::new(1.0, 1.0, 1.0).unwrap();
    let error = Program::new(f64::NAN, vec![Step::Move { to: 0.0, limits }]).unwrap_err();
    assert!(matches!(
        error,
        TrajectoryError::Invalid { field: "start", .. }
    ));
    let cycles = Oscillation::sine(
        0.0,
        &Sine {
            amplitude: 1.0,
            frequency: 1.0,
            cycles: 0,
        },
    )
    .unwrap_err();
    assert!(matches!(
        cycles,
        TrajectoryError::Invalid {
            field: "cycles",
            ..
        }
    ));
}
