//! `discover-matrix --version 2`: machines as hard as real ones, searched blind, and the
//! score.

use std::ops::Range;
use std::path::{Path, PathBuf};

use axis_sim::Axis;
use campaign::{Column, Failure, Inputs, Job, Merged, Row, Value};
use discover_matrix::matrix2::{Bench, Case, CaseOutcome, MatrixPlan, cases};
use miette::{IntoDiagnostic, Result};

use super::matrix_kept::{Kept, replaceable};
use super::matrix_options::Options;
use crate::page::matrix2;
use feed_axis::jobs::failure;
use feed_axis::output::{ready, say, write_whole};

/// The job of these options.
pub(super) fn job(options: &Options) -> Result<Matrix2> {
    if let Some(page) = &options.page {
        replaceable(page, options.seed, matrix2::seed_of)?;
    }
    let read = |file: &PathBuf| Axis::read(file).into_diagnostic();
    let machines: Vec<Axis> = options.machines.iter().map(read).collect::<Result<_>>()?;
    let plan = match options.size {
        _ if options.quick => MatrixPlan::quick(machines.len()),
        Some(size) => MatrixPlan::of(size),
        None => MatrixPlan::full(),
    };
    let mut cases = cases(&machines, &plan, options.seed).into_diagnostic()?;
    options.chosen(&mut cases, |c| &c.id)?;
    let name = format!("seed-{}-of-{}", options.seed, plan.cases());
    let default = || Path::new("runs/discover-matrix-2").join(name);
    let out = options.out.clone().unwrap_or_else(default);
    ready(&out.join("cases"))?;
    let kept = Kept::new(&machines, &out);
    if options.tell {
        cases.retain(|case| by_any(&kept, case).is_some());
    }
    Ok(Matrix2 {
        seed: options.seed,
        all: plan.cases(),
        each: plan.cases() / plan.plots.max(1),
        told: options.tell,
        page: options.page.clone(),
        machines,
        cases,
        kept,
        out,
    })
}

/// The second matrix: a case is a case of it, whose outcome is also kept as a file.
pub(super) struct Matrix2 {
    machines: Vec<Axis>,
    seed: u64,
    cases: Vec<Case>,
    /// Cases of the whole matrix, of which `cases` may be a part.
    all: usize,
    /// Cases of a plot.
    each: usize,
    /// Whether what any program kept is told, and nothing is run.
    told: bool,
    kept: Kept,
    out: PathBuf,
    page: Option<PathBuf>,
}

/// What any program kept of a case.
fn by_any(kept: &Kept, case: &Case) -> Option<CaseOutcome> {
    let (_, outcome): (String, CaseOutcome) = kept.read_any(&case.id)?;
    outcome.case.is_same(case).then_some(outcome)
}

impl Matrix2 {
    /// What was kept of a case.
    fn outcome(&self, case: &Case) -> Option<CaseOutcome> {
        if self.told {
            return by_any(&self.kept, case);
        }
        let outcome: Option<CaseOutcome> = self.kept.read(&case.id);
        outcome.filter(|o| o.case.is_same(case))
    }

    /// Outcomes of cases of one plot, which share what is made beforehand.
    fn plot(&self, cases: &[Case]) -> std::result::Result<Vec<CaseOutcome>, Failure> {
        let mut bench = None;
        let mut one = |case: &Case| -> std::result::Result<CaseOutcome, Failure> {
            if let Some(outcome) = self.outcome(case) {
                return Ok(outcome);
            }
            let mut machines = self.machines.iter();
            let axis = machines.find(|axis| axis.name == case.setting.machine);
            let axis = axis.ok_or("a machine of the matrix is not there")?;
            // Where the search refuses the very motion, it refuses each case of it.
            let bench = bench.get_or_insert_with(|| {
                Bench::new(axis, &case.setting).map_err(|error| error.to_string())
            });
            let outcome = match bench {
                Ok(bench) => bench.try_case(case),
                Err(why) => CaseOutcome::failed(case, why.clone()),
            };
            self.kept.write(&case.id, &outcome).map_err(failure)?;
            Ok(outcome)
        };
        cases.iter().map(&mut one).collect()
    }

    fn write(&self, outcomes: &[CaseOutcome]) -> Result<()> {
        let page = matrix2::page(&self.machines, self.seed, self.all, outcomes);
        write_whole(&self.out.join("matrix.md"), page.as_bytes())?;
        if let Some(file) = &self.page {
            write_whole(file, page.as_bytes())?;
        }
        say(matrix2::figures(outcomes))?;
        say(self.out.join("matrix.md").display().to_string())
    }
}

impl Job for Matrix2 {
    fn name(&self) -> &'static str {
        "discover-matrix"
    }

    fn inputs(&self) -> Inputs {
        let cases = serde_json::to_string(&self.cases).unwrap_or_default();
        let axes: Vec<&str> = (self.machines.iter())
            .map(|axis| axis.fingerprint.as_str())
            .collect();
        feed_axis::program::inputs()
            .with("version", 2)
            .with("axes", axes.join(" "))
            .with("seed", self.seed)
            .with("cases", blake3::hash(cases.as_bytes()).to_hex())
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

    /// As many as a plot has.
    fn block(&self) -> usize {
        self.each
    }

    fn rows(&self, cases: Range<usize>) -> std::result::Result<Vec<Row>, Failure> {
        let mut rows = Vec::new();
        for plot in self.cases[cases].chunk_by(|a, b| a.plot == b.plot) {
            for (case, outcome) in plot.iter().zip(self.plot(plot)?) {
                let outcome = serde_json::to_string(&outcome)?;
                rows.push(vec![Value::Text(case.id.clone()), Value::Text(outcome)]);
            }
        }
        Ok(rows)
    }

    fn finish(&self, rows: &Merged) -> std::result::Result<(), Failure> {
        let read = |row: std::result::Result<Row, campaign::CampaignError>| -> std::result::Result<CaseOutcome, Failure> {
            Ok(serde_json::from_str(row?[1].text()?)?)
        };
        let outcomes = rows
            .rows()
            .map(read)
            .collect::<std::result::Result<Vec<_>, _>>()?;
        self.write(&outcomes).map_err(failure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::matrix_options::MACHINES;

    fn machines() -> Vec<Axis> {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
        let read = |file: &&str| Axis::read(&root.join(file)).unwrap();
        MACHINES.iter().map(read).collect()
    }

    /// Or what is kept would be run again.
    #[test]
    fn every_case_comes_back_from_its_file() {
        let all = cases(&machines(), &MatrixPlan::full(), 6).unwrap();
        assert!(all.len() >= 600);
        for case in all {
            let text = serde_json::to_vec_pretty(&case).unwrap();
            assert_eq!(serde_json::from_slice::<Case>(&text).unwrap(), case);
        }
    }

    #[test]
    fn a_page_says_its_seed() {
        let page = matrix2::page(&machines(), 202, 1080, &[]);
        assert_eq!(matrix2::seed_of(&page), Some(202));
        assert_eq!(matrix2::seed_of("# Notes\n"), None);
    }
}
