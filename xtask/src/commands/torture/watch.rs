//! Starts workers, looks after them, and counts what they found.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use indicatif::ProgressBar;
use miette::{IntoDiagnostic, Result, miette};

use super::kinds::{Kind, all};
use super::worker::{PROGRESS, Progress, again, keep, noted};
use super::{Options, tell};
use feed_axis::output::say;
use feed_axis::progress::bar;

/// Inputs that one process judges.
const BLOCK: u64 = 20_000;
/// Processor time after which one input is taken to hang, s: a thousand times what the
/// slowest usual ones take. What can be counted is limited by its count instead.
const PATIENCE: f64 = 20.0;
/// Faults that are told one by one.
const TOLD: usize = 20;

/// What all workers found.
struct Sum {
    counts: Vec<[u64; 3]>,
    peak: u64,
    limited: bool,
}

/// Tries inputs until `--inputs` or the time is reached. The number of faults.
pub fn inputs(options: &Options, until: Instant) -> Result<u64> {
    let faults = options.out.join("faults");
    if faults.exists() {
        std::fs::remove_dir_all(&faults).into_diagnostic()?;
    }
    let kinds = all(&options.out.join("again"))?;
    let mut sum = Sum {
        counts: vec![[0; 3]; kinds.len()],
        peak: 0,
        limited: true,
    };
    let end = options.from.saturating_add(options.inputs);
    let progress = if options.inputs == u64::MAX {
        ProgressBar::new_spinner()
    } else {
        bar("inputs", options.inputs)
    };
    let watch = Watch {
        options,
        kinds: &kinds,
        until,
        bar: &progress,
    };
    let start = Instant::now();
    let mut index = options.from;
    while index < end && Instant::now() < until {
        let count = BLOCK.min(end - index);
        index = watch.block(index, count, &mut sum)?;
    }
    progress.finish_and_clear();
    summary(&kinds, &sum, start.elapsed())?;
    list(&faults)?;
    Ok(sum.counts.iter().map(|[.., faults]| faults).sum())
}

/// What holds for all workers.
struct Watch<'a> {
    options: &'a Options,
    kinds: &'a [Box<dyn Kind>],
    /// When to end.
    until: Instant,
    bar: &'a ProgressBar,
}

impl Watch<'_> {
    /// Has a worker judge `count` inputs; the number of the next one.
    fn block(&self, index: u64, count: u64, sum: &mut Sum) -> Result<u64> {
        let Self {
            options,
            kinds,
            until,
            bar,
        } = *self;
        let record = options.out.join(PROGRESS);
        feed_axis::output::remove(&record)?;
        let mut child = start(options, index, count)?;
        let mut at = (u64::MAX, 0.0);
        let ended: Result<Option<ExitStatus>> = loop {
            if let Some(status) = child.try_wait().into_diagnostic()? {
                break Ok(Some(status));
            }
            std::thread::sleep(Duration::from_millis(20));
            let now = noted(&record).map_or(u64::MAX, |progress| progress.index);
            if now != u64::MAX {
                bar.set_position(now - options.from);
            }
            let used = processor_time(child.id());
            if now != at.0 {
                at = (now, used);
            }
            let (hangs, late) = (used - at.1 > PATIENCE, Instant::now() > until);
            if hangs || late {
                child
                    .kill()
                    .and_then(|()| child.wait().map(drop))
                    .into_diagnostic()?;
                break Ok(None);
            }
        };
        let status = ended?;
        let said = std::fs::read_to_string(options.out.join("worker.txt")).unwrap_or_default();
        let Some(found) = noted(&record) else {
            return Err(miette!("a worker did not begin: {said}"));
        };
        add(sum, &found);
        match status {
            Some(status) if status.success() => Ok(found.index),
            None if Instant::now() > until => Ok(found.index),
            Some(_) if said.contains("cannot ") => Err(miette!("a worker failed: {said}")),
            other => {
                let (kind, input) = again(options, kinds, found.index)?;
                let what = match other {
                    Some(status) => format!("ends the process ({status}): {}", said.trim()),
                    None => format!("takes more than {PATIENCE} s of processor time"),
                };
                keep(options, found.index, kinds[kind].name(), &input, &what)?;
                sum.counts[kind][2] += 1;
                Ok(found.index + 1)
            }
        }
    }
}

fn start(options: &Options, index: u64, count: u64) -> Result<Child> {
    let said = File::create(options.out.join("worker.txt")).into_diagnostic()?;
    let mut command = Command::new(std::env::current_exe().into_diagnostic()?);
    let numbers = [
        ("--seed", options.seed),
        ("--from", index),
        ("--inputs", count),
    ];
    command
        .args(["torture", "--worker", "--out"])
        .arg(&options.out);
    for (name, value) in numbers {
        command.arg(name).arg(value.to_string());
    }
    // One thread and one heap, so that the size of the process is what inputs take.
    command
        .env("RAYON_NUM_THREADS", "1")
        .env("MALLOC_ARENA_MAX", "1");
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(said);
    command.spawn().into_diagnostic()
}

fn add(sum: &mut Sum, found: &Progress) {
    for (all, new) in sum.counts.iter_mut().zip(&found.counts) {
        all.iter_mut().zip(new).for_each(|(all, new)| *all += new);
    }
    sum.peak = sum.peak.max(found.peak);
    sum.limited &= found.limited;
}

/// What a process has used of the processor, s; where the system does not tell, the time
/// since it was first asked about.
fn processor_time(pid: u32) -> f64 {
    static FIRST: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    let text = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    let after = text.rsplit(')').next().unwrap_or_default();
    let ticks = |at: usize| after.split_whitespace().nth(at)?.parse::<f64>().ok();
    match (ticks(11), ticks(12)) {
        (Some(user), Some(system)) => (user + system) / 100.0,
        _ => FIRST.get_or_init(Instant::now).elapsed().as_secs_f64(),
    }
}

fn summary(kinds: &[Box<dyn Kind>], sum: &Sum, took: Duration) -> Result<()> {
    let row = |name: &str, [accepted, refused, faults]: [u64; 3]| {
        let tried = accepted + refused + faults;
        let [tried, accepted, refused, faults] =
            [tried, accepted, refused, faults].map(|n| n.to_string());
        [name.to_owned(), tried, accepted, refused, faults]
    };
    let mut rows = vec![["input", "tried", "accepted", "refused", "faults"].map(str::to_owned)];
    let each = kinds.iter().zip(&sum.counts);
    rows.extend(each.map(|(kind, counts)| row(kind.name(), *counts)));
    let all = (0..3).map(|i| sum.counts.iter().map(|counts| counts[i]).sum());
    let all: Vec<u64> = all.collect();
    rows.push(row("all", [all[0], all[1], all[2]]));
    tell(&rows)?;
    let limit = if sum.limited {
        format!("at most {} kB above the start, limit 100 MB", sum.peak)
    } else {
        "not limited here (no prlimit)".to_owned()
    };
    say(format!(
        "{:.0} s; memory of a worker: {limit}",
        took.as_secs_f64()
    ))
}

/// Tells the faults, those that read alike once.
fn list(folder: &Path) -> Result<()> {
    let mut alike: BTreeMap<String, (u64, String)> = BTreeMap::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let text = std::fs::read_to_string(entry.path().join("fault.txt")).unwrap_or_default();
        let first = text.lines().next().unwrap_or_default();
        let shape: String = first
            .chars()
            .filter(|c| c.is_alphabetic() || *c == ' ')
            .take(120)
            .collect();
        let place = format!("{first}\n    {}", entry.path().display());
        alike.entry(shape).or_insert((0, place)).0 += 1;
    }
    let mut alike: Vec<(u64, String)> = alike.into_values().collect();
    alike.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
    for (count, place) in alike.iter().take(TOLD) {
        say(format!("{count} × {place}"))?;
    }
    Ok(())
}
