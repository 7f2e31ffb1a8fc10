//! The unit's file.

use std::io::{Cursor, Read};

use axis_fmu::{FmiVersion, LIBRARY_MARK, PackageError, Unit, package, platform};
use zip::ZipArchive;

use crate::text;

/// A text file of the unit of an axis.
fn part(axis: &str, version: FmiVersion, path: &str) -> String {
    let bytes = package(&crate::unit(axis), &library(), version).unwrap();
    read(bytes, path)
}

/// A text file of these bytes.
fn read(bytes: Vec<u8>, path: &str) -> String {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut part = String::new();
    let mut file = archive.by_name(path).unwrap();
    file.read_to_string(&mut part).unwrap();
    part
}

fn library() -> Vec<u8> {
    format!("stands for a library: {LIBRARY_MARK}").into_bytes()
}

/// A correction is among the resources, as it was given.
#[test]
fn a_compensated_unit_takes_its_correction_along() {
    let correction = "{\"strategy\":\"plan\"}";
    let unit = Unit::compensated("belt.toml", &text("belt.toml"), correction).unwrap();
    for version in [FmiVersion::V2, FmiVersion::V3] {
        let bytes = package(&unit, &library(), version).unwrap();
        assert_eq!(read(bytes, "resources/correction.json"), correction);
    }
}

#[test]
fn the_archive_holds_description_axis_file_and_library() {
    let (text, unit) = (text("belt.toml"), crate::unit("belt.toml"));
    let bytes = package(&unit, &library(), FmiVersion::V3).unwrap();
    assert_eq!(bytes, package(&unit, &library(), FmiVersion::V3).unwrap());
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
    let (platform, end) = platform(FmiVersion::V3).unwrap();
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
        "canSerializeFMUState=\"true\"",
        "<Unit name=\"A/(rpm.s)\">",
    ] {
        let is_there = description.contains(part);
        // The belt's gains are in other units.
        assert_eq!(is_there, !part.contains("rpm.s"), "{part}");
    }
    assert!(description.contains("<Unit name=\"mm\"><BaseUnit m=\"1\" factor=\"0.001\"/></Unit>"));
}

/// FMI 2.0 has other names for nearly everything, and counts variables from 1.
#[test]
fn a_unit_of_fmi_2_describes_the_same_variables() {
    for axis in ["belt.toml", "rotary-table.toml", "linear-motor.toml"] {
        let [two, three] = [FmiVersion::V2, FmiVersion::V3]
            .map(|version| part(axis, version, "modelDescription.xml"));
        let folder = platform(FmiVersion::V2).unwrap();
        let path = format!("binaries/{}/feed_axis.{}", folder.0, folder.1);
        assert!(path.contains("64/") && !path.contains("x86_64"));
        assert_eq!(part(axis, FmiVersion::V2, &path).as_bytes(), library());
        let token = crate::unit(axis).token();
        assert!(two.contains("fmiVersion=\"2.0\"") && two.contains(&format!("guid=\"{token}\"")));
        let lines = |text: &str, element: &str| -> Vec<String> {
            let begin = format!("<{element} ");
            let all = text.lines().filter_map(|line| line.strip_prefix(&begin));
            all.map(str::to_owned).collect()
        };
        let list = lines(&two, "ScalarVariable");
        let joined = |line: &str| {
            let line = line.replace("><Real", "");
            line.replace("</ScalarVariable>", "")
        };
        let of_two: Vec<String> = list.iter().map(|line| joined(line)).collect();
        assert_eq!(of_two, lines(&three, "Float64"));
        // The structure names all outputs, once as such and once as unknown at the start.
        let named = |line: &String| -> String {
            let index = line.split('"').nth(1).unwrap();
            let index: usize = index.parse().unwrap();
            list[index - 1].clone()
        };
        let unknowns: Vec<String> = lines(&two, "Unknown").iter().map(named).collect();
        let outputs: Vec<String> = (list.iter())
            .filter(|line| line.contains("causality=\"output\""))
            .cloned()
            .collect();
        assert_eq!(unknowns, [&outputs[..], &outputs].concat());
    }
}

#[test]
fn another_library_is_refused() {
    let refused = package(
        &crate::unit("belt.toml"),
        b"\x7fELF of something else",
        FmiVersion::V3,
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
    let refused = Unit::new("belt.toml", &text).unwrap_err().to_string();
    assert!(refused.contains("carriage_mass_lb"), "{refused}");
}
