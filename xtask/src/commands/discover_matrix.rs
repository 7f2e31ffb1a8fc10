//! `discover-matrix`: machines with something hidden in them, searched blind,
//! and the score.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use axis_sim::Axis;
use campaign::Job;
use clap::Args;
use discover_matrix::matrix::{Case, CaseOutcome, Sizes, cases};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::matrix_job::Matrix;
use crate::page::matrix;
use feed_axis::jobs::{JobOptions, Sharding};
use feed_axis::output::{ready, say, write_whole};

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Axis file: the machine in which effects are hidden (version 1)
    #[arg(long, value_name = "FILE", default_value = "data/axes/liu2025.toml")]
    axis: PathBuf,
    /// 1: one machine that follows the model's laws; 2: several that differ from the model as real
    /// machines do
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=2))]
    version: u32,
    /// Axis files of version 2, taken in turn
    #[arg(long, value_name = "FILE", num_args = 1.., default_values = super::discover_matrix2::MACHINES)]
    pub(super) machines: Vec<PathBuf>,
    /// Cases of version 2, rounded up to whole plots [default: 1080]
    #[arg(long, value_name = "N", conflicts_with = "quick")]
    pub(super) size: Option<usize>,
    /// Folder for one file a case, matrix.json and matrix.md [default: runs/, the name of
    /// the axis, /discover-matrix/seed-N]; cases found there are not run again, if this
    /// program ran them on this axis file
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Seed of the cases, noise and known parameters; 1 to 7 were used in development
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Some twenty cases, of every kind
    #[arg(long)]
    pub(super) quick: bool,
    /// Only the first N cases; every kind comes up early
    #[arg(long, value_name = "N")]
    pub(super) first: Option<usize>,
    /// Only these cases, by their names (may be repeated)
    #[arg(long, value_name = "CASE", conflicts_with = "first")]
    pub(super) only: Vec<String>,
    /// Also write the page of the full matrix here; a page of another seed is not overwritten
    #[arg(long, value_name = "FILE", conflicts_with_all = ["quick", "first", "only"])]
    pub(super) page: Option<PathBuf>,
    /// Run nothing; show the kept results of these cases, whichever program made them (version 2)
    #[arg(long)]
    pub(super) tell: bool,
    /// Threads, 0 for all cores; results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    #[command(flatten)]
    sharding: Sharding,
}

impl Options {
    /// Leaves the cases that are asked for.
    pub(super) fn chosen<C>(&self, cases: &mut Vec<C>, id: fn(&C) -> &String) -> Result<()> {
        cases.truncate(self.first.unwrap_or(cases.len()));
        let is_there = |name: &&String| cases.iter().any(|c| id(c) == *name);
        if let Some(name) = self.only.iter().find(|name| !is_there(name)) {
            return Err(miette!(
                "there is no case \"{name}\"; cases are named like {}",
                cases.first().map_or("", |c| id(c))
            ));
        }
        cases.retain(|c| self.only.is_empty() || self.only.contains(id(c)));
        Ok(())
    }
}

impl JobOptions for Options {
    fn job(&self) -> Result<Box<dyn Job>> {
        let _ = rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .build_global();
        match self.version {
            2 => Ok(Box::new(super::discover_matrix2::job(self)?)),
            _ => Ok(Box::new(job(self)?)),
        }
    }

    fn sharding(&self) -> &Sharding {
        &self.sharding
    }
}

/// The job of these options.
fn job(options: &Options) -> Result<Matrix> {
    if options.tell || options.size.is_some() {
        return Err(miette!("--tell and --size are of --version 2"));
    }
    let axis = Axis::read(&options.axis).into_diagnostic()?;
    if let Some(page) = &options.page {
        replaceable(page, options.seed, matrix::seed_of)?;
    }
    let sizes = if options.quick {
        Sizes::SMALL
    } else {
        Sizes::FULL
    };
    let mut cases = cases(&axis, &sizes, options.seed).into_diagnostic()?;
    let all = cases.len();
    options.chosen(&mut cases, |c| &c.id)?;
    let name = format!("seed-{}", options.seed);
    let default = || {
        Path::new("runs")
            .join(&axis.name)
            .join("discover-matrix")
            .join(name)
    };
    let out = options.out.clone().unwrap_or_else(default);
    ready(&out.join("cases"))?;
    let kept = Kept::new([&axis], &out);
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
    fn tell_of_others(&self, cases: &[Case]) -> Result<()> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use discover_matrix::matrix::Score;

    fn axis() -> Axis {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/axes/liu2025.toml");
        Axis::read(file.as_ref()).unwrap()
    }

    fn outcome_of(case: &Case) -> CaseOutcome {
        CaseOutcome {
            case: case.clone(),
            predicted: Vec::new(),
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
        let own = Kept::new([&axis], folder.path());
        own.write(&case.id, &outcome_of(case)).unwrap();
        assert_eq!(own.outcome(case), Some(outcome_of(case)));
        let other = Kept {
            made_by: "another".to_owned(),
            folder: own.folder.clone(),
        };
        assert_eq!(other.outcome(case), None);
        let mut changed = axis.clone();
        changed.fingerprint += "x";
        let changed = Kept::new([&changed], folder.path());
        assert_eq!(changed.outcome(case), None);
        // What does not say who made it is of no known program.
        let bare = serde_json::to_vec(&outcome_of(case)).unwrap();
        std::fs::write(own.file(&case.id), bare).unwrap();
        assert_eq!(own.outcome(case), None);
    }

    #[test]
    fn a_page_takes_the_place_of_none_but_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("page.md");
        replaceable(&file, 8, matrix::seed_of).unwrap();
        let page = matrix::page(&axis(), 8, 0, &[], &Score::new(&[]));
        std::fs::write(&file, page).unwrap();
        replaceable(&file, 8, matrix::seed_of).unwrap();
        let refused = |seed| {
            replaceable(&file, seed, matrix::seed_of)
                .unwrap_err()
                .to_string()
        };
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
