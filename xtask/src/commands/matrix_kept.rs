//! Cases of a matrix that an earlier run kept.

use std::path::{Path, PathBuf};

use axis_sim::Axis;
use discover_matrix::matrix::{Case, CaseOutcome};
use feed_axis::output::{say, write_whole};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Refuses to write a page over anything but a page of the same seed.
pub(super) fn replaceable(page: &Path, seed: u64, seed_of: fn(&str) -> Option<u64>) -> Result<()> {
    let there = match std::fs::read_to_string(page) {
        Ok(text) => text,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(e) => {
            return Err(e)
                .into_diagnostic()
                .wrap_err_with(|| page.display().to_string());
        }
    };
    match seed_of(&there) {
        Some(other) if other == seed => Ok(()),
        Some(other) => Err(miette!(
            "{} is the page of seed {other}, not {seed}; give another file with --page, or remove it",
            page.display()
        )),
        None => Err(miette!(
            "{} is no page of this command; give another file with --page",
            page.display()
        )),
    }
}

/// Outcomes on disk: one file a case, with what they were made by.
pub(super) struct Kept {
    pub(super) folder: PathBuf,
    pub(super) made_by: String,
}

/// What a file of a case holds.
#[derive(Serialize, Deserialize)]
struct File<O> {
    /// Hash of the program and of the axis file that made it.
    made_by: String,
    outcome: O,
}

impl Kept {
    /// Outcomes of this program on these axes, in a folder.
    pub(super) fn new<'a>(axes: impl IntoIterator<Item = &'a Axis>, out: &Path) -> Self {
        let fingerprints = axes.into_iter().map(|axis| axis.fingerprint.as_str());
        let fingerprints: Vec<&str> = fingerprints.collect();
        let made_by = feed_axis::program::inputs().with("axis", fingerprints.join(" "));
        Self {
            folder: out.join("cases"),
            made_by: made_by.key(),
        }
    }

    /// Says how many of these cases lie there from another program or axis file.
    pub(super) fn tell_of_others(&self, cases: &[Case]) -> Result<()> {
        let is_other = |case: &&Case| self.file(&case.id).exists() && self.outcome(case).is_none();
        match cases.iter().filter(is_other).count() {
            0 => Ok(()),
            stale => say(format!(
                "{stale} cases in {} are of another program or axis file, and are run again",
                self.folder.display()
            )),
        }
    }

    pub(super) fn file(&self, id: &str) -> PathBuf {
        self.folder.join(format!("{id}.json"))
    }

    /// What this program kept under a name.
    pub(super) fn read<O: DeserializeOwned>(&self, id: &str) -> Option<O> {
        let (made_by, outcome) = self.read_any(id)?;
        (made_by == self.made_by).then_some(outcome)
    }

    /// What any program kept under a name, and the hash of program and axis files.
    pub(super) fn read_any<O: DeserializeOwned>(&self, id: &str) -> Option<(String, O)> {
        let text = std::fs::read(self.file(id)).ok()?;
        let file: File<O> = serde_json::from_slice(&text).ok()?;
        Some((file.made_by, file.outcome))
    }

    /// The outcome of a case; `None` if there is none of this program.
    pub(super) fn outcome(&self, case: &Case) -> Option<CaseOutcome> {
        let outcome: Option<CaseOutcome> = self.read(&case.id);
        outcome.filter(|o| o.case.is_same(case))
    }

    pub(super) fn write(&self, id: &str, outcome: &impl Serialize) -> Result<()> {
        let file = File {
            made_by: self.made_by.clone(),
            outcome,
        };
        let json = serde_json::to_vec_pretty(&file).into_diagnostic()?;
        write_whole(&self.file(id), &json)
    }
}
