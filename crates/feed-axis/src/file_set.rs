//! Files that appear together.

use std::io::Write;
use std::path::{Path, PathBuf};

use atomic_write_file::AtomicWriteFile;
use miette::{IntoDiagnostic, Report, Result, WrapErr, miette};

use crate::output::{ready, remove, sweep};

/// The files of one result in one folder. They are written aside one by one, and put in place when all of
/// them are whole: where writing one fails, or the process ends before, the folder stays as it was.
///
/// The last name vouches for the others, such as the page that shows them: that of an earlier run goes before
/// any other file is put in place, and its own is put in place last. Where it is there, all are there and of
/// one run.
pub struct FileSet<'a> {
    folder: &'a Path,
    /// Every file that such a result may have.
    names: Vec<&'a str>,
    staged: Vec<Option<Staged>>,
}

/// A file that is whole, aside.
struct Staged {
    path: PathBuf,
    file: AtomicWriteFile,
}

impl<'a> FileSet<'a> {
    /// The files of these names, of which none is written yet: in the order in which they are put in place.
    /// Those that are not written until then are removed where an earlier run has left them.
    ///
    /// # Errors
    /// Where the folder cannot be written to.
    pub fn new(folder: &'a Path, names: &[&'a str]) -> Result<Self> {
        ready(folder)?;
        sweep(folder, names)?;
        Ok(Self {
            folder,
            names: names.to_vec(),
            staged: names.iter().map(|_| None).collect(),
        })
    }

    /// Writes one of them aside.
    ///
    /// # Errors
    /// Where it is none of them, or cannot be written.
    pub fn put(&mut self, name: &str, bytes: &[u8]) -> Result<()> {
        let path = self.folder.join(name);
        let place = self.names.iter().position(|known| *known == name);
        let place = place.ok_or_else(|| miette!("{} is none of these files", path.display()))?;
        let staged = Staged::write(path, bytes)?;
        self.staged[place] = Some(staged);
        Ok(())
    }

    /// Puts all in place.
    ///
    /// # Errors
    /// Where a file cannot be put in place; the last one is then not there.
    pub fn publish(self) -> Result<()> {
        // A folder of a file's name is in its way: told before anything is changed.
        if let Some(path) = self.paths().find(|path| path.is_dir()) {
            return Err(miette!(
                "{} is a folder, where a file is to be written; remove it, or give another folder",
                path.display()
            ));
        }
        if let Some(voucher) = self.paths().last() {
            remove(&voucher)?;
        }
        let missing = self.paths().zip(&self.staged);
        for (path, _) in missing.filter(|(_, staged)| staged.is_none()) {
            remove(&path)?;
        }
        self.staged
            .into_iter()
            .flatten()
            .try_for_each(Staged::place)
    }

    fn paths(&self) -> impl Iterator<Item = PathBuf> {
        self.names.iter().map(|name| self.folder.join(name))
    }
}

impl Staged {
    fn write(path: PathBuf, bytes: &[u8]) -> Result<Self> {
        let attempt = || -> std::io::Result<AtomicWriteFile> {
            let mut file = AtomicWriteFile::open(&path)?;
            file.write_all(bytes)?;
            file.sync_all()?;
            Ok(file)
        };
        match attempt() {
            Ok(file) => Ok(Self { path, file }),
            Err(e) => Err(unwritten(e, &path)),
        }
    }

    fn place(self) -> Result<()> {
        self.file.commit().map_err(|e| unwritten(e, &self.path))
    }
}

fn unwritten(e: std::io::Error, path: &Path) -> Report {
    let failed: Result<()> = Err(e).into_diagnostic();
    let failed = failed.wrap_err_with(|| crate::output::cannot_write(path));
    failed.err().unwrap_or_else(|| miette!("cannot write"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 3] = ["a.json", "b.toml", "page.html"];

    fn there(folder: &Path) -> Vec<(String, String)> {
        let mut all: Vec<(String, String)> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| {
                let entry = entry.unwrap();
                let text = std::fs::read_to_string(entry.path()).unwrap_or_default();
                (entry.file_name().into_string().unwrap(), text)
            })
            .collect();
        all.sort();
        all
    }

    fn pairs(all: &[(&str, &str)]) -> Vec<(String, String)> {
        let pair = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
        all.iter().map(pair).collect()
    }

    #[test]
    fn files_of_a_set_appear_together_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let mut set = FileSet::new(folder, &NAMES).unwrap();
        for name in NAMES {
            set.put(name, b"one").unwrap();
            let asides = there(folder);
            assert!(
                asides.iter().all(|(name, _)| name.starts_with('.')),
                "{asides:?}"
            );
        }
        set.publish().unwrap();
        let first = pairs(&[("a.json", "one"), ("b.toml", "one"), ("page.html", "one")]);
        assert_eq!(there(folder), first);

        // Given up halfway: the folder is as it was.
        let mut set = FileSet::new(folder, &NAMES).unwrap();
        set.put("a.json", b"two").unwrap();
        assert!(set.put("other", b"two").is_err());
        drop(set);
        assert_eq!(there(folder), first);

        // What this result does not have goes.
        let mut set = FileSet::new(folder, &NAMES).unwrap();
        set.put("page.html", b"three").unwrap();
        set.put("a.json", b"three").unwrap();
        set.publish().unwrap();
        assert_eq!(
            there(folder),
            pairs(&[("a.json", "three"), ("page.html", "three")])
        );
    }

    #[test]
    fn what_a_killed_process_left_aside_goes_with_the_next() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(".a.json.x1Y2z3"), "half").unwrap();
        FileSet::new(folder.path(), &NAMES).unwrap();
        assert_eq!(there(folder.path()), []);
    }

    /// A file that cannot be put in place leaves those of the earlier run.
    #[test]
    fn a_folder_in_the_way_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        std::fs::create_dir(folder.join("b.toml")).unwrap();
        std::fs::write(folder.join("a.json"), "before").unwrap();
        std::fs::write(folder.join("page.html"), "before").unwrap();
        let mut set = FileSet::new(folder, &NAMES).unwrap();
        for name in NAMES {
            set.put(name, b"new").unwrap();
        }
        let said = format!("{:?}", set.publish().unwrap_err());
        assert!(
            said.contains("b.toml") && said.contains("is a folder"),
            "{said}"
        );
        let before = pairs(&[
            ("a.json", "before"),
            ("b.toml", ""),
            ("page.html", "before"),
        ]);
        assert_eq!(there(folder), before);
    }
}
