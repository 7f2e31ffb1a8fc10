//! Writing to the terminal and to files so that failures are told, not thrown.

use std::io::{ErrorKind, Write};
use std::path::Path;

use miette::{IntoDiagnostic, Result, WrapErr, miette};

/// A line on standard output; an error where nobody reads it any more.
pub fn say(line: impl AsRef<str>) -> Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{}", line.as_ref())
        .and_then(|()| out.flush())
        .map_err(|e| miette!("cannot write to standard output: {e}"))
}

/// Writes a file whole: aside first, then renamed.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let attempt = || -> std::io::Result<()> {
        std::fs::create_dir_all(folder)?;
        let mut aside = tempfile::NamedTempFile::new_in(folder)?;
        aside.write_all(bytes)?;
        readable(&aside)?;
        aside.as_file().sync_all()?;
        aside.persist(path).map_err(|e| e.error)?;
        Ok(())
    };
    attempt().into_diagnostic().wrap_err_with(|| {
        format!(
            "cannot write {}: is the folder writable, the disk full?",
            path.display()
        )
    })
}

/// Makes the folder where it is not there, and asks whether results can be written to
/// it: before the work that makes them, so that none is lost.
pub fn ready(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)
        .and_then(|()| tempfile::NamedTempFile::new_in(folder))
        .map(drop)
        .into_diagnostic()
        .wrap_err_with(|| {
            format!(
                "cannot write to the folder {}; give one that can be written to with --out",
                folder.display()
            )
        })
}

/// Removes what an earlier run left, where there is something.
pub fn remove(path: &Path) -> Result<()> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(e)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot remove {}, of an earlier run", path.display())),
        _ => Ok(()),
    }
}

/// Temporary files are private; results are for everyone to read.
#[cfg(unix)]
fn readable(file: &tempfile::NamedTempFile) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    let mode = std::fs::Permissions::from_mode(0o644);
    file.as_file().set_permissions(mode)
}

#[cfg(not(unix))]
fn readable(_: &tempfile::NamedTempFile) -> std::io::Result<()> {
    Ok(())
}
