//! Options of `discover-matrix`.

use std::path::PathBuf;

use clap::Args;
use feed_axis::jobs::Sharding;
use miette::{Result, miette};

/// Axis files of machines that are taken where none are given.
pub(super) const MACHINES: [&str; 3] = [
    "data/axes/liu2025.toml",
    "data/axes/joint.toml",
    "data/axes/linear-motor.toml",
];
/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Axis file: the machine in which effects are hidden (version 1)
    #[arg(long, value_name = "FILE", default_value = "data/axes/liu2025.toml")]
    pub(super) axis: PathBuf,
    /// 1: one machine that follows the model's laws; 2: several that differ from the model as real
    /// machines do
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=2))]
    pub(super) version: u32,
    /// Axis files of version 2, taken in turn
    #[arg(long, value_name = "FILE", num_args = 1.., default_values = MACHINES)]
    pub(super) machines: Vec<PathBuf>,
    /// Cases of version 2, rounded up to whole plots [default: 1080]
    #[arg(long, value_name = "N", conflicts_with = "quick")]
    pub(super) size: Option<usize>,
    /// Folder for one file a case, matrix.json and matrix.md [default: runs/, the name of
    /// the axis, /discover-matrix/seed-N]; cases found there are not run again, if this
    /// program ran them on this axis file
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Seed of the cases, noise and known parameters; 1 to 7 were used in development
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Some twenty cases, of every kind
    #[arg(long)]
    pub(super) quick: bool,
    /// Only the first N cases; every kind comes up early
    #[arg(long, value_name = "N")]
    pub(super) first: Option<usize>,
    /// Only these cases, by their names (may be repeated)
    #[arg(long, value_name = "CASE", conflicts_with = "first")]
    pub(super) only: Vec<String>,
    /// Also write the page of the full matrix here; a page of another seed is not overwritten
    #[arg(long, value_name = "FILE", conflicts_with_all = ["quick", "first", "only"])]
    pub(super) page: Option<PathBuf>,
    /// Run nothing; show the kept results of these cases, whichever program made them (version 2)
    #[arg(long)]
    pub(super) tell: bool,
    /// Threads, 0 for all cores; results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) threads: usize,
    #[command(flatten)]
    pub(super) sharding: Sharding,
}

impl Options {
    /// Leaves the cases that are asked for.
    pub(super) fn chosen<C>(&self, cases: &mut Vec<C>, id: fn(&C) -> &String) -> Result<()> {
        cases.truncate(self.first.unwrap_or(cases.len()));
        let is_there = |name: &&String| cases.iter().any(|c| id(c) == *name);
        if let Some(name) = self.only.iter().find(|name| !is_there(name)) {
            return Err(miette!(
                "there is no case \"{name}\"; cases are named like {}",
                cases.first().map_or("", |c| id(c))
            ));
        }
        cases.retain(|c| self.only.is_empty() || self.only.contains(id(c)));
        Ok(())
    }
}
