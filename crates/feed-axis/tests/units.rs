//! Figures of an axis that turns are in its own unit, in every file, table and page.

use std::path::Path;

use crate::common::{run, succeed, text};
use crate::schema_of::assert_validates;
use serde_json::Value;

/// A turning axis with one short move, so that a whole pipeline is quick.
fn table(folder: &Path) -> String {
    let root = crate::common::root();
    let file = std::fs::read_to_string(root.join("data/axes/rotary-table.toml")).unwrap();
    let head = file.split("[[trajectory]]").next().unwrap();
    let short = "[[trajectory]]\ndisplacement_deg = 20\nspeed_deg_per_s = 60\n\
        acceleration_deg_per_s2 = 300\njerk_deg_per_s3 = 3000\n";
    let path = folder.join("table.toml");
    std::fs::write(&path, format!("{head}{short}")).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Names of everything that a document holds.
fn names(of: &Value, to: &mut Vec<String>) {
    match of {
        Value::Object(map) => map.iter().for_each(|(name, value)| {
            to.push(name.clone());
            names(value, to);
        }),
        Value::Array(all) => all.iter().for_each(|value| names(value, to)),
        _ => {}
    }
}

/// No name of a document ends in a unit of length.
fn assert_turns(what: &str, document: &Value) {
    let mut all = Vec::new();
    names(document, &mut all);
    assert!(!all.is_empty(), "{what}");
    for name in all {
        let of_length = ["_um", "_mm", "_m", "_mm_s", "_mm_s2", "_mm_s3"];
        assert!(
            !of_length.iter().any(|end| name.ends_with(end)),
            "{what}: {name}"
        );
    }
}

fn json_files(folder: &Path) -> Vec<std::path::PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => found.extend(json_files(&path)),
            false if path.extension().is_some_and(|e| e == "json") => found.push(path),
            false => {}
        }
    }
    found
}

/// Every file of a pipeline, its documents and its report.
#[test]
fn a_pipeline_of_a_turning_axis_has_no_length_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let axis = table(folder.path());
    let out = folder.path().join("run");
    let arguments = [
        "pipeline",
        "--quick",
        "--axis",
        &axis,
        "--out",
        out.to_str().unwrap(),
    ];
    let said = succeed(&arguments);
    assert!(said.contains("µrad") && !said.contains("µm"), "{said}");
    let files = json_files(&out);
    assert!(files.len() > 8, "{files:?}");
    for file in files {
        let document = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
        assert_turns(&file.display().to_string(), &document);
    }
    let summary = std::fs::read(out.join("summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    assert_validates("summary", &summary);
    let errors = &summary["trajectories"][0]["errors_urad"];
    assert!(errors["machine"]["max"].as_f64().unwrap() > 0.0, "{errors}");
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    for length in ["µm", "mm/s", " mm", "read mrad"] {
        let text = &page;
        let near = text.find(length).map(|at| {
            let from = text[..at]
                .char_indices()
                .rev()
                .nth(60)
                .map_or(0, |(i, _)| i);
            text[from..at + length.len()].to_owned()
        });
        assert_eq!(near, None, "{length}");
    }
    // As documents: what each command prints.
    for command in ["validate", "compensate", "train", "identify"] {
        let mut arguments = arguments.to_vec();
        arguments[0] = command;
        let output = run(&[&arguments[..], &["--format", "json"]].concat());
        assert!(output.status.success(), "{}", text(&output));
        assert_turns(command, &serde_json::from_slice(&output.stdout).unwrap());
    }
}

/// Moves, with what is learned of them; one motion and its page.
#[test]
fn moves_and_motions_of_a_turning_axis_are_in_its_unit() {
    let folder = tempfile::tempdir().unwrap();
    let axis = table(folder.path());
    let (json, page) = (
        folder.path().join("moves.json"),
        folder.path().join("page.html"),
    );
    let said = succeed(&[
        "compensate",
        "--axis",
        &axis,
        "--machine",
        &axis,
        "--strategy",
        "adaptive",
        "--moves",
        "1",
        "--json",
        json.to_str().unwrap(),
    ]);
    assert!(
        said.contains("max / mean in µrad") && said.contains("free_travel_urad"),
        "{said}"
    );
    let moves: Value = serde_json::from_slice(&std::fs::read(json).unwrap()).unwrap();
    assert_turns("moves.json", &moves);
    let entry = &moves["moves"][0];
    assert!(
        entry["errors_urad"]["compensated"]["max"].is_f64(),
        "{entry}"
    );
    assert!(entry["learned"]["free_travel_urad"].is_f64(), "{entry}");

    let page = page.to_str().unwrap();
    succeed(&[
        "simulate",
        "--axis",
        &axis,
        "--trajectory",
        "1",
        "--report",
        page,
    ]);
    let html = std::fs::read_to_string(page).unwrap();
    assert!(html.contains("µrad") && !html.contains("µm"));
}

/// A table of errors of such an axis names its unit, and one of lengths is not taken for it.
#[test]
fn a_table_of_errors_is_in_the_unit_of_the_axis() {
    let folder = tempfile::tempdir().unwrap();
    let axis = table(folder.path());
    let out = folder.path().join("out");
    let measured = folder.path().join("errors.csv");
    let rank = |unit: &str| {
        std::fs::write(
            &measured,
            format!("trajectory,max_{unit},mean_{unit}\n1,300,100\n"),
        )
        .unwrap();
        run(&[
            "discover",
            "--axis",
            &axis,
            "--summary",
            measured.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
        ])
    };
    let output = rank("um");
    assert!(!output.status.success());
    assert!(
        text(&output).contains("experiment_max_urad or max_urad"),
        "{}",
        text(&output)
    );
    let output = rank("urad");
    assert!(output.status.success(), "{}", text(&output));
    assert!(out.join("ranking.json").exists() && out.join("ranking.html").exists());
}
