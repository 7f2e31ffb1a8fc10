//! Runs that are doubled, or find no room, no right to write, or nobody who listens.

use std::path::Path;
use std::process::{Command, Stdio};

use miette::{IntoDiagnostic, Result};

use super::{Bench, Tally, said};

/// Every way but killing, once or a few times each.
pub fn all(bench: &Bench) -> Result<Vec<Tally>> {
    Ok(vec![
        twice(bench)?,
        small_files(bench)?,
        full_disk(bench)?,
        read_only(bench)?,
        no_folder(bench)?,
        unheard(bench)?,
    ])
}

impl Tally {
    fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default()
        }
    }

    /// Counts a run that must either end well or say why not, and what follows it.
    fn judge(&mut self, bench: &Bench, ended_well: bool, words: &str, why: &[&str]) -> Result<()> {
        self.tried += 1;
        let name = self.name.clone();
        if !ended_well {
            self.struck += 1;
            if words.contains("panicked") || !why.iter().any(|why| words.contains(why)) {
                self.faults
                    .push(format!("{name}: it does not say why: {words}"));
            }
        }
        if let Err(what) = bench.mends()? {
            self.faults.push(format!("{name}: {what}"));
        }
        Ok(())
    }
}

/// Two runs started at once in one folder.
fn twice(bench: &Bench) -> Result<Tally> {
    let mut tally = Tally::named("started twice at once");
    for (stage, _) in bench.some(&bench.stages) {
        bench.without(stage)?;
        let start = || -> Result<_> {
            let mut command = bench.command(&bench.work, &[])?;
            command.stdout(Stdio::piped()).stderr(Stdio::piped());
            command.spawn().into_diagnostic()
        };
        let (one, two) = (start()?, start()?);
        let outputs = [one.wait_with_output(), two.wait_with_output()];
        let [one, two] = outputs.map(IntoDiagnostic::into_diagnostic);
        let (one, two) = (one?, two?);
        if !(one.status.success() || two.status.success()) {
            tally
                .faults
                .push(format!("neither run ends: {} {}", said(&one), said(&two)));
        }
        let late = if one.status.success() { &two } else { &one };
        let words = said(late);
        tally.judge(
            bench,
            late.status.success(),
            &words,
            &["another run is at work"],
        )?;
    }
    Ok(tally)
}

/// Files may not grow beyond a few kB: writing fails, as on a full disk.
fn small_files(bench: &Bench) -> Result<Tally> {
    let mut tally = Tally::named("files limited in size");
    // Blocks of 512 bytes, in a shell by POSIX; the signal would end the process.
    let script = "trap '' XFSZ; ulimit -f \"$1\" && shift && exec \"$@\"";
    for blocks in bench.some(&["0", "1", "2", "8", "40", "120", "400", "1000"]) {
        bench.clear()?;
        std::fs::create_dir_all(&bench.work).into_diagnostic()?;
        let mut command = Command::new("sh");
        command.args(["-c", script, "sh", blocks]);
        command.arg(std::env::current_exe().into_diagnostic()?);
        bench.arguments(&mut command, &bench.work);
        let Ok(output) = command.output() else {
            tally.skipped = Some("no shell".to_owned());
            return Ok(tally);
        };
        tally.judge(
            bench,
            output.status.success(),
            &said(&output),
            &["cannot write", "cannot flush"],
        )?;
    }
    Ok(tally)
}

/// A file system with less room than a run needs.
fn full_disk(bench: &Bench) -> Result<Tally> {
    let mut tally = Tally::named("disk full");
    for size in bench.some(&["24k", "96k", "210k", "260k", "400k", "1000k"]) {
        bench.clear()?;
        std::fs::create_dir_all(&bench.work).into_diagnostic()?;
        let Some(mount) = Mount::new(
            &bench.work,
            &["-t", "tmpfs", "-o", &format!("size={size}"), "none"],
        ) else {
            tally.skipped = Some("mounting is not permitted".to_owned());
            return Ok(tally);
        };
        let output = bench.run(&bench.work, &[])?;
        // With room again, the next run goes on from what is there.
        mount.change("remount,size=100m");
        tally.judge(
            bench,
            output.status.success(),
            &said(&output),
            &["cannot write"],
        )?;
        drop(mount);
    }
    Ok(tally)
}

/// A folder that cannot be written to.
fn read_only(bench: &Bench) -> Result<Tally> {
    let mut tally = Tally::named("folder read-only");
    bench.clear()?;
    std::fs::create_dir_all(&bench.work).into_diagnostic()?;
    let Some(mount) = Mount::new(&bench.work, &["-t", "tmpfs", "none"]) else {
        tally.skipped = Some("mounting is not permitted".to_owned());
        return Ok(tally);
    };
    mount.change("remount,ro");
    let output = bench.run(&bench.work, &[])?;
    mount.change("remount,rw");
    let words = said(&output);
    if output.status.success() {
        tally
            .faults
            .push("a run in a read-only folder ends well".to_owned());
    }
    tally.judge(bench, false, &words, &["cannot write to the folder"])?;
    drop(mount);
    Ok(tally)
}

/// A folder that cannot be made, below a file.
fn no_folder(bench: &Bench) -> Result<Tally> {
    let mut tally = Tally::named("folder below a file");
    bench.without("sample")?;
    let output = bench.run(&bench.axis.join("run"), &[])?;
    tally.judge(
        bench,
        output.status.success(),
        &said(&output),
        &["cannot write to the folder"],
    )?;
    Ok(tally)
}

/// Nobody reads standard output: the pipe is closed, or the disk behind it full.
fn unheard(bench: &Bench) -> Result<Tally> {
    let mut tally = Tally::named("standard output closed");
    for stage in bench.some(&["sample", "study"]) {
        bench.without(stage)?;
        let mut command = bench.command(&bench.work, &[])?;
        let mut child = command
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        drop(child.as_mut().ok().and_then(|child| child.stdout.take()));
        let output = child
            .and_then(std::process::Child::wait_with_output)
            .into_diagnostic()?;
        let words = said(&output);
        tally.judge(bench, output.status.success(), &words, &[""])?;
        // A reader that has left needs no words.
        if !words.is_empty() {
            let name = &tally.name;
            tally.faults.push(format!("{name}: it says {words}"));
        }
        let Ok(full) = std::fs::OpenOptions::new().write(true).open("/dev/full") else {
            continue;
        };
        bench.without(stage)?;
        let mut command = bench.command(&bench.work, &[])?;
        let output = command
            .stdout(full)
            .stderr(Stdio::piped())
            .output()
            .into_diagnostic()?;
        tally.judge(
            bench,
            output.status.success(),
            &said(&output),
            &["standard output"],
        )?;
    }
    Ok(tally)
}

/// A file system on a folder, until this is dropped.
struct Mount<'a>(&'a Path);

impl<'a> Mount<'a> {
    fn new(at: &'a Path, arguments: &[&str]) -> Option<Self> {
        let mut command = Command::new("mount");
        command.args(arguments).arg(at).stderr(Stdio::null());
        command
            .status()
            .is_ok_and(|status| status.success())
            .then_some(Self(at))
    }

    fn change(&self, options: &str) {
        let mut command = Command::new("mount");
        // Where it does not take, the run that follows shows it.
        let _ = command
            .args(["-o", options])
            .arg(self.0)
            .stderr(Stdio::null())
            .status();
    }
}

impl Drop for Mount<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}
