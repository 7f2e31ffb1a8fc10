//! The JSON Schemas of the files: current, and true of what the commands write.

use crate::common::{refuse, root, run, succeed};
use crate::schema_of::{assert_validates, committed};
use axis_sim::mechanism::MECHANISMS;
use clap::ValueEnum;
use feed_axis::commands::schema::File;
use serde_json::Value;

#[test]
fn the_committed_schemas_are_those_of_the_code() {
    for file in File::value_variants() {
        let value = file.to_possible_value().unwrap();
        let name = value.get_name();
        jsonschema::draft202012::meta::validate(&file.schema()).unwrap();
        assert!(
            file.schema() == committed(name),
            "make it anew: feed-axis schema {name} --out data/schemas/{name}.json"
        );
    }
}

#[test]
fn the_command_writes_the_schema() {
    let output = run(&["schema", "axis"]);
    let written: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(
        written == committed("axis"),
        "as in the folder data/schemas"
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s/discovery.json");
    succeed(&["schema", "discovery", "--out", path.to_str().unwrap()]);
    let file = root().join("data/schemas/discovery.json");
    assert_eq!(std::fs::read(path).unwrap(), std::fs::read(file).unwrap());
    let message = refuse(&["schema", "log"]);
    assert!(message.contains("axis, summary, discovery"), "{message}");
}

/// Of each kind of mechanism.
#[test]
fn files_of_new_validate() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    for kind in MECHANISMS {
        succeed(&["new", kind.name, "--kind", kind.name, "--out", out]);
        let text = std::fs::read_to_string(format!("{out}/{}.toml", kind.name)).unwrap();
        let file: Value = toml::from_str(&text).unwrap();
        assert_validates("axis", &file);
    }
}

/// A capture of another program is told with the mapping that it could have.
#[test]
fn log_inspect_proposes_a_mapping_and_applies_none() {
    let file = "crates/axis-log/tests/data/halscope.log";
    let said = succeed(&["log", "inspect", file]);
    assert!(said.contains("20 samples at 1000"), "{said}");
    assert!(said.contains("LinuxCNC halscope"), "{said}");
    assert!(
        said.contains("source = \"joint.0.motor-pos-cmd\""),
        "{said}"
    );
    assert!(said.contains("not known by name: pid.x.output"), "{said}");
    let output = run(&["log", "inspect", file, "--format", "json"]);
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let log = &found["logs"][0];
    assert_eq!(log["channels"].as_array().map(Vec::len), Some(0));
    assert_eq!(log["imported"][0]["others"][0], "pid.x.output");
}

/// So is a table of text, with its columns; `discover` says where to look.
#[test]
fn a_table_that_lacks_its_mapping_is_shown_with_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.csv");
    let rows: String = (0..20).map(|k| format!("{k};{},5;1\n", 600 + k)).collect();
    std::fs::write(&path, format!("Zeit [ms];Lage;CH3\n{rows}")).unwrap();
    let path = path.to_str().unwrap();
    let said = succeed(&["log", "inspect", path]);
    assert!(
        said.starts_with(&format!("{path}: text, semicolons between fields; 20 rows, 3 columns\nno log yet, as it has no time")),
        "{said}"
    );
    for part in [
        "column     unit     least  greatest      mean  numbers",
        "Lage       ?     6.0050e2  6.1950e2  6.1000e2       20",
        "proposed, for the axis file, 1000.0000 Hz",
        "source = \"Zeit [ms]\"\nchannel = \"t_s\"\nunit = \"ms\"",
        "source = \"Lage\"\nchannel = \"position_m\"\nunit = \"mm\"",
        "not known by name: CH3",
    ] {
        assert!(said.contains(part), "no {part:?} in\n{said}");
    }
    let output = run(&["discover", "--fit", path, "--check", path]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains(&format!("log inspect {path} shows")),
        "{said}"
    );
    // With its time it is a log whose columns are no channels yet.
    let timed = folder.path().join("timed.csv");
    let text = std::fs::read_to_string(path).unwrap();
    std::fs::write(&timed, text.replace("Zeit [ms]", "t_s")).unwrap();
    let output = run(&[
        "log",
        "inspect",
        timed.to_str().unwrap(),
        "--format",
        "json",
    ]);
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["logs"][0]["columns"][1]["name"], "Lage");
    assert_eq!(found["logs"][0]["columns"][1]["greatest"], 619.5);
}

/// A name that ends in a unit and means nothing is said, with those that do.
#[test]
fn a_mapped_channel_that_nothing_knows_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(
        at("drive.csv"),
        "t_s,Strom,x\n0,1,0\n0.001,2,1\n0.002,3,2\n",
    )
    .unwrap();
    let axis = std::fs::read_to_string(root().join("data/axes/rack.toml")).unwrap();
    let mapped = "\n[[log.column]]\nsource = \"Strom\"\nchannel = \"strom_a\"\n[[log.column]]\nsource = \"x\"\nchannel = \"position_m\"\n";
    std::fs::write(at("axis.toml"), axis + mapped).unwrap();
    let text = succeed(&[
        "log",
        "inspect",
        &at("drive.csv"),
        "--axis",
        &at("axis.toml"),
    ]);
    assert!(
        text.contains("\"strom_a\" of the mapping (source \"Strom\") is not used: known are "),
        "{text}"
    );
    assert!(
        text.contains("iq_a, ") && !text.contains("\"position_m\" of the mapping"),
        "{text}"
    );
}

/// The page of logs has every channel that means something, and no other.
#[test]
fn the_page_of_logs_lists_the_known_channels() {
    let page = std::fs::read_to_string(root().join("docs/logs.md")).unwrap();
    let section = page.split("## Channels").nth(1).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    let first = rows.map(|row| row.split('|').nth(1).unwrap());
    let mut listed: Vec<&str> = first
        .flat_map(|cell| cell.split('`').skip(1).step_by(2))
        .collect();
    listed.sort_unstable();
    let known: Vec<&str> = axis_sim::known_channels().collect();
    assert_eq!(listed, known);
}

/// One that lacks its time is shown with the mapping that would correct that, as JSON too.
#[test]
fn log_inspect_proposes_a_mapping_of_what_cannot_be_read_yet() {
    let file = "crates/axis-log/tests/data/sinumerik.json";
    let said = succeed(&["log", "inspect", file]);
    assert!(said.contains("20 rows, 5 columns\nno log yet"), "{said}");
    assert!(said.contains("SINUMERIK Data Recorder"), "{said}");
    assert!(said.contains("source = \"DES_POS|1\""), "{said}");
    let output = run(&["log", "inspect", file, "--format", "json"]);
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let log = &found["logs"][0];
    assert!(log["lacks"].as_str().unwrap().contains("t_s"), "{log}");
    assert_eq!(
        (&log["files"][0]["rows"], &log["samples"]),
        (&20.into(), &0.into())
    );
}

/// Each axis of a file is offered.
#[test]
fn log_inspect_offers_every_axis() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("robot.csv");
    let rows: String = (0..50).map(|k| format!("{k},{k},{}\n", 2 * k)).collect();
    std::fs::write(&path, format!("Time,Pos1 [deg],Pos2 [deg]\n{rows}")).unwrap();
    let said = succeed(&["log", "inspect", path.to_str().unwrap()]);
    for part in [
        "choose one.\n  Axis 1:\n",
        "source = \"Pos1 [deg]\"",
        "  or axis 2:\n[[log.column]]\nsource = \"Pos2 [deg]\"\nchannel = \"position_rad\"\nunit = \"deg\"",
    ] {
        assert!(said.contains(part), "no {part:?} in\n{said}");
    }
}
