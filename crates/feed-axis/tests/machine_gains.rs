//! A machine's file with other gains than the axis file: said once, in words, in all that is written.

use serde_json::Value;

use crate::common::{root, succeed};

const AXIS: &str = "data/axes/liu2025.toml";

#[test]
fn gains_that_differ_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let text = std::fs::read_to_string(root().join("data/axes/liu2025-machine.toml")).unwrap();
    let other = text
        .replace(
            "speed_proportional_a_per_rpm = 0.0678",
            "speed_proportional_a_per_rpm = 0.05",
        )
        .replace("current_limit_a = 15", "current_limit_a = 12");
    assert!(other.matches("= 0.05").count() == 1 && other.contains("= 12"));
    std::fs::write(at("other.toml"), other).unwrap();
    let gain =
        "control.speed_proportional_a_per_rpm is 0.0678 in the axis file and 0.05 in the machine's";
    let limit = "current_limit_a is 15 in the axis file and 12 in the machine's";

    let moves = [
        "compensate",
        "--axis",
        AXIS,
        "--strategy",
        "drive-terms",
        "--moves",
        "1",
    ];
    let export = ["export", "drive", "--axis", AXIS];
    let (json, drive) = (at("moves.json"), at("drive"));
    let with = |machine: &str| -> [(String, String); 2] {
        let machine = ["--machine", machine];
        let moved = succeed(&[&moves[..], &machine, &["--json", &json]].concat());
        let exported = succeed(&[&export[..], &machine, &["--out", &drive, "--force"]].concat());
        [
            (moved, json.clone()),
            (exported, format!("{drive}/drive.json")),
        ]
    };
    let listed = |file: &str| -> Vec<String> {
        let found: Value = serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
        let all = found["control_differences"].as_array().unwrap().iter();
        all.map(|one| one.as_str().unwrap().to_owned()).collect()
    };
    for (said, file) in with(&at("other.toml")) {
        for part in [gain, limit] {
            assert_eq!(said.matches(part).count(), 1, "{said}");
        }
        assert_eq!(listed(&file), [gain, limit]);
    }
    // Other friction, the same gains, however they are spelt: Kv of 280.2 rpm/mm and 10 mm a turn, T_n of k_p/k_i.
    let spelt = text
        .replace("position_gain_rpm_per_mm = 280.2", "kv_per_s = 46.7")
        .replace(
            "speed_integral_a_per_rpm_s = 0.7122",
            &format!("speed_integral_time_s = {:e}", 0.0678 / 0.7122),
        );
    assert!(spelt.contains("kv_per_s") && spelt.contains("integral_time"));
    std::fs::write(at("spelt.toml"), spelt).unwrap();
    for machine in [
        "data/axes/liu2025-machine.toml".to_owned(),
        at("spelt.toml"),
    ] {
        for (said, file) in with(&machine) {
            assert!(!said.contains("warning"), "{machine}: {said}");
            assert!(listed(&file).is_empty());
        }
    }
}
