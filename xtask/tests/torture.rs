//! A short torture: no damaged or made-up input, and no disturbed run, shows a fault.
//! The long one is `cargo xtask torture` (docs/reliability.md).

use crate::common::{refuse, succeed};

#[test]
fn inputs_are_read_or_refused_the_same_way_each_time() {
    let run = || {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().to_str().unwrap();
        let said = succeed(&["torture", "--inputs", "4000", "--kills", "0", "--out", out]);
        assert!(said.contains("no faults"), "{said}");
        let counts = said
            .lines()
            .take_while(|line| !line.contains("memory of a worker"));
        counts.map(str::to_owned).collect::<Vec<_>>()
    };
    let counts = run();
    assert!(counts.last().unwrap().contains("4000"), "{counts:?}");
    assert_eq!(run(), counts);
}

#[test]
fn disturbed_runs_are_mended_by_the_next() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let said = succeed(&[
        "torture", "--inputs", "0", "--kills", "3", "--once", "--out", out,
    ]);
    assert!(said.contains("no faults"), "{said}");
    for way in [
        "twice at once",
        "limited in size",
        "read-only",
        "killed in a stage",
    ] {
        assert!(said.contains(way), "{said}");
    }
}

#[test]
fn a_folder_in_which_a_run_is_at_work_is_left_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let lock = std::fs::File::create(folder.path().join("run.lock")).unwrap();
    lock.lock().unwrap();
    for command in ["pipeline", "sample", "study", "report"] {
        let message = refuse(&[command, "--quick", "--out", out]);
        assert!(message.contains("another run is at work in"), "{message}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    drop(lock);
    succeed(&["sample", "--quick", "--out", out]);
}

#[test]
fn a_time_that_is_none_is_refused() {
    for minutes in ["nan", "-1", "1e9"] {
        let message = refuse(&["torture", &format!("--minutes={minutes}")]);
        assert!(message.contains("give 0 to 100000"), "{message}");
    }
}
