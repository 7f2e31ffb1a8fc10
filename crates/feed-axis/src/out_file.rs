//! Names of files that commands write: refused before any work where they cannot be meant.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{OsStringValueParser, TypedValueParser};
use miette::{Result, miette};

/// Reads the name of a page, which ends in `.html`: a browser would show another as text.
pub fn page() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|name: OsString| {
        let path = named(name, "page.html")?;
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("html" | "htm") => Ok(path),
            _ => Err(format!(
                "a page is HTML: give a name that ends in .html, such as {}",
                path.with_extension("html").display()
            )),
        }
    })
}

/// Reads the name of any other file.
pub fn file() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|name: OsString| named(name, "file"))
}

/// A name that is one: `-` is standard output for other programs, and carries results here.
pub(crate) fn named(name: OsString, example: &str) -> Result<PathBuf, String> {
    match name.to_str() {
        Some("-") => Err(format!(
            "no file is written to standard output, which carries the results; give the name of a file, or ./- for one of that name (such as {example})"
        )),
        Some("") => Err(format!("the name is empty; give one, such as {example}")),
        _ => Ok(name.into()),
    }
}

/// The option that lets a command write over files that are there.
#[derive(Args)]
#[group(id = "force-option")]
pub struct Force {
    /// Overwrite existing files
    #[arg(long)]
    pub force: bool,
}

impl Force {
    /// [`spare`], of files in a folder.
    ///
    /// # Errors
    /// As [`spare`].
    pub fn spare_in(&self, folder: &Path, names: &[&str]) -> Result<()> {
        let mut names = names.iter();
        names.try_for_each(|name| spare(&folder.join(name), self.force))
    }
}

/// Refuses to write over a file that is there, of those that people edit or take into other programs: axis files, exports.
/// Results (logs, pages, JSON, a run's folder) are replaced.
///
/// # Errors
/// A file of that name, where `force` is not set.
pub fn spare(path: &Path, force: bool) -> Result<()> {
    match path.exists() && !force {
        true => Err(miette!(
            "{} exists already; give another name, or --force to overwrite it",
            path.display()
        )),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use clap::{Arg, Command};

    use super::*;

    fn read(parser: impl TypedValueParser<Value = PathBuf>, name: &str) -> Result<PathBuf, String> {
        let command = Command::new("c").arg(Arg::new("n").value_parser(parser));
        let mut matches = command
            .try_get_matches_from(["c", "--", name])
            .map_err(|e| e.to_string())?;
        Ok(matches.remove_one("n").unwrap())
    }

    #[test]
    fn a_page_is_html() {
        for good in ["motion.html", "a b/motion.HTM"] {
            assert_eq!(read(page(), good).unwrap(), Path::new(good));
        }
        for bad in ["motion.txt", "motion"] {
            let said = read(page(), bad).unwrap_err();
            assert!(said.contains("such as motion.html"), "{said}");
        }
    }

    #[test]
    fn a_dash_is_no_file() {
        for said in [read(page(), "-"), read(file(), "-")] {
            let said = said.unwrap_err();
            assert!(said.contains("standard output"), "{said}");
        }
        assert!(read(file(), "").unwrap_err().contains("empty"));
        assert_eq!(read(file(), "log.csv").unwrap(), Path::new("log.csv"));
    }
}
