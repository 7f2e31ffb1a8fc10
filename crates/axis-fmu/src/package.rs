//! The unit's file: a ZIP archive (FMI 3.0.2, Section 2.5; FMI 2.0.5, Section 2.3).

use std::io::{Cursor, Write};

use thiserror::Error;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::description::description;
use crate::unit::Unit;
use crate::version::FmiVersion;

/// Name of the library's file in the archive, without its end.
pub const MODEL_IDENTIFIER: &str = "feed_axis";

/// The axis file among the unit's resources.
pub const AXIS_FILE: &str = "axis.toml";

/// The correction of a compensated unit, among them.
pub const CORRECTION_FILE: &str = "correction.json";

/// What the library of this version holds in its data, and another one does not.
pub const LIBRARY_MARK: &str = concat!(
    "library of feed-axis units, version ",
    env!("CARGO_PKG_VERSION")
);

/// Why there is no package.
#[derive(Debug, Error)]
pub enum PackageError {
    /// The library is another program's or another version's.
    #[error(
        "the library is not the {LIBRARY_MARK}; valid: the one that `cargo build --release -p feed-axis-fmu` makes of the same sources"
    )]
    Library,
    /// FMI units of this system are not made here.
    #[error(
        "no library of units is made for {os} on {arch}; valid: linux or macos on x86_64 or aarch64"
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

/// The platform of this program as that version of FMI names it, and how libraries end there.
///
/// # Errors
/// [`PackageError::Platform`] if the library is not made: elsewhere arrays do not pass as
/// its functions take them.
pub fn platform(version: FmiVersion) -> Result<(String, &'static str), PackageError> {
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    let platform = version.platform(os, arch);
    let platform = platform.ok_or(PackageError::Platform { os, arch })?;
    Ok((platform, if os == "macos" { "dylib" } else { "so" }))
}

/// The name of the library as cargo builds it.
///
/// # Errors
/// As [`platform`].
pub fn library_file() -> Result<String, PackageError> {
    Ok(format!(
        "libfeed_axis_fmu.{}",
        platform(FmiVersion::default())?.1
    ))
}

/// The bytes of the unit's file in that version of FMI, with `library`. The same inputs give the
/// same bytes.
///
/// # Errors
/// [`PackageError`] if the library is of another version, or none is made for this system.
pub fn package(unit: &Unit, library: &[u8], version: FmiVersion) -> Result<Vec<u8>, PackageError> {
    let (platform, end) = platform(version)?;
    let mark = LIBRARY_MARK.as_bytes();
    if !library.windows(mark.len()).any(|window| window == mark) {
        return Err(PackageError::Library);
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
        (
            format!("binaries/{platform}/{MODEL_IDENTIFIER}.{end}"),
            library,
            plain.unix_permissions(0o755),
        ),
    ];
    files.extend(unit.correction().map(|correction| {
        let path = format!("resources/{CORRECTION_FILE}");
        (path, correction.text().as_bytes(), plain)
    }));
    for (path, bytes, options) in files {
        archive.start_file(path, options)?;
        archive.write_all(bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}
