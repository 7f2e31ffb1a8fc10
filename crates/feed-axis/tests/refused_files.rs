//! Files that commands do not read or write: empty axis files, names that cannot be meant, work of one's own.

use crate::outside::{refuse_in, succeed_in};

/// A file with nothing in it, or without a mechanism, is no ball screw: what it needs, and what
/// writes it.
#[test]
fn an_empty_axis_file_is_asked_for_a_mechanism() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for text in ["", "# nothing yet\n", "schema = 2\nname = \"x\"\n"] {
        std::fs::write(folder.join("empty.toml"), text).unwrap();
        std::fs::write(folder.join("log.csv"), "t_s,position_m\n0,0\n0.001,0\n").unwrap();
        for command in [
            &["simulate", "--trajectory", "1"][..],
            &["analyse"],
            &["tune", "--out", "tuned.toml"],
            &["log", "inspect", "log.csv"],
            &[
                "identify-control",
                "--fit",
                "log.csv",
                "--check",
                "log.csv",
                "--out",
                "c.toml",
            ],
        ] {
            let message = refuse_in(folder, 1, &[command, &["--axis", "empty.toml"]].concat());
            for part in ["`mechanism` is missing", "feed-axis new NAME --kind KIND"] {
                assert!(message.contains(part), "{command:?}: {message}");
            }
            assert!(!message.contains("screw"), "{message}");
        }
    }
}

/// Every option that names a page or another file to write.
#[test]
fn files_that_cannot_be_meant_are_refused_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed_in(folder, &["new", "x", "--kind", "rigid-mass"]);
    succeed_in(
        folder,
        &[
            "simulate",
            "--axis",
            "x.toml",
            "--trajectory",
            "1",
            "--log",
            "log.csv",
        ],
    );
    let axis = ["--axis", "x.toml"];
    let simulate = [&["simulate", "--trajectory", "1"][..], &axis].concat();
    let tune = [&["tune"][..], &axis].concat();
    for command in [
        &simulate,
        &[&["analyse"][..], &axis].concat(),
        &[&tune[..], &["--out", "t.toml"]].concat(),
        &vec!["contour", "--x", "x.toml", "--y", "x.toml"],
        &vec!["log", "inspect", "log.csv"],
    ] {
        for name in ["motion.txt", "motion", "-"] {
            let message = refuse_in(folder, 2, &[&command[..], &["--report", name]].concat());
            let part = if name == "-" {
                "standard output"
            } else {
                "such as motion.html"
            };
            assert!(message.contains(part), "{message}");
        }
    }
    for command in [
        &[&simulate[..], &["--log", "-", "--format", "json"]].concat(),
        &[&tune[..], &["--out", "-"]].concat(),
        &vec!["log", "convert", "log.csv", "--out", "-"],
        &vec!["schema", "axis", "--out", "-"],
        &[
            &["learn", "--log", "log.csv", "--correction", "-"][..],
            &axis,
        ]
        .concat(),
        &[&["sample", "--count", "5", "--file", "-"][..], &axis].concat(),
    ] {
        let message = refuse_in(folder, 2, command);
        assert!(message.contains("standard output"), "{message}");
    }
    let message = refuse_in(folder, 2, &[&simulate[..], &["--log", "log"]].concat());
    assert!(
        message.contains("the name has no extension: it must be .csv"),
        "{message}"
    );
    let mut there: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    there.sort();
    assert_eq!(there, ["log.csv", "x.toml"]);
}

/// An axis file that is there may have been edited: it is written over only where that is asked
/// for, by every command that writes one.
#[test]
fn an_axis_file_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let new = ["new", "x", "--kind", "rigid-mass"];
    succeed_in(folder, &new);
    succeed_in(
        folder,
        &[
            "simulate",
            "--axis",
            "x.toml",
            "--trajectory",
            "1",
            "--log",
            "a.csv",
        ],
    );
    std::fs::write(folder.join("own.toml"), "# my own work\n").unwrap();
    let tune = ["tune", "--axis", "x.toml", "--out", "own.toml"];
    let control = [
        "identify-control",
        "--axis",
        "x.toml",
        "--fit",
        "a.csv",
        "--check",
        "a.csv",
        "--out",
        "own.toml",
    ];
    for command in [&new[..], &tune, &control] {
        let message = refuse_in(folder, 1, command);
        assert!(
            message.contains("exists already") && message.contains("--force"),
            "{message}"
        );
    }
    assert_eq!(
        std::fs::read_to_string(folder.join("own.toml")).unwrap(),
        "# my own work\n"
    );
    succeed_in(folder, &[&tune[..], &["--force"]].concat());
    assert!(
        std::fs::read_to_string(folder.join("own.toml"))
            .unwrap()
            .contains("[mechanism]")
    );
}
