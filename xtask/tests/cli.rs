//! The developers' commands, and that the users' are among them.

use crate::common::{refuse, root, succeed};

#[test]
fn every_crate_depends_strictly_downward() {
    assert!(succeed(&["layers"]).contains("strictly downward"));
}

#[test]
fn no_two_crates_give_one_name_to_different_types() {
    assert!(succeed(&["names"]).contains("alone"));
}

#[test]
fn pages_name_the_crates_and_what_they_need() {
    assert!(succeed(&["crates"]).contains("described"));
}

#[test]
fn publishing_is_left_to_a_person() {
    assert!(refuse(&["publish"]).contains("only `publish --dry-run` is possible"));
}

#[test]
fn help_names_the_commands_of_users_and_of_developers() {
    let help = succeed(&["--help"]);
    for command in [
        "pipeline",
        "sample",
        "merge",
        "export-drive",
        "discover-matrix",
        "independent",
        "bench",
        "torture",
        "layers",
        "names",
        "crates",
        "publish",
    ] {
        assert!(help.contains(command), "{command}");
        let own = succeed(&[command, "--help"]);
        assert!(
            own.contains(&format!("Usage: cargo xtask {command}")),
            "{own}"
        );
    }
}

/// A message that names a command names the program that the user runs.
#[test]
fn messages_name_this_program() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let message = refuse(&["train", "--quick", "--out", out]);
    assert!(
        message.contains("first run `cargo xtask sample --out "),
        "{message}"
    );
}

#[test]
fn the_scored_page_is_not_taken_by_another_seed() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.md");
    std::fs::copy(
        root().join("data/outcomes/discover-matrix-seed-18.md"),
        &page,
    )
    .unwrap();
    let before = std::fs::read(&page).unwrap();
    let to = page.to_str().unwrap();
    let said = refuse(&["discover-matrix", "--seed", "1", "--page", to]);
    assert!(said.contains("page of seed 18, not 1"), "{said}");
    let said = refuse(&[
        "discover-matrix",
        "--seed",
        "18",
        "--first",
        "3",
        "--page",
        to,
    ]);
    assert!(said.contains("cannot be used with"), "{said}");
    assert_eq!(std::fs::read(&page).unwrap(), before);
}
