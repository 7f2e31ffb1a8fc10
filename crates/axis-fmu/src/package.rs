//! The unit's file: a ZIP archive (FMI 3.0.2, Section 2.5; FMI 2.0.5, Section 2.3).

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::description::{MODEL_IDENTIFIER, description};
use crate::library::UnitLibrary;
use crate::package_error::PackageError;
use crate::unit::Unit;
use crate::version::FmiVersion;

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
    let own = (
        "modelDescription.xml".to_owned(),
        description.as_bytes(),
        plain,
    );
    let mut files = vec![own];
    files.extend(unit.resources().into_iter().map(|(name, text)| {
        let path = format!("resources/{name}");
        (path, text.as_bytes(), plain)
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
