//! An unknown controller, estimated from logs.

use axis_log::intake::{Options, prepare};
use axis_log::{Channel, Log};
use axis_sim::{Axis, ClosedLoop, Recorder};
use compensator::NoCompensation;
use discrepancy::LogSet;
use discrepancy::controller::{
    ControllerEstimate, Gain, Undetermined, better_than_own, closed_loop, estimate,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

fn machine(name: &str) -> Axis {
    let file = format!("{}/../../data/axes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Axis::read(file.as_ref()).unwrap()
}

/// A run of a trajectory, its logged position with white noise that the controller did not
/// see (m), its command logged late by whole cycles.
fn log(axis: &Axis, trajectory: usize, seed: u64, noise: f64, late: usize) -> (String, Log, f64) {
    let motion = axis.plan(&axis.trajectories[trajectory]).unwrap();
    let mut recorder = Recorder::new(axis);
    let run = ClosedLoop::new(axis).unwrap();
    run.run(&motion, &mut NoCompensation, |cycle| recorder.push(cycle))
        .completed()
        .unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noisy = |x: &f64| -> f64 {
        let normal: f64 = StandardNormal.sample(&mut random);
        x + noise * normal
    };
    let mut channel = |channel: &Channel| {
        let mut channel = channel.clone();
        let samples = &channel.samples;
        match channel.name.as_str() {
            "position_m" => channel.samples = samples.iter().map(&mut noisy).collect(),
            "torque_ref_n_m" => {
                let past = (0..samples.len()).map(|k| samples[k.saturating_sub(late)]);
                channel.samples = past.collect();
            }
            _ => {}
        }
        channel
    };
    let log = recorder.log().unwrap();
    let channels = log.channels().iter().map(&mut channel).collect();
    let name = format!("run {trajectory}");
    (name, Log::new(channels).unwrap(), axis.period)
}

fn gain<'a>(found: &'a ControllerEstimate, key: &str) -> &'a Gain {
    found.gains.iter().find(|gain| gain.key == key).unwrap()
}

/// The rack's gains, as its axis file has them.
const RACK: [(&str, f64); 4] = [
    ("kv", 1000.0 / 60.0),
    ("velocity_feedforward", 1.0),
    ("speed_proportional", 1.0),
    ("speed_integral_time", 0.025),
];

/// The same with other gains, as a file that is wrong by 30 to 50 %.
fn wrong(axis: &Axis) -> Axis {
    let mut wrong = axis.clone();
    let change = |values: &mut axis_sim::part::Values| {
        values.scale("kv", 1.5);
        values.scale("velocity_feedforward", 0.7);
        values.scale("speed_proportional", 0.7);
        values.scale("speed_integral_time", 1.4);
    };
    wrong.control.change(change).unwrap();
    wrong
}

/// The rack's K_v is 16.7 1/s and its 1/T_i 40 1/s: exchanged, they give nearly the same
/// command, which no estimate may fall for.
#[test]
fn gains_that_a_file_has_wrong_are_found_to_a_hundredth_and_inside_their_intervals() {
    let axis = machine("rack");
    let (mut inside, mut all) = (0, 0);
    for seed in 0..4 {
        let [fit, check] = [(0, seed), (2, 100 + seed)].map(|(t, s)| [log(&axis, t, s, 1e-7, 0)]);
        let found = estimate(&wrong(&axis), &fit, &check).unwrap();
        assert_eq!(found.control.kind().name, "p-pi", "{:?}", found.tried);
        for (key, truth) in RACK {
            let gain = gain(&found, key);
            let off = (gain.value / truth - 1.0).abs();
            assert!(off < 0.01, "seed {seed}: {gain:?}");
            all += 1;
            inside += usize::from((gain.ci95[0]..=gain.ci95[1]).contains(&truth));
        }
        assert!(found.explained[1] > 0.999, "{:?}", found.explained);
    }
    assert!(10 * inside >= 8 * all, "{inside} of {all} inside");
}

#[test]
fn a_command_logged_two_cycles_late_is_found_so() {
    let axis = machine("rack");
    let [fit, check] = [0, 2].map(|t| [log(&axis, t, 1, 1e-7, 2)]);
    let found = estimate(&wrong(&axis), &fit, &check).unwrap();
    let cycles = found.delay.value / axis.period;
    assert!((cycles - 2.0).abs() < 0.02, "{:?}", found.delay);
    assert!((gain(&found, "kv").value / RACK[0].1 - 1.0).abs() < 0.01);
}

/// A low pass that a file does not know of is found from the logs; a controller that is as the file
/// says, or has its gains inside what noise tells, is not doubted.
#[test]
fn a_controller_that_does_not_give_the_command_is_told() {
    let file = machine("rack");
    let mut other = file.clone();
    let change = |values: &mut axis_sim::part::Values| values.set("speed_lowpass", 200.0);
    other.control.change(change).unwrap();
    let logs = |axis: &Axis| [0, 2].map(|t| [log(axis, t, t as u64, 1e-8, 0)]);
    let [fit, check] = logs(&other);
    let found = better_than_own(&file, &fit, &check).unwrap();
    assert!(found.better.contains("speed_lowpass"), "{found:?}");
    assert!(found.better_left < 0.1 * found.left, "{found:?}");
    assert_eq!(better_than_own(&other, &fit, &check), None);
    let [fit, check] = logs(&file);
    assert_eq!(better_than_own(&file, &fit, &check), None);
    // Without a command there is nothing to compare.
    let bare = |logs: &[(String, Log, f64)]| {
        let one = |(name, log, period): &(String, Log, f64)| {
            let channels = log.channels().iter();
            let kept = channels.filter(|c| c.name != "torque_ref_n_m").cloned();
            (name.clone(), Log::new(kept.collect()).unwrap(), *period)
        };
        logs.iter().map(one).collect::<Vec<_>>()
    };
    let [fit, check] = logs(&other).map(|logs| bare(&logs));
    assert_eq!(better_than_own(&file, &fit, &check), None);
}

#[test]
fn the_published_gains_of_emps_come_from_a_file_without_them() {
    // Of nonlinearbenchmark.org.
    let Some(data) = crate::needs::shared("data/emps") else {
        return;
    };
    let axis = machine("emps");
    let read = |file: &str| {
        let options = Options {
            exact: &[],
            ..Options::default()
        };
        let read = prepare(&[data.join(file)], &axis.log, &[], options).unwrap();
        [(file.to_owned(), read.log, 1e-3)]
    };
    let (fit, check) = (read("emps.csv"), read("emps_pulses.csv"));
    let found = estimate(&axis.clone().without_control().unwrap(), &fit, &check).unwrap();
    assert_eq!(found.control.kind().name, "p-p", "{:?}", found.tried);
    for (key, published) in [("position_gain", 160.18), ("speed_gain", 243.45)] {
        let value = gain(&found, key).value;
        assert!((value / published - 1.0).abs() < 1e-3, "{key} {value}");
    }
    assert!(found.explained[1] > 0.99, "{:?}", found.explained);
}

/// A delay between command and torque is not in the controller's equation: the closed loop
/// has it.
#[test]
fn a_command_that_acts_two_cycles_late_is_found_by_the_closed_loop() {
    let axis = machine("rack");
    let mut late = axis.clone();
    let cycles = 2.0 * axis.period;
    let own = axis.actuator.values().optional("delay").unwrap();
    late.actuator
        .change(|values| values.set("delay", own + cycles))
        .unwrap();
    let [fit, check] = [0, 2].map(|t| [log(&late, t, 1, 1e-7, 0)]);
    let found = estimate(&wrong(&axis), &fit, &check).unwrap();
    let replayed = closed_loop(&axis, &found, &fit).unwrap();
    let delay = replayed.command_delay.unwrap();
    assert!((delay.value / cycles - 1.0).abs() < 0.05, "{delay:?}");
    let kv = replayed.gains.iter().find(|gain| gain.key == "kv").unwrap();
    assert!((kv.value / RACK[0].1 - 1.0).abs() < 0.01, "{kv:?}");
}

/// What answers a log says whether its gains were estimated; a balance needs none.
#[test]
fn a_file_that_says_so_answers_with_an_estimated_controller() {
    let file = format!("{}/../../data/axes/rack.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(file).unwrap();
    let with = |line: &str| {
        let text = text.replace("[control]\n", &format!("[control]\n{line}\n"));
        Axis::parse("rack.toml", &text)
    };
    let given = with("gains = \"given\"").unwrap();
    let estimated = with("gains = \"estimated\"").unwrap();
    assert!(with("gains = \"guessed\"").is_err());
    let balanced = estimated.clone().without_control().unwrap();
    let logs = vec![log(&given, 1, 1, 1e-7, 0)];
    for (axis, answer) in [
        (given, "closed-loop-replay"),
        (estimated, "controller-estimated"),
        (balanced, "torque-balance"),
    ] {
        let set = LogSet::new(logs.clone(), &axis).unwrap();
        assert_eq!(set.answer_of(&axis), answer);
    }
}

/// Logs of a command that a file's keys cannot give: its velocity feed-forward is 17.6, and an axis file
/// takes 10 at most.
#[test]
fn a_gain_beyond_what_a_file_takes_ends_there_and_is_said_to_be_undetermined() {
    let axis = machine("rack");
    let made = |trajectory: usize| {
        let (name, log, period) = log(&axis, trajectory, 7, 0.0, 0);
        let of = |name: &str| log.channel(name).unwrap().to_vec();
        let (reference, position) = (of("position_ref_m"), of("position_m"));
        let angle = of("motor_angle_rad");
        let travel = axis.travel_per_radian();
        let slope = |samples: &[f64], k: usize| match k {
            0 => 0.0,
            k => (samples[k] - samples[k - 1]) / period,
        };
        let mut integral = 0.0;
        let command = (0..reference.len()).map(|k| {
            let asked = 9.0 * (reference[k] - position[k]) / travel;
            let off = asked + 17.6 * slope(&reference, k) / travel - slope(&angle, k);
            integral += 0.002 * off * period;
            0.004 * off + integral
        });
        let command: Vec<f64> = command.collect();
        let channels = log.channels().iter().map(|channel| {
            let mut channel = channel.clone();
            if channel.name == "torque_ref_n_m" {
                channel.samples.clone_from(&command);
            }
            channel
        });
        [(name, Log::new(channels.collect()).unwrap(), period)]
    };
    let found = estimate(&axis, &made(0), &made(2)).unwrap();
    assert_eq!(found.control.kind().name, "p-pi", "{:?}", found.tried);
    let keys = found.control.kind().keys;
    for gain in &found.gains {
        let key = keys.iter().find(|key| key.name() == gain.key).unwrap();
        let [least, most] = key.limits().unwrap();
        assert!((least..=most).contains(&gain.value), "{gain:?}");
    }
    assert_eq!(gain(&found, "velocity_feedforward").value, 10.0);
    let at_edge = Undetermined::AtEdge([0.0, 10.0]);
    let doubt = ("velocity_feedforward", at_edge);
    assert!(
        found.undetermined.contains(&doubt),
        "{:?}",
        found.undetermined
    );
}
