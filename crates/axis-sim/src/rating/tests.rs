//! Every key does something, and stands in the page.

use super::*;
use crate::part::Kind;

const PAGE: &str = include_str!("../../../../docs/check.md");

fn axis(name: &str) -> Axis {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes");
    Axis::read(&std::path::Path::new(folder).join(name)).unwrap()
}

/// A duty with forces of both signs, regeneration and travel.
fn checked(axis: &Axis) -> Vec<CheckedItem> {
    let mut duty = AxisDuty::of(axis).unwrap();
    let turns = axis.travel_per_radian();
    for (speed, torque) in [(200.0, 6.0), (150.0, -5.0), (-100.0, 4.0), (0.0, 1.0)] {
        duty.push(&DutyStretch {
            duration: 0.1,
            speed: speed * turns,
            acceleration: 0.1 * torque,
            torque,
            current: [0.5, torque / axis.torque_constant()],
        })
        .unwrap();
    }
    axis.checked(&duty).unwrap()
}

/// With all keys set to something, another value of each changes what is found, on one of these axes.
#[test]
fn every_key_changes_an_item() {
    let axes = ["screw-datasheet.toml", "belt.toml"].map(axis);
    let set = |axis: &mut Axis, key: &crate::part::Key, other: bool| match &key.kind {
        Kind::Word(words) => {
            let word = if other { words.last() } else { words.first() };
            axis.rating
                .values
                .set_word(key.name, word.copied().unwrap());
        }
        _ => {
            let value = match (key.name, other) {
                ("brake_on_voltage" | "dc_link_limit", false) => 650.0,
                ("brake_on_voltage" | "dc_link_limit", true) => 660.0,
                ("winding_temperature_limit", false) => 155.0,
                ("belt_teeth_in_mesh", false) => 9.0,
                ("nut_preload" | "bearing_preload", _) => {
                    if other {
                        3500.0
                    } else {
                        3000.0
                    }
                }
                (_, false) => 0.5,
                (_, true) => 0.6,
            };
            let value = if key.name == "winding_temperature_limit" && other {
                156.0
            } else {
                value
            };
            axis.rating.values.set(key.name, value);
        }
    };
    for key in RATING_KEYS {
        let changes = axes.iter().any(|axis| {
            let mut full = axis.clone();
            RATING_KEYS
                .iter()
                .for_each(|key| set(&mut full, key, false));
            let mut changed = full.clone();
            set(&mut changed, key, true);
            checked(&full) != checked(&changed)
        });
        assert!(changes, "{}", key.name);
        assert!(
            PAGE.contains(&format!("`{}`", key.name)),
            "{} in docs/check.md",
            key.name
        );
    }
}

/// Whatever is not stated is asked for by a key that exists, and that key is enough.
#[test]
fn what_is_not_known_names_keys_that_make_it_known() {
    for file in [
        "screw-datasheet.toml",
        "belt.toml",
        "linear-motor.toml",
        "rotary-table.toml",
        "joint.toml",
    ] {
        let mut axis = axis(file);
        for _ in 0..4 {
            for item in checked(&axis) {
                let ItemState::NotKnown { keys, .. } = item.state else {
                    continue;
                };
                assert!(!keys.is_empty(), "{file}: {}", item.name);
                for name in keys {
                    if name.starts_with("thermal.motor_constant_n") {
                        axis.thermal.set("motor_constant", 1.0);
                        continue;
                    }
                    let key = RATING_KEYS
                        .iter()
                        .find(|key| key.spellings().contains(&name));
                    let key =
                        key.unwrap_or_else(|| panic!("{file}: {} asks for {name}", item.name));
                    match &key.kind {
                        Kind::Word(words) => axis.rating.values.set_word(key.name, words[0]),
                        _ => axis.rating.values.set(key.name, 700.0),
                    }
                }
            }
        }
        let all = checked(&axis);
        assert!(
            all.iter()
                .all(|item| item.verdict() != ItemVerdict::NotKnown),
            "{file}: {all:?}"
        );
    }
}
