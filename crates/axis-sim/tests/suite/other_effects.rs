//! Effects on the axes of the other mechanisms.

use axis_log::Log;
use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, Nature, Scales};
use axis_sim::{Axis, ClosedLoop, Recorder, Replay, Trace};
use compensator::NoCompensation;
use trajectories::{Limits, SCurve};

use crate::{OTHERS, axis};

/// A motion over a hundredth of the stroke.
fn log(axis: &Axis) -> Log {
    let spec = &axis.trajectories[1].limits;
    let way = 0.01 * (axis.stroke.maximum - axis.stroke.minimum);
    let limits = Limits::new(spec.velocity(), spec.acceleration(), spec.jerk()).unwrap();
    let start = axis.stroke.start;
    let motion = SCurve::plan(start, start + way, &limits).unwrap();
    let mut recorder = Recorder::new(axis);
    ClosedLoop::new(axis)
        .unwrap()
        .without_noise()
        .run(&motion, &mut NoCompensation, |c| recorder.push(c))
        .completed()
        .unwrap();
    recorder.log().unwrap()
}

/// Typical values, their places and times inside the motion.
fn typical(effect: &Effect, axis: &Axis, duration: f64) -> Vec<f64> {
    let mut values = effect.typical(&Scales::of(axis));
    for (value, p) in values.iter_mut().zip(effect.parameters) {
        match p.nature {
            Nature::Place(_) => *value = axis.stroke.start,
            Nature::Begin(_) => *value = 0.2 * duration,
            Nature::End(_) => *value = 0.6 * duration,
            _ => {}
        }
    }
    values
}

fn same(a: &Trace, b: &Trace) -> bool {
    a.channels == b.channels && a.speed == b.speed
}

#[test]
fn each_that_fits_changes_the_log_and_nothing_at_its_null_value() {
    let mut fitting = Vec::new();
    for file in OTHERS {
        let axis = axis(file);
        let log = log(&axis);
        let replay = Replay::new(&log, axis.period).unwrap();
        let duration = log.time()[log.len() - 1];
        let run = |effects: &[ActiveEffect]| replay.run(&axis, effects, None).unwrap();
        let without = run(&[]);
        // The replay of its own log is the log.
        for (name, samples) in &without.channels {
            let logged = log.channel(name).unwrap();
            let far = samples.iter().zip(logged).map(|(a, b)| (a - b).abs());
            assert!(far.fold(0.0, f64::max) == 0.0, "{file} {name}");
        }
        let mut fits = 0;
        for effect in EFFECTS.iter().copied() {
            if effect.applies_to(&axis).is_err() {
                continue;
            }
            fits += 1;
            let with = |values| run(&[ActiveEffect { effect, values }]);
            let null = with(effect.null(&Scales::of(&axis)));
            assert!(same(&without, &null), "{file} {}", effect.name);
            let typical = with(typical(effect, &axis, duration));
            let differs = without.channels.iter().zip(&typical.channels);
            let differs = differs.into_iter().any(|(a, b)| a != b);
            assert!(differs, "{file} {}", effect.name);
        }
        fitting.push(fits);
    }
    // Of 40: a torque or force source has no currents, poles or dead time (5), Coulomb's
    // friction no bristle stiffness, motor and load as one no transmission, encoder or
    // inertia of the motor's own (11), a PID no velocity feed-forward. Only a load that
    // turns is out of balance, only a linear motor with poles has their pitch, and only one
    // that turns has cogging.
    assert_eq!(EFFECTS.len(), 40);
    assert_eq!(fitting, [32, 38, 34, 27, 26, 20, 38]);
}
