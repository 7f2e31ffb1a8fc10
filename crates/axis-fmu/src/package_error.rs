//! Why a unit has no file.

use thiserror::Error;

use crate::library_mark::LIBRARY_MARK;

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
