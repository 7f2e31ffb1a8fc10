//! Slow logs and growth along them, against a second simulator that shares no code
//! (`independent_axis::HeatedScrew`: a rod of 5 mm cells, the nut where it is, losses of each instant).

use std::path::PathBuf;
use std::sync::Arc;

use axis_log::{Channel, Log};
use axis_pipeline::heat::{
    DutyHeat, FollowOptions, ModelHeat, SlowLog, SlowLogOptions, fit, follow, warm_axis,
};
use axis_pipeline::strategies::SharedMotion;
use axis_sim::Axis;
use axis_thermal::{GrowthOf, GrowthZero};
use independent_axis::{HeatedScrew, Motion, Parameters, Random, there_and_back};
use trajectories::{Limits, Program, Step};

pub(crate) fn axis() -> Axis {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../data/axes");
    Axis::read(&folder.join("screw-heat.toml")).unwrap()
}

pub(crate) fn program(from: f64, to: f64, speed: f64) -> Program {
    let limits = Limits::new(speed, 1.0, 10.0).unwrap();
    let rest = Step::Dwell { duration: 1.0 };
    let steps = [to, from].map(|to| [Step::Move { to, limits }, rest]);
    Program::new(from, steps.concat()).unwrap()
}

pub(crate) fn log(channels: Vec<(&str, Vec<f64>)>) -> Log {
    let channel = |(name, values)| Channel::new(name, values).unwrap();
    Log::new(channels.into_iter().map(channel).collect()).unwrap()
}

/// A duty and how many probings of it, each after five minutes at two places.
type Stretch<'a> = (Option<&'a Motion>, f64, u32);

/// A log of probings: time, number of the duty, place, growth (µm), power of friction.
fn probed(stretches: &[Stretch<'_>]) -> Log {
    let mut machine = HeatedScrew::other(20.0);
    let mut random = Random::new(5, 3);
    let mut rows: [Vec<f64>; 5] = Default::default();
    let mut row = |values: [f64; 5]| {
        for (column, value) in rows.iter_mut().zip(values) {
            column.push(value);
        }
    };
    row([0.0, 0.0, 500.0, 0.0, 0.0]);
    for (motion, number, count) in stretches {
        for _ in 0..*count {
            for (place, seconds) in [(0.5, 290.0), (1.1, 10.0)] {
                let spent = machine.friction_heat;
                machine.run(*motion, seconds, |_| 20.0);
                let growth = 1e6 * machine.growth(20.0, place) + 0.5 * random.normal();
                let power = (machine.friction_heat - spent) / seconds;
                row([machine.time, *number, 1e3 * place, growth, power]);
            }
        }
    }
    let [time, duty, place, growth, _] = rows;
    log(vec![
        ("t_s", time),
        ("duty_1", duty),
        ("place_mm", place),
        ("growth_um", growth),
    ])
}

/// An hour and three quarters of probings: two thirds fitted, the rest predicted.
#[test]
fn a_log_of_probings_makes_a_model_that_predicts_its_held_out_part() {
    let axis = axis();
    let (a, b) = (
        there_and_back(0.45, 0.95, 0.2, 1.0),
        there_and_back(0.1, 1.4, 0.15, 1.0),
    );
    let log = probed(&[(Some(&a), 1.0, 10), (Some(&b), 2.0, 6), (Some(&a), 1.0, 5)]);
    let duties = [program(0.45, 0.95, 0.2), program(0.1, 1.4, 0.15)];
    let duties = duties.map(|program| Arc::new(program) as SharedMotion);
    let options = SlowLogOptions {
        duties: &duties,
        ..SlowLogOptions::default()
    };
    let slow = SlowLog::new(&axis, &log, &options).unwrap();
    let found = fit(&axis, &[slow], 0.25).unwrap();
    println!(
        "{:?} {:?} {:e}",
        found.before, found.after, found.fitted.rms
    );
    assert!(found.before.greatest > 15e-6 && found.before.of > 100e-6);
    assert!(
        found.after.greatest < 4e-6 && found.after.rms < 2e-6,
        "{:?}",
        found.after
    );
    // The model as a file's keys, and along the same log with a probing each half hour.
    let keys = axis.thermal_keys_of(&found.fitted.parameters);
    assert!(keys.iter().any(|(key, _)| key == "nut_to_screw_w_per_k"));
    let slow = SlowLog::new(&axis, &log, &options).unwrap();
    let errors = |parameters, probe_each| {
        let how = FollowOptions {
            window: 60.0,
            homed: 0.0,
            probe_each,
            places: vec![0.95],
        };
        let model = axis_thermal::ThermalModel::new(parameters).unwrap();
        let found = follow(model, &slow, &how).unwrap();
        let errors = found.readings.iter().map(|[_, read, p]| read - p);
        let squares = errors.map(|error| error * error).sum::<f64>();
        let rms = (squares / found.readings.len() as f64).sqrt();
        (rms, found.probings)
    };
    let assumed = errors(axis.thermal_parameters(), None);
    let set_right = errors(axis.thermal_parameters(), Some(1200.0));
    let fitted = errors(found.fitted.parameters.clone(), None);
    println!("{assumed:?} {set_right:?} {fitted:?}");
    assert!(
        fitted.0 < 1.5e-6 && set_right.1 == 5,
        "{set_right:?} {fitted:?}"
    );
    assert!(set_right.0 < 0.4 * assumed.0, "{set_right:?} {assumed:?}");
}

/// A log of encoder, scale and current, five times a second. The transmission winds up by friction and inertia, the
/// screw has pitch errors, the scale grows.
fn encoder_and_scale(hours: f64) -> (Log, Vec<[f64; 3]>) {
    let p = Parameters::paper_with_measured_viscosity();
    let motion = there_and_back(0.45, 0.95, 0.2, 1.0);
    let mut machine = HeatedScrew::other(20.0);
    let step = 0.2;
    let mut rows: [Vec<f64>; 5] = Default::default();
    let mut truth = Vec::new();
    for k in 0..=(3600.0 * hours / step).round() as u32 {
        let t = f64::from(k) * step;
        let at = |t: f64| motion.at(t.rem_euclid(motion.duration()));
        let [before, now, after] = [at(t - 1e-3), at(t), at(t + 1e-3)];
        let acceleration = (after.velocity - before.velocity) / 2e-3;
        let [dry, viscous] = machine.friction_factors(now.position);
        let w = now.velocity / p.travel();
        let friction = match w == 0.0 {
            true => 0.0,
            false => dry * p.coulomb * w.signum() + viscous * p.viscous * w,
        };
        let torque = friction + p.inertia() * acceleration / p.travel();
        // 0.7 mrad for each N·m at the motor.
        let wind_up = 7e-4 * torque * p.travel();
        let grown = machine.growth(20.0, now.position);
        let pitch = 4e-6 * (9.0 * now.position).sin();
        let scale = 10e-6 * (machine.bodies[7] - 20.0) * now.position;
        let table = now.position + grown - wind_up + pitch;
        let values = [
            t,
            1e3 * now.position,
            table - scale,
            now.position / p.travel(),
            torque / p.torque_constant,
        ];
        for (column, value) in rows.iter_mut().zip(values) {
            column.push(value);
        }
        if k % 1500 == 0 && k > 0 {
            let warmer = machine.bodies[7] - 20.0;
            let growth = |x: f64| machine.growth(20.0, x) - 10e-6 * warmer * x;
            truth.push([t, growth(0.65), growth(0.75)]);
        }
        machine.run(Some(&motion), step, |_| 20.0);
    }
    let [time, reference, position, angle, current] = rows;
    let log = log(vec![
        ("t_s", time),
        ("position_ref_mm", reference),
        ("position_m", position),
        ("motor_angle_rad", angle),
        ("iq_a", current),
    ]);
    (log, truth)
}

#[test]
fn encoder_less_scale_tells_growth_and_the_current_tells_friction() {
    let axis = axis();
    let (log, truth) = encoder_and_scale(1.0);
    let slow = SlowLog::new(&axis, &log, &SlowLogOptions::default()).unwrap();
    assert_eq!(
        slow.reads(),
        (GrowthOf::ScrewLessScale, GrowthZero::FirstAtPlace)
    );
    let model = axis.thermal_model().unwrap();
    let stretches = slow.stretches(&model).stretches;
    assert_eq!(stretches.len(), 12);
    // Readings, each less the first at its place.
    let mut worst = 0.0_f64;
    let read = |stretch: usize, x: f64| {
        let found = &stretches[stretch].found;
        // Five times a second tells a constant speed 0.1 m from the ends at the earliest.
        assert!(found.len() >= 4, "{found:?}");
        let after = found.iter().position(|[place, _]| *place > x).unwrap();
        let ([a, p], [b, q]) = (found[after - 1], found[after]);
        p + (q - p) * (x - a) / (b - a)
    };
    for (k, [_, near, far]) in truth.iter().enumerate() {
        for (x, growth, first) in [(0.65, near, truth[0][1]), (0.75, far, truth[0][2])] {
            let found = read(k, x) - read(0, x);
            worst = worst.max((found - (growth - first)).abs());
        }
    }
    println!("{worst:e}");
    assert!(worst < 1e-6, "{worst:e}");
    // Friction's power beside that of the second simulator: inertia leaves it out.
    let mut machine = HeatedScrew::other(20.0);
    let motion = there_and_back(0.45, 0.95, 0.2, 1.0);
    for stretch in &stretches {
        let spent = machine.friction_heat;
        machine.run(Some(&motion), 300.0, |_| 20.0);
        let power = (machine.friction_heat - spent) / 300.0;
        let found = stretch.friction.unwrap();
        assert!((found / power - 1.0).abs() < 0.02, "{found} {power}");
    }
    let found = fit(&axis, &[slow], 0.25).unwrap();
    println!("{:?} {:?}", found.before, found.after);
    assert!(found.after.greatest < 3e-6, "{:?}", found.after);
    assert!(found.after.friction.unwrap() < 0.02, "{:?}", found.after);
}

/// Where a log is cut off by chance does not count.
#[test]
fn a_second_more_of_a_log_changes_little() {
    let axis = axis();
    let (longer, _) = encoder_and_scale(1801.2 / 3600.0);
    let rows = longer
        .time()
        .iter()
        .filter(|t| **t <= 1800.0 + 1e-6)
        .count();
    let channels = [
        "t_s",
        "position_ref_mm",
        "position_m",
        "motor_angle_rad",
        "iq_a",
    ];
    let first = channels.map(|name| match name {
        "t_s" => (name, longer.time()[..rows].to_vec()),
        name => (name, longer.channel(name).unwrap()[..rows].to_vec()),
    });
    let shorter = log(first.to_vec());
    let fitted = |log: &Log, held_out: f64| {
        let slow = SlowLog::new(&axis, log, &SlowLogOptions::default()).unwrap();
        let stretches = slow.stretches(&axis.thermal_model().unwrap()).stretches;
        assert_eq!(stretches.len(), 6);
        let found = fit(&axis, &[slow], held_out).unwrap();
        let factors = found.fitted.factors.iter().map(|(_, factor)| factor.ln());
        (factors.collect::<Vec<f64>>(), found.after)
    };
    let (all, all_longer) = (fitted(&shorter, 0.0).0, fitted(&longer, 0.0).0);
    for (a, b) in all.iter().zip(&all_longer) {
        assert!((a - b).abs() < 0.03, "{all:?} {all_longer:?}");
    }
    let (held, held_longer) = (fitted(&shorter, 0.3).1, fitted(&longer, 0.3).1);
    println!("{held:?} {held_longer:?}");
    assert_eq!(held.readings, held_longer.readings);
    assert!(
        (held.rms - held_longer.rms).abs() < 0.2e-6,
        "{held:?} {held_longer:?}"
    );
    let [a, b] = [held, held_longer].map(|held| held.friction.unwrap());
    assert!((a - b).abs() < 0.003, "{a} {b}");
}

/// A correction subtracts the growth that the controller does not see: of the screw with the motor's encoder, of the
/// scale with a scale. Both by the growth of the thermal network itself.
#[test]
fn a_reference_is_corrected_by_the_growth_that_the_axis_does_not_see() {
    let text = include_str!("../../../data/axes/screw-heat.toml");
    let by_scale = text.replace("feedback = \"motor\"", "feedback = \"load\"");
    assert_ne!(text, by_scale);
    let one = program(0.45, 0.95, 0.2);
    let duration = trajectories::Motion::duration(&one);
    let time: Vec<f64> = (0..=12_000).map(|k| 0.1 * f64::from(k)).collect();
    let at = |t: &f64| trajectories::Motion::at(&one, t.rem_euclid(duration)).position;
    let position: Vec<f64> = time.iter().map(at).collect();
    let log = log(vec![("t_s", time), ("position_ref_m", position)]);
    let last = |text: &str| {
        let axis = Axis::parse("axis.toml", text).unwrap();
        let slow = SlowLog::new(&axis, &log, &SlowLogOptions::default()).unwrap();
        let end = slow.reference().unwrap()[12_000];
        let how = FollowOptions {
            window: 60.0,
            homed: 0.0,
            probe_each: None,
            places: vec![end],
        };
        let found = follow(axis.thermal_model().unwrap(), &slow, &how).unwrap();
        let last = found.rows.last().unwrap();
        // A minute late, as the prediction is.
        let mut heat =
            ModelHeat::new(&axis, &[Arc::new(one.clone()) as SharedMotion], 20.0).unwrap();
        heat.until(1140.0).unwrap();
        (last.at_reference.unwrap(), last.growth[0], heat.growth(end))
    };
    let (corrected, screw, unseen) = last(text);
    assert!(
        corrected > 15e-6 && corrected == screw,
        "{corrected:e} {screw:e}"
    );
    assert!(
        (corrected - unseen).abs() < 0.5e-6,
        "{corrected:e} {unseen:e}"
    );
    let (corrected, screw, unseen) = last(&by_scale);
    assert!(screw > 15e-6, "{screw:e}");
    assert!(corrected > 0.0 && corrected < 2e-6, "{corrected:e}");
    assert!(
        (corrected - unseen).abs() < 0.02e-6,
        "{corrected:e} {unseen:e}"
    );
}

/// A machine that grows 5 µm more than its model: after one probing of two places, ten seconds apart, the rest is
/// predicted. In the minute and a half until the next row the machine grows by more than that.
#[test]
fn what_a_probing_finds_is_off_at_its_own_time() {
    let axis = axis();
    let motion = there_and_back(0.45, 0.95, 0.2, 1.0);
    let duties = [Arc::new(program(0.45, 0.95, 0.2)) as SharedMotion];
    let options = SlowLogOptions {
        duties: &duties,
        ..SlowLogOptions::default()
    };
    let along = |rows: &[(f64, f64)], probe_each| {
        let mut machine = HeatedScrew::assumed(20.0);
        let read = |(time, place): &(f64, f64)| {
            machine.run(Some(&motion), time - machine.time, |_| 20.0);
            machine.growth(20.0, *place) + 5e-6
        };
        let growth: Vec<f64> = rows.iter().map(read).collect();
        let log = log(vec![
            ("t_s", rows.iter().map(|row| row.0).collect()),
            ("duty_1", vec![1.0; rows.len()]),
            ("place_m", rows.iter().map(|row| row.1).collect()),
            ("growth_m", growth.clone()),
        ]);
        let slow = SlowLog::new(&axis, &log, &options).unwrap();
        let how = FollowOptions {
            probe_each,
            places: vec![0.95],
            ..FollowOptions::default()
        };
        let found = follow(axis.thermal_model().unwrap(), &slow, &how).unwrap();
        (found, growth)
    };
    let rows = [
        (0.0, 0.95),
        (300.0, 0.95),
        (310.0, 0.5),
        (400.0, 0.95),
        (500.0, 0.5),
    ];
    let (found, growth) = along(&rows, Some(300.0));
    assert!(growth[3] - growth[1] > 8e-6, "{growth:?}");
    assert_eq!((found.probings, found.readings.len()), (1, 3));
    for [place, read, predicted] in &found.readings[1..] {
        assert!(
            (read - predicted).abs() < 0.5e-6,
            "{place}: {read:e} {predicted:e}"
        );
    }
    // A probing that ends the log counts, and the last row goes through it.
    let (found, growth) = along(&rows[..2], Some(300.0));
    assert_eq!((found.probings, found.readings.len()), (1, 1));
    let last = found.rows.last().unwrap();
    assert!(
        (last.growth[0] - growth[1]).abs() < 1e-9,
        "{last:?} {growth:?}"
    );
    let (found, _) = along(&rows[..2], None);
    assert_eq!((found.probings, found.readings.len()), (0, 2));
}

#[test]
fn probing_without_a_time_between_is_refused() {
    let axis = axis();
    let log = log(vec![("t_s", vec![0.0, 300.0]), ("duty_1", vec![0.0, 0.0])]);
    let slow = SlowLog::new(&axis, &log, &SlowLogOptions::default()).unwrap();
    let along = |probe_each| {
        let how = FollowOptions {
            probe_each: Some(probe_each),
            ..FollowOptions::default()
        };
        follow(axis.thermal_model().unwrap(), &slow, &how)
    };
    for each in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = along(each).unwrap_err().to_string();
        assert!(
            error.contains("probe_each") && error.contains("valid: above 0 s"),
            "{error}"
        );
    }
    assert!(along(300.0).is_ok());
}

#[test]
fn logs_without_sense_are_refused() {
    let axis = axis();
    let time = || ("t_s", vec![0.0, 300.0]);
    let refused = |channels, options: &SlowLogOptions<'_>| {
        let log = log(channels);
        let refused = SlowLog::new(&axis, &log, options).map(|slow| fit(&axis, &[slow], 0.0));
        match refused {
            Err(error) | Ok(Err(error)) => error.to_string(),
            Ok(Ok(_)) => panic!("taken"),
        }
    };
    let options = SlowLogOptions::default();
    for (channels, words) in [
        (vec![time()], "duty_1"),
        (
            vec![time(), ("duty_1", vec![0.0, 1.0])],
            "row 2; valid: 0 for standstill",
        ),
        (
            vec![time(), ("position_ref_m", vec![0.5, 0.6])],
            "rows at most 0.2 s apart",
        ),
        (
            vec![time(), ("duty_1", vec![0.0, 0.0])],
            "valid: a log with growth",
        ),
        (
            vec![
                time(),
                ("duty_1", vec![0.0, 0.0]),
                ("growth_um", vec![0.0, 1.0]),
            ],
            "growth and place without the other",
        ),
        (
            vec![
                ("t_s", vec![0.0, 0.2]),
                ("position_ref_m", vec![0.5, 0.6]),
                ("place_m", vec![0.5, 0.6]),
                ("growth_m", vec![0.0, 1e-6]),
            ],
            "probed_1",
        ),
    ] {
        let message = refused(channels, &options);
        assert!(message.contains(words), "{message}");
    }
    let text = include_str!("../../../data/axes/linear-motor.toml");
    let other = Axis::parse("linear-motor.toml", text).unwrap();
    let log = log(vec![time(), ("duty_1", vec![0.0, 0.0])]);
    let error = SlowLog::new(&other, &log, &options).err().unwrap();
    assert!(error.to_string().contains("no screw"), "{error}");
}

/// All levels of a dry friction are warm, and all parts of a viscous one.
#[test]
fn a_friction_by_direction_warms_as_a_whole() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../data/axes");
    let file = std::fs::read_to_string(folder.join("screw-heat.toml")).unwrap();
    let level = "coulomb_n_m = 0.6757\n";
    assert!(file.contains(level));
    let more =
        format!("{level}coulomb_backward_n_m = 0.6757\nviscous_quadratic_n_m_s2_per_rad2 = 1e-6\n");
    let axis = Axis::parse("screw-heat.toml", &file.replace(level, &more)).unwrap();
    let warm = warm_axis(&axis, [0.7, 0.4]).unwrap();
    let [cold, warm] = [axis, warm].map(|axis| axis.friction.values().clone());
    for (key, by) in [
        ("coulomb", 0.7),
        ("coulomb_backward", 0.7),
        ("stiction", 0.7),
        ("viscous_quadratic", 0.4),
    ] {
        let [cold, warm] = [&cold, &warm].map(|values| values.number(key).unwrap());
        assert!(
            (warm - by * cold).abs() < 1e-12 * cold,
            "{key}: {cold} to {warm}"
        );
    }
}
