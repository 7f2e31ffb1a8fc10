//! `campaign`: scripts that run a job's shards under a scheduler, and merge them.

use std::path::{Path, PathBuf};
use std::process::Command;

use campaign::{Scheduler, Submission};
use clap::{Args, Parser, ValueEnum};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Serialize;

use crate::exit::wrong_use;
use crate::file_set::FileSet;
use crate::jobs::Jobs;
use crate::output::{Worded, print, ready, write_whole};
use crate::program;

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// The job: a command that has the option --shard, like sample, study or robustness
    job: String,
    /// Number of shards; several for each core, so that none waits long for the last
    #[arg(long, value_name = "N")]
    shards: usize,
    /// Who runs them
    #[arg(long)]
    scheduler: Which,
    /// Hand the scripts to the scheduler, rather than only write them
    #[arg(long)]
    submit: bool,
    /// Longest time of a shard, minutes, 3 at least [default: the scheduler's]; under Slurm a
    /// shard returns to the queue a minute before its end and later continues where it was
    #[arg(long, value_name = "MINUTES", value_parser = clap::value_parser!(u32).range(3..))]
    time: Option<u32>,
    /// Cores of a shard
    #[arg(long, value_name = "N", default_value_t = 1)]
    cpus: usize,
    /// A further option for the scheduler, like --scheduler-option=--partition=long (may be
    /// repeated)
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    scheduler_option: Vec<String>,
    /// Options of the job's command, after --
    #[arg(last = true)]
    options: Vec<String>,
}

/// A scheduler by its name.
#[derive(Clone, Copy, ValueEnum)]
enum Which {
    Slurm,
    Hyperqueue,
}

/// The job's command alone, to read its options.
#[derive(Parser)]
#[command(name = program::name(), bin_name = program::name())]
struct Alone<J: Jobs> {
    #[command(subcommand)]
    job: J,
}

/// Runs the command, for one of the program's jobs.
pub fn command<J: Jobs>(options: &Options) -> Result<()> {
    let job = read::<J>(options)?;
    let cases = job.cases();
    if !(1..=cases).contains(&options.shards) {
        return Err(wrong_use(format!(
            "{} has {cases} cases with these options: --shards takes 1 to {cases}, not {}",
            job.name(),
            options.shards
        )));
    }
    let folder = std::path::absolute(job.folder()).into_diagnostic()?;
    let folder = folder.join("campaign");
    ready(&folder.join("logs"))?;
    let submission = Submission {
        scheduler: match options.scheduler {
            Which::Slurm => Scheduler::Slurm,
            Which::Hyperqueue => Scheduler::HyperQueue,
        },
        job: job.name().to_owned(),
        shards: options.shards,
        program: copy_of_program(&folder)?,
        directory: std::env::current_dir().into_diagnostic()?,
        options: options.options.clone(),
        cpus: options.cpus.max(1),
        minutes: options.time,
        scheduler_options: options.scheduler_option.clone(),
        folder,
    };
    let scripts = submission.scripts();
    let names: Vec<&str> = scripts.iter().map(|(name, _)| name.as_ref()).collect();
    let mut set = FileSet::new(&submission.folder, &names)?;
    for (name, text) in &scripts {
        set.put(name, text.as_bytes())?;
    }
    set.publish()?;
    let files: Vec<PathBuf> = names.iter().map(|n| submission.folder.join(n)).collect();
    let script = submission.folder.join("submit.sh");
    let mut text: String = files.iter().map(|f| format!("{}\n", f.display())).collect();
    if !options.submit {
        text += &format!(
            "{cases} cases in {} shards; to submit them: bash {}",
            options.shards,
            script.display()
        );
    }
    let value = Written {
        cases,
        shards: options.shards,
        submit: &script,
        files,
    };
    print("campaign", &Worded { text, value })?;
    match options.submit {
        true => submit(&script, submission.needs()),
        false => Ok(()),
    }
}

/// The scripts.
#[derive(Serialize)]
struct Written<'a> {
    cases: usize,
    shards: usize,
    /// The script that submits the others.
    submit: &'a Path,
    files: Vec<PathBuf>,
}

/// The job, of its options.
fn read<J: Jobs>(options: &Options) -> Result<Box<dyn campaign::Job>> {
    let own = ["--threads", "--shard"];
    let is_own = |word: &&String| own.iter().any(|o| word.split('=').next() == Some(o));
    if let Some(word) = options.options.iter().find(is_own) {
        return Err(wrong_use(format!(
            "{word} is given by the scripts; --cpus sets the threads of a shard"
        )));
    }
    let words = [program::name(), &options.job].map(str::to_owned);
    let words = words.into_iter().chain(options.options.iter().cloned());
    let alone = Alone::<J>::try_parse_from(words).map_err(|e| wrong_use(plain(&e)))?;
    alone.job.options().job()
}

/// What the parser says, without its own "error".
fn plain(error: &clap::Error) -> String {
    let text = error.to_string();
    let text = text.trim();
    text.strip_prefix("error: ").unwrap_or(text).to_owned()
}

/// A copy of this program beside the scripts, so that shards which start later run the same
/// one, whatever is built meanwhile.
fn copy_of_program(folder: &Path) -> Result<PathBuf> {
    let program = std::env::current_exe().into_diagnostic()?;
    let copy = folder.join(program.file_name().unwrap_or_default());
    if program != copy {
        let bytes = std::fs::read(&program).into_diagnostic()?;
        write_whole(&copy, &bytes)?;
        let rights = std::fs::metadata(&program).into_diagnostic()?.permissions();
        std::fs::set_permissions(&copy, rights)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot make {} executable", copy.display()))?;
    }
    Ok(copy)
}

/// Runs the script that submits.
fn submit(script: &Path, needs: &str) -> Result<()> {
    let there = Command::new(needs).arg("--version").output();
    if let Err(e) = there {
        return Err(miette!(
            "`{needs}` cannot be run here ({e}): submit on a machine that has the scheduler, with bash {}",
            script.display()
        ));
    }
    let status = Command::new("bash")
        .arg(script)
        .status()
        .into_diagnostic()?;
    if status.success() {
        return Ok(());
    }
    Err(miette!(
        "{} failed ({status}); what {needs} said stands above",
        script.display()
    ))
}
