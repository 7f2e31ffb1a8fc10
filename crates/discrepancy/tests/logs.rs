//! Logs from which nothing may be concluded are refused, with what, where and
//! what would be valid; one that starts in motion is told.

use axis_log::{Channel, Log};
use axis_sim::{Axis, ClosedLoop, Recorder, position_shown};
use compensator::NoCompensation;
use discrepancy::logs::{
    LogSetError, admit, check_distinct, check_log, from_rest, needed_channels,
};
use discrepancy::{LogSet, State};
use trajectories::{Limits, Program, Step};

const PERIOD: f64 = 1e-3;

fn machine(name: &str) -> Axis {
    let file = format!("{}/../../data/axes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Axis::read(file.as_ref()).unwrap()
}

/// A rest, 50 mm out, a rest, back, a rest: half a second each.
fn reference(t: f64) -> f64 {
    let ramp = |share: f64| {
        let s = share.clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    };
    0.7 + 0.05 * (ramp(2.0 * t - 1.0) - ramp(2.0 * t - 3.0))
}

fn log(
    from: f64,
    to: f64,
    reference: impl Fn(f64) -> f64,
    position: impl Fn(f64) -> f64,
    iq: impl Fn(f64) -> f64,
) -> Log {
    let n = ((to - from) / PERIOD).round() as usize;
    let t: Vec<f64> = (0..n).map(|k| from + k as f64 * PERIOD).collect();
    let channel = |name: &str, unit: &str, samples: Vec<f64>| Channel {
        name: name.to_owned(),
        unit: unit.to_owned(),
        samples,
    };
    Log::new(vec![
        channel("t_s", "s", t.clone()),
        channel(
            "position_ref_m",
            "m",
            t.iter().map(|&t| reference(t)).collect(),
        ),
        channel("position_m", "m", t.iter().map(|&t| position(t)).collect()),
        channel("iq_a", "A", t.iter().map(|&t| iq(t)).collect()),
    ])
    .unwrap()
}

fn followed(t: f64) -> f64 {
    reference(t - 2e-3) + 1e-7 * (300.0 * t).sin()
}

fn current(t: f64) -> f64 {
    (40.0 * t).sin()
}

fn refusal(log: &Log) -> String {
    let error = check_log("drive.csv", log, &machine("liu2025")).unwrap_err();
    let message = error.to_string();
    assert!(message.starts_with("drive.csv: "), "{message}");
    message
}

#[test]
fn a_sound_log_gives_its_period() {
    let sound = log(0.0, 2.5, reference, followed, current);
    let period = check_log("drive.csv", &sound, &machine("liu2025")).unwrap();
    assert!((period - PERIOD).abs() < 1e-12);
    let (left, note) = from_rest("drive.csv", sound.clone(), period, &machine("liu2025")).unwrap();
    assert_eq!((left.len(), note), (sound.len(), None));
}

#[test]
fn a_column_in_millimetres_is_named_with_its_scale() {
    let message = refusal(&log(0.0, 2.5, reference, |t| 1e3 * followed(t), current));
    assert!(
        message.contains("millimetres") && message.contains("scale = 0.001"),
        "{message}"
    );
}

#[test]
fn a_constant_channel_is_named() {
    let message = refusal(&log(0.0, 2.5, reference, followed, |_| 0.25));
    assert!(
        message.contains("\"iq_a\"") && message.contains("same value"),
        "{message}"
    );
}

#[test]
fn what_leaves_the_stroke_is_told_with_its_time() {
    // Past 1.25 m, the end of this axis.
    let far = |t: f64| 0.7 + 20.0 * (reference(t) - 0.7);
    let message = refusal(&log(0.0, 2.5, far, far, current));
    assert!(
        message.contains("outside the axis' stroke") && message.contains("t = 0."),
        "{message}"
    );
}

#[test]
fn a_table_that_does_not_follow_is_another_axis() {
    let other = |t: f64| 0.7 + 1e-3 * (5.0 * t).sin();
    let message = refusal(&log(0.0, 2.5, reference, other, current));
    assert!(
        message.contains("not of one axis") && message.contains("t = "),
        "{message}"
    );
}

#[test]
fn a_motion_too_poor_says_what_it_lacks() {
    let message = refusal(&log(0.0, 1.25, reference, followed, current));
    assert!(
        message.contains("one direction only") && message.contains("a move and its return"),
        "{message}"
    );
    let shaking = |t: f64| 0.7 + 1e-8 * (30.0 * t).sin();
    let message = refusal(&log(0.0, 2.5, shaking, shaking, current));
    assert!(message.contains("less than 0.1 mm"), "{message}");
}

#[test]
fn a_check_that_was_fitted_is_refused() {
    let named = |name: &str, log: Log| (name.to_owned(), log, PERIOD);
    let one = || log(0.0, 2.5, reference, followed, current);
    let error = check_distinct(&[named("a.csv", one())], &[named("b.csv", one())]).unwrap_err();
    assert!(
        matches!(&error, LogSetError::SameLog { fit, check } if fit == "a.csv" && check == "b.csv")
    );
    // The same motion once more, with a nanometre of other noise.
    let again = |t: f64| followed(t) + 1e-9 * (777.0 * t).sin();
    let other = log(0.0, 2.5, reference, again, current);
    check_distinct(&[named("a.csv", one())], &[named("b.csv", other)]).unwrap();
}

/// From any row on, from another zero, and where only a part is of the other log.
#[test]
fn a_check_that_was_cut_from_what_was_fitted_is_refused() {
    let named = |name: &str, log: Log| (name.to_owned(), log, PERIOD);
    let fit = || [named("a.csv", log(0.0, 2.5, reference, followed, current))];
    let cut = |from: usize, to: usize, zero: f64| {
        let whole = fit()[0].1.skip(from).unwrap().first(to - from).unwrap();
        let moved = |c: &Channel| {
            let by = if c.unit == "m" { zero } else { 0.0 };
            let samples = c.samples.iter().map(|x| x + by).collect();
            Channel {
                samples,
                ..c.clone()
            }
        };
        Log::new(whole.channels().iter().map(moved).collect()).unwrap()
    };
    for (from, to, zero) in [
        (0, 2500, 0.0),
        (1, 2500, 0.0),
        (437, 2113, 0.0),
        (600, 900, 0.125),
    ] {
        let error = check_distinct(&fit(), &[named("b.csv", cut(from, to, zero))]).unwrap_err();
        assert!(
            matches!(&error, LogSetError::SameLog { .. }),
            "{from}: {error}"
        );
    }
    // Half of it is another run.
    let mut half = cut(500, 1500, 0.0).channels().to_vec();
    for (k, x) in half[2].samples.iter_mut().enumerate().skip(500) {
        *x += 1e-8 * (0.9 * k as f64).sin();
    }
    let half = Log::new(half).unwrap();
    let error = check_distinct(&fit(), &[named("b.csv", half)]).unwrap_err();
    let LogSetError::SharedPart { samples, from, .. } = &error else {
        panic!("{error}");
    };
    assert!((499..=502).contains(samples), "{error}");
    assert!((from - 0.5).abs() < 1e-9, "{error}");
}

/// A replay needs what a controller was given; so does no reading.
#[test]
fn a_slow_log_is_refused_for_a_replay_by_its_rate() {
    let mut slow = log(0.0, 2.5, reference, followed, current)
        .channels()
        .to_vec();
    slow[0].samples.iter_mut().for_each(|t| *t *= 1000.0 / 93.4);
    let message = refusal(&Log::new(slow).unwrap());
    assert!(
        message.contains("93.4000 Hz") && message.contains("100 Hz at least"),
        "{message}"
    );
}

#[test]
fn a_log_that_starts_in_motion_begins_at_its_first_rest_or_is_refused() {
    let cut = log(0.7, 2.5, reference, followed, current);
    let (left, note) = from_rest("drive.csv", cut.clone(), PERIOD, &machine("liu2025")).unwrap();
    // The first rest is from 1.0 to 1.5 s, and half of 0.2 s of it is kept.
    let from = left.time()[0];
    assert!((from - 1.4).abs() < 0.02, "{from}");
    let note = note.unwrap();
    assert!(
        note.contains("starts in motion") && note.contains("left out"),
        "{note}"
    );
    let moving = log(0.6, 0.9, reference, followed, current);
    let error = from_rest("drive.csv", moving, PERIOD, &machine("liu2025")).unwrap_err();
    assert!(
        error.to_string().contains("record from standstill"),
        "{error}"
    );
    // Of its first rest the last move is over.
    let over = log(1.6, 5.0, reference, followed, current);
    let error = from_rest("drive.csv", over, PERIOD, &machine("liu2025")).unwrap_err();
    assert!(
        error.to_string().contains("before its last move"),
        "{error}"
    );
    // A rigid machine can begin anywhere.
    let (left, note) = from_rest("drive.csv", cut.clone(), PERIOD, &machine("emps")).unwrap();
    assert_eq!(left.len(), cut.len());
    assert!(note.unwrap().contains("taken from its first samples"));
}

#[test]
fn a_turned_sign_is_refused_with_the_lines_that_mend_it() {
    let turned = log(0.0, 2.5, reference, |t| -followed(t), current);
    let message = refusal(&turned);
    for part in [
        "except for its sign",
        "[[log.column]]",
        "\"position_m\"",
        "factor = -1",
    ] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn a_long_hole_is_refused_and_a_short_one_has_no_weight() {
    let sound = log(0.0, 2.5, reference, followed, current);
    let hole = |samples: usize| {
        let mut log = sound.clone();
        log.mark_missing("iq_a", std::iter::once(300..300 + samples))
            .unwrap();
        log
    };
    let message = refusal(&hole(6));
    assert!(
        message.contains("6 samples from t = 0.3000 s") && message.contains("iq_a"),
        "{message}"
    );
    let machine = machine("liu2025");
    let period = check_log("drive.csv", &hole(5), &machine).unwrap();
    let set = LogSet::new(vec![("drive.csv".to_owned(), hole(5), period)], &machine).unwrap();
    let traces = set.simulate(&machine, &State::initial(&machine)).unwrap();
    let channel = set.channels.iter().position(|c| *c == "iq_a").unwrap();
    let rest = &set.rest(&traces)[0][channel];
    assert!(rest[300..305].iter().all(|r| *r == 0.0));
    assert!(rest[299] != 0.0 && rest[305] != 0.0);
}

/// A robot joint has no sensor at its load: a log of the motor's angle and the command is all that its drive has. Its log
/// was refused for want of `position_rad`.
#[test]
fn a_joint_without_a_sensor_at_the_load_is_replayed_by_its_motors_angle() {
    let joint = machine("joint");
    let start = joint.stroke.start;
    let limits = Limits::new(0.8, 3.0, 30.0).unwrap();
    let turn = |to: f64| Step::Move { to, limits };
    let rest = Step::Dwell { duration: 0.3 };
    let steps = vec![rest, turn(start + 0.4), rest, turn(start + 0.1), rest];
    let program = Program::new(start, steps).unwrap();
    let mut recorder = Recorder::new(&joint);
    ClosedLoop::new(&joint)
        .unwrap()
        .without_noise()
        .run(&program, &mut NoCompensation, |c| recorder.push(c))
        .completed()
        .unwrap();
    let whole = recorder.log().unwrap();
    let without = |names: &[&str]| {
        let kept = whole.channels().iter();
        let kept = kept.filter(|c| !names.contains(&c.name.as_str()));
        Log::new(kept.cloned().collect()).unwrap()
    };
    assert_eq!(needed_channels(&joint), ["position_ref_rad"]);
    let log = without(&["position_rad"]);
    let shown = position_shown(&log, &joint).unwrap();
    let own = whole.channel("position_rad").unwrap();
    // Homed on the reference, and not where the encoder's step left it.
    let off = shown.iter().zip(own).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-6);
    let (_, log, period) = admit("joint.csv".to_owned(), log, &joint, &mut Vec::new()).unwrap();
    let logs = vec![("joint.csv".to_owned(), log, period)];
    let set = LogSet::new(logs, &joint).unwrap();
    assert_eq!(set.channels, ["motor_angle_rad", "torque_ref_n_m"]);
    let rest = set.rest(&set.simulate(&joint, &State::initial(&joint)).unwrap());
    let most = |c: usize| rest[0][c].iter().fold(0.0_f64, |most, r| most.max(r.abs()));
    println!("{:.1e} rad, {:.1e} N·m", most(0), most(1));
    assert!(most(0) < 1e-2 && most(1) < 0.02, "{} {}", most(0), most(1));
    // Nothing shows where the arm is:
    let blind = without(&["position_rad", "motor_angle_rad"]);
    let error = check_log("joint.csv", &blind, &joint)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("motor_angle_rad") && error.contains("position_rad"),
        "{error}"
    );
    // With a sensor at the load its channel is needed.
    let needed = needed_channels(&machine("rack"));
    assert_eq!(needed, ["position_ref_m", "position_m"]);
}
