//! The schema against the reader.

use std::sync::LazyLock;

use jsonschema::Validator;
use serde_json::Value;

use crate::{Axis, Registry};

static VALIDATOR: LazyLock<Validator> = LazyLock::new(|| {
    let schema = Registry::default().json_schema();
    jsonschema::draft202012::meta::validate(&schema).unwrap();
    jsonschema::draft202012::new(&schema).unwrap()
});

fn errors(text: &str) -> Vec<String> {
    let file: Value = toml::from_str(text).unwrap();
    VALIDATOR
        .iter_errors(&file)
        .map(|e| format!("{}: {e}", e.instance_path()))
        .collect()
}

/// Files of this project that the reader takes.
fn examples() -> Vec<(String, String)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes");
    let files = std::fs::read_dir(folder).unwrap();
    let paths = files.map(|file| file.unwrap().path());
    let mut all: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            (path.display().to_string(), text)
        })
        .collect();
    all.sort();
    assert!(all.len() > 10);
    all
}

#[test]
fn every_example_validates() {
    for (name, text) in examples() {
        let found = errors(&text);
        assert!(found.is_empty(), "{name}: {found:#?}");
    }
}

/// How each kind moves is seen, so that its file is held to one unit.
#[test]
fn every_kind_is_told_apart() {
    let registry = Registry::default();
    for kind in &registry.mechanisms {
        assert!(kind.example().is_some(), "{}", kind.name);
    }
    for kind in &registry.actuators {
        assert!(kind.example().is_some(), "{}", kind.name);
    }
}

/// Numbers of a file, as the places of their text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let (before, value) = line.split_once('=').unwrap_or((line, ""));
        let value = value.split('#').next().unwrap_or("").trim();
        if value.parse::<f64>().is_ok() && !before.trim_start().starts_with('#') {
            let from = at + line.find(value).unwrap().max(before.len());
            let from = from + text[from..].find(value).unwrap();
            found.push(from..from + value.len());
        }
        at += line.len();
    }
    found
}

/// Whatever a change of one place does: what the reader takes, the schema takes. Tested as its contrapositive: what the schema
/// refuses is refused by the reader, which refuses early: of what it takes it makes the whole plant.
#[test]
fn what_the_reader_takes_the_schema_takes() {
    let (mut taken, mut refused) = (0, 0);
    for (name, text) in examples() {
        for place in numbers(&text) {
            let old: f64 = text[place.clone()].parse().unwrap();
            for new in ["0", "1", "-1", "1e-3", "1000", "1e30"]
                .map(str::to_owned)
                .into_iter()
                .chain([format!("{:e}", 2.0 * old), format!("{:e}", -old)])
            {
                let mut changed = text.clone();
                changed.replace_range(place.clone(), &new);
                let found = errors(&changed);
                if found.is_empty() {
                    taken += 1;
                } else {
                    refused += 1;
                    let read = Axis::parse("changed", &changed);
                    assert!(read.is_err(), "{name}: {new} at {place:?}: {found:#?}");
                }
            }
        }
    }
    assert!(taken > 500 && refused > 500, "{taken}, {refused}");
}

/// A key more, a key less, a number beyond its limits, a second unit, another word.
#[test]
fn what_the_reader_refuses_of_keys_and_limits_the_schema_refuses() {
    let belt = include_str!("../../../../../data/axes/belt.toml");
    let paper = include_str!("../../../../../data/axes/liu2025.toml");
    let joint = include_str!("../../../../../data/axes/joint.toml");
    let insert = |text: &str, table: &str, line: &str| {
        assert!(text.contains(table), "{table}");
        text.replacen(table, &format!("{table}\n{line}"), 1)
    };
    let without = |text: &str, key: &str| {
        let kept = text.lines().filter(|line| !line.starts_with(key));
        let kept: Vec<&str> = kept.collect();
        assert!(kept.len() < text.lines().count(), "{key}");
        kept.join("\n") + "\n"
    };
    let cases = [
        insert(belt, "[mechanism]", "no_such_key = 1"),
        insert(belt, "[control]", "no_such_key = 1"),
        insert(belt, "[stroke]", "no_such_key = 1"),
        format!("{belt}\n[no_such_table]\nx = 1\n"),
        format!("{belt}\n[[effects]]\nname = \"no-such-effect\"\n"),
        format!("{belt}\n[[effects]]\nname = \"viscous-friction\"\nno_such = 1\n"),
        format!("{belt}\n[log]\nno_such = 1\n"),
        without(belt, "ratio"),
        without(belt, "schema"),
        without(belt, "name"),
        insert(&without(belt, "ratio"), "[mechanism]", "ratio = 1e9"),
        insert(&without(belt, "ratio"), "[mechanism]", "ratio = \"five\""),
        belt.replacen("kind = \"belt\"", "kind = \"bolt\"", 1),
        belt.replacen("schema = 2", "schema = 1", 1),
        insert(belt, "[mechanism]", "motor_inertia_kg_cm2 = 1.8"),
        insert(belt, "[stroke]", "start_deg = 1"),
        insert(joint, "[stroke]", "start_mm = 1"),
        insert(joint, "[control]", "following_error_limit_mm = 1"),
        insert(paper, "[mechanism]", "no_such_key = 1"),
        format!("{paper}\n[mechanisms]\nkind = \"belt\"\n"),
        paper.replacen("schema = 2", "schema = 3", 1),
    ];
    for (k, text) in cases.iter().enumerate() {
        let refused = Axis::parse("case", text);
        assert!(refused.is_err(), "case {k} is taken by the reader");
        assert!(!errors(text).is_empty(), "case {k} validates");
    }
}
