//! What the numbers of a moving axis tell: units, turns, stamps.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use axis_log::intake::Done;
use axis_log::quality::{CrossCheckVerdict, Relation, RelationLaw, cross_check, sample_jitter};
use axis_log::{Channel, Log, Mapping};

use super::{assert_near, given, rate, told};
use crate::reading::noise;

/// Angle in turns and speed in turns a second: there by eight turns and back.
fn motion(t: f64) -> [f64; 2] {
    let w = TAU * 0.4;
    [4.0 * (1.0 - (w * t).cos()), 4.0 * w * (w * t).sin()]
}

fn table(names: &str, row: impl Fn(f64) -> Vec<f64>, rows: usize) -> String {
    let mut text = format!("{names}\n");
    for k in 0..rows {
        let fields = row(k as f64 * 1e-3).into_iter().map(|v| format!("{v:.9}"));
        writeln!(text, "{}", fields.collect::<Vec<_>>().join(",")).unwrap();
    }
    text
}

/// Integers whose only name is a time, and their unit.
#[test]
fn the_unit_of_a_time_is_that_of_a_rate_that_is_read() {
    let start = 1_600_000_000_000_000_000_i64;
    for (name, step, unit, rate_hz) in [
        ("time_ns", 500_000_i64, Some("ns"), 2000.0),
        ("Time [ns]", 250_000, Some("ns"), 4000.0),
        ("t_us", 125, Some("us"), 8000.0),
        ("Zeit [ms]", 4, Some("ms"), 250.0),
        // Not said, or said wrongly.
        ("timestamp", 1_000_000, Some("ns"), 1000.0),
        ("Time", 1, Some("ms"), 1000.0),
        ("time", 200, Some("us"), 5000.0),
        ("Time [s]", 2, Some("ms"), 500.0),
        // No rate at which logs are read.
        ("Time", 7_000_000_000_000, None, 0.0),
    ] {
        let mut text = format!("{name},x\n");
        let begin = if step > 1000 { start } else { 0 };
        (0..60).for_each(|k| writeln!(text, "{},{k}", begin + k * step).unwrap());
        let given = given("log.csv", text);
        let proposal = given.proposal();
        let time = proposal.columns.iter().find(|c| c.channel == "t_s");
        assert_eq!(time.map(|c| c.unit), unit, "{name}");
        let Some(rate_found) = proposal.rate_hz else {
            assert!(proposal.remarks[0].contains("no time between 20 and 20000 Hz"));
            continue;
        };
        assert!(
            (rate_found / rate_hz - 1.0).abs() < 1e-3,
            "{name}: {rate_found}"
        );
        assert!(
            (rate(&given.accepted()) / rate_hz - 1.0).abs() < 1e-4,
            "{name}"
        );
    }
}

/// Position and speed without units tell the time's: 0.05 could be 20 Hz or 20 kHz.
#[test]
fn a_speed_beside_its_position_tells_the_unit_of_the_time() {
    for (factor, unit, rate_hz) in [(1.0, "s", 20.0), (1e3, "ms", 20e3)] {
        let row = |k: usize| {
            let step = 0.05 / factor;
            let t = k as f64 * step;
            let w = TAU / (600.0 * step);
            format!(
                "{},{:.9},{:.9}\n",
                k as f64 * 0.05,
                (w * t).sin(),
                w * (w * t).cos()
            )
        };
        let rows: String = (0..1500).map(row).collect();
        let proposal = given("log.csv", format!("Time,Pos,Vel\n{rows}")).proposal();
        assert_eq!(proposal.columns[0].unit, unit, "{:?}", proposal.remarks);
        assert!((proposal.rate_hz.unwrap() / rate_hz - 1.0).abs() < 1e-6);
    }
}

#[test]
fn units_of_position_and_speed_are_told_by_each_other() {
    for (x, v, units) in [
        (TAU, 60.0, ["rad", "rpm"]),
        (360.0, 360.0, ["mm", "mm/s"]),
        (360.0, 60.0, ["deg", "rpm"]),
        (TAU, 360.0, ["rad", "deg/s"]),
    ] {
        let row = |t: f64| vec![t, x * motion(t)[0], v * motion(t)[1]];
        let proposal = given("log.csv", table("Time,Angle,Speed", row, 2500)).proposal();
        let found: Vec<&str> = proposal.columns[1..].iter().map(|c| c.unit).collect();
        assert_eq!(found, units, "{:?}", proposal.remarks);
    }
    // Said ones stay, and one that begins anew after 360 is in degrees.
    let row = |t: f64| {
        vec![
            t,
            (360.0 * motion(t)[0]).rem_euclid(360.0),
            60.0 * motion(t)[1],
        ]
    };
    let given = given("log.csv", table("Time,Position,Speed", row, 2500));
    let proposal = given.proposal();
    let found: Vec<_> = proposal.columns[1..]
        .iter()
        .map(|c| (c.channel, c.unit))
        .collect();
    assert_eq!(found, [("position_rad", "deg"), ("velocity_rad_s", "rpm")]);
    let log = given.accepted();
    let angle = log.log.channel("position_rad").unwrap();
    assert_near(angle, |k| TAU * motion(k as f64 * 1e-3)[0], 1e-8);
}

#[test]
fn an_angle_that_begins_anew_goes_on() {
    for (turn, scale) in [
        (TAU, 1.0),
        (360.0, TAU / 360.0),
        (1.0, TAU),
        (4096.0, TAU / 1000.0),
    ] {
        let whole = turn * scale / TAU;
        let row = |t: f64| vec![t, (motion(t)[0] / whole * turn).rem_euclid(turn)];
        let mapping = crate::reading::mapping(
            &[("t", "t_s", 1.0), ("phi", "motor_angle_rad", scale)],
            None,
        );
        let log = given("log.csv", table("t,phi", row, 2500)).mapped(&mapping);
        let period = turn * scale;
        let told = |d: &Done| matches!(d, Done::Unwrapped { period: p, .. } if (p / period - 1.0).abs() < 1e-9);
        assert!(log.done.iter().any(told), "{turn}: {:?}", log.done);
        let angle = log.log.channel("motor_angle_rad").unwrap();
        assert_near(angle, |k| TAU * motion(k as f64 * 1e-3)[0], 1e-6 * period);
    }
    // A command that steps by a turn stays, and so does a length that jumps.
    let step = |t: f64| vec![t, if t < 0.5 { 0.0 } else { TAU }];
    let log = given("log.csv", table("t_s,position_ref_rad", step, 1000)).plain();
    assert!(log.done.is_empty(), "{}", told(&log));
    assert_eq!(
        log.log.channel("position_ref_rad").unwrap()[999],
        "6.283185307".parse::<f64>().unwrap()
    );
}

/// What is measured counts from the turn of its command, whichever it began in.
#[test]
fn a_command_and_its_angle_count_from_one_turn() {
    let late = |t: f64| TAU * motion((t - 0.002).max(0.0))[0] - 0.001;
    let row = |t: f64| {
        let command = TAU * motion(t)[0];
        vec![t, command.rem_euclid(TAU), late(t).rem_euclid(TAU)]
    };
    let log = given(
        "log.csv",
        table("t_s,position_ref_rad,position_rad", row, 2500),
    )
    .plain();
    let command = log.log.channel("position_ref_rad").unwrap();
    assert_near(command, |k| TAU * motion(k as f64 * 1e-3)[0], 1e-8);
    assert_near(
        log.log.channel("position_rad").unwrap(),
        |k| late(k as f64 * 1e-3),
        1e-8,
    );
}

#[test]
fn a_slip_is_laid_to_the_channel_that_a_unit_explains() {
    let of = |angle: f64, speed: f64| {
        let time: Vec<f64> = (0..2500).map(|k| f64::from(k) * 1e-3).collect();
        let angles = time.iter().map(|&t| angle * motion(t)[0]).collect();
        let speeds = time.iter().map(|&t| speed * motion(t)[1]).collect();
        let channels = [
            ("t_s", time.clone()),
            ("motor_angle_rad", angles),
            ("motor_speed_rad_s", speeds),
        ];
        let log = Log::new(channels.map(|(n, s)| Channel::new(n, s).unwrap()).to_vec()).unwrap();
        let law = RelationLaw::Integral { factor: 1.0 };
        let relation = Relation::new("motor_angle_rad", "motor_speed_rad_s", law);
        cross_check(&log, &Mapping::default(), &[relation]).remove(0)
    };
    for (angle, speed, channel, unit, scale) in [
        (TAU, 1.0, "motor_speed_rad_s", "rev/s", TAU),
        (TAU, 60.0, "motor_speed_rad_s", "rpm", TAU / 60.0),
        (TAU, 360.0, "motor_speed_rad_s", "deg/s", TAU / 360.0),
        (
            TAU,
            8192.0,
            "motor_speed_rad_s",
            "counts, 8192 a turn",
            TAU / 8192.0,
        ),
        (1.0, TAU, "motor_angle_rad", "rev", TAU),
        (360.0, TAU, "motor_angle_rad", "deg", TAU / 360.0),
        (
            4000.0,
            TAU,
            "motor_angle_rad",
            "counts, 4000 a turn",
            TAU / 4000.0,
        ),
    ] {
        let found = of(angle, speed);
        assert_eq!(found.verdict, CrossCheckVerdict::Contradicts, "{found}");
        assert!(
            found
                .looks_like
                .starts_with(&format!("{channel} is in {unit}")),
            "{found}"
        );
        let repair = found.repair.unwrap();
        assert_eq!(repair.channel, channel);
        assert!(
            (repair.scale / scale - 1.0).abs() < 1e-9,
            "{}",
            repair.scale
        );
    }
}

/// Stamps of a computer that asks when it comes to it.
fn polled(seed: u64) -> Vec<f64> {
    let mut noise = noise(seed);
    (0..2000)
        .map(|k| (f64::from(k) + 0.3 * noise()) * 2e-3)
        .collect()
}

/// A program stamps what it read the round before.
#[test]
fn samples_a_row_beside_their_stamps_are_put_to_them() {
    let stamps = polled(3);
    for rows in [1_i64, -1] {
        let at = |k: usize| (k as i64 - rows).clamp(0, 1999) as usize;
        let mut text = "t_s,position_rad\n".to_owned();
        for (k, t) in stamps.iter().enumerate() {
            writeln!(text, "{t:.9},{:.12}", motion(stamps[at(k)])[0]).unwrap();
        }
        let log = given("log.csv", text).plain();
        let told = |d: &Done| matches!(d, Done::Shifted { rows: found, .. } if *found == rows);
        assert!(log.done.iter().any(told), "{:?}", log.done);
        let found = log.log.channel("position_rad").unwrap();
        let time = log.log.time().to_vec();
        // The first or last row has the value of its neighbour, as there was none before.
        let inside = 4..found.len() - 4;
        for k in inside {
            assert!((found[k] - motion(time[k])[0]).abs() < 1e-6, "{k}");
        }
    }
}

#[test]
fn jitter_of_samples_under_even_stamps_is_estimated() {
    let log = |share: f64, level: f64, seed: u64| {
        let (mut jitter, mut rough) = (noise(seed), noise(seed + 1));
        let time: Vec<f64> = (0..6000).map(|k| f64::from(k) * 1e-3).collect();
        // Of variance 1/3.
        let scale = 3f64.sqrt();
        let at = |t: f64, off: f64| motion(t + off)[0];
        let samples = time
            .iter()
            .map(|&t| at(t, share * 1e-3 * scale * jitter()) + level * scale * rough());
        let channels = [("t_s", time.clone()), ("position_rev", samples.collect())];
        Log::new(channels.map(|(n, s)| Channel::new(n, s).unwrap()).to_vec()).unwrap()
    };
    for (share, level) in [(0.03, 1e-6), (0.01, 1e-6), (0.1, 1e-4), (0.03, 1e-4)] {
        let found = sample_jitter(&log(share, level, 40), "position_rev").unwrap();
        assert!(
            (found.share / share - 1.0).abs() < 0.12,
            "{share}: {found:?}"
        );
        assert!((found.rms - 1e-3 * found.share).abs() < 1e-12);
        assert!(
            (found.share - share).abs() < 5.0 * found.standard_error / 1e-3,
            "{found:?}"
        );
    }
    // Noise alone, quantisation alone, and a vibration that is fast where the motion is.
    for seed in 1..6 {
        assert_eq!(sample_jitter(&log(0.0, 1e-4, seed), "position_rev"), None);
    }
    let of = |value: &dyn Fn(f64) -> f64| {
        let time: Vec<f64> = (0..6000).map(|k| f64::from(k) * 1e-3).collect();
        let samples = time.iter().map(|&t| value(t)).collect();
        let channels = [("t_s", time.clone()), ("position_rev", samples)];
        let log = Log::new(channels.map(|(n, s)| Channel::new(n, s).unwrap()).to_vec()).unwrap();
        sample_jitter(&log, "position_rev")
    };
    assert_eq!(of(&|t| (motion(t)[0] * 1000.0).round() / 1000.0), None);
    assert_eq!(
        of(&|t| motion(t)[0] + 1e-3 * (TAU * 4.0 * motion(t)[0]).sin()),
        None
    );
    assert_eq!(of(&|t| motion((t * 500.0).floor() / 500.0)[0]), None);
}
