//! `discover-matrix`: machines with something hidden in them, searched blind,
//! and the score.

use std::path::Path;
use std::sync::OnceLock;

use axis_sim::Axis;
use campaign::Job;
use discover_matrix::matrix::{Sizes, cases};
use miette::{IntoDiagnostic, Result, miette};

use super::matrix_job::Matrix;
use super::matrix_kept::{Kept, replaceable};
pub use super::matrix_options::Options;
use crate::page::matrix;
use feed_axis::jobs::{JobOptions, Sharding};
use feed_axis::output::ready;

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

#[cfg(test)]
mod tests {
    use super::*;
    use discover_matrix::matrix::{Case, CaseOutcome, Score};

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
