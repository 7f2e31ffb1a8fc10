//! Files as drives write them, made one log.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::path::PathBuf;

use axis_log::intake::{Done, Options, PreparedLog, prepare};
use axis_log::{ColumnMap, ColumnUnit, Log, Mapping, MappingError, read_log};
use proptest::prelude::*;

use crate::reading::noise;

/// Rests, moves 0.3 m within 0.8 s without a jump up to the jerk, rests.
fn position(t: f64) -> f64 {
    let s = ((t - 0.3) / 0.8).clamp(0.0, 1.0);
    0.3 * (s - (TAU * s).sin() / TAU)
}

fn speed(t: f64) -> f64 {
    let s = ((t - 0.3) / 0.8).clamp(0.0, 1.0);
    0.3 / 0.8 * (1.0 - (TAU * s).cos())
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn file(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    }

    fn table(&self, name: &str, heads: &str, rows: impl Iterator<Item = Vec<f64>>) -> PathBuf {
        let mut text = heads.to_owned() + "\n";
        for row in rows {
            let row: Vec<String> = row.iter().map(f64::to_string).collect();
            writeln!(text, "{}", row.join(",")).unwrap();
        }
        self.file(name, &text)
    }
}

fn plain(paths: &[PathBuf]) -> PreparedLog {
    prepare(paths, &Mapping::default(), &[], Options::default()).unwrap()
}

fn rms(log: &Log, channel: &str, truth: impl Fn(f64) -> f64) -> f64 {
    let samples = log.channel(channel).unwrap();
    let square = |(v, t): (&f64, &f64)| (v - truth(*t)).powi(2);
    let sum: f64 = samples.iter().zip(log.time()).map(square).sum();
    (sum / samples.len() as f64).sqrt()
}

#[test]
fn a_sound_file_is_read_to_the_bit() {
    let folder = Folder::new();
    let mut noise = noise(1);
    let rows = (0..3000)
        .map(|k| f64::from(k) * 1e-3)
        .map(|t| vec![t, position(t) + 1e-6 * noise()]);
    let path = folder.table("a.csv", "t_s,position_m", rows);
    let found = plain(std::slice::from_ref(&path));
    assert_eq!(found.done, []);
    assert_eq!(
        found.log,
        read_log(&path, &Mapping::default(), &[]).unwrap()
    );
}

#[test]
fn two_clocks_and_a_given_delay_recover_the_signal() {
    let folder = Folder::new();
    let (slow, fast) = (2e-3 / 3.0, 0.5e-3);
    let force = |t: f64| 20.0 * (TAU * 35.0 * t).sin() + 50.0 * speed(t);
    let one = (0..2400)
        .map(|k| f64::from(k) * slow)
        .map(|t| vec![t, speed(t)]);
    // What it stamps t happened 4 ms before, and above the slow rate's half it hums.
    let hum = |t: f64| 3.0 * (TAU * 980.0 * t).sin();
    let other = (1..3200).map(|k| f64::from(k) * fast);
    let other = other.map(|t| vec![t, force(t - 4e-3) + hum(t)]);
    let paths = [
        folder.table("drive.csv", "t_s,velocity_m_s", one),
        folder.table("force.csv", "t_s,cell", other),
    ];
    let mut map = ColumnMap::in_unit("cell", "force_n", ColumnUnit::default()).unwrap();
    map.delay = 4e-3;
    let mapping = Mapping {
        columns: vec![map],
        sample_rate_hz: None,
    };
    let found = prepare(
        &paths,
        &mapping,
        &["force_n", "velocity_m_s"],
        Options::default(),
    )
    .unwrap();
    let period = found.log.time()[1] - found.log.time()[0];
    assert!((period / slow - 1.0).abs() < 1e-9, "{period}");
    // Passed to 1e-4, the hum taken out by 80 dB, but at the ends, which the kernel reaches
    // beyond.
    let inner = |t: f64| (0.05..1.5).contains(&t);
    let all = found
        .log
        .channel("force_n")
        .unwrap()
        .iter()
        .zip(found.log.time());
    let worst = all
        .filter(|(_, t)| inner(**t))
        .map(|(v, t)| (v - force(*t)).abs())
        .fold(0.0, f64::max);
    assert!(worst < 1e-3 * 20.0, "{worst}");
    assert!(rms(&found.log, "velocity_m_s", speed) < 1e-6);
    assert!(
        matches!(found.done[..], [Done::Joined { .. }, Done::Delayed { .. }]),
        "{:?}",
        found.done
    );
}

#[test]
fn the_delay_of_a_file_is_found_from_a_channel_of_the_same_quantity() {
    let folder = Folder::new();
    let period = 0.5e-3;
    // A motion that shakes up to 60 Hz, and one that does not.
    let lively = |t: f64, d: i32| -> f64 {
        let tone = |f: f64| (TAU * f).powi(d) * (TAU * f * t + f + f64::from(d) * PI / 2.0).sin();
        [7.3, 19.1, 31.7, 60.3].map(tone).iter().sum::<f64>() / 2f64.sqrt()
    };
    let calm = |t: f64, d: i32| if d == 0 { position(t) } else { speed(t) };
    // A shape, and the RMS of it and its derivative.
    type Shape<'a> = (&'a dyn Fn(f64, i32) -> f64, [f64; 2]);
    let shapes: [Shape<'_>; 2] = [(&lively, [1.414, 1.0e2 * 3.2]), (&calm, [0.14, 0.21])];
    for (which, (shape, rms)) in shapes.iter().enumerate() {
        for (name, d, truth) in [("position_m", 0, 4.37e-3), ("velocity_m_s", 1, -2.81e-3)] {
            let (mut a, mut b) = (noise(3 + d as u64), noise(13 + d as u64));
            // A hundred times less than the signal, RMS.
            let sizes = rms.map(|r| 3f64.sqrt() * r / 100.0);
            let one = (0..4000).map(|k| f64::from(k) * period);
            let one = one.map(|t| vec![t, shape(t, 0) + sizes[0] * a(), 0.5]);
            let other = (0..4000).map(|k| f64::from(k) * period);
            let other = other.map(|t| vec![t, shape(t - truth, d) + sizes[d as usize] * b()]);
            let paths = [
                folder.table("a.csv", "t_s,position_m,iq_a", one),
                folder.table("b.csv", &format!("t_s,{name}"), other),
            ];
            let done = plain(&paths).done;
            let aligned = done.iter().find_map(|d| match d {
                Done::Aligned { found, .. } => Some(found),
                _ => None,
            });
            let delay = aligned.expect("aligned");
            let off = (delay.delay - truth).abs();
            println!(
                "{which} {name}: off by {off:.2e} s, standard error {:.2e} s",
                delay.standard_error
            );
            assert!(off < 4.0 * delay.standard_error, "{delay:?}");
            // The calm motion cannot tell more: its slope over its noise gives 0.2 samples.
            let most = if which == 0 { 0.05 } else { 1.0 };
            assert!(off < most * period, "{delay:?}");
        }
    }
}

#[test]
fn files_without_a_common_quantity_are_told() {
    let folder = Folder::new();
    let rows = |f: fn(f64) -> f64| {
        (0..2000)
            .map(move |k| f64::from(k) * 1e-3)
            .map(move |t| vec![t, f(t)])
    };
    let paths = [
        folder.table("a.csv", "t_s,position_m", rows(position)),
        folder.table("b.csv", "t_s,force_n", rows(|t| (9.0 * t).sin())),
    ];
    let found = plain(&paths);
    let told = found
        .done
        .iter()
        .any(|d| d.to_string().contains("set delay_ms"));
    assert!(told, "{:?}", found.done);
}

#[test]
fn a_delay_of_whole_samples_moves_the_very_values() {
    let folder = Folder::new();
    let rows = (0..1000).map(|k| vec![f64::from(k) * 1e-3, f64::from(k % 7), f64::from(k).sin()]);
    let path = folder.table("a.csv", "t_s,iq_a,u", rows);
    let mut map = ColumnMap::in_unit("u", "uq_v", ColumnUnit::default()).unwrap();
    map.delay = 3e-3;
    let mapping = Mapping {
        columns: vec![map],
        sample_rate_hz: None,
    };
    let found = prepare(
        std::slice::from_ref(&path),
        &mapping,
        &[],
        Options::default(),
    )
    .unwrap();
    let (uq, iq) = (
        found.log.channel("uq_v").unwrap(),
        found.log.channel("iq_a").unwrap(),
    );
    assert_eq!(uq.len(), 997);
    for k in 0..997 {
        assert_eq!(uq[k], ((k + 3) as f64).sin());
        assert_eq!(iq[k], (k % 7) as f64);
    }
    let refused = read_log(&path, &mapping, &[]).unwrap_err().to_string();
    assert!(refused.contains("intake::prepare"), "{refused}");
}

#[test]
fn holes_and_spikes_are_bridged_marked_and_told() {
    let folder = Folder::new();
    let mut noise = noise(9);
    let mut text = "t_s,position_m,iq_a\n".to_owned();
    for k in 0..3000 {
        let t = f64::from(k) * 1e-3;
        let x = position(t) + 1e-5 * noise();
        let cell = match k {
            700..703 => String::new(),
            900 => "NaN".to_owned(),
            1200 => "0.9".to_owned(),
            _ => x.to_string(),
        };
        // Three rows are not there at all.
        if !(2000..2003).contains(&k) {
            writeln!(text, "{t:.4},{cell},{:.3}", noise()).unwrap();
        }
    }
    let found = plain(&[folder.file("a.csv", &text)]);
    assert_eq!(found.log.len(), 3000);
    let marks = found.log.missing("position_m");
    assert_eq!(marks, [700..703, 900..901, 1200..1201, 2000..2003]);
    assert_eq!(found.log.missing("iq_a"), &marks[3..]);
    // A line over three samples of this motion is off by its acceleration at most.
    let worst = found
        .log
        .channel("position_m")
        .unwrap()
        .iter()
        .zip(found.log.time());
    let worst = worst
        .map(|(x, t)| (x - position(*t)).abs())
        .fold(0.0, f64::max);
    assert!(worst < 5e-5, "{worst}");
    assert_eq!(found.log.skip(701).unwrap().missing("position_m")[0], 0..2);
    assert_eq!(
        found.log.decimate(100).unwrap().missing("position_m"),
        [7..8, 9..10, 12..13, 20..21]
    );
    let told: Vec<String> = found.done.iter().map(Done::to_string).collect();
    let told = told.join("\n");
    for part in [
        "3 rows missing in 1 place",
        "1 isolated outlier",
        "8 sample(s)",
        "with zero weight",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
}

#[test]
fn steps_ramps_and_pulse_trains_are_no_outliers() {
    let step = |t: f64| if t < 1.0 { 0.0 } else { 5.0 };
    let pulses = |t: f64| if (t / 0.05).fract() < 0.5 { 1.0 } else { -1.0 };
    let burst = |t: f64| (-(t - 1.0).max(0.0) * 20.0).exp() * (TAU * 80.0 * t).sin() * step(t);
    let shapes: [&dyn Fn(f64) -> f64; 4] = [&step, &pulses, &position, &burst];
    for (i, shape) in shapes.iter().enumerate() {
        let mut noise = noise(20 + i as u64);
        for size in [0.0, 1e-4, 1e-2] {
            let x: Vec<f64> = (0..3000)
                .map(|k| shape(f64::from(k) * 1e-3) + size * noise())
                .collect();
            assert_eq!(axis_log::quality::outliers(&x), [], "{i} {size}");
        }
    }
}

/// Pulses of a command are meant, and so is what answers them; a pulse that no command explains is an outlier.
#[test]
fn pulses_of_a_command_and_their_answers_stay() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    let mut noise = noise(3);
    let mut text = "t_s,iq_ref_a,iq_a\n".to_owned();
    for k in 0..3000_u32 {
        // One sample high every 50, and its answer two samples later; by itself one at sample 1540.
        let pulse = |k: u32| if k % 50 == 20 { 4.0 } else { 0.0 };
        let answer = if k < 2 { 0.0 } else { 0.8 * pulse(k - 2) };
        let glitch = if k == 1540 { 4.0 } else { 0.0 };
        let [a, b] = [0.0, 0.0].map(|_: f64| 1e-2 * noise());
        text += &format!(
            "{},{},{}\n",
            f64::from(k) * 1e-3,
            pulse(k) + a,
            answer + glitch + b
        );
    }
    std::fs::write(&path, text).unwrap();
    let taken_out = |exact: &[&str]| {
        let options = Options {
            exact,
            ..Options::default()
        };
        let prepared = prepare(&[&path], &Mapping::default(), &[], options).unwrap();
        let of = |name: &str| {
            prepared
                .log
                .missing(name)
                .iter()
                .map(|r| r.len())
                .sum::<usize>()
        };
        [of("iq_ref_a"), of("iq_a")]
    };
    assert_eq!(taken_out(&["iq_ref_a"]), [0, 1]);
    // Where nobody says that it is a command, its pulses look like outliers.
    assert_eq!(taken_out(&[]), [60, 61]);
}

#[test]
fn units_are_exact_and_wrong_ones_are_refused() {
    let scale = |channel: &str, unit: &str, counts: Option<f64>, factor: Option<f64>| {
        let unit = ColumnUnit {
            unit: Some(unit),
            counts_per_turn: counts,
            factor,
        };
        ColumnMap::in_unit("c", channel, unit).map(|m| m.scale)
    };
    for (channel, unit, exact) in [
        ("motor_angle_rad", "deg", PI / 180.0),
        ("motor_angle_rad", "rev", TAU),
        ("motor_speed_rad_s", "rpm", TAU / 60.0),
        ("position_m", "mm", 1e-3),
        ("position_m", "µm", 1e-6),
        ("position_m", "m", 1.0),
        ("iq_a", "mA", 1e-3),
        ("t_s", "ms", 1e-3),
        ("x_1", "%", 0.01),
    ] {
        assert_eq!(scale(channel, unit, None, None), Ok(exact), "{unit}");
    }
    assert_eq!(
        scale("motor_angle_rad", "counts", Some(10_000.0), Some(-1.0)),
        Ok(-TAU / 10_000.0)
    );
    assert_eq!(
        scale("torque_ref_n_m", "%", None, Some(1.3)),
        Ok(0.01 * 1.3)
    );
    let refused = |found: Result<f64, MappingError>| found.unwrap_err().to_string();
    assert!(refused(scale("torque_ref_n_m", "%", None, None)).contains("what 100 % is"));
    assert!(refused(scale("motor_angle_rad", "counts", None, None)).contains("counts_per_turn"));
    assert!(refused(scale("motor_angle_rad", "deg", Some(4.0), None)).contains("counts_per_turn"));
    assert!(refused(scale("position_m", "deg", None, None)).contains("another dimension"));
    assert!(refused(scale("position_m", "furlong", None, None)).contains("one of m mm um nm in %"));
}

proptest! {
    #[test]
    fn a_mapping_is_undone_by_its_inverse(
        raw in -1e9..1e9f64, factor in prop_oneof![-1e3..-1e-3f64, 1e-3..1e3f64],
        offset in -1e3..1e3f64, which in 0..5usize,
    ) {
        let (channel, unit) = [
            ("a_rad", "deg"), ("x_m", "mm"), ("w_rad_s", "rpm"), ("i_a", "mA"), ("p_1", "%"),
        ][which];
        let unit = ColumnUnit { unit: Some(unit), counts_per_turn: None, factor: Some(factor) };
        let map = ColumnMap { offset, ..ColumnMap::in_unit("c", channel, unit).unwrap() };
        let value = map.apply(raw);
        // Each of the four operations rounds once, and what is subtracted may cancel.
        let size = f64::EPSILON * (raw.abs() + 2.0 * (offset / map.scale).abs());
        prop_assert!((map.invert(value) - raw).abs() <= 4.0 * size, "{} {raw}", map.invert(value));
        let back = ColumnMap { scale: 1.0 / map.scale, offset: -offset / map.scale, ..map.clone() };
        prop_assert!((back.apply(value) - raw).abs() <= 6.0 * size);
    }

    #[test]
    fn a_given_delay_is_taken_out(delay in -0.02..0.02f64) {
        let folder = Folder::new();
        let rows = (0..1500).map(|k| f64::from(k) * 1e-3).map(|t| vec![t, position(t), position(t - delay)]);
        let path = folder.table("a.csv", "t_s,position_ref_m,late", rows);
        let mut map = ColumnMap::in_unit("late", "position_m", ColumnUnit::default()).unwrap();
        map.delay = delay;
        let mapping = Mapping { columns: vec![map], sample_rate_hz: None };
        let log = prepare(&[path], &mapping, &[], Options::default()).unwrap().log;
        prop_assert!(rms(&log, "position_m", position) < 1e-6);
        prop_assert!(rms(&log, "position_ref_m", position) < 1e-6);
    }
}

#[test]
fn the_rack_is_joined_with_the_delay_that_its_authors_give() {
    let Some(folder) = crate::needs::shared("data/rack") else {
        return;
    };
    let unit = |unit, factor| ColumnUnit {
        unit,
        factor,
        ..ColumnUnit::default()
    };
    let mut columns = vec![
        ColumnMap::in_unit("t_ms", "t_s", unit(Some("ms"), None)).unwrap(),
        ColumnMap::in_unit(
            "motor_speed_rpm",
            "motor_speed_rad_s",
            unit(Some("rpm"), Some(-1.0)),
        )
        .unwrap(),
        ColumnMap::in_unit("load_cell_v", "force_n", unit(None, Some(-200.0))).unwrap(),
    ];
    // The force is to be moved 4 ms later: it is early.
    columns[2].delay = -4e-3;
    let mapping = Mapping {
        columns,
        sample_rate_hz: None,
    };
    let paths = [folder.join("drive.csv"), folder.join("force.csv")];
    let found = prepare(
        &paths,
        &mapping,
        &["motor_speed_rad_s", "force_n"],
        Options::default(),
    )
    .unwrap();
    found.done.iter().for_each(|d| println!("{d}"));
    // 20 mm a turn, 24.7 kg: force over mass times acceleration, both low-passed by a mean
    // over 20 ms, is most alike where the delay is right.
    let speed: Vec<f64> = found
        .log
        .channel("motor_speed_rad_s")
        .unwrap()
        .iter()
        .map(|w| w * 0.02 / TAU)
        .collect();
    let force = found.log.channel("force_n").unwrap();
    let period = found.log.time()[1] - found.log.time()[0];
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let alike = |shift: usize| {
        let (mut xy, mut xx, mut yy) = (0.0, 0.0, 0.0);
        let n = speed.len();
        let pairs: Vec<(f64, f64)> = (40..n - 60)
            .map(|k| {
                let a = (speed[k + 15] - speed[k - 15]) / (30.0 * period);
                (24.7 * a, mean(&force[k + shift - 30..k + shift + 1]))
            })
            .collect();
        let (mx, my) = (
            mean(&pairs.iter().map(|p| p.0).collect::<Vec<_>>()),
            mean(&pairs.iter().map(|p| p.1).collect::<Vec<_>>()),
        );
        for (x, y) in pairs {
            xy += (x - mx) * (y - my);
            xx += (x - mx).powi(2);
            yy += (y - my).powi(2);
        }
        xy / (xx * yy).sqrt()
    };
    // A centred window of 31 ends 15 behind.
    let best = (0..40)
        .max_by(|&a, &b| alike(a).total_cmp(&alike(b)))
        .unwrap();
    println!(
        "best alignment of force and acceleration after the delay: {:.2} ms",
        (best as f64 - 15.0) * period * 1e3
    );
    assert!(alike(15) > 0.9, "{}", alike(15));
}
