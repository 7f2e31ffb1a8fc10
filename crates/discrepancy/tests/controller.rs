//! An unknown controller, estimated from logs.

use std::path::Path;

use axis_log::{Channel, Log, read_csv_from};
use axis_sim::{Axis, ClosedLoop, Recorder};
use compensator::NoCompensation;
use discrepancy::controller::{Estimate, estimate};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

fn machine(name: &str) -> Axis {
    let file = format!("{}/../../data/axes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Axis::read(file.as_ref()).unwrap()
}

/// A run of a trajectory, its logged position with white noise that the controller did not
/// see (m), its command late by whole cycles.
fn log(axis: &Axis, trajectory: usize, seed: u64, noise: f64, late: usize) -> (String, Log, f64) {
    let motion = axis.plan(&axis.trajectories[trajectory]).unwrap();
    let mut recorder = Recorder::new(axis);
    let run = ClosedLoop::new(axis).unwrap();
    run.run(&motion, &mut NoCompensation, |cycle| recorder.push(cycle))
        .completed()
        .unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let channel = |channel: &Channel| {
        let n = channel.samples.len();
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        let samples = match channel.name.as_str() {
            "position_m" => channel
                .samples
                .iter()
                .map(|x| x + noise * normal())
                .collect(),
            "force_ref_n" | "torque_ref_n_m" | "iq_ref_a" | "drive_command_v" => (0..n)
                .map(|k| channel.samples[k.saturating_sub(late)])
                .collect(),
            _ => channel.samples.clone(),
        };
        Channel {
            samples,
            ..channel.clone()
        }
    };
    let log = recorder.log().unwrap();
    let channels = log.channels().iter().map(channel).collect();
    (
        format!("run {trajectory}"),
        Log::new(channels).unwrap(),
        axis.period,
    )
}

fn gain(found: &Estimate, key: &str) -> (f64, [f64; 2]) {
    let gain = found.gains.iter().find(|gain| gain.key == key).unwrap();
    (gain.value, gain.ci95)
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
    wrong
        .control
        .change(|values| {
            values.scale("kv", 1.5);
            values.scale("speed_proportional", 0.7);
            values.scale("speed_integral_time", 1.4);
        })
        .unwrap();
    wrong
}

#[test]
fn gains_that_a_file_has_wrong_are_found_to_a_hundredth_and_inside_their_intervals() {
    let axis = machine("rack");
    let (mut inside, mut all) = (0, 0);
    for seed in 0..10 {
        let [fit, check] = [(0, seed), (2, 100 + seed)].map(|(t, s)| [log(&axis, t, s, 1e-7, 0)]);
        let found = estimate(&wrong(&axis), &fit, &check).unwrap();
        assert_eq!(found.control.kind().name, "p-pi", "{:?}", found.tried);
        if seed == 0 { eprintln!("{found:?}"); }
        for (key, truth) in RACK {
            let (value, [low, high]) = gain(&found, key);
            assert!(
                (value / truth - 1.0).abs() < 0.01,
                "seed {seed}: {key} {value}"
            );
            all += 1;
            inside += usize::from((low..=high).contains(&truth));
        }
    }
    assert!(10 * inside >= 8 * all, "{inside} of {all} inside");
}

#[test]
fn a_command_logged_two_cycles_late_is_found_so() {
    let axis = machine("rack");
    let [fit, check] = [0, 2].map(|t| [log(&axis, t, 1, 1e-7, 2)]);
    let found = estimate(&wrong(&axis), &fit, &check).unwrap();
    assert!(
        (found.delay.0 / axis.period - 2.0).abs() < 0.05,
        "{:?}",
        found.delay
    );
    assert!((gain(&found, "kv").0 / RACK[0].1 - 1.0).abs() < 0.01);
}

#[test]
fn the_published_gains_of_emps_come_from_a_file_without_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let data = ["../../shared/data/emps", "../shared/data/emps"].map(|at| root.join(at));
    let Some(data) = data.iter().find(|at| at.join("emps.csv").is_file()) else {
        eprintln!("skipped: no logs of EMPS beside the project");
        return;
    };
    let read = |file: &str| {
        let text = std::fs::read_to_string(data.join(file)).unwrap();
        let text = text.replacen("u_V", "u_v", 1).replacen("pulse_V", "pulse_v", 1);
        let log = read_csv_from(text.as_bytes(), file, &[]).unwrap();
        let named = |c: &Channel| {
            let name = match c.name.as_str() {
                "q_ref_m" => "position_ref_m",
                "q_meas_m" => "position_m",
                "u_v" => "drive_command_v",
                "pulse_v" => "drive_command_added_v",
                other => other,
            };
            Channel::new(name, c.samples.clone()).unwrap()
        };
        let log = Log::new(log.channels().iter().map(named).collect()).unwrap();
        [(file.to_owned(), log, 1e-3)]
    };
    let axis = machine("emps").without_control().unwrap();
    let found = estimate(&axis, &read("emps.csv"), &read("emps_pulses.csv")).unwrap();
    assert_eq!(found.control.kind().name, "p-p", "{:?}", found.tried);
    let (position, _) = gain(&found, "position_gain");
    let (speed, _) = gain(&found, "speed_gain");
    assert!((position / 160.18 - 1.0).abs() < 0.01, "{position}");
    assert!((speed / 243.45 - 1.0).abs() < 0.01, "{speed}");
}
