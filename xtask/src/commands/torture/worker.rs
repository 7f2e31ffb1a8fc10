//! Judges inputs in a process of its own, so that one that ends the process, or takes
//! all memory, is seen and does not end the rest.

use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::process::Command;

use miette::{IntoDiagnostic, Result, WrapErr, miette};

use super::Options;
use super::kinds::{Input, Kind, Verdict, all, schedule};
use super::random::Source;

/// Where a worker says how far it is.
pub const PROGRESS: &str = "progress";
/// What a process may take beyond what it has before the first input, bytes. The tenfold
/// of the largest input is less than a hundredth of this, and left out.
pub const MEMORY: u64 = 100_000_000;

/// What a worker has judged: of each kind, accepted, refused, faults.
#[derive(Debug, Default, PartialEq)]
pub struct Progress {
    /// The input that is being judged.
    pub index: u64,
    /// Counts by kind.
    pub counts: Vec<[u64; 3]>,
    /// Greatest memory, kB beyond the start.
    pub peak: u64,
    /// Whether the memory could be limited.
    pub limited: bool,
}

/// Judges the inputs from `--from` on.
pub fn run(options: &Options) -> Result<()> {
    std::panic::set_hook(Box::new(|_| {}));
    let desk = options.out.join("desk");
    let kinds = all(&desk)?;
    let turns = schedule(&kinds);
    let start = status("VmSize:");
    let mut progress = Progress {
        counts: vec![[0; 3]; kinds.len()],
        limited: limit(start),
        ..Progress::default()
    };
    let path = options.out.join(PROGRESS);
    let mut file = File::create(&path).into_diagnostic()?;
    for index in options.from..options.from.saturating_add(options.inputs) {
        let kind = turns[(index % turns.len() as u64) as usize];
        progress.index = index;
        note(&mut file, &progress).wrap_err("cannot note the progress")?;
        let input = kinds[kind].input(&mut Source::new(options.seed, kinds[kind].name(), index));
        let verdict = one(kinds[kind].as_ref(), &input, &desk)?;
        let column = match &verdict {
            Verdict::Accepted => 0,
            Verdict::Refused => 1,
            Verdict::Fault(what) => {
                keep(options, index, kinds[kind].name(), &input, what)?;
                2
            }
        };
        progress.counts[kind][column] += 1;
        kinds[kind].restore(&input, &desk)?;
    }
    progress.index = options.from.saturating_add(options.inputs);
    progress.peak = status("VmPeak:").saturating_sub(start);
    note(&mut file, &progress)
}

fn one(kind: &dyn Kind, input: &Input, desk: &Path) -> Result<Verdict> {
    let path = desk.join(&input.file);
    // A file that is emptied and written again is flushed to the disk by some systems.
    feed_axis::output::remove(&path)?;
    std::fs::write(&path, &input.bytes)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))?;
    let judged = catch_unwind(AssertUnwindSafe(|| kind.judge(input, desk)));
    Ok(judged.unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Verdict::Fault(format!("panics: {}", text.unwrap_or("without words")))
    }))
}

/// A record of fixed place, so that a process that ends leaves the last one.
fn note(file: &mut File, progress: &Progress) -> Result<()> {
    let mut words = vec![progress.index, progress.peak, u64::from(progress.limited)];
    words.extend(progress.counts.iter().flatten());
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    file.seek(SeekFrom::Start(0)).into_diagnostic()?;
    file.write_all(&bytes).into_diagnostic()
}

/// The record that a worker left last.
pub fn noted(path: &Path) -> Option<Progress> {
    let bytes = std::fs::read(path).ok()?;
    let word = |c: &[u8]| c.try_into().map(u64::from_le_bytes).unwrap_or(0);
    let words: Vec<u64> = bytes.chunks_exact(8).map(word).collect();
    let [index, peak, limited, counts @ ..] = words.as_slice() else {
        return None;
    };
    Some(Progress {
        index: *index,
        counts: counts.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        peak: *peak,
        limited: *limited == 1,
    })
}

/// Keeps an input that showed a fault, with what is needed to make it again.
pub fn keep(options: &Options, index: u64, kind: &str, input: &Input, what: &str) -> Result<()> {
    let name = kind.replace([' ', ','], "-");
    let folder = options.out.join("faults").join(format!("{name}-{index}"));
    let file = input.file.rsplit('/').next().unwrap_or("input");
    std::fs::create_dir_all(&folder).into_diagnostic()?;
    std::fs::write(folder.join(file), &input.bytes).into_diagnostic()?;
    let text = format!(
        "{kind}: {what}\n\ncargo xtask torture --seed {} --from {index} --inputs 1 --kills 0\n",
        options.seed
    );
    std::fs::write(folder.join("fault.txt"), text).into_diagnostic()
}

/// Limits this process to its present size and [`MEMORY`]; `false` if the system has
/// no `prlimit`.
fn limit(now: u64) -> bool {
    if now == 0 {
        return false;
    }
    let most = 1024 * now + MEMORY;
    let pid = std::process::id().to_string();
    let mut command = Command::new("prlimit");
    let status = command
        .args(["--pid", &pid, &format!("--as={most}:{most}")])
        .status();
    status.is_ok_and(|status| status.success())
}

/// A line of the process's status, kB; 0 if the system has none.
fn status(line: &str) -> u64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let found = text.lines().find_map(|l| l.strip_prefix(line));
    let number = found.and_then(|rest| rest.split_whitespace().next());
    number.and_then(|number| number.parse().ok()).unwrap_or(0)
}

/// The input of a number, made again.
pub fn again(options: &Options, kinds: &[Box<dyn Kind>], index: u64) -> Result<(usize, Input)> {
    let turns = schedule(kinds);
    let turn = usize::try_from(index % turns.len().max(1) as u64).into_diagnostic()?;
    let kind = *turns
        .get(turn)
        .ok_or_else(|| miette!("there are no kinds of input"))?;
    let input = kinds[kind].input(&mut Source::new(options.seed, kinds[kind].name(), index));
    Ok((kind, input))
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Bad;

    impl Kind for Bad {
        fn name(&self) -> &'static str {
            "bad"
        }
        fn share(&self) -> usize {
            1
        }
        fn input(&self, _: &mut Source) -> Input {
            Input {
                file: "bad".to_owned(),
                bytes: vec![1, 2],
                damaged: false,
            }
        }
        fn judge(&self, input: &Input, desk: &Path) -> Verdict {
            assert_eq!(std::fs::read(desk.join(&input.file)).unwrap(), [1, 3]);
            Verdict::Accepted
        }
    }

    #[test]
    fn a_panic_is_a_fault_and_says_its_words() {
        let desk = tempfile::tempdir().unwrap();
        let input = Bad.input(&mut Source::new(1, "bad", 1));
        match one(&Bad, &input, desk.path()).unwrap() {
            Verdict::Fault(what) => assert!(what.contains("panics: assertion"), "{what}"),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_record_of_a_worker_is_read_as_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(PROGRESS);
        let written = Progress {
            index: 7,
            counts: vec![[1, 2, 3], [4, 5, u64::MAX]],
            peak: 9,
            limited: true,
        };
        note(&mut File::create(&path).unwrap(), &written).unwrap();
        assert_eq!(noted(&path), Some(written));
    }
}
