//! Logs that begin anywhere: cut out of a longer run, under loads that were held for long,
//! with what earlier moves have left. The stored state is the run's own; a replay is told
//! nothing of it but the log.

use axis_log::{Channel, Log};
use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, ClosedLoop, Recorder, Replay, Stored, reference_in};
use compensator::NoCompensation;
use discrepancy::logs::{from_rest, set_apart};
use discrepancy::{Answer, Fitter, LogSet, State};
use trajectories::{Limits, Program, Step};

/// An axis whose sensors are perfect, so that nothing but the start makes a rest.
fn machine(name: &str) -> Axis {
    let file = format!("{}/../../data/axes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut axis = Axis::read(file.as_ref()).unwrap();
    axis.sensors = axis_sim::Sensors::default();
    // No log shows in which cycle a slower loop begins.
    if axis.control.values().optional("position_rate").is_some() {
        let rate = 1.0 / axis.period;
        axis.control
            .change(|v| v.set("position_rate", rate))
            .unwrap();
    }
    axis
}

fn with(machine: &Axis, effects: &[ActiveEffect]) -> Axis {
    let mut axis = machine.clone();
    axis.effects.extend_from_slice(effects);
    axis
}

fn load(force: f64) -> ActiveEffect {
    ActiveEffect {
        effect: Effect::named("constant-load").unwrap(),
        values: vec![force],
    }
}

/// Force at which the axis' friction breaks away, N.
fn break_away(machine: &Axis) -> f64 {
    let lever = machine.friction.lever(machine.travel_per_radian());
    machine.friction.law.parameters().coulomb / lever
}

fn program(from: f64, steps: &[(f64, f64)]) -> Program {
    let moves = steps.iter().flat_map(|&(to, rest)| {
        let limits = Limits::new(0.05, 0.5, 10.0).unwrap();
        let turn = Step::Move { to, limits };
        [turn, Step::Dwell { duration: rest }]
    });
    let first = Step::Dwell { duration: 0.15 };
    Program::new(from, std::iter::once(first).chain(moves).collect()).unwrap()
}

/// The log of `logged`, which follows on `earlier` without a break, of an axis that stood
/// under all its loads before. All channels, at the control's rate.
fn cut_out(axis: &Axis, earlier: &Program, logged: &Program) -> Log {
    let closed_loop = ClosedLoop::new(axis).unwrap();
    let start = axis_sim::Start::at(trajectories::Motion::at(earlier, 0.0).position);
    let mut state = closed_loop.start(&start).unwrap();
    let mut run = |motion: &Program, recorder: &mut Recorder| {
        let observe = |cycle: &axis_sim::Cycle| recorder.push(cycle);
        closed_loop
            .run_from(&mut state, motion, &mut NoCompensation, |_| (), observe)
            .completed()
            .unwrap();
    };
    run(earlier, &mut Recorder::new(axis));
    let mut recorder = Recorder::new(axis);
    run(logged, &mut recorder);
    recorder.log().unwrap()
}

fn only(log: &Log, names: &[&str]) -> Log {
    let all = log.channels().iter();
    let kept = all.filter(|c| names.contains(&c.name.as_str()));
    Log::new(kept.cloned().collect()).unwrap()
}

fn set_of(machine: &Axis, log: &Log) -> LogSet {
    LogSet::new(
        vec![("cut.csv".to_owned(), log.clone(), machine.period)],
        machine,
    )
    .unwrap()
}

/// Largest departure of the position from a log, m: with what the log shows to be stored at
/// its start, and with nothing stored.
fn departures(machine: &Axis, log: &Log, effects: Vec<ActiveEffect>) -> [f64; 2] {
    let state = State {
        effects,
        ..State::initial(machine)
    };
    let mut set = set_of(machine, log);
    let place = set
        .channels
        .iter()
        .position(|c| *c == "position_m")
        .unwrap();
    let most = |set: &LogSet| {
        let rest = set.rest(&set.simulate(machine, &state).unwrap());
        rest[0][place].iter().fold(0.0_f64, |m, r| m.max(r.abs()))
    };
    let stored = most(&set);
    let replay = Replay::new(log, machine.period).unwrap();
    set.logs[0].answer = Answer::Replay(Box::new(replay));
    [stored, most(&set)]
}

/// Where motion was earlier and is logged: mid-stroke, both ways.
fn motions(machine: &Axis) -> [Program; 2] {
    let x = machine.stroke.start + 0.02;
    let earlier = program(x, &[(x + 0.012, 1.5)]);
    [
        earlier,
        program(x + 0.012, &[(x + 0.02, 0.15), (x + 0.008, 0.15)]),
    ]
}

#[test]
fn a_log_after_an_earlier_move_begins_with_what_that_has_left() {
    for name in ["rack", "liu2025"] {
        let machine = machine(name);
        let [earlier, logged] = motions(&machine);
        let log = cut_out(&machine, &earlier, &logged);
        let [stored, nothing] = departures(&machine, &log, Vec::new());
        println!("{name}: {stored:e} m, {nothing:e} m with nothing stored");
        assert!(stored < 0.02 * nothing, "{name}: {stored:e} {nothing:e}");
    }
}

/// Less than friction could hold, and more.
#[test]
fn a_load_that_was_there_for_long_is_held_from_the_first_sample_on() {
    for name in ["rack", "liu2025"] {
        let machine = machine(name);
        for share in [0.6, -1.3] {
            let hidden = load(share * break_away(&machine));
            let [earlier, logged] = motions(&machine);
            let axis = with(&machine, std::slice::from_ref(&hidden));
            let log = cut_out(&axis, &earlier, &logged);
            let [stored, nothing] = departures(&machine, &log, vec![hidden]);
            println!("{name}, {share}: {stored:e} m, {nothing:e} m with nothing stored");
            assert!(stored < 0.02 * nothing, "{name}: {stored:e} {nothing:e}");
        }
    }
}

#[test]
fn a_log_that_begins_with_its_machine_has_nothing_stored_or_the_same_bits() {
    let machine = machine("rack");
    let [_, logged] = motions(&machine);
    let log_of = |axis: &Axis| {
        let mut recorder = Recorder::new(axis);
        ClosedLoop::new(axis)
            .unwrap()
            .run(&logged, &mut NoCompensation, |cycle| recorder.push(cycle))
            .completed()
            .unwrap();
        recorder.log().unwrap()
    };
    let stored = |set: &LogSet| set.logs[0].answer.replay().unwrap().stored();
    // A load that comes up with the log.
    let comes_up = log_of(&with(&machine, &[load(0.5 * break_away(&machine))]));
    assert_eq!(stored(&set_of(&machine, &comes_up)), Stored::Nothing);

    let clean = log_of(&machine);
    let set = set_of(&machine, &clean);
    assert_eq!(stored(&set), Stored::InBristles);
    let own = set.simulate(&machine, &State::initial(&machine)).unwrap();
    let replay = Replay::new(&clean, machine.period).unwrap();
    let plain = replay.run(&machine, &[], None).unwrap();
    assert_eq!(own[0].channels, plain.channels);
}

/// Reference and position tell no command: what the bristles hold is then an unknown.
#[test]
fn where_no_command_is_logged_what_bristles_hold_is_found() {
    let machine = machine("rack");
    let [earlier, logged] = motions(&machine);
    let log = cut_out(&machine, &earlier, &logged);
    let log = only(&log, &["t_s", "position_ref_m", "position_m"]);
    let state = State::initial(&machine);
    let mut set = set_of(&machine, &log);
    let most = |set: &LogSet| {
        let rest = set.rest(&set.simulate(&machine, &state).unwrap());
        rest[0][0].iter().fold(0.0_f64, |m, r| m.max(r.abs()))
    };
    let free = most(&set);
    set.find_stored(&machine, &state).unwrap();
    let found = most(&set);
    println!("{found:e} m, {free:e} m with free bristles");
    assert!(found < 0.1 * free, "{found:e} {free:e}");
}

/// Any zero and many turns; the position anywhere on the stroke.
#[test]
fn the_angle_counts_from_anywhere() {
    let machine = machine("rack");
    let [earlier, logged] = motions(&machine);
    let log = cut_out(&machine, &earlier, &logged);
    let turned = |c: &Channel| {
        let by = if c.name == "motor_angle_rad" {
            -4321.25
        } else {
            0.0
        };
        Channel {
            samples: c.samples.iter().map(|v| v + by).collect(),
            ..c.clone()
        }
    };
    let other = Log::new(log.channels().iter().map(turned).collect()).unwrap();
    let deviance = |log: &Log| {
        let set = set_of(&machine, log);
        let fitter = Fitter {
            machine: &machine,
            set: &set,
        };
        fitter.at(State::initial(&machine)).unwrap().rest
    };
    for (a, b) in deviance(&log).iter().zip(&deviance(&other)) {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).norm() < 1e-9, "{a} {b}");
        }
    }
}

/// Cut in motion: what lies before the first standstill is left out, and that standstill has stored
/// what the move before it has left.
#[test]
fn a_log_cut_in_motion_begins_with_what_its_first_rest_has_stored() {
    let machine = machine("liu2025");
    let x = machine.stroke.start;
    let whole = program(x, &[(x + 0.05, 0.6), (x + 0.03, 0.3)]);
    let hidden = load(0.6 * break_away(&machine));
    let far = program(x - 0.01, &[(x, 0.3)]);
    let log = cut_out(&with(&machine, std::slice::from_ref(&hidden)), &far, &whole);
    let moving = log.skip((0.6 / machine.period) as usize).unwrap();
    let (left, note) = from_rest("cut.csv", moving, machine.period, &machine).unwrap();
    assert!(note.unwrap().contains("first standstill"));
    let [stored, nothing] = departures(&machine, &left, vec![hidden]);
    println!("{stored:e} m, {nothing:e} m with nothing stored");
    // The loop has had half a second to settle, with a time constant of a fifth of it.
    assert!(stored < 0.1 * nothing, "{stored:e} {nothing:e}");
}

#[test]
fn figures_come_from_logs_that_took_no_part_where_there_can_be_such() {
    let machine = machine("rack");
    let x = machine.stroke.start;
    let to_and_fro = program(x, &[(x + 0.02, 0.3), (x, 0.3), (x + 0.01, 0.3), (x, 0.3)]);
    let earlier = program(x, &[(x, 0.1)]);
    let log = cut_out(&machine, &earlier, &to_and_fro);
    let named = |name: &str, log: &Log| (name.to_owned(), log.clone(), machine.period);

    let (check, test) = set_apart(vec![named("a", &log), named("b", &log)], &machine);
    assert_eq!((check[0].0.as_str(), test[0].0.as_str()), ("a", "b"));

    let (check, test) = set_apart(vec![named("a", &log)], &machine);
    let (before, after) = (&check[0].1, &test[0].1);
    assert_eq!(before.len() + after.len(), log.len());
    assert_eq!(after.time()[0], log.time()[before.len()]);
    let at = reference_in(after).unwrap();
    assert!((at[0] - x).abs() < 1e-6, "not at rest: {}", at[0]);

    // One way and back is not to be cut.
    let short = cut_out(
        &machine,
        &earlier,
        &program(x, &[(x + 0.01, 0.3), (x, 0.3)]),
    );
    let (check, test) = set_apart(vec![named("a", &short)], &machine);
    assert_eq!((check.len(), test.len()), (1, 0));
    assert_eq!(check[0].1.len(), short.len());
}

/// A log at 1 kHz of an axis that follows a motion with a lag of the first order.
fn lagging(motion: &Program, lag: f64) -> Log {
    let period = 1e-3;
    let samples = (trajectories::Motion::duration(motion) / period).round() as usize;
    let time: Vec<f64> = (0..samples).map(|k| k as f64 * period).collect();
    let at = |t: &f64| trajectories::Motion::at(motion, *t).position;
    let reference: Vec<f64> = time.iter().map(at).collect();
    let mut now = reference[0];
    let follow = |to: &f64| {
        now += (to - now) * (1.0 - (-period / lag).exp());
        now
    };
    let position: Vec<f64> = reference.iter().map(follow).collect();
    let channel = |name: &str, samples| Channel::new(name, samples).unwrap();
    Log::new(vec![
        channel("t_s", time),
        channel("position_ref_m", reference),
        channel("position_m", position),
    ])
    .unwrap()
}

/// The best place of a cut by its share of the log is where the reference has just stopped. The axis
/// follows it with a lag of 30 ms, and stands a quarter of a second later.
#[test]
fn a_log_is_cut_and_begun_where_the_axis_stands_and_not_its_reference_alone() {
    let machine = machine("rack");
    let (x, lag) = (machine.stroke.start, 0.03);
    let short = 0.01;
    let before = [(x + 0.04, 1.4), (x, short)];
    let stops = trajectories::Motion::duration(&program(x, &before)) - short;
    let whole = |last: f64| program(x, &[before[0], (x, 0.6), (x + 0.02, short), (x, last)]);
    let rest = 1.5 * (stops + 0.05) - trajectories::Motion::duration(&whole(short)) + short;
    let log = lagging(&whole(rest), lag);
    assert!((1.5 * (stops + 0.05) - log.time()[log.len() - 1]).abs() < 2e-3);

    let (check, test) = set_apart(vec![("a".to_owned(), log.clone(), 1e-3)], &machine);
    assert_eq!((check.len(), test.len()), (1, 1));
    let cut = test[0].1.time()[0];
    assert!(cut > stops && cut < stops + 0.5, "{cut} {stops}");
    let left = |log: &Log| {
        let first = log.first(1).unwrap();
        let [r, x] = ["position_ref_m", "position_m"].map(|n| first.channel(n).unwrap()[0]);
        (r - x).abs()
    };
    // It trails by 1.5 mm while it moves.
    assert!(left(&test[0].1) < 5e-6, "{:e} m", left(&test[0].1));

    let paper = self::machine("liu2025");
    let from = (stops - 0.3) / 1e-3;
    let moving = log.skip(from as usize).unwrap();
    let (begun, note) = from_rest("cut.csv", moving, 1e-3, &paper).unwrap();
    assert!(note.unwrap().contains("first standstill"));
    assert!(left(&begun) < 5e-6, "{:e} m", left(&begun));
}

/// The joint's position loop runs in every fourth cycle. A log of one sample in its period, taken from any of these
/// cycles, is replayed from that one.
#[test]
fn a_log_between_the_ticks_of_a_slower_loop_is_begun_there() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/joint.toml");
    let mut joint = Axis::read(file.as_ref()).unwrap();
    joint.sensors = axis_sim::Sensors::default();
    let start = joint.stroke.start;
    let limits = Limits::new(0.8, 3.0, 30.0).unwrap();
    let turn = |to: f64| Step::Move { to, limits };
    let rest = Step::Dwell { duration: 0.2 };
    let steps = vec![rest, turn(start + 0.3), rest, turn(start + 0.1), rest];
    let mut recorder = Recorder::new(&joint);
    ClosedLoop::new(&joint)
        .unwrap()
        .run(
            &Program::new(start, steps).unwrap(),
            &mut NoCompensation,
            |c| recorder.push(c),
        )
        .completed()
        .unwrap();
    let whole = recorder.log().unwrap();
    let state = State::initial(&joint);
    for phase in 0..4 {
        let log = whole.skip(phase).unwrap().decimate(4).unwrap();
        let logs = vec![("log.csv".to_owned(), log, 4.0 * joint.period)];
        let mut set = LogSet::new(logs, &joint).unwrap();
        let command = set
            .channels
            .iter()
            .position(|c| *c == "torque_ref_n_m")
            .unwrap();
        let left = |set: &LogSet| {
            let rest = set.rest(&set.simulate(&joint, &state).unwrap());
            let squares: f64 = rest[0][command].iter().map(|r| r * r).sum();
            (squares / rest[0][command].len() as f64).sqrt()
        };
        let found = left(&set);
        let Answer::Replay(replay) = set.logs[0].answer.clone() else {
            panic!("no replay");
        };
        assert_eq!(replay.ticks() as usize, phase);
        set.logs[0].answer = Answer::Replay(Box::new(replay.ticked(0)));
        let at_first = left(&set);
        println!("{phase}: {found:.1e} N·m, {at_first:.1e} begun with the first sample");
        assert!(phase == 0 || found < 0.1 * at_first, "{found} {at_first}");
    }
}
