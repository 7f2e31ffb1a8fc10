//! Campaigns without a scheduler: shards and their merging against one process, byte for byte.

use std::path::Path;
use std::process::Command;

use crate::common::{refuse, root, succeed, text};

fn read(path: impl AsRef<Path>) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

#[test]
fn samples_from_shards_are_those_of_one_process() {
    let folder = tempfile::tempdir().unwrap();
    let [one, many] = ["one", "many"].map(|name| {
        let path = folder.path().join(name);
        path.to_str().unwrap().to_owned()
    });
    fn options(file: &str) -> [&str; 7] {
        ["sample", "--count", "40000", "--seed", "9", "--file", file]
    }
    succeed(&options(&one));
    // Nothing else stays of a single process.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let shard = |i: &'static str| [&options(&many)[..], &["--threads", "1", "--shard", i]].concat();
    succeed(&shard("3/3"));
    succeed(&shard("1/3"));
    let merge = [&["merge"][..], &options(&many)].concat();
    let message = refuse(&merge);
    assert!(
        message.contains("1 of 3 shards") && message.contains("--shard 2/3"),
        "{message}"
    );
    succeed(&shard("2/3"));
    // A shard that is there is left alone, so that a campaign can be submitted again.
    let file = Path::new(&format!("{many}.campaign")).join("shards/sample-2-of-3.parquet");
    let made = std::fs::metadata(&file).unwrap().modified().unwrap();
    succeed(&shard("2/3"));
    assert_eq!(std::fs::metadata(&file).unwrap().modified().unwrap(), made);
    succeed(&merge);
    assert!(read(&one) == read(&many));
    let other = [
        &shard("2/3")[..],
        &["--axis", "data/axes/liu2025-machine.toml"],
    ]
    .concat();
    let message = refuse(&other);
    assert!(
        message.contains("axis is") && message.contains("remove it"),
        "{message}"
    );
}

#[test]
fn networks_from_shards_are_those_of_one_process() {
    let folder = tempfile::tempdir().unwrap();
    let [one, many] = ["one", "many"].map(|name| {
        let path = folder.path().join(name);
        path.to_str().unwrap().to_owned()
    });
    fn options(file: &str) -> [&str; 6] {
        ["study", "--quick", "--seeds", "2", "--file", file]
    }
    succeed(&options(&one));
    for shard in ["1/4", "2/4", "3/4", "4/4"] {
        succeed(&[&options(&many)[..], &["--shard", shard]].concat());
    }
    succeed(&[&["merge"][..], &options(&many)].concat());
    assert!(read(&one) == read(&many));
}

/// `hq` as its documentation says of `hq submit`: one task after another, each with its id.
const HQ: &str = r#"#!/bin/bash
set -eu
[ "$1" = --version ] && exit
[ "$1" = submit ] || exit 9
shift
array=0-0 log=/dev/null
while [ "$1" != -- ]; do
  case $1 in
    --array=*) array=${1#*=} ;;
    --stdout=*) log=${1#*=} ;;
    --wait | --name=* | --cpus=* | --time-limit=*min | --stderr=* | --priority=3) ;;
    *) echo "unknown: $1" >&2; exit 9 ;;
  esac
  shift
done
shift
for HQ_TASK_ID in $(seq "${array%-*}" "${array#*-}"); do
  export HQ_TASK_ID
  "$@" >"${log/\%\{TASK_ID\}/$HQ_TASK_ID}" 2>&1
done
"#;

#[test]
#[cfg(unix)]
fn a_campaign_of_hyperqueue_runs_its_shards_and_merges_them() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let hq = folder.path().join("hq");
    std::fs::write(&hq, HQ).unwrap();
    std::fs::set_permissions(&hq, PermissionsExt::from_mode(0o755)).unwrap();
    let path = format!(
        "{}:{}",
        folder.path().display(),
        std::env::var("PATH").unwrap()
    );
    // The shell must not take the name for three words.
    let file = folder.path().join("it's some samples");
    let name = file.to_str().unwrap();
    let campaign = |path: &str, scheduler: &str, options: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_feed-axis"))
            .args([
                "campaign",
                "sample",
                "--shards",
                "3",
                "--scheduler",
                scheduler,
                "--submit",
            ])
            .args(["--time", "5", "--scheduler-option=--priority=3", "--"])
            .args(["--count", "100", "--file", name])
            .args(options)
            .current_dir(root())
            .env("PATH", path)
            .output()
            .unwrap()
    };
    let without = campaign("", "slurm", &[]);
    assert!(!without.status.success());
    assert!(
        text(&without).contains("`sbatch` cannot be run here"),
        "{}",
        text(&without)
    );
    let refused = campaign(&path, "hyperqueue", &["--threads", "3"]);
    assert!(text(&refused).contains("--cpus"), "{}", text(&refused));
    let done = campaign(&path, "hyperqueue", &[]);
    assert!(done.status.success(), "{}", text(&done));
    let one = folder.path().join("one");
    succeed(&["sample", "--count", "100", "--file", one.to_str().unwrap()]);
    assert!(read(one) == read(&file));
    let logs = folder
        .path()
        .join("it's some samples.campaign/campaign/logs");
    let log = String::from_utf8(read(logs.join("shard-2.log"))).unwrap();
    assert!(log.contains("shard 2/3: 33 cases"), "{log}");
}
