//! Text files as Windows' programs write them: with a byte-order mark, in UTF-16, or in an encoding that is not known.

use std::path::Path;

use crate::common::{refuse, root, succeed};

/// The bytes of a text.
type Encoded = fn(&str) -> Vec<u8>;

/// The encodings that are plain by their first bytes.
fn encodings() -> [(&'static str, Encoded); 4] {
    let marked = |text: &str| [b"\xef\xbb\xbf", text.as_bytes()].concat();
    let low = |text: &str| -> Vec<u8> {
        let units = format!("\u{feff}{text}");
        units.encode_utf16().flat_map(u16::to_le_bytes).collect()
    };
    let high = |text: &str| -> Vec<u8> {
        let units = format!("\u{feff}{text}");
        units.encode_utf16().flat_map(u16::to_be_bytes).collect()
    };
    let bare = |text: &str| -> Vec<u8> { text.encode_utf16().flat_map(u16::to_le_bytes).collect() };
    [
        ("a mark", marked),
        ("UTF-16 LE", low),
        ("UTF-16 BE", high),
        ("UTF-16 without a mark", bare),
    ]
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> String {
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path.display().to_string()
}

const PROGRAM: &str = "start_mm = 600\n[[steps]]\nmove_by = { by_mm = 2, velocity_mm_s = 50, acceleration_mm_s2 = 1000, jerk_mm_s3 = 50000 }\n";

#[test]
fn files_in_utf_16_and_with_a_mark_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let axis = std::fs::read_to_string(root().join("data/axes/linear-motor.toml")).unwrap();
    // A sign beyond ASCII, in both.
    let axis = format!("# Träger, µ\n{axis}");
    let program = PROGRAM.replace("600", "200");
    let plain = [
        write(folder, "axis.toml", axis.as_bytes()),
        write(folder, "program.toml", program.as_bytes()),
    ];
    let made =
        |axis: &str, program: &str| succeed(&["simulate", "--axis", axis, "--program", program]);
    let expected = made(&plain[0], &plain[1]);
    for (what, encoded) in encodings() {
        let axis = write(folder, "encoded.toml", &encoded(&axis));
        let program = write(folder, "encoded-program.toml", &encoded(&program));
        assert_eq!(made(&axis, &program), expected, "{what}");
        // Through `--set` the text is read again.
        let said = succeed(&["analyse", "--axis", &axis, "--set", "name=other"]);
        assert!(said.contains("loops of other"), "{what}: {said}");
    }
}

#[test]
fn a_machine_file_is_read_alike() {
    let folder = tempfile::tempdir().unwrap();
    let axes = root().join("data/axes").display().to_string();
    let text = format!(
        "schema = 1\nname = \"pair\"\n[axes]\nx = '{axes}/liu2025.toml'\ny = '{axes}/liu2025-y.toml'\n"
    );
    let circle = ["contour", "--radius", "5", "--feed", "1", "--machine"];
    for (what, encoded) in encodings() {
        let file = write(folder.path(), "machine.toml", &encoded(&text));
        let said = succeed(&[&circle[..], &[&file]].concat());
        assert!(said.contains("pair"), "{what}: {said}");
    }
}

#[test]
fn an_encoding_that_is_not_known_is_refused_with_how_to_save() {
    let folder = tempfile::tempdir().unwrap();
    let axis = write(folder.path(), "axis.toml", b"schema = 2\n# Tr\xe4ger\n");
    let program = [PROGRAM.as_bytes(), b"# Tr\xe4ger\n"].concat();
    let program = write(folder.path(), "program.toml", &program);
    let own = "data/axes/liu2025.toml";
    for (axis, program, file, line) in [
        (&*axis, &*program, "axis.toml", "line 2"),
        (own, &*program, "program.toml", "line 4"),
    ] {
        let message = refuse(&["simulate", "--axis", axis, "--program", program]);
        for part in [file, line, "no text in UTF-8", "Notepad: Save as"] {
            assert!(message.contains(part), "no {part}: {message}");
        }
    }
}

/// A path with backslashes in double quotes.
#[test]
fn a_path_of_windows_is_shown_as_it_should_be() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(root().join("data/axes/linear-motor.toml")).unwrap();
    let bad = format!("{text}\n[experiment]\nmachine = \"C:\\users\\machine.toml\"\n");
    let file = write(folder.path(), "axis.toml", bad.as_bytes());
    let message = refuse(&["analyse", "--axis", &file]);
    assert!(
        message.contains(r"machine = 'C:\users\machine.toml'"),
        "{message}"
    );
}
