//! Scripts that run a job's shards under a scheduler, and merge them.

use std::fmt::Write as _;
use std::path::PathBuf;

/// A scheduler that runs shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheduler {
    /// Slurm: a job array, and a job that begins when all of it has succeeded.
    /// <https://slurm.schedmd.com/job_array.html>
    Slurm,
    /// HyperQueue: a task array, waited for, and a task that merges.
    /// <https://it4innovations.github.io/hyperqueue/stable/jobs/arrays/>
    HyperQueue,
}

/// What is to be run.
#[derive(Clone, Debug)]
pub struct Submission {
    /// Who runs it.
    pub scheduler: Scheduler,
    /// Name of the job, which is the command that makes its shards.
    pub job: String,
    /// Number of shards.
    pub shards: usize,
    /// The program, where all nodes see it.
    pub program: PathBuf,
    /// Folder in which the program is started.
    pub directory: PathBuf,
    /// Folder of the scripts and their output; `logs` in it must exist.
    pub folder: PathBuf,
    /// Options of the job's command.
    pub options: Vec<String>,
    /// Cores of a shard.
    pub cpus: usize,
    /// Longest time of a shard, minutes; the scheduler's own limit if there is none.
    pub minutes: Option<u32>,
    /// Further options for the scheduler, like `--partition=long`.
    pub scheduler_options: Vec<String>,
}

/// How often a shard that was killed by a signal is begun again by its own script.
const TRIES: usize = 3;

impl Submission {
    /// Names and contents of the scripts: `shard.sh`, `merge.sh` and `submit.sh`, which
    /// hands both to the scheduler.
    pub fn scripts(&self) -> [(&'static str, String); 3] {
        [
            ("shard.sh", self.shard()),
            ("merge.sh", self.merge()),
            ("submit.sh", self.submit()),
        ]
    }

    /// The program that must be there to submit.
    pub fn needs(&self) -> &'static str {
        match self.scheduler {
            Scheduler::Slurm => "sbatch",
            Scheduler::HyperQueue => "hq",
        }
    }

    fn shard(&self) -> String {
        let mut script = self.head();
        let (id, stop) = match self.scheduler {
            Scheduler::Slurm => {
                self.slurm_lines(&mut script);
                ("SLURM_ARRAY_TASK_ID", SLURM_TIME_IS_UP)
            }
            Scheduler::HyperQueue => ("HQ_TASK_ID", ""),
        };
        let _ = write!(
            script,
            "set -u\ncd {directory} || exit\n\n{stop}\
             # Killed by a signal (kill, out of memory): begun again, and it goes on where it was.\n\
             for try in $(seq {TRIES}); do\n  \
               {command} \\\n    --threads {cpus} --shard \"${id}/{shards}\" &\n  \
               shard=$!\n  wait \"$shard\"\n  status=$?\n  \
               [ \"$status\" -le 128 ] && exit \"$status\"\n  \
               echo \"try $try of {TRIES} was killed by signal $((status - 128))\" >&2\n\
             done\nexit \"$status\"\n",
            directory = quoted(&self.directory.to_string_lossy()),
            command = self.command(&[&self.job]),
            cpus = self.cpus,
            shards = self.shards,
        );
        script
    }

    fn slurm_lines(&self, script: &mut String) {
        let logs = self.folder.join("logs").join("shard-%a.log");
        // Slurm takes quotation marks in these lines.
        let _ = write!(
            script,
            "#SBATCH --job-name={}\n#SBATCH --array=1-{}\n#SBATCH --cpus-per-task={}\n\
             #SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --signal=B:USR1@60\n\
             #SBATCH --output=\"{}\"\n",
            self.job,
            self.shards,
            self.cpus,
            logs.display()
        );
        if let Some(minutes) = self.minutes {
            let _ = writeln!(script, "#SBATCH --time={minutes}");
        }
        for option in &self.scheduler_options {
            let _ = writeln!(script, "#SBATCH {option}");
        }
    }

    fn merge(&self) -> String {
        let shards = self.shards.to_string();
        format!(
            "{}set -eu\ncd {}\nexec {}\n",
            self.head(),
            quoted(&self.directory.to_string_lossy()),
            self.command(&["merge", "--shards", &shards, &self.job]),
        )
    }

    fn submit(&self) -> String {
        let file = |name: &str| quoted(&self.folder.join(name).to_string_lossy());
        let [shard, merge] = ["shard.sh", "merge.sh"].map(file);
        let options: Vec<String> = self.scheduler_options.iter().map(|o| quoted(o)).collect();
        let options = options.join(" ");
        let mut script = self.head() + "set -eu\n";
        let _ = match self.scheduler {
            Scheduler::Slurm => write!(
                script,
                "array=$(sbatch --parsable {shard})\narray=${{array%%;*}}\n\
                 merge=$(sbatch --parsable --dependency=\"afterok:$array\" --kill-on-invalid-dep=yes \
                 --job-name={job}-merge --output={log} {options} {merge})\n\
                 echo \"array $array, merge ${{merge%%;*}}\"\n",
                job = self.job,
                log = file("logs/merge.log"),
            ),
            Scheduler::HyperQueue => {
                let limit = self
                    .minutes
                    .map_or(String::new(), |m| format!("--time-limit={m}min "));
                let log = self.folder.join("logs").join("shard-%{TASK_ID}.log");
                let log = quoted(&log.to_string_lossy());
                write!(
                    script,
                    "# A task array succeeds as a whole or not: merged only where it did.\n\
                     hq submit --wait --name={job} --array=1-{shards} --cpus={cpus} {limit}\
                     --stdout={log} --stderr={log} {options} -- bash {shard}\n\
                     hq submit --wait --name={job}-merge --stdout={merged} --stderr={merged} -- bash {merge}\n",
                    job = self.job,
                    shards = self.shards,
                    cpus = self.cpus,
                    merged = file("logs/merge.log"),
                )
            }
        };
        script
    }

    fn head(&self) -> String {
        "#!/bin/bash\n".to_owned()
    }

    /// The program with these arguments and the job's options.
    fn command(&self, arguments: &[&str]) -> String {
        let program = self.program.to_string_lossy();
        let options = self.options.iter().map(String::as_str);
        let all = [&*program].into_iter();
        let all = all.chain(arguments.iter().copied()).chain(options);
        let all: Vec<String> = all.map(quoted).collect();
        all.join(" ")
    }
}

/// A minute before the time limit: stopped, and back to the queue. What was made is kept. The
/// task is named by array and index: the job's own number is that of the whole array in its last
/// task, and would put all of it back, what is finished too
/// (<https://slurm.schedmd.com/job_array.html>, job ID and environment variables).
const SLURM_TIME_IS_UP: &str = "\
# A minute before the time limit: back to the queue, to go on where it was.\n\
again() {\n  \
  kill \"$shard\"\n  wait \"$shard\"\n  \
  [ \"${SLURM_RESTART_COUNT:-0}\" -lt 10 ] && \
  scontrol requeue \"${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}\"\n  \
  exit 1\n}\n\
trap again USR1\n\n";

/// A word as the shell takes it literally.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,@%+".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shell gives every word back as it was.
    #[test]
    fn words_pass_the_shell_unchanged() {
        for word in [
            "",
            "plain",
            "two words",
            "it's",
            "$HOME `x` \\ \"q\"",
            "*",
            "a\nb",
        ] {
            let shell = std::process::Command::new("sh")
                .args(["-c", &format!("printf %s {}", quoted(word))])
                .output()
                .unwrap();
            assert_eq!(String::from_utf8(shell.stdout).unwrap(), word);
        }
    }

    /// The last task of an array has the array's own number for its job: it alone goes back.
    #[test]
    fn a_task_whose_time_is_up_puts_itself_back_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let write = |name: &str, text: &str| {
            use std::os::unix::fs::PermissionsExt;
            std::fs::write(at(name), text).unwrap();
            let all = std::fs::Permissions::from_mode(0o755);
            std::fs::set_permissions(at(name), all).unwrap();
        };
        write("scontrol", "#!/bin/sh\necho \"$@\" >> \"$TOLD\"\n");
        // Tells the script that starts it that its time is up.
        write(
            "program",
            "#!/bin/sh\nsleep 0.3\nkill -USR1 $PPID\nexec sleep 60\n",
        );
        let submission = Submission {
            scheduler: Scheduler::Slurm,
            job: "robustness".to_owned(),
            shards: 3,
            program: at("program"),
            directory: folder.path().to_owned(),
            folder: folder.path().to_owned(),
            options: Vec::new(),
            cpus: 1,
            minutes: Some(60),
            scheduler_options: Vec::new(),
        };
        let [(name, script), ..] = submission.scripts();
        write(name, &script);
        let path = std::env::var("PATH").unwrap();
        let ended = std::process::Command::new("bash")
            .arg(at(name))
            .env("PATH", format!("{}:{path}", folder.path().display()))
            .env("TOLD", at("told"))
            .env("SLURM_JOB_ID", "4711")
            .env("SLURM_ARRAY_JOB_ID", "4711")
            .env("SLURM_ARRAY_TASK_ID", "3")
            .output()
            .unwrap();
        assert_eq!(ended.status.code(), Some(1), "{ended:?}");
        let told = std::fs::read_to_string(at("told")).unwrap();
        assert_eq!(told, "requeue 4711_3\n");
    }
}
