//! What a script relies on: exit codes, what stands on standard output, one JSON document.

use crate::common::{refuse, root, run, succeed, text};
use serde_json::Value;

/// Standard output of a command that must be done, as JSON.
fn json(arguments: &[&str]) -> Value {
    let output = run(&[arguments, &["--format", "json"]].concat());
    assert!(output.status.success(), "{arguments:?}: {}", text(&output));
    serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {}", text(&output)))
}

fn code(arguments: &[&str]) -> Option<i32> {
    run(arguments).status.code()
}

#[test]
fn every_way_to_end_has_its_code() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    assert_eq!(code(&["--help"]), Some(0));
    assert_eq!(
        code(&["simulate", "--axis", "no.toml", "--trajectory", "1"]),
        Some(1)
    );
    assert_eq!(code(&["simulate", "--no-such-option"]), Some(2));
    assert_eq!(code(&["simulate", "--trajectory", "9"]), Some(2));
    assert_eq!(
        code(&["simulate", "--trajectory", "1", "--noise", "-1"]),
        Some(2)
    );
    assert_eq!(
        code(&["new", "a/b", "--kind", "belt", "--out", out]),
        Some(2)
    );
    let lock = std::fs::File::create(folder.path().join("run.lock")).unwrap();
    lock.lock().unwrap();
    assert_eq!(code(&["sample", "--quick", "--out", out]), Some(3));
}

/// The figures of the text and of the document are the same.
#[test]
fn a_document_says_what_the_text_says() {
    let arguments = ["simulate", "--trajectory", "1"];
    let (said, found) = (succeed(&arguments), json(&arguments));
    let peak = found["errors_um"]["max"].as_f64().unwrap();
    assert!(
        said.contains(&format!("max {peak:.3} µm")),
        "{said} {found}"
    );
    assert_eq!(found["cycles"], 36320);
    let turning = [
        "simulate",
        "--axis",
        "data/axes/joint.toml",
        "--trajectory",
        "1",
    ];
    assert!(json(&turning)["errors_urad"]["max"].as_f64().unwrap() > 0.0);
}

/// Notes go to standard error; with `--quiet` nowhere.
#[test]
fn standard_output_carries_results_alone() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let man = run(&["man", "--out", out]);
    assert!(man.status.success() && man.stdout.is_empty() && !man.stderr.is_empty());
    let quiet = run(&["man", "--out", out, "--quiet"]);
    assert!(quiet.status.success() && quiet.stderr.is_empty());
    // An error is told however quiet.
    let failed = run(&["simulate", "--axis", "no.toml", "--trajectory", "1", "-q"]);
    assert!(text(&failed).contains("no.toml") && failed.stdout.is_empty());
}

#[test]
fn colour_is_as_asked() {
    let stderr = |when: &str, arguments: &[&str]| {
        let output = run(&[arguments, &["--color", when]].concat());
        String::from_utf8(output.stderr).unwrap()
    };
    for arguments in [
        &["simulate", "--nonsense"][..],
        &["simulate", "--axis", "no.toml", "--trajectory", "1"],
    ] {
        assert!(
            stderr("always", arguments).contains('\u{1b}'),
            "{arguments:?}"
        );
        assert!(
            !stderr("never", arguments).contains('\u{1b}'),
            "{arguments:?}"
        );
        // No terminal reads it here.
        assert!(
            !stderr("auto", arguments).contains('\u{1b}'),
            "{arguments:?}"
        );
    }
}

#[test]
fn a_written_axis_file_is_simulated_and_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let file = format!("{out}/saddle.toml");
    let new = ["new", "saddle", "--kind", "rack", "--out", out];
    assert_eq!(json(&new)["file"], file.as_str());
    json(&["simulate", "--axis", &file, "--trajectory", "2"]);
    std::fs::write(&file, "mine").unwrap();
    let again = refuse(&new);
    assert!(again.contains("--force"), "{again}");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "mine");
    succeed(&[&new[..], &["--force"]].concat());
    assert!(std::fs::read_to_string(&file).unwrap().contains("saddle"));
}

/// A gap of a hundred rows is told with its place, in the table, the document and the page.
#[test]
fn a_log_is_shown_with_its_gaps() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (log, page) = (at("log.csv"), at("log.html"));
    let rows = (0..2000).filter(|k| !(500..600).contains(k)).map(|k| {
        let t = f64::from(k) * 1e-3;
        format!("{t:.3},{:.6}\n", (6.0 * t).sin())
    });
    std::fs::write(
        &log,
        "t_s,position_m\n".to_owned() + &rows.collect::<String>(),
    )
    .unwrap();
    let inspect = ["log", "inspect", &log, "--report", &page];
    let said = succeed(&inspect);
    assert!(
        said.contains("position_m") && said.contains("100 in 1"),
        "{said}"
    );
    let found = json(&inspect);
    let channel = &found["logs"][0]["channels"][0];
    assert!((found["logs"][0]["rate_hz"].as_f64().unwrap() - 1e3).abs() < 1e-6);
    assert_eq!(channel["unit"], "m");
    assert_eq!(channel["gaps"][0]["samples"], 100);
    assert!((channel["gaps"][0]["from_s"].as_f64().unwrap() - 0.5).abs() < 1e-9);
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("gap: not measured"));
    // `log` by itself, as it was before.
    let pages = at("pages");
    succeed(&["log", &log, "--out", &pages]);
    assert!(root().join(pages).join("log.html").exists());
}

#[test]
fn shells_and_the_manual_know_every_command() {
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = succeed(&["completions", shell]);
        for word in ["simulate", "inspect", "kind"] {
            assert!(script.contains(word), "{word} for {shell}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    succeed(&["man", "--out", folder.path().to_str().unwrap()]);
    for page in [
        "feed-axis",
        "feed-axis-simulate",
        "feed-axis-log-inspect",
        "feed-axis-export-drive",
    ] {
        let page = std::fs::read_to_string(folder.path().join(format!("{page}.1"))).unwrap();
        assert!(page.starts_with(".ie") && page.contains(".SH OPTIONS"));
    }
}
