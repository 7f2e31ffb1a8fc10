//! The unit's file.

use std::io::{Cursor, Read};

use axis_fmu::{LIBRARY_MARK, PackageError, package, platform};
use zip::ZipArchive;

use crate::text;

fn library() -> Vec<u8> {
    format!("stands for a library: {LIBRARY_MARK}").into_bytes()
}

#[test]
fn the_archive_holds_description_axis_file_and_library() {
    let text = text("belt.toml");
    let bytes = package("belt.toml", &text, &library()).unwrap();
    assert_eq!(bytes, package("belt.toml", &text, &library()).unwrap());
    let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut content = |path: &str| {
        let mut bytes = Vec::new();
        archive
            .by_name(path)
            .unwrap()
            .read_to_end(&mut bytes)
            .unwrap();
        bytes
    };
    assert_eq!(content("resources/axis.toml"), text.as_bytes());
    let (platform, end) = platform().unwrap();
    assert_eq!(
        content(&format!("binaries/{platform}/feed_axis.{end}")),
        library()
    );
    let description = String::from_utf8(content("modelDescription.xml")).unwrap();
    let token = crate::unit("belt.toml").token();
    for part in [
        "fmiVersion=\"3.0\"",
        &format!("instantiationToken=\"{token}\""),
        "fixedInternalStepSize=\"0.000125\"",
        // The log of trajectory 1 has 7814 samples, the last at the end of 7813 periods; the move
        // ends within the next.
        "<DefaultExperiment startTime=\"0\" stopTime=\"0.97675\" stepSize=\"0.000125\"/>",
        "canSerializeFMUState=\"false\"",
        "<Unit name=\"A/(rpm.s)\">",
    ] {
        let is_there = description.contains(part);
        // The belt's gains are in other units.
        assert_eq!(is_there, !part.contains("rpm.s"), "{part}");
    }
    assert!(description.contains("<Unit name=\"mm\"><BaseUnit m=\"1\" factor=\"0.001\"/></Unit>"));
}

#[test]
fn another_library_is_refused() {
    let refused = package(
        "belt.toml",
        &text("belt.toml"),
        b"\x7fELF of something else",
    );
    let refused = refused.unwrap_err();
    assert!(matches!(refused, PackageError::Library));
    assert!(
        refused
            .to_string()
            .contains("cargo build --release -p feed-axis-fmu"),
        "{refused}"
    );
}

#[test]
fn a_file_that_is_no_axis_says_where() {
    let text = text("belt.toml").replace("carriage_mass_kg", "carriage_mass_lb");
    let refused = package("belt.toml", &text, &library())
        .unwrap_err()
        .to_string();
    assert!(refused.contains("carriage_mass_lb"), "{refused}");
}
