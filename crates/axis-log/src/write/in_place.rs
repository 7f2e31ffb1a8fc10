//! What was written aside, put in place.

use std::io;

use atomic_write_file::AtomicWriteFile;

/// Renames what was written aside.
pub(super) fn in_place(file: AtomicWriteFile) -> io::Result<()> {
    // Before the commit, which leaves the file aside behind where flushing fails.
    file.sync_all()?;
    file.commit()
}
