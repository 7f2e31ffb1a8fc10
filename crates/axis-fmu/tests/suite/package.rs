//! The unit's file.

use std::io::{Cursor, Read};

use axis_fmu::{FmiVersion, LIBRARY_MARK, PackageError, Unit, UnitLibrary};
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

/// What stands for a library of Linux: its header, and the mark.
pub fn library() -> Vec<u8> {
    elf(62)
}

fn elf(machine: u8) -> Vec<u8> {
    let mut bytes = b"\x7fELF\x02\x01\x01".to_vec();
    bytes.resize(16, 0);
    bytes.extend([3, 0, machine, 0]);
    marked(bytes)
}

fn pe(machine: u16) -> Vec<u8> {
    let mut bytes = b"MZ".to_vec();
    bytes.resize(0x3c, 0);
    bytes.extend([0x80, 0, 0, 0]);
    bytes.resize(0x80, 0);
    bytes.extend(b"PE\0\0");
    bytes.extend(machine.to_le_bytes());
    bytes.resize(0x80 + 22, 0);
    bytes.extend([0x22, 0x20]);
    marked(bytes)
}

fn mach_o(processor: u32) -> Vec<u8> {
    let words = [0xfeed_facf, processor, 0, 6];
    marked(words.iter().flat_map(|word| word.to_le_bytes()).collect())
}

fn marked(mut header: Vec<u8>) -> Vec<u8> {
    header.extend(LIBRARY_MARK.as_bytes());
    header
}

fn package(unit: &Unit, library: &[u8], version: FmiVersion) -> Result<Vec<u8>, PackageError> {
    axis_fmu::package(unit, &[UnitLibrary::of(library)?], version)
}

/// Folders and names are those of the standards' tables for the platform that a header says (FMI
/// 3.0.2, Section 2.5.1.4.1; FMI 2.0.5, Section 2.3).
#[test]
fn libraries_of_all_platforms_have_their_folders() {
    let all = [
        (elf(62), "x86_64-linux/feed_axis.so", "linux64/feed_axis.so"),
        (
            elf(183),
            "aarch64-linux/feed_axis.so",
            "linux64/feed_axis.so",
        ),
        (
            pe(0x8664),
            "x86_64-windows/feed_axis.dll",
            "win64/feed_axis.dll",
        ),
        (
            pe(0xaa64),
            "aarch64-windows/feed_axis.dll",
            "win64/feed_axis.dll",
        ),
        (
            mach_o(0x0100_0007),
            "x86_64-darwin/feed_axis.dylib",
            "darwin64/feed_axis.dylib",
        ),
        (
            mach_o(0x0100_000c),
            "aarch64-darwin/feed_axis.dylib",
            "darwin64/feed_axis.dylib",
        ),
    ];
    let unit = crate::unit("belt.toml");
    let libraries: Vec<_> = (all.iter())
        .map(|(bytes, ..)| UnitLibrary::of(bytes).unwrap())
        .collect();
    let three = axis_fmu::package(&unit, &libraries, FmiVersion::V3).unwrap();
    let mut three = ZipArchive::new(Cursor::new(three)).unwrap();
    for ((bytes, in_three, in_two), library) in all.iter().zip(&libraries) {
        let mut found = Vec::new();
        let mut file = three.by_name(&format!("binaries/{in_three}")).unwrap();
        file.read_to_end(&mut found).unwrap();
        assert_eq!(&found, bytes);
        let two = axis_fmu::package(&unit, &[*library], FmiVersion::V2).unwrap();
        let mut two = ZipArchive::new(Cursor::new(two)).unwrap();
        assert!(
            two.by_name(&format!("binaries/{in_two}")).is_ok(),
            "{in_two}"
        );
    }
    // FMI 2.0 has one folder for both processors.
    let refused = axis_fmu::package(&unit, &libraries[..2], FmiVersion::V2).unwrap_err();
    assert!(
        refused.to_string().contains("binaries/linux64"),
        "{refused}"
    );
    let refused = axis_fmu::package(&unit, &[], FmiVersion::V3).unwrap_err();
    assert!(matches!(refused, PackageError::NoLibrary));
}

#[test]
fn what_is_no_library_of_a_platform_is_refused() {
    let (mut program, mut narrow, mut exe) = (elf(62), elf(62), pe(0x8664));
    program[16] = 2;
    narrow[4] = 1;
    exe[0x80 + 23] = 0;
    for (bytes, words) in [
        (b"[axis]".to_vec(), "neither ELF, PE nor Mach-O"),
        (Vec::new(), "neither ELF, PE nor Mach-O"),
        (program, "no shared library"),
        (narrow, "not of 64 bits"),
        (elf(40), "another processor (number 0x28)"),
        (pe(0x14c), "another processor (number 0x14c)"),
        (exe, "no library"),
        (b"MZ and nothing more".to_vec(), "program of DOS"),
        (mach_o(7), "another processor (number 0x7)"),
        (b"\xca\xfe\xba\xbe".to_vec(), "several processors"),
        (elf(62)[..17].to_vec(), "no shared library"),
        (elf(62)[..19].to_vec(), "ends in its header"),
    ] {
        let refused = UnitLibrary::of(&bytes).unwrap_err().to_string();
        assert!(
            refused.contains(words) && refused.contains("valid:"),
            "{refused}"
        );
    }
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
    assert_eq!(content("binaries/x86_64-linux/feed_axis.so"), library());
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
        let path = "binaries/linux64/feed_axis.so";
        assert_eq!(part(axis, FmiVersion::V2, path).as_bytes(), library());
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
    let mut other = library();
    other.truncate(20);
    other.extend(b"of something else");
    let refused = package(&crate::unit("belt.toml"), &other, FmiVersion::V3);
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
