//! Runs killed at random moments.
//!
//! A third of the kills come at any time of any stage, all stages alike; a third within
//! 3 ms of a change in the stage's folder, where files are written and put in place; a
//! third at any time of a whole pipeline, which after it goes on in the same folder and
//! may be killed again.

use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use miette::{IntoDiagnostic, Result};

use super::{Bench, Tally, wait};
use crate::commands::torture::random::Source;
use feed_axis::progress::bar;

/// Kills up to `most` runs until the time is over.
pub fn all(bench: &Bench, most: u64, until: Instant) -> Result<Vec<Tally>> {
    let named = |name: &str| Tally {
        name: name.to_owned(),
        ..Tally::default()
    };
    let mut tallies = vec![
        named("killed in a stage"),
        named("killed while writing"),
        named("killed in a pipeline"),
    ];
    let progress = bar("kills", most);
    let mut round = 0;
    let struck = |tallies: &[Tally]| tallies.iter().map(|tally| tally.struck).sum::<u64>();
    while struck(&tallies) < most && Instant::now() < until {
        let mut random = Source::new(bench.seed, "kill", round);
        let left = most - struck(&tallies);
        match fewest(&tallies) {
            0 => stage(bench, &mut tallies[0], &mut random, false)?,
            1 => stage(bench, &mut tallies[1], &mut random, true)?,
            _ => pipeline(bench, &mut tallies[2], &mut random, left)?,
        }
        round += 1;
        progress.set_position(struck(&tallies));
    }
    progress.finish_and_clear();
    Ok(tallies)
}

/// The kind of kill of which there were fewest.
fn fewest(tallies: &[Tally]) -> usize {
    let kinds = tallies.iter().enumerate();
    kinds
        .min_by_key(|(_, tally)| tally.struck)
        .map_or(0, |(kind, _)| kind)
}

/// Kills a run that has one stage to do, and looks at the next run.
fn stage(bench: &Bench, tally: &mut Tally, random: &mut Source, writing: bool) -> Result<()> {
    let (stage, seconds) = random.pick(&bench.stages).clone();
    bench.without(&stage)?;
    let mut child = bench.command(&bench.work, &[])?;
    let mut child = child
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .into_diagnostic()?;
    let delay = if writing {
        let folder = bench.work.join(&stage);
        changes(&mut child, &folder, random.below(8))?;
        Duration::from_secs_f64(3e-3 * random.unit())
    } else {
        Duration::from_secs_f64((seconds + 0.05) * random.unit())
    };
    tally.tried += 1;
    if kill(&mut child, delay)? {
        tally.struck += 1;
    }
    if let Err(what) = bench.mends()? {
        tally.faults.push(format!("{stage} killed: {what}"));
    }
    Ok(())
}

/// Waits until the folder has changed so many times, or the child is at its end.
fn changes(child: &mut Child, folder: &Path, many: usize) -> Result<()> {
    let names = || -> Vec<_> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut names: Vec<_> = entries.map(|entry| entry.file_name()).collect();
        names.sort();
        names
    };
    let (mut before, mut seen) = (names(), 0);
    while seen < many && child.try_wait().into_diagnostic()?.is_none() {
        let now = names();
        if now != before {
            (before, seen) = (now, seen + 1);
        }
        std::thread::sleep(Duration::from_micros(200));
    }
    Ok(())
}

/// Kills one pipeline in an empty folder again and again, until it comes to its end.
fn pipeline(bench: &Bench, tally: &mut Tally, random: &mut Source, left: u64) -> Result<()> {
    bench.clear()?;
    let whole: f64 = bench.stages.iter().map(|(_, seconds)| seconds).sum();
    let mut killed = 0;
    while killed < left {
        let mut command = bench.command(&bench.work, &[])?;
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().into_diagnostic()?;
        tally.tried += 1;
        // The share of the whole that is small enough to strike several times.
        let delay = Duration::from_secs_f64(0.6 * whole * random.unit());
        if !kill(&mut child, delay)? {
            break;
        }
        killed += 1;
        tally.struck += 1;
    }
    std::fs::create_dir_all(&bench.work).into_diagnostic()?;
    if let Err(what) = bench.mends()? {
        tally
            .faults
            .push(format!("pipeline killed {killed} times: {what}"));
    }
    Ok(())
}

/// Kills the child after `delay`; `false` if it had ended before.
fn kill(child: &mut Child, delay: Duration) -> Result<bool> {
    let ended = wait(child, delay)?;
    // A child that has ended by now is not hurt by it.
    child.kill().into_diagnostic()?;
    let status = child.wait().into_diagnostic()?;
    Ok(!ended && status.code().is_none())
}
