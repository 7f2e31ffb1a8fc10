//! Page to file.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::error::WriteError;
use crate::html::render;
use crate::page::Page;

/// Renders a page into a file that appears whole or not at all.
///
/// The text is written to a temporary file in the same folder, flushed to the
/// disk and renamed; a file of that name is replaced. Its mode is 0644 on Unix.
///
/// # Errors
/// [`WriteError::Report`] where the page cannot be rendered, [`WriteError::Io`]
/// where the folder is missing or not writable or the disk is full.
pub fn write_atomic(path: impl AsRef<Path>, page: &Page) -> Result<(), WriteError> {
    let path = path.as_ref();
    let text = render(page)?;
    let io = |action| {
        move |source| WriteError::Io {
            path: path.display().to_string(),
            action,
            source,
        }
    };
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut file = NamedTempFile::new_in(folder).map_err(io("create a file in its folder"))?;
    file.write_all(text.as_bytes()).map_err(io("write it"))?;
    make_readable(file.as_file()).map_err(io("set its mode"))?;
    file.as_file()
        .sync_all()
        .map_err(io("flush it to the disk"))?;
    match file.persist(path) {
        Ok(_) => Ok(()),
        Err(failed) => Err(io("put it in place")(failed.error)),
    }
}

/// Temporary files are created with mode 0600; a report is for all to read.
#[cfg(unix)]
fn make_readable(file: &File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_: &File) -> io::Result<()> {
    Ok(())
}
