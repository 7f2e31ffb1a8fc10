//! The cases of `discover-matrix` as a job.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use axis_sim::Axis;
use campaign::{Column, Failure, Inputs, Job, Merged, Row, Value};
use discover_matrix::hidden::Exercise;
use discover_matrix::matrix::{Bench, Case, CaseOutcome, Score};

use super::matrix_kept::Kept;
use crate::page::matrix;
use feed_axis::jobs::failure;
use feed_axis::output::{say, write_whole};

/// The matrix of an axis: a case is a case of it, whose outcome is also kept as a file.
pub(super) struct Matrix {
    pub(super) axis: Axis,
    pub(super) seed: u64,
    pub(super) cases: Vec<Case>,
    /// Cases of the whole matrix, of which `cases` may be a part.
    pub(super) all: usize,
    pub(super) kept: Kept,
    pub(super) out: PathBuf,
    pub(super) page: Option<PathBuf>,
    /// What cases on one motion share.
    pub(super) benches: OnceLock<Vec<Bench>>,
}

impl Matrix {
    fn outcome(&self, case: &Case) -> Result<CaseOutcome, Failure> {
        if let Some(outcome) = self.kept.outcome(case) {
            return Ok(outcome);
        }
        let mut benches = self.benches.get().into_iter().flatten();
        let bench = benches.find(|bench| bench.exercise() == case.exercise);
        let bench = bench.ok_or("its motion was not prepared")?;
        let outcome = bench.try_case(case);
        self.kept.write(&case.id, &outcome).map_err(failure)?;
        Ok(outcome)
    }

    fn write(&self, outcomes: &[CaseOutcome]) -> miette::Result<()> {
        let score = Score::new(outcomes);
        let page = matrix::page(&self.axis, self.seed, self.all, outcomes, &score);
        let json = serde_json::to_vec_pretty(&score).map_err(|e| miette::miette!("{e}"))?;
        write_whole(&self.out.join("matrix.json"), &json)?;
        write_whole(&self.out.join("matrix.md"), page.as_bytes())?;
        if let Some(file) = &self.page {
            write_whole(file, page.as_bytes())?;
        }
        say(matrix::figures(&score))?;
        say(self.out.join("matrix.md").display().to_string())
    }
}

impl Job for Matrix {
    fn name(&self) -> &'static str {
        "discover-matrix"
    }

    fn inputs(&self) -> Inputs {
        let cases = serde_json::to_string(&self.cases).unwrap_or_default();
        let cases = blake3::hash(cases.as_bytes()).to_hex();
        feed_axis::program::inputs()
            .with("axis", &self.axis.fingerprint)
            .with("seed", self.seed)
            .with("cases", cases)
    }

    fn folder(&self) -> &Path {
        &self.out
    }

    fn columns(&self) -> &'static [Column] {
        const COLUMNS: [Column; 2] = [Column::text("name"), Column::text("outcome")];
        &COLUMNS
    }

    fn cases(&self) -> usize {
        self.cases.len()
    }

    fn prepare(&self, cases: &[Range<usize>]) -> Result<(), Failure> {
        let cases = cases.iter().cloned().flatten().map(|i| &self.cases[i]);
        let missing = cases.filter(|case| self.kept.outcome(case).is_none());
        let mut exercises: Vec<Exercise> = missing.map(|case| case.exercise).collect();
        exercises.sort();
        exercises.dedup();
        let benches = exercises.iter().map(|kind| {
            Bench::new(&self.axis, *kind)
                .map_err(|e| format!("the axis does not run the exercises of the matrix: {e}"))
        });
        let benches = benches.collect::<Result<Vec<_>, _>>()?;
        // Called once.
        let _ = self.benches.set(benches);
        Ok(())
    }

    fn rows(&self, cases: Range<usize>) -> Result<Vec<Row>, Failure> {
        let row = |case: &Case| {
            let outcome = serde_json::to_string(&self.outcome(case)?)?;
            Ok(vec![Value::Text(case.id.clone()), Value::Text(outcome)])
        };
        self.cases[cases].iter().map(row).collect()
    }

    fn finish(&self, rows: &Merged) -> Result<(), Failure> {
        let read = |row: Result<Row, campaign::CampaignError>| -> Result<CaseOutcome, Failure> {
            Ok(serde_json::from_str(row?[1].text()?)?)
        };
        let outcomes = rows.rows().map(read).collect::<Result<Vec<_>, _>>()?;
        self.write(&outcomes).map_err(failure)
    }
}
