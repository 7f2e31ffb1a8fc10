//! Page to file.

use std::io::Write;
use std::path::Path;

use atomic_write_file::AtomicWriteFile;

use crate::error::PageWriteError;
use crate::html::render;
use crate::page::Page;

/// Renders a page into a file that appears whole or not at all.
///
/// The text is written to a temporary file in the same folder, flushed to the
/// disk and renamed, and the folder is flushed; a file of that name is replaced, and
/// its mode kept. A process that is killed may leave the temporary file,
/// `.<name>.<six letters or digits>`, and so does a rename that fails, on a folder of
/// that name.
///
/// # Errors
/// [`PageWriteError::Report`] if the page cannot be rendered, [`PageWriteError::Io`]
/// if the folder is missing or not writable or the disk is full.
pub fn write_atomic(path: impl AsRef<Path>, page: &Page) -> Result<(), PageWriteError> {
    let path = path.as_ref();
    let text = render(page)?;
    let io = |action| {
        move |source| PageWriteError::Io {
            path: path.display().to_string(),
            action,
            source,
        }
    };
    let mut file = AtomicWriteFile::open(path).map_err(io("create a file in its folder"))?;
    file.write_all(text.as_bytes()).map_err(io("write it"))?;
    // Before the commit, which leaves the file aside behind where flushing fails.
    file.sync_all().map_err(io("flush it to the disk"))?;
    file.commit().map_err(io("put it in place"))
}
