//! The library as cargo builds it.
#![cfg(all(
    any(unix, windows),
    any(target_arch = "x86_64", target_arch = "aarch64")
))]

use std::path::Path;

/// It lies beside the tests, and has what `export fmu` knows it by.
#[test]
fn a_package_takes_the_library() {
    let name = axis_fmu::library_file().unwrap();
    let library = std::env::current_exe().unwrap().with_file_name(name);
    let library = std::fs::read(&library).unwrap_or_else(|e| panic!("{}: {e}", library.display()));
    let axis = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/axes/belt.toml");
    let text = std::fs::read_to_string(axis).unwrap();
    let unit = axis_fmu::Unit::new("belt.toml", &text).unwrap();
    for version in [axis_fmu::FmiVersion::V2, axis_fmu::FmiVersion::V3] {
        let library = axis_fmu::UnitLibrary::of(&library).unwrap();
        let package = axis_fmu::package(&unit, &[library], version).unwrap();
        assert!(package.starts_with(b"PK"));
    }
}
