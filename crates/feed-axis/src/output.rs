//! Writing to the terminal and to files so that failures are told, not thrown.

use std::io::{BufWriter, ErrorKind, Write};
use std::path::Path;

use atomic_write_file::AtomicWriteFile;
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
    write_whole_by(path, |file| file.write_all(bytes))
}

/// As [`write_whole`], with a content that is never all in memory.
pub fn write_whole_by(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<AtomicWriteFile>) -> std::io::Result<()>,
) -> Result<()> {
    let attempt = || -> std::io::Result<()> {
        std::fs::create_dir_all(path.parent().unwrap_or(path))?;
        let mut file = BufWriter::new(AtomicWriteFile::open(path)?);
        write(&mut file)?;
        let file = file.into_inner()?;
        // Before the commit, which leaves the file aside behind where flushing fails.
        file.sync_all()?;
        file.commit()
    };
    attempt().into_diagnostic().wrap_err_with(|| {
        format!(
            "cannot write {}: is the folder writable, the disk full?",
            path.display()
        )
    })
}

/// Removes what killed runs left of the files of these names: what was written aside,
/// `.<name>.<six letters or digits>`.
pub fn sweep(folder: &Path, names: &[&str]) -> Result<()> {
    let aside = |file: &str| {
        let middle = file
            .strip_prefix('.')
            .and_then(|rest| rest.rsplit_once('.'));
        middle.is_some_and(|(name, end)| {
            names.contains(&name)
                && end.len() == 6
                && end.bytes().all(|b| b.is_ascii_alphanumeric())
        })
    };
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_str().is_some_and(aside) {
            remove(&entry.path())?;
        }
    }
    Ok(())
}

/// Makes the folder where it is not there, and asks whether results can be written to
/// it: before the work that makes them, so that none is lost.
pub fn ready(folder: &Path) -> Result<()> {
    const PROBE: &str = "writable";
    std::fs::create_dir_all(folder)
        .and_then(|()| AtomicWriteFile::open(folder.join(PROBE)))
        .map(drop)
        .into_diagnostic()
        .wrap_err_with(|| {
            format!(
                "cannot write to the folder {}; give one that can be written to with --out",
                folder.display()
            )
        })?;
    sweep(folder, &[PROBE])
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_written_aside_is_swept() {
        let folder = tempfile::tempdir().unwrap();
        let kept = [
            "a.json",
            ".a.json",
            ".a.json.1234567",
            ".b.json.123456",
            ".a.json.12-456",
        ];
        for name in kept.iter().chain(&[".a.json.1aB456"]) {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        sweep(folder.path(), &["a.json", "c.json"]).unwrap();
        let mut left: Vec<String> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        let mut kept = kept.map(str::to_owned);
        kept.sort();
        assert_eq!(left, kept);
    }
}
