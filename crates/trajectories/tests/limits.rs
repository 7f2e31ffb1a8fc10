//! Values of any kind, whatever they are: a motion that can be sampled anywhere, or an error that
//! names the field and what would be valid.
#![cfg(feature = "alloc")]

use proptest::prelude::*;
use trajectories::{
    Chirp, Extremes, Limits, Motion, Oscillation, Program, SCurve, Sine, Step, Sweep,
    TrajectoryError, maximum,
};

/// All bit patterns, and magnitudes of which some are valid.
fn any_number() -> impl Strategy<Value = f64> {
    let special = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        0.0,
        -0.0,
        5e-324,
        1e-9,
        1e6,
        1e9,
    ];
    prop_oneof![
        1 => any::<f64>(),
        4 => (-20.0..20.0f64).prop_map(|x| 10f64.powf(x)),
        2 => -2.0..2.0f64,
        1 => prop::sample::select(special.to_vec()),
    ]
}

fn any_step() -> impl Strategy<Value = Step> {
    let numbers = prop::array::uniform5(any_number());
    (numbers, 0..5, any::<u32>(), any::<bool>()).prop_map(|(v, kind, cycles, sweep)| {
        let limits = Limits::new(v[1], v[2], v[3]).unwrap_or(Limits::new(0.1, 1.0, 10.0).unwrap());
        match kind {
            0 => Step::Move { to: v[0], limits },
            1 => Step::MoveBy { by: v[0], limits },
            2 => Step::Dwell { duration: v[0] },
            3 => Step::Sine(Sine {
                amplitude: v[0],
                frequency: v[1],
                cycles: cycles % if sweep { 20 } else { u32::MAX },
            }),
            _ => Step::Chirp(Chirp {
                amplitude: v[0],
                from_frequency: v[1],
                to_frequency: v[2],
                duration: v[3],
                ramp: v[4],
                sweep: if sweep {
                    Sweep::Linear
                } else {
                    Sweep::Logarithmic
                },
            }),
        }
    })
}

/// Every number finite, wherever it is sampled, and within what the motion says of itself.
fn is_sound(motion: &impl Motion, extremes: Extremes, times: &[f64]) -> bool {
    let duration = motion.duration();
    let inside = (0..=20).map(|i| duration * f64::from(i) / 20.0);
    (0.0..=maximum::DURATION).contains(&duration)
        && inside.chain(times.iter().copied()).all(|t| {
            let s = motion.at(t);
            s.position >= extremes.position_min
                && s.position <= extremes.position_max
                && s.velocity.abs() <= extremes.velocity
                && s.acceleration.abs() <= extremes.acceleration
                && s.jerk.abs() <= extremes.jerk
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn any_program_is_refused_or_sound(
        start in prop_oneof![-1.0..1.0f64, any_number()],
        steps in prop::collection::vec(any_step(), 0..4),
        times in prop::array::uniform4(any_number()),
    ) {
        match Program::new(start, steps) {
            Ok(program) => prop_assert!(is_sound(&program, program.extremes(), &times), "{program:?}"),
            Err(error) => prop_assert!(error.to_string().contains("must be") || error.to_string().contains("64-bit"), "{error}"),
        }
    }

    #[test]
    fn any_move_is_refused_or_sound(
        ends in prop::array::uniform2(any_number()), v in prop::array::uniform3(any_number()),
        times in prop::array::uniform4(any_number()),
    ) {
        let Ok(limits) = Limits::new(v[0], v[1], v[2]) else { return Ok(()) };
        if let Ok(curve) = SCurve::plan(ends[0], ends[1], &limits) {
            prop_assert!(is_sound(&curve, curve.extremes(), &times), "{curve:?}");
            prop_assert!(curve.segments().iter().all(|s| s.duration >= 0.0 && s.start.is_finite()));
            prop_assert!(curve.cruise().is_none_or(|(begin, end)| begin < end));
        }
    }

    #[test]
    fn any_oscillation_is_refused_or_sound(
        about in any_number(), step in any_step(), times in prop::array::uniform4(any_number()),
    ) {
        let made = match step {
            Step::Sine(sine) => Oscillation::sine(about, &sine),
            Step::Chirp(chirp) => Oscillation::chirp(about, &chirp),
            _ => return Ok(()),
        };
        if let Ok(oscillation) = made {
            prop_assert!(is_sound(&oscillation, oscillation.extremes(), &times), "{oscillation:?}");
            let (begin, end) = oscillation.full_amplitude();
            prop_assert!(begin <= end);
        }
    }
}

/// Each limit is told, with the value and the unit.
#[test]
fn absurd_values_are_refused_with_the_limit() {
    let refused = |step| {
        let message = Program::new(0.0, vec![step]).unwrap_err().to_string();
        message.split_once("): ").unwrap().1.to_owned()
    };
    let sine = |amplitude, frequency, cycles| {
        Step::Sine(Sine {
            amplitude,
            frequency,
            cycles,
        })
    };
    assert_eq!(
        refused(sine(1e-3, 1e23, 1)),
        "frequency is 100000000000000000000000 Hz, but must be from 1e-9 to 1e6"
    );
    assert!(refused(sine(1e10, 1.0, 1)).starts_with("amplitude is 10000000000 m"));
    assert!(refused(sine(1.0, 1e-3, 20_000)).starts_with("duration is 20002000 s"));
    assert!(refused(sine(1.0, 1e6, 2_000_000_000)).starts_with("total cycles is 2000000002"));
    let chirp = |to_frequency, duration| {
        Step::Chirp(Chirp {
            amplitude: 1e-3,
            from_frequency: 1.0,
            to_frequency,
            duration,
            ramp: 0.1,
            sweep: Sweep::Linear,
        })
    };
    assert!(refused(chirp(1e23, 1.0)).starts_with("to_frequency is"));
    assert!(refused(chirp(2.0, 1e8)).starts_with("duration is 100000000 s"));
    assert!(refused(Step::Dwell { duration: 1e8 }).contains("from 0 to 1e7"));
    let limits = Limits::new(1.0, 1.0, 1.0).unwrap();
    assert!(refused(Step::Move { to: 1e10, limits }).starts_with("to is 10000000000 m"));
    assert!(refused(Step::MoveBy { by: 1e10, limits }).starts_with("by is 10000000000 m"));
    let limits = Limits::new(1e4, 1e4, 1e4).unwrap();
    let away = [
        Step::Move { to: 9e8, limits },
        Step::MoveBy { by: 9e8, limits },
    ];
    let message = Program::new(0.0, away.to_vec()).unwrap_err().to_string();
    assert!(
        message.contains("end of the step is 1800000000 m"),
        "{message}"
    );
    let long = vec![Step::Dwell { duration: 9e6 }; 2];
    let message = Program::new(0.0, long).unwrap_err().to_string();
    assert!(
        message.contains("time at the end of the step is 18000000 s"),
        "{message}"
    );
    let many = vec![Step::Dwell { duration: 0.0 }; maximum::STEPS + 1];
    let message = Program::new(0.0, many).unwrap_err().to_string();
    assert!(message.contains("number of steps is 100001"), "{message}");
    for (v, a, j, field) in [
        (1e10, 1.0, 1.0, "velocity"),
        (1.0, 1e10, 1.0, "acceleration"),
        (1.0, 1.0, 1e16, "jerk"),
    ] {
        let error = Limits::new(v, a, j).unwrap_err();
        assert!(matches!(error, TrajectoryError::Invalid { field: f, .. } if f == field));
    }
}

#[cfg(feature = "serde")]
proptest! {
    /// Files with any numbers: a sound program, or a refusal that says where.
    #[test]
    fn any_file_is_refused_or_sound(v in prop::array::uniform6(any_number()), kind in 0..5, cycles: i64) {
        let step = match kind {
            0 => format!("move = {{ to_mm = {:?}, velocity_mm_s = {:?}, acceleration_mm_s2 = {:?}, jerk_mm_s3 = {:?} }}", v[0], v[1], v[2], v[3]),
            1 => format!("move_by = {{ by_mm = {:?}, velocity_mm_s = {:?}, acceleration_mm_s2 = {:?}, jerk_mm_s3 = {:?} }}", v[0], v[1], v[2], v[3]),
            2 => format!("dwell = {{ duration_s = {:?} }}", v[0]),
            3 => format!("sine = {{ amplitude_mm = {:?}, frequency_hz = {:?}, cycles = {cycles} }}", v[0], v[1]),
            _ => format!("chirp = {{ amplitude_mm = {:?}, from_frequency_hz = {:?}, to_frequency_hz = {:?}, duration_s = {:?} }}", v[0], v[1], v[2], v[3]),
        };
        let text = format!("start_mm = {:?}\n[[steps]]\n{step}\n", v[4] % 100.0).replace("NaN", "nan");
        match toml::from_str::<Program>(&text) {
            Ok(program) => prop_assert!(is_sound(&program, program.extremes(), &[v[5]])),
            Err(error) => {
                let message = error.to_string();
                let placed = ["step 1 (", "start is", "line 3"].iter().any(|place| message.contains(place));
                prop_assert!(placed, "{text}: {message}");
            }
        }
    }

    /// Text of any kind is refused without a panic.
    #[test]
    fn any_text_is_refused_or_read(text in "(start_mm|steps|move|=|\\[|\\]|\\{|\\}|[0-9.e+\"-]|nan|inf|\n| ){0,40}") {
        let _ = toml::from_str::<Program>(&text);
    }
}
