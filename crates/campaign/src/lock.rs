//! One process at a time.

use std::fs::{File, TryLockError};
use std::io;
use std::path::Path;

/// Opens a file to read and write, made where it is not there, and locks it until the
/// file is dropped or the process ends, however it ends. `None` if another process has it.
///
/// On a file system without locks the file comes unlocked: whoever uses one sees to it.
///
/// # Errors
/// The file cannot be opened or locked.
pub fn try_lock(path: &Path) -> io::Result<Option<File>> {
    let mut options = File::options();
    let options = options.read(true).write(true).create(true).truncate(false);
    let file = options.open(path)?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Ok(None),
        Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => Ok(Some(file)),
        Err(TryLockError::Error(e)) => Err(e),
    }
}
