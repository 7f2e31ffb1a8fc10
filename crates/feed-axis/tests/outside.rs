//! The installed command in a folder of a user's own, with file names as users have them.

use std::path::Path;
use std::process::{Command, Output};

use crate::common::text;

const PROGRAM: &str = env!("CARGO_BIN_EXE_feed-axis");

/// The command, in that folder.
pub fn run_in(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(PROGRAM)
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

pub fn succeed_in(folder: &Path, arguments: &[&str]) -> String {
    let output = run_in(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", text(&output));
    text(&output)
}

/// The message of a command that must fail, its line breaks taken out.
pub fn refuse_in(folder: &Path, code: i32, arguments: &[&str]) -> String {
    let output = run_in(folder, arguments);
    assert_eq!(output.status.code(), Some(code), "{}", text(&output));
    text(&output)
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

/// Runs a line in a shell, where `feed-axis` is the program that is tested.
#[cfg(unix)]
fn in_a_shell(folder: &Path, line: &str) -> String {
    let bin = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(PROGRAM, bin.path().join("feed-axis")).unwrap();
    let path = format!("{}:/usr/bin:/bin", bin.path().display());
    let output = Command::new("sh")
        .args(["-c", line])
        .env("PATH", path)
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{line}: {}", text(&output));
    text(&output)
}

/// What stands between backquotes.
fn commands(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

/// The greatest tracking error that `simulate` prints.
fn peak(said: &str) -> f64 {
    let after = said.split("error max ").nth(1).unwrap();
    after.split(' ').next().unwrap().parse().unwrap()
}

/// A default that is not there is no default: what to give instead is said.
#[test]
fn outside_of_the_project_an_axis_file_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["pipeline"][..],
        &["simulate", "--trajectory", "1"],
        &["export", "drive", "--out", "drive"],
        &["export", "c", "--strategy", "plan", "--out", "c"],
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_feed-axis"))
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let message = text(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        for help in ["--axis FILE", "feed-axis new NAME --kind KIND"] {
            assert!(message.contains(help), "{message}");
        }
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// The line that `new` prints, pasted into a shell.
#[test]
#[cfg(unix)]
fn the_next_command_works_with_spaces_in_a_name() {
    let folder = tempfile::tempdir().unwrap();
    let said = succeed_in(folder.path(), &["new", "my axis", "--kind", "rack"]);
    let next = said.trim().split("next: ").nth(1).unwrap();
    assert!(in_a_shell(folder.path(), next).contains("tracking error"));
}

/// A strategy that needs results says which commands make them; run as they are printed, they do.
#[test]
#[cfg(unix)]
fn the_commands_of_a_hint_make_what_was_missing() {
    let folder = tempfile::tempdir().unwrap();
    succeed_in(folder.path(), &["new", "my axis", "--kind", "rigid-mass"]);
    let asked = [
        "simulate",
        "--axis",
        "my axis.toml",
        "--trajectory",
        "1",
        "--quick",
        "--seed",
        "3",
        "--set",
        "mechanism.mass_kg=90",
        "--out",
        "the results",
        "--compensation",
    ];
    for (strategy, stages) in [
        ("network", ["sample", "train"].as_slice()),
        ("transfer-function", &["identify"]),
    ] {
        let asked = [&asked[..], &[strategy]].concat();
        let message = refuse_in(folder.path(), 1, &asked);
        let hint = commands(&message);
        assert_eq!(hint.len(), stages.len(), "{message}");
        for (line, stage) in hint.iter().zip(stages) {
            assert!(
                line.starts_with(&format!("feed-axis {stage} ")),
                "{message}"
            );
            in_a_shell(folder.path(), line);
        }
        succeed_in(folder.path(), &asked);
    }
}

/// Every kind that `new` writes has a feedback, which does what it is for.
#[test]
fn what_new_writes_can_be_compensated() {
    let folder = tempfile::tempdir().unwrap();
    for kind in [
        "ball-screw",
        "screw-datasheet",
        "rack",
        "belt",
        "gear",
        "linear-motor",
        "torque-motor",
        "rigid-mass",
    ] {
        succeed_in(folder.path(), &["new", kind, "--kind", kind]);
        let file = format!("{kind}.toml");
        let peaks = ["none", "plan", "feedback"].map(|strategy| {
            let run = [
                "simulate",
                "--axis",
                &file,
                "--trajectory",
                "1",
                "--compensation",
                strategy,
            ];
            peak(&succeed_in(folder.path(), &run))
        });
        println!("{kind}: none, plan, feedback {peaks:?}");
        // The joint has no sensor behind a soft gear: its feedback is slow, and worth less than its plan.
        let share = if kind == "gear" { 0.2 } else { 0.1 };
        assert!(
            peaks[1] < share * peaks[0] && peaks[2] < share * peaks[0],
            "{kind}: {peaks:?}"
        );
    }
}

/// No motion, a wrong one, or a file without any: the trajectories that there are, and what else
/// would be valid.
#[test]
fn a_missing_motion_is_told_with_those_that_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed_in(folder, &["new", "x", "--kind", "gear"]);
    let two = "trajectories 1 (by 60 ° at up to 90 °/s), 2 (by -20 ° at up to 30 °/s)";
    let message = refuse_in(folder, 2, &["simulate", "--axis", "x.toml"]);
    assert!(
        message.contains("--program FILE, or --trajectory N") && message.contains(two),
        "{message}"
    );
    for number in ["0", "3"] {
        let message = refuse_in(
            folder,
            2,
            &["simulate", "--axis", "x.toml", "--trajectory", number],
        );
        assert!(message.contains(two), "{message}");
    }
    let compensate = [
        "compensate",
        "--axis",
        "x.toml",
        "--strategy",
        "plan",
        "--moves",
        "7",
    ];
    assert!(refuse_in(folder, 2, &compensate).contains(two));

    let text = std::fs::read_to_string(folder.join("x.toml")).unwrap();
    let (before, _) = text.split_once("[[trajectory]]").unwrap();
    std::fs::write(folder.join("none.toml"), before).unwrap();
    for more in [&["--trajectory", "1"][..], &[]] {
        let message = refuse_in(
            folder,
            2,
            &[&["simulate", "--axis", "none.toml"], more].concat(),
        );
        assert!(
            message.contains("has no [[trajectory]]: add one"),
            "{message}"
        );
    }
}

/// From nothing but the installed program to what a model lacks: an axis, its motions, logs of a
/// machine with more friction, and the search.
#[test]
fn a_search_needs_no_clone() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for kind in ["screw-datasheet", "gear"] {
        succeed_in(
            folder,
            &["new", "x", "--kind", kind, "--programs", "--force"],
        );
        for program in ["x-fit.toml", "x-check.toml"] {
            succeed_in(
                folder,
                &["simulate", "--axis", "x.toml", "--program", program],
            );
        }
    }
    succeed_in(
        folder,
        &["new", "y", "--kind", "linear-motor", "--programs"],
    );
    // Four times that of the file: its residual is 67 times the noise.
    let machine = "friction.viscous_n_s_per_m=200";
    for (log, seed) in [("fit", "1"), ("check", "2")] {
        let (program, log) = (format!("y-{log}.toml"), format!("{log}.csv"));
        succeed_in(
            folder,
            &[
                "simulate",
                "--axis",
                "y.toml",
                "--set",
                machine,
                "--program",
                &program,
                "--noise",
                "1",
                "--exact",
                "--seed",
                seed,
                "--log",
                &log,
            ],
        );
    }
    let said = succeed_in(
        folder,
        &[
            "discover",
            "--axis",
            "y.toml",
            "--fit",
            "fit.csv",
            "--check",
            "check.csv",
        ],
    );
    assert!(said.contains("The model lacks viscous-friction."), "{said}");
    assert!(said.contains("coefficient 0.150"), "{said}");
    assert!(folder.join("runs/y/discover/report.html").exists());
}

/// A refused feedback names a change that gives the axis one; made, it does.
#[test]
fn what_a_refusal_names_gives_a_feedback() {
    let axis = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/joint.toml");
    let folder = tempfile::tempdir().unwrap();
    let asked = [
        "simulate",
        "--axis",
        axis,
        "--trajectory",
        "2",
        "--compensation",
        "feedback",
    ];
    let message = refuse_in(folder.path(), 1, &asked);
    let named = "or this axis with the position controller at the rate of the control (4 kHz)";
    assert!(message.contains(named), "{message}");
    let changed = [&asked[..], &["--set", "control.position_rate_khz=4"]].concat();
    succeed_in(folder.path(), &changed);
}
