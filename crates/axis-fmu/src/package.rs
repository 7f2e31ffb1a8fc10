//! The unit's file: a ZIP archive (FMI 3.0.2, Section 2.5; FMI 2.0.5, Section 2.3).

use std::io::{Cursor, Write};

use thiserror::Error;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::description::description;
use crate::library::{LIBRARY_MARK, UnitLibrary};
use crate::unit::Unit;
use crate::version::FmiVersion;

/// Name of the library's file in the archive, without its end.
pub const MODEL_IDENTIFIER: &str = "feed_axis";

/// The axis file among the unit's resources.
pub const AXIS_FILE: &str = "axis.toml";

/// The correction of a compensated unit, among them.
pub const CORRECTION_FILE: &str = "correction.json";

/// Why there is no package.
#[derive(Debug, Error)]
pub enum PackageError {
    /// The library is another program's or another version's.
    #[error(
        "the library is not the {LIBRARY_MARK}; valid: the one that `cargo build --release -p feed-axis-fmu` makes of the same sources"
    )]
    Library,
    /// The file is no library that a unit can have.
    #[error(
        "the file is not a library of units: {0}; valid: a shared library for Linux (ELF), Windows (PE) or macOS (Mach-O) on x86_64 or aarch64"
    )]
    Header(String),
    /// A unit without a library cannot be simulated.
    #[error("the unit has no library; valid: one for each platform, at least one")]
    NoLibrary,
    /// Two libraries for one folder.
    #[error("two libraries belong in binaries/{0} of the unit; valid: one for each platform")]
    SamePlatform(String),
    /// FMI units of this system are not made here.
    #[error(
        "no library of units is made for {os} on {arch}; valid: linux, windows or macos on x86_64 or aarch64"
    )]
    Platform {
        /// Operating system.
        os: &'static str,
        /// Architecture.
        arch: &'static str,
    },
    /// The archive could not be made.
    #[error("the archive cannot be made")]
    Archive(#[from] zip::result::ZipError),
    /// Likewise, where bytes were written.
    #[error("the archive cannot be made")]
    Write(#[from] std::io::Error),
}

/// The bytes of the unit's file in that version of FMI, with these libraries. The same inputs give the
/// same bytes.
///
/// # Errors
/// [`PackageError`] if there is no library, or two belong in one folder.
pub fn package(
    unit: &Unit,
    libraries: &[UnitLibrary<'_>],
    version: FmiVersion,
) -> Result<Vec<u8>, PackageError> {
    if libraries.is_empty() {
        return Err(PackageError::NoLibrary);
    }
    let description = description(unit, version);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let plain = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut files = vec![
        (
            "modelDescription.xml".to_owned(),
            description.as_bytes(),
            plain,
        ),
        (
            format!("resources/{AXIS_FILE}"),
            unit.text().as_bytes(),
            plain,
        ),
    ];
    files.extend(unit.correction().map(|correction| {
        let path = format!("resources/{CORRECTION_FILE}");
        (path, correction.text().as_bytes(), plain)
    }));
    for (i, library) in libraries.iter().enumerate() {
        let platform = library.platform(version)?;
        let others = libraries.iter().take(i);
        if others
            .into_iter()
            .any(|other| other.platform(version).is_ok_and(|p| p == platform))
        {
            return Err(PackageError::SamePlatform(platform));
        }
        let path = format!("binaries/{platform}/{MODEL_IDENTIFIER}.{}", library.end());
        files.push((path, library.bytes(), plain.unix_permissions(0o755)));
    }
    for (path, bytes, options) in files {
        archive.start_file(path, options)?;
        archive.write_all(bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}
