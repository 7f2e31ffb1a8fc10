//! `discover-matrix`: machines with something hidden in them, searched blind,
//! and the score.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use axis_sim::Axis;
use campaign::Job;
use clap::Args;
use discover_matrix::matrix::{Case, Outcome, Sizes, cases};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};

use super::matrix_job::Matrix;
use crate::jobs::{JobOptions, Sharding};
use crate::output::{ready, say, write_whole};
use crate::page::matrix;

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Axis file: the machine in which effects are hidden
    #[arg(long, value_name = "FILE", default_value = "data/axes/liu2025.toml")]
    axis: PathBuf,
    /// Folder for one file a case, matrix.json and matrix.md [default: runs/, the name of
    /// the axis, /discover-matrix/seed-N]; cases found there are not run again, if this
    /// program ran them on this axis file
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Layout of the cases, noise and known parameters; 1 to 7 served development
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Some twenty cases, of every kind
    #[arg(long)]
    quick: bool,
    /// Only the first N cases; every kind comes up early
    #[arg(long, value_name = "N")]
    first: Option<usize>,
    /// Only these cases, by their names (may be repeated)
    #[arg(long, value_name = "CASE", conflicts_with = "first")]
    only: Vec<String>,
    /// Also write the page of the full matrix here, where no page of another seed is
    #[arg(long, value_name = "FILE", conflicts_with_all = ["quick", "first", "only"])]
    page: Option<PathBuf>,
    /// Threads, 0 for all cores; results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    #[command(flatten)]
    sharding: Sharding,
}

impl JobOptions for Options {
    fn job(&self) -> Result<Box<dyn Job>> {
        Ok(Box::new(job(self)?))
    }

    fn sharding(&self) -> &Sharding {
        &self.sharding
    }
}

/// The job of these options.
fn job(options: &Options) -> Result<Matrix> {
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build_global();
    let axis = Axis::read(&options.axis).into_diagnostic()?;
    if let Some(page) = &options.page {
        replaceable(page, options.seed)?;
    }
    let sizes = if options.quick {
        Sizes::SMALL
    } else {
        Sizes::FULL
    };
    let mut cases = cases(&axis, &sizes, options.seed).into_diagnostic()?;
    let all = cases.len();
    cases.truncate(options.first.unwrap_or(all));
    if let Some(name) = options
        .only
        .iter()
        .find(|n| cases.iter().all(|c| c.id != **n))
    {
        return Err(miette!(
            "there is no case \"{name}\"; cases are named like {}",
            cases.first().map_or("", |c| &c.id)
        ));
    }
    cases.retain(|c| options.only.is_empty() || options.only.contains(&c.id));
    let name = format!("seed-{}", options.seed);
    let default = || {
        Path::new("runs")
            .join(&axis.name)
            .join("discover-matrix")
            .join(name)
    };
    let out = options.out.clone().unwrap_or_else(default);
    ready(&out.join("cases"))?;
    let kept = Kept::new(&axis, &out);
    kept.tell_of_others(&cases)?;
    Ok(Matrix {
        axis,
        seed: options.seed,
        cases,
        all,
        kept,
        out,
        page: options.page.clone(),
        benches: OnceLock::new(),
    })
}

/// Refuses to write a page over anything but a page of the same seed.
fn replaceable(page: &Path, seed: u64) -> Result<()> {
    let there = match std::fs::read_to_string(page) {
        Ok(text) => text,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(e) => {
            return Err(e)
                .into_diagnostic()
                .wrap_err_with(|| page.display().to_string());
        }
    };
    match matrix::seed_of(&there) {
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
    folder: PathBuf,
    made_by: String,
}

/// What a file of a case holds.
#[derive(Serialize, Deserialize)]
struct File<O> {
    /// Hash of the program and of the axis file that made it.
    made_by: String,
    outcome: O,
}

impl Kept {
    /// Outcomes of this program on this axis, in a folder.
    fn new(axis: &Axis, out: &Path) -> Self {
        let made_by = crate::program::inputs().with("axis", &axis.fingerprint);
        Self {
            folder: out.join("cases"),
            made_by: made_by.key(),
        }
    }

    /// Says how many of these cases lie there from another program or axis file.
    fn tell_of_others(&self, cases: &[Case]) -> Result<()> {
        let is_other = |case: &&Case| self.file(case).exists() && self.outcome(case).is_none();
        match cases.iter().filter(is_other).count() {
            0 => Ok(()),
            stale => say(format!(
                "{stale} cases in {} are of another program or axis file, and are run again",
                self.folder.display()
            )),
        }
    }

    fn file(&self, case: &Case) -> PathBuf {
        self.folder.join(format!("{}.json", case.id))
    }

    /// The outcome of a case; `None` where there is none of this program.
    pub(super) fn outcome(&self, case: &Case) -> Option<Outcome> {
        let text = std::fs::read(self.file(case)).ok()?;
        let file: File<Outcome> = serde_json::from_slice(&text).ok()?;
        let current = file.made_by == self.made_by && file.outcome.case.is_same(case);
        current.then_some(file.outcome)
    }

    pub(super) fn write(&self, case: &Case, outcome: &Outcome) -> Result<()> {
        let file = File {
            made_by: self.made_by.clone(),
            outcome,
        };
        let json = serde_json::to_vec_pretty(&file).into_diagnostic()?;
        write_whole(&self.file(case), &json)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use discover_matrix::matrix::Score;

    fn axis() -> Axis {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/axes/liu2025.toml");
        Axis::read(file.as_ref()).unwrap()
    }

    fn outcome_of(case: &Case) -> Outcome {
        Outcome {
            case: case.clone(),
            foreseen: Vec::new(),
            failed: None,
            verdict: None,
            named: Vec::new(),
            estimates: Vec::new(),
            reduction: 0.5,
            check: Vec::new(),
            unknown: None,
            split: None,
        }
    }

    #[test]
    fn outcomes_of_another_program_or_axis_are_not_taken_for_this_one() {
        let folder = tempfile::tempdir().unwrap();
        let axis = axis();
        let case = &cases(&axis, &Sizes::SMALL, 1).unwrap()[0];
        let own = Kept::new(&axis, folder.path());
        own.write(case, &outcome_of(case)).unwrap();
        assert_eq!(own.outcome(case), Some(outcome_of(case)));
        let other = Kept {
            made_by: "another".to_owned(),
            folder: own.folder.clone(),
        };
        assert_eq!(other.outcome(case), None);
        let mut changed = axis.clone();
        changed.fingerprint += "x";
        let changed = Kept::new(&changed, folder.path());
        assert_eq!(changed.outcome(case), None);
        // What does not say who made it is of no known program.
        let bare = serde_json::to_vec(&outcome_of(case)).unwrap();
        std::fs::write(own.file(case), bare).unwrap();
        assert_eq!(own.outcome(case), None);
    }

    #[test]
    fn a_page_takes_the_place_of_none_but_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("page.md");
        replaceable(&file, 8).unwrap();
        let page = matrix::page(&axis(), 8, 0, &[], &Score::new(&[]));
        std::fs::write(&file, page).unwrap();
        replaceable(&file, 8).unwrap();
        let refused = |seed| replaceable(&file, seed).unwrap_err().to_string();
        assert!(refused(1).contains("seed 8, not 1"), "{}", refused(1));
        std::fs::write(&file, "# Notes\n").unwrap();
        assert!(refused(8).contains("no page"), "{}", refused(8));
    }

    /// Or what is kept would be run again: without `float_roundtrip` of serde_json a
    /// fifth of the cases came back with another last bit.
    #[test]
    fn every_case_comes_back_from_its_file() {
        for case in cases(&axis(), &Sizes::FULL, 6).unwrap() {
            let text = serde_json::to_vec_pretty(&case).unwrap();
            assert_eq!(serde_json::from_slice::<Case>(&text).unwrap(), case);
        }
    }
}
