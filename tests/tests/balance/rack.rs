//! A carriage on a rack, pushed once: github:KonradMnich/friction-identification (no
//! licence). The force is measured by a load cell, at another rate and on another clock.
//!
//! Published, by a static fit on force minus mass times acceleration: dry 10.0 N, viscous
//! 67.4 N·s/m, and up to 29.6 N at 13.5 mm/s.

use std::path::Path;

use axis_log::{Channel, Log};

use super::{axis, discover, folder, only, prepared};

const FROM: &str = "github:KonradMnich/friction-identification, as CSV (data/axes/rack-push.toml)";

/// By how much the load cell's clock is ahead of the drive's, s, as published.
const AHEAD: f64 = 0.004;

/// Two columns of a file.
fn columns(path: &Path, at: [usize; 2]) -> [Vec<f64>; 2] {
    let text = std::fs::read_to_string(path).unwrap();
    let column = |c: usize| -> Vec<f64> {
        let rows = text.lines().skip(1);
        rows.map(|row| row.split(',').nth(c).unwrap().parse().unwrap())
            .collect()
    };
    at.map(column)
}

/// Linear between neighbours, held at the ends.
fn at(times: &[f64], values: &[f64], t: f64) -> f64 {
    let after = times.partition_point(|x| *x <= t).clamp(1, times.len() - 1);
    let part = ((t - times[after - 1]) / (times[after] - times[after - 1])).clamp(0.0, 1.0);
    (1.0 - part) * values[after - 1] + part * values[after]
}

/// Speed and force on the drive's clock.
fn joined(folder: &Path) -> Log {
    let [ms, rpm] = columns(&folder.join("drive.csv"), [0, 1]);
    let [seconds, volts] = columns(&folder.join("force.csv"), [0, 1]);
    let zero = volts[..10].iter().sum::<f64>() / 10.0;
    let last = seconds[seconds.len() - 1] + AHEAD;
    let time: Vec<f64> = ms.iter().map(|t| 1e-3 * t).filter(|t| *t <= last).collect();
    let force = |t: &f64| -200.0 * (at(&seconds, &volts, t - AHEAD) - zero);
    let speed = rpm.iter().take(time.len()).map(|n| -n * 0.020 / 60.0);
    let force: Vec<f64> = time.iter().map(force).collect();
    Log::new(vec![
        Channel::new("t_s", time.clone()).unwrap(),
        Channel::new("velocity_m_s", speed.collect()).unwrap(),
        Channel::new("force_n", force).unwrap(),
    ])
    .unwrap()
}

/// One push is fitted; there is no other to check on, so effects are given, not searched.
#[test]
fn a_push_has_the_published_friction() {
    let Some(folder) = folder("rack", FROM) else {
        return;
    };
    let machine = axis("rack-push", "");
    let log = joined(&folder);
    let period = (log.time()[log.len() - 1] - log.time()[0]) / (log.len() - 1) as f64;
    let set = prepared(&machine, vec![("push".to_owned(), log, period)]);
    let effects = ["coulomb-friction", "viscous-friction"];
    let told = discover(&machine, &set, &set, &only(&effects));
    let [(dry, _), (viscous, _)] = effects.map(|e| told.value(e, 0));
    // The push says little of how friction is shared between the two; its sum in the
    // middle of the speeds agrees.
    for speed in [0.3, 0.4, 0.5] {
        let found = dry + speed * viscous;
        let published = 10.0 + speed * 67.4;
        println!("{speed} m/s: {found:.2} N beside {published:.2} N");
        assert!(
            (found / published - 1.0).abs() < 0.15,
            "{found} {published}"
        );
    }
}
