//! `discover-matrix`: machines with something hidden in them, searched blind,
//! and the score.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use axis_sim::Axis;
use clap::Args;
use discrepancy::hidden::Exercise;
use discrepancy::matrix::{Bench, Case, Outcome, Score, Sizes, cases};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use rayon::prelude::*;

use crate::output::{say, write_whole};
use crate::page::matrix;
use crate::progress::bar;

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Axis file: the machine in which effects are hidden
    #[arg(long, value_name = "FILE", default_value = "data/axes/liu2025.toml")]
    axis: PathBuf,
    /// Folder for one file a case, matrix.json and matrix.md [default: runs/,
    /// the name of the axis, /discover-matrix]; cases found there are not run again
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Layout of the cases, noise and known parameters
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
    /// Also write the page here once every case of the full matrix is there
    #[arg(long, value_name = "FILE", default_value = "docs/discovery-matrix.md")]
    page: PathBuf,
    /// Threads, 0 for all cores; results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build_global();
    let axis = Axis::read(&options.axis).into_diagnostic()?;
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
    let outcomes = run(&axis, &cases, &out)?;
    let score = Score::new(&outcomes);
    let page = matrix::page(&axis, options.seed, all, &outcomes, &score);
    let json = serde_json::to_vec_pretty(&score).into_diagnostic()?;
    write_whole(&out.join("matrix.json"), &json)?;
    write_whole(&out.join("matrix.md"), page.as_bytes())?;
    if !options.quick && outcomes.len() == all {
        write_whole(&options.page, page.as_bytes())?;
    }
    say(matrix::figures(&score))?;
    say(format!("{}", out.join("matrix.md").display()))
}

/// Outcomes of all cases, in their order; those in `out` are read.
fn run(axis: &Axis, cases: &[Case], out: &Path) -> Result<Vec<Outcome>> {
    let file = |case: &Case| out.join("cases").join(format!("{}.json", case.id));
    let kept = |case: &Case| -> Option<Outcome> {
        let text = std::fs::read(file(case)).ok()?;
        let outcome: Outcome = serde_json::from_slice(&text).ok()?;
        outcome.case.is_same(case).then_some(outcome)
    };
    let missing: Vec<&Case> = cases.iter().filter(|case| kept(case).is_none()).collect();
    let mut exercises: Vec<Exercise> = missing.iter().map(|case| case.exercise).collect();
    exercises.sort();
    exercises.dedup();
    let progress = bar("cases", cases.len() as u64);
    progress.inc((cases.len() - missing.len()) as u64);
    let benches: Vec<Bench> = exercises
        .iter()
        .map(|kind| Bench::new(axis, *kind).into_diagnostic())
        .collect::<Result<_>>()
        .wrap_err("the axis does not run the exercises of the matrix")?;
    // Cases are taken one after another, not in blocks, so that what is there
    // after a stop are the first ones.
    let queue = Mutex::new(missing.into_iter());
    let next = || {
        let mut queue = queue
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        queue.next()
    };
    (0..rayon::current_num_threads())
        .into_par_iter()
        .try_for_each(|_| -> Result<()> {
            while let Some(case) = next() {
                let bench = benches.iter().find(|b| b.exercise() == case.exercise);
                if let Some(bench) = bench {
                    let outcome = bench.try_case(case);
                    let json = serde_json::to_vec_pretty(&outcome).into_diagnostic()?;
                    write_whole(&file(case), &json)?;
                }
                progress.inc(1);
            }
            Ok(())
        })?;
    progress.finish_and_clear();
    Ok(cases.iter().filter_map(kept).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Or what is kept would be run again: without `float_roundtrip` of serde_json a
    /// fifth of the cases came back with another last bit.
    #[test]
    fn every_case_comes_back_from_its_file() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/axes/liu2025.toml");
        let axis = Axis::read(file.as_ref()).unwrap();
        for case in cases(&axis, &Sizes::FULL, 6).unwrap() {
            let text = serde_json::to_vec_pretty(&case).unwrap();
            assert_eq!(serde_json::from_slice::<Case>(&text).unwrap(), case);
        }
    }
}
