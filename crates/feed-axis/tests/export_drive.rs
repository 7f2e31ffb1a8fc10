//! `export drive` as a user runs it.

use crate::common::{refuse, succeed};
use serde_json::Value;

#[test]
fn terms_tables_and_loss_are_written_with_their_units() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("drive");
    let machine = "data/axes/liu2025-machine.toml";
    let said = succeed(&[
        "export",
        "drive",
        "--axis",
        machine,
        "--out",
        out.to_str().unwrap(),
    ]);
    assert!(
        said.contains("kg·cm²") && said.contains("N·m/(1000 rpm)"),
        "{said}"
    );
    assert!(
        said.contains("SINAMICS S120 p1460, SINAMICS S210 p1460, AX5000 S-0-0100")
            && said.contains("AX8000 3140:02 (0.095198 s)"),
        "{said}"
    );
    let json: Value =
        serde_json::from_slice(&std::fs::read(out.join("drive.json")).unwrap()).unwrap();
    let terms = json["terms"].as_array().unwrap();
    // Those of the correction, gains of position and speed, of both current controllers.
    assert_eq!(terms.len(), 24 + 3 + 4);
    // The file's k_p, 0.0678 A/rpm, by hand: 0.0678 · 30/π · 1.641; Kv of 46.7/s over 16.667 and T_n of 0.0678/0.7122.
    let drive_value = |name: &str| {
        let term = terms.iter().find(|term| term["name"] == name).unwrap();
        (
            term["drive_value"].as_f64().unwrap(),
            term["drive_unit"].as_str().unwrap(),
        )
    };
    for (name, value, unit) in [
        ("position_gain", 2.802, "(m/min)/mm"),
        ("speed_gain", 1.06245, "N·m/(rad/s)"),
        ("speed_integral_time", 95.198, "ms"),
        ("current_q_gain", 8.805, "V/A"),
        ("current_q_integral_time", 8.776, "ms"),
    ] {
        let (found, found_unit) = drive_value(name);
        assert!((found / value - 1.0).abs() < 1e-4, "{name}: {found}");
        assert_eq!(found_unit, unit);
    }
    for term in terms {
        for key in ["name", "unit", "drive_unit", "meaning"] {
            assert!(term[key].as_str().is_some_and(|s| !s.is_empty()), "{term}");
        }
        assert!(
            term["value"].is_f64() && term["drive_value"].is_f64(),
            "{term}"
        );
    }
    let loss = json["loss"].as_array().unwrap();
    assert_eq!((loss.len(), json["loss_unit"].as_str()), (6, Some("µm")));
    let max = |l: &Value, of: &str| l[of]["max"].as_f64().unwrap();
    assert!(loss.iter().all(|l| max(l, "none") > max(l, "drive_terms")));
    assert!(loss.iter().all(|l| max(l, "drive_terms") > max(l, "plan")));
    let csv = std::fs::read_to_string(out.join("drive.csv")).unwrap();
    assert!(
        csv.lines().count() == 34 && csv.starts_with("position (m),"),
        "{csv}"
    );
    assert!(!out.join("drive-turn.csv").exists());
}

/// Files that are there may stand in a drive's project already.
#[test]
fn an_export_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let of = |more: &[&str]| -> Vec<String> {
        let export = [&["export"][..], more].concat();
        export.iter().map(|word| (*word).to_owned()).collect()
    };
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (drive, code, component) = (at("drive"), at("c"), at("hal"));
    let axis = "data/axes/emps.toml";
    let plan = [
        "--axis",
        "data/axes/rack.toml",
        "--strategy",
        "plan",
        "--out",
    ];
    let commands = [
        (
            of(&["drive", "--axis", axis, "--out", &drive]),
            "drive.json",
        ),
        (of(&[&["c"][..], &plan, &[&code]].concat()), "plan.c"),
        (
            of(&[&["linuxcnc"][..], &plan, &[&component]].concat()),
            "plan.hal",
        ),
    ];
    for (command, file) in commands {
        let command: Vec<&str> = command.iter().map(String::as_str).collect();
        succeed(&command);
        let path = std::path::Path::new(command.last().unwrap()).join(file);
        std::fs::write(&path, "my own\n").unwrap();
        let message = refuse(&command);
        assert!(
            message.contains("exists already") && message.contains("--force"),
            "{message}"
        );
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "my own\n");
        succeed(&[&command[..], &["--force"]].concat());
        assert_ne!(std::fs::read_to_string(&path).unwrap(), "my own\n");
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("drive");
    let out = out.to_str().unwrap();
    let message = refuse(&["export", "drive", "--axis", "no-such.toml", "--out", out]);
    assert!(message.contains("no-such.toml"), "{message}");
    let message = refuse(&["export", "drive"]);
    assert!(message.contains("--out"), "{message}");
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let message = refuse(&["export", "drive", "--out", file.to_str().unwrap()]);
    assert!(message.contains("--out"), "{message}");
    // No trajectories: the terms all the same.
    let said = succeed(&[
        "export",
        "drive",
        "--axis",
        "data/axes/emps.toml",
        "--out",
        out,
    ]);
    assert!(said.contains("no [[trajectory]]"), "{said}");
}
