//! `discover-matrix --version 2`: machines as hard as real ones, searched blind, and the
//! score.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use axis_sim::Axis;
use discover_matrix::matrix2::{Bench, Case, Outcome, Plan, cases};
use indicatif::ProgressBar;
use miette::{IntoDiagnostic, Result, miette};
use rayon::prelude::*;

use super::discover_matrix::{Kept, Options, replaceable};
use crate::output::{ready, say, write_whole};
use crate::page::matrix2;
use crate::progress::bar;

/// Axis files of machines that are taken where none are given.
pub(super) const MACHINES: [&str; 3] = [
    "data/axes/liu2025.toml",
    "data/axes/joint.toml",
    "data/axes/linear-motor.toml",
];

/// Runs the command.
pub(super) fn command(options: &Options) -> Result<()> {
    if let Some(page) = &options.page {
        replaceable(page, options.seed, matrix2::seed_of)?;
    }
    let read = |file: &std::path::PathBuf| Axis::read(file).into_diagnostic();
    let machines: Vec<Axis> = options.machines.iter().map(read).collect::<Result<_>>()?;
    let plan = match options.size {
        _ if options.quick => Plan::quick(machines.len()),
        Some(size) => Plan::of(size),
        None => Plan::full(),
    };
    let mut cases = cases(&machines, &plan, options.seed).into_diagnostic()?;
    options.chosen(&mut cases, |c| &c.id)?;
    let name = format!("seed-{}-of-{}", options.seed, plan.cases());
    let default = || Path::new("runs/discover-matrix-2").join(name);
    let out = options.out.clone().unwrap_or_else(default);
    ready(&out.join("cases"))?;
    let kept = Kept::new(&machines, &out)?;
    let outcomes: Vec<Outcome> = if options.tell {
        let read = |case: &Case| -> Option<Outcome> {
            let (_, outcome): (String, Outcome) = kept.read_any(&case.id)?;
            outcome.case.is_same(case).then_some(outcome)
        };
        cases.iter().filter_map(read).collect()
    } else {
        run(&machines, &cases, &kept)?;
        cases.iter().filter_map(|c| outcome(&kept, c)).collect()
    };
    let page = matrix2::page(&machines, options.seed, plan.cases(), &outcomes);
    write_whole(&out.join("matrix.md"), page.as_bytes())?;
    if let Some(file) = &options.page {
        write_whole(file, page.as_bytes())?;
    }
    say(matrix2::figures(&outcomes))?;
    say(format!("{}", out.join("matrix.md").display()))
}

/// What this program kept of a case.
fn outcome(kept: &Kept, case: &Case) -> Option<Outcome> {
    let outcome: Option<Outcome> = kept.read(&case.id);
    outcome.filter(|o| o.case.is_same(case))
}

/// Runs what is not kept yet, a plot after another.
fn run(machines: &[Axis], cases: &[Case], kept: &Kept) -> Result<()> {
    let is_missing = |case: &&Case| outcome(kept, case).is_none();
    let missing: Vec<&Case> = cases.iter().filter(is_missing).collect();
    let progress = bar("cases", cases.len() as u64);
    progress.inc((cases.len() - missing.len()) as u64);
    // Plots one after another, so that what is there after a stop are the first ones.
    let queue = Mutex::new(missing.chunk_by(|a, b| a.plot == b.plot));
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let threads = (0..rayon::current_num_threads()).into_par_iter();
    threads.try_for_each(|_| -> Result<()> {
        while let Some(plot) = next() {
            run_plot(machines, plot, kept, &progress)?;
        }
        Ok(())
    })?;
    progress.finish_and_clear();
    Ok(())
}

/// Runs cases of one plot.
fn run_plot(machines: &[Axis], cases: &[&Case], kept: &Kept, progress: &ProgressBar) -> Result<()> {
    let Some(setting) = cases.first().map(|c| &c.setting) else {
        return Ok(());
    };
    let axis = machines.iter().find(|axis| axis.name == setting.machine);
    let axis = axis.ok_or_else(|| miette!("no machine is called {}", setting.machine))?;
    // Where the search refuses the very motion, it refuses each case of it.
    let bench = Bench::new(axis, setting).map_err(|error| error.to_string());
    for case in cases {
        let outcome = match &bench {
            Ok(bench) => bench.try_case(case),
            Err(why) => Outcome::failed(case, why.clone()),
        };
        kept.write(&case.id, &outcome)?;
        progress.inc(1);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn machines() -> Vec<Axis> {
        let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
        let read = |file: &&str| Axis::read(&root.join(file)).unwrap();
        MACHINES.iter().map(read).collect()
    }

    /// Or what is kept would be run again.
    #[test]
    fn every_case_comes_back_from_its_file() {
        let all = cases(&machines(), &Plan::full(), 6).unwrap();
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
