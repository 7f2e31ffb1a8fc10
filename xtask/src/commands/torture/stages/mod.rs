//! Stages on disk: runs that are killed, doubled or starved, and what the next run
//! makes of what they left.

mod folder;
mod kills;
mod starved;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use miette::{IntoDiagnostic, Result, miette};

use super::kinds::small_screw;
use super::{Options, tell};
use feed_axis::output::write_whole;
use folder::Snapshot;

/// A pipeline small enough to be run a thousand times.
pub struct Bench {
    seed: u64,
    /// Whether one of several stages or sizes is enough.
    once: bool,
    axis: PathBuf,
    /// Where runs work.
    work: PathBuf,
    /// Where the undisturbed run is.
    whole: PathBuf,
    /// What it left.
    reference: Snapshot,
    /// Its stages in their order, and how long each took, s.
    stages: Vec<(String, f64)>,
}

/// The outcome of one way to disturb a run.
#[derive(Default)]
pub struct Tally {
    pub name: String,
    pub tried: u64,
    /// Runs that were stopped by it, or said that they could not go on.
    pub struck: u64,
    pub faults: Vec<String>,
    /// Why it was left out.
    pub skipped: Option<String>,
}

/// Disturbs stages until `--kills` or the time is reached. The number of faults.
pub fn torture(options: &Options, until: Instant) -> Result<u64> {
    let bench = Bench::new(options)?;
    let mut tallies = starved::all(&bench)?;
    tallies.extend(kills::all(&bench, options.kills, until)?);
    let mut rows = vec![["runs", "tried", "struck", "", "faults"].map(str::to_owned)];
    for tally in &tallies {
        let numbers = [tally.tried, tally.struck].map(|n| n.to_string());
        let [tried, struck] = numbers;
        let note = tally.skipped.clone().unwrap_or_default();
        let faults = tally.faults.len().to_string();
        rows.push([tally.name.clone(), tried, struck, note, faults]);
    }
    tell(&rows)?;
    let faults: Vec<&String> = tallies.iter().flat_map(|tally| &tally.faults).collect();
    let text: Vec<String> = faults.iter().map(|fault| format!("{fault}\n")).collect();
    write_whole(
        &options.out.join("stage-faults.txt"),
        text.concat().as_bytes(),
    )?;
    faults
        .iter()
        .take(10)
        .try_for_each(|fault| feed_axis::output::say(fault.as_str()))?;
    Ok(faults.len() as u64)
}

impl Bench {
    fn new(options: &Options) -> Result<Self> {
        let folder = std::path::absolute(options.out.join("stages")).into_diagnostic()?;
        if folder.exists() {
            std::fs::remove_dir_all(&folder).into_diagnostic()?;
        }
        std::fs::create_dir_all(&folder).into_diagnostic()?;
        let axis = folder.join("axis.toml");
        write_whole(&axis, axis_file().as_bytes())?;
        let whole = folder.join("whole");
        let mut bench = Self {
            seed: options.seed,
            once: options.once,
            work: folder.join("work"),
            reference: Snapshot::default(),
            stages: Vec::new(),
            axis,
            whole,
        };
        let output = bench.run(&bench.whole, &[])?;
        if !output.status.success() {
            return Err(miette!("the undisturbed run failed: {}", said(&output)));
        }
        bench.reference = Snapshot::of(&bench.whole)?;
        bench.stages = folder::times(&bench.whole)?;
        Ok(bench)
    }

    /// All of these, or the one that the seed chooses.
    fn some<'a, T>(&self, all: &'a [T]) -> &'a [T] {
        match self.once && !all.is_empty() {
            true => {
                let one = (self.seed % all.len() as u64) as usize;
                &all[one..=one]
            }
            false => all,
        }
    }

    /// The small pipeline in a folder.
    fn command(&self, out: &Path, more: &[&str]) -> Result<Command> {
        let mut command = Command::new(std::env::current_exe().into_diagnostic()?);
        self.arguments(&mut command, out);
        command.args(more).stdin(Stdio::null());
        Ok(command)
    }

    fn arguments(&self, command: &mut Command, out: &Path) {
        command
            .args(["pipeline", "--quick", "--axis"])
            .arg(&self.axis);
        command.arg("--out").arg(out);
    }

    fn run(&self, out: &Path, more: &[&str]) -> Result<Output> {
        self.command(out, more)?.output().into_diagnostic()
    }

    /// Whether the next run in the folder `work` ends as the undisturbed one did, and
    /// leaves alone what was finished.
    fn mends(&self) -> Result<std::result::Result<(), String>> {
        let finished = folder::finished(&self.work)?;
        let output = self.run(&self.work, &[])?;
        let words = said(&output);
        if !output.status.success() || words.contains("panicked") {
            return Ok(Err(format!("the next run fails: {words}")));
        }
        for (stage, times) in finished {
            if !words.contains(&format!("{stage}: up to date")) {
                return Ok(Err(format!("{stage} was finished and ran again")));
            }
            if folder::files(&self.work.join(&stage))? != times {
                return Ok(Err(format!("{stage} was finished and its files changed")));
            }
        }
        Ok(Snapshot::of(&self.work)?.same_as(&self.reference))
    }

    /// Makes the folder `work` as the undisturbed run left it, but for the stage.
    fn without(&self, stage: &str) -> Result<()> {
        self.clear()?;
        folder::copy(&self.whole, &self.work)?;
        let stage = self.work.join(stage);
        std::fs::remove_dir_all(stage).into_diagnostic()
    }

    fn clear(&self) -> Result<()> {
        match std::fs::remove_dir_all(&self.work) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(e).into_diagnostic(),
            _ => Ok(()),
        }
    }
}

/// The paper's axis with few elements, at 5 kHz, and one short move.
fn axis_file() -> String {
    let text = small_screw().replace("frequency_khz = 10", "frequency_khz = 5");
    let text = text.replace("step_us = 100", "step_us = 200");
    let moves = text.find("[[trajectory]]").unwrap_or(text.len());
    text[..moves].to_owned()
        + "[[trajectory]]\ndisplacement_mm = 10\nspeed_mm_per_s = 100\n\
           acceleration_mm_per_s2 = 225\njerk_mm_per_s3 = 1200\n"
}

fn said(output: &Output) -> String {
    let both = [&output.stdout[..], &output.stderr[..]].concat();
    String::from_utf8_lossy(&both).into_owned()
}

/// Waits for a child's end, at most so long.
fn wait(child: &mut std::process::Child, most: Duration) -> Result<bool> {
    let start = Instant::now();
    while start.elapsed() < most {
        if child.try_wait().into_diagnostic()?.is_some() {
            return Ok(true);
        }
        std::thread::sleep(Duration::from_micros(500));
    }
    Ok(false)
}
