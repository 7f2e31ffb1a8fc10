//! The tuned examples are those of the axis files as they are.

use std::path::{Path, PathBuf};

use axis_sim::Axis;
use drive_loop::{LoopAnalysis, LoopError, LoopSet};
use toml::{Table, Value};

use crate::common::{refuse, root, succeed};

fn files(folder: &Path) -> Vec<PathBuf> {
    let all = std::fs::read_dir(folder).unwrap();
    let mut all: Vec<PathBuf> = all.map(|entry| entry.unwrap().path()).collect();
    all.retain(|path| path.extension().is_some_and(|end| end == "toml"));
    all.sort();
    all
}

fn table(path: &Path) -> Table {
    std::fs::read_to_string(path).unwrap().parse().unwrap()
}

/// What a file says besides gains: the keys that tuning sets, and paths, are left out.
fn besides_gains(path: &Path) -> Table {
    let mut all = table(path);
    for key in ["machine", "paper_tables"] {
        if let Some(Value::Table(experiment)) = all.get_mut("experiment") {
            experiment.remove(key);
        }
    }
    let Some(Value::Table(control)) = all.get_mut("control") else {
        panic!("{}: no [control]", path.display());
    };
    let gains = [
        "kv_",
        "position_gain_",
        "speed_proportional_",
        "speed_integral_",
        "speed_gain_",
        "acceleration_feedforward_",
        "notch_",
        "proportional_",
        "integral_",
        "derivative_n",
    ];
    control.retain(|key, _| !gains.iter().any(|gain| key.starts_with(gain)));
    all
}

/// Of every file with two loops there is one, which differs in its gains alone and keeps the limits.
#[test]
fn tuned_examples_are_the_files_with_gains_within_the_limits() {
    let folder = root().join("data/axes");
    let mut tuned = files(&folder.join("tuned"));
    for file in files(&folder) {
        let axis = Axis::read(&file).unwrap();
        let own = LoopAnalysis::of(&axis, &LoopSet::nominal());
        if matches!(own, Err(LoopError::Control { .. })) {
            continue;
        }
        let made = folder.join("tuned").join(file.file_name().unwrap());
        let name = made.display();
        let at = tuned.iter().position(|path| *path == made);
        tuned.remove(at.unwrap_or_else(|| panic!("{name} is missing: cargo xtask tuning --write")));
        let anew = "make it anew: cargo xtask tuning --write";
        assert_eq!(besides_gains(&file), besides_gains(&made), "{name}: {anew}");
        let axis = Axis::read(&made).unwrap();
        let worst = LoopAnalysis::of(&axis, &LoopSet::default()).unwrap().worst;
        let [now, late] = [worst.sensitivity, worst.sensitivity_late].map(Option::unwrap);
        assert!(
            now <= 1.6001 && late <= 2.0001,
            "{name}: {now} {late}; {anew}"
        );
    }
    assert!(tuned.is_empty(), "of no axis file: {tuned:?}");
}

/// Made anew, the quickest of them have the gains that they are committed with.
#[test]
fn tuned_examples_are_what_the_command_writes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let names = ["linear-motor", "rotary-table", "rack"];
    let said = succeed(&[&["tuning", "--write", "--out", out], &names[..]].concat());
    for name in names {
        assert!(said.contains(&format!("| {name} | ")), "{said}");
        let file = format!("{name}.toml");
        let kept = root().join("data/axes/tuned").join(&file);
        let [kept, made] = [kept, folder.path().join(&file)].map(|path| {
            let all = table(&path);
            all["control"].as_table().unwrap().clone()
        });
        assert!(made.keys().eq(kept.keys()), "{made} {kept}");
        for (key, value) in &made {
            let number = |v: &Value| v.as_float().or(v.as_integer().map(|i| i as f64));
            match (number(value), number(&kept[key])) {
                (Some(a), Some(b)) => assert!(
                    (a - b).abs() <= 5e-3 * b.abs(),
                    "{name}: {key} = {a}, not {b}: cargo xtask tuning --write"
                ),
                _ => assert_eq!(value, &kept[key], "{name}: {key}"),
            }
        }
    }
    let message = refuse(&["tuning", "--write", "--out", out, "lathe"]);
    assert!(message.contains("no axis file to tune"), "{message}");
}
