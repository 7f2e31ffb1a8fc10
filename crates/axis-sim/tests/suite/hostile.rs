//! Values that nobody should give, to everything that is public: no panic, and
//! an end.

use axis_log::{Channel, Log};
use axis_sim::effects::{ActiveEffect, EFFECTS};
use axis_sim::mechanism::SolutionMethod;
use axis_sim::{Axis, ClosedLoop, CycleInput, LoggedReference, OneCycle, Probe, Replay, SixDigits};
use compensator::NoCompensation;
use proptest::prelude::*;
use trajectories::{Limits, Motion, SCurve};

use crate::{OTHERS, PRINTED, RIGID, axis, text};

/// Any number at all: the odd ones often.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        -10.0..10.0_f64,
        prop::sample::select(vec![
            0.0,
            -0.0,
            1.0,
            1e-300,
            1e9,
            1e20,
            1e300,
            f64::MIN_POSITIVE,
            f64::MAX,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ]),
    ]
}

/// A log of a short move with `samples` instants.
fn log(samples: usize) -> Log {
    let t = (0..samples).map(|k| k as f64 * 1e-3);
    let position = |t: f64| 0.6 + 0.1 * t * t;
    Log::new(vec![
        Channel::new("t_s", t.clone().collect()).unwrap(),
        Channel::new("position_ref_m", t.clone().map(position).collect()).unwrap(),
        Channel::new("position_m", t.map(position).collect()).unwrap(),
    ])
    .unwrap()
}

fn machines() -> [Axis; 2] {
    [PRINTED, RIGID].map(axis)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn single_cycles(
        position in any_number(), speed in any_number(),
        acceleration in any_number(), command in any_number()
    ) {
        let one = OneCycle::new(&axis(PRINTED)).unwrap();
        let _ = one.increment(&CycleInput { position, speed, acceleration, command });
    }

    #[test]
    fn effects_with_any_values(
        which in 0..EFFECTS.len(), values in prop::collection::vec(any_number(), 0..5)
    ) {
        let effect = EFFECTS[which];
        let replay = Replay::new(&log(20), 1e-3).unwrap();
        for machine in &machines() {
            let active = ActiveEffect { effect, values: values.clone() };
            // Run, or refused.
            let _ = replay.run(machine, &[active.clone(), active], None);
            let _ = effect.applies_to(machine);
        }
    }

    #[test]
    fn replays_of_any_log(
        samples in 1..8_usize, period in any_number(), t in any_number(),
        probe in prop::collection::vec(any_number(), 0..4)
    ) {
        if let Ok(reference) = LoggedReference::new(&log(samples), period) {
            let at = reference.at(t);
            if t.is_nan() || t <= -period {
                prop_assert_eq!((at.position, at.velocity), (0.6, 0.0));
            }
        }
        for machine in &machines() {
            // As long as a log may be is longer than a test may take.
            if let Ok(replay) = Replay::new(&log(samples), period) && !(1.0..1e6).contains(&period) {
                let probe: std::sync::Arc<[f64]> = probe.clone().into();
                let _ = replay.run(machine, &[], Some(&Probe::Load(probe.clone())));
                let _ = replay.run(machine, &[], Some(&Probe::Offset(probe)));
            }
        }
    }

    #[test]
    fn machines_with_any_period_and_step(
        period in prop_oneof![any_number(), 1e-6..1e-2_f64],
        step in prop_oneof![any_number(), 1e-7..1e-2_f64]
    ) {
        let limits = Limits::new(1.0, 100.0, 1e5).unwrap();
        let motion = SCurve::plan(0.6, 0.6001, &limits).unwrap();
        for method in [SolutionMethod::Fast, SolutionMethod::Exact] {
            let mut axis = axis(PRINTED);
            (axis.period, axis.simulation.step, axis.simulation.method) = (period, step, method);
            if let Ok(closed_loop) = ClosedLoop::new(&axis)
                && closed_loop.steps(&motion) < 1e6
            {
                closed_loop.run(&motion, &mut NoCompensation, |_| ());
            }
            let _ = OneCycle::new(&axis).map(|one| one.increment(&CycleInput::default()));
        }
        let mut axis = axis(RIGID);
        (axis.period, axis.simulation.step) = (period, step);
        // What is refused, or what a test has the time for.
        let steps = (2e-3 / period + 1.0) * (period / step + 1.0);
        if !(1e6..2e10).contains(&steps) {
            let _ = Replay::new(&log(3), 1e-3).unwrap().run(&axis, &[], None);
        }
    }

    /// Six digits at most, and the number to six digits.
    #[test]
    fn six_digits(value in any_number()) {
        let text = SixDigits(value).to_string();
        let digits = text.split('e').next().unwrap().trim_start_matches(['-', '0', '.']);
        // Zeros before the point are no significant digits.
        let digits = if text.contains('.') { digits } else { digits.trim_end_matches('0') };
        prop_assert!(digits.chars().filter(char::is_ascii_digit).count() <= 6, "{text}");
        let read: f64 = text.parse().unwrap();
        let near = (read - value).abs() <= 5.001e-6 * value.abs();
        prop_assert!(near || read == value || (value.is_nan() && read.is_nan())
            || value.abs() > 1.79769e308, "{text} {value:e}");
    }
}

/// Lines of a file whose value is a number, with key and value.
fn numbers(content: &str) -> Vec<(usize, String)> {
    let lines = content.lines().enumerate();
    lines
        .filter_map(|(i, line)| {
            let (key, value) = line.split('#').next()?.split_once('=')?;
            value.trim().parse::<f64>().ok()?;
            Some((i, key.trim().to_owned()))
        })
        .collect()
}

fn with_values(content: &str, values: &[(usize, f64)]) -> String {
    let places = numbers(content);
    let mut lines: Vec<String> = content.lines().map(str::to_owned).collect();
    for (which, value) in values {
        let (i, key) = &places[which % places.len()];
        lines[*i] = format!("{key} = {value:e}");
    }
    lines.join("\n")
}

/// Values over the whole range of exponents that a file may have.
fn wild() -> impl Strategy<Value = f64> {
    (any::<bool>(), -9.0..9.0_f64, any_number()).prop_map(|(odd, exponent, any)| {
        if odd { any } else { 10_f64.powf(exponent) }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    /// Files with wild values are refused, or their axis is planned, set up and
    /// run for fifty cycles; how long a run takes is known before, so that one without end is refused and this ends.
    #[test]
    fn files_with_any_values(
        which in 0..2 + OTHERS.len(),
        values in prop::collection::vec((0..200_usize, wild()), 1..4)
    ) {
        let content = with_values(&text([PRINTED, RIGID].iter().chain(&OTHERS).nth(which).unwrap()), &values);
        match Axis::parse("axis.toml", &content) {
            Err(error) => prop_assert!(error.to_string().starts_with("axis.toml:")),
            Ok(axis) if which == 1 => {
                let log = log(50);
                // Fifty periods, whatever their length.
                let replay = Replay::new(&log, axis.period).unwrap();
                let _ = replay.run(&axis, &[], None);
            }
            Ok(axis) => fifty_cycles(&axis),
        }
    }
}

fn fifty_cycles(axis: &Axis) {
    let plans = axis
        .trajectories
        .iter()
        .map(|spec| axis.plan(spec).unwrap());
    let Ok(closed_loop) = ClosedLoop::new(axis) else {
        return;
    };
    for motion in plans {
        assert!(closed_loop.steps(&motion) <= axis_sim::MOST_STEPS);
    }
    struct Fifty(f64, f64);
    impl Motion for Fifty {
        fn duration(&self) -> f64 {
            50.0 * self.1
        }
        fn at(&self, t: f64) -> trajectories::Setpoint {
            trajectories::Setpoint {
                velocity: 1e-3,
                ..trajectories::Setpoint::at_rest(self.0 + 1e-3 * t)
            }
        }
    }
    let motion = Fifty(axis.stroke.start, axis.period);
    closed_loop.run(&motion, &mut NoCompensation, |_| ());
}

/// A file that goes on for ever is not read for ever.
#[test]
#[cfg(unix)]
fn a_file_without_end() {
    let error = Axis::read("/dev/zero".as_ref()).unwrap_err();
    assert!(error.to_string().contains("1 MiB"), "{error}");
}
