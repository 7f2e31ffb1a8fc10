//! The command `feed-axis`.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use feed_axis::cli::{Global, finish, parse, start};
use feed_axis::commands::Command;
use feed_axis::commands::UserJob;
use feed_axis::commands::manual::{self, Completions, Pages};

/// Feed axes: simulate, identify, find what a model lacks, compensate.
///
/// Start with `feed-axis new my-axis --kind rack`, which writes an axis file, and `feed-axis
/// simulate --axis my-axis.toml --trajectory 1`. `feed-axis pipeline` takes an axis through
/// every stage of Liu et al. 2025 (Machines 13(5), 433) and writes a report; its stages can
/// also be run one by one, each with the results of those above it.
#[derive(Parser)]
#[command(name = "feed-axis", version)]
struct Cli {
    #[command(flatten)]
    global: Global,
    #[command(subcommand)]
    command: Own,
}

#[derive(Subcommand)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is one value of it, for as long as the process lives"
)]
enum Own {
    #[command(flatten)]
    User(Command<UserJob>),
    /// Write the completions of a shell to standard output
    Completions(Completions),
    /// Write the manual's pages
    Man(Pages),
}

fn main() -> ExitCode {
    let cli: Cli = parse("feed-axis");
    start(&cli.global);
    finish(match &cli.command {
        Own::User(command) => command.run(),
        Own::Completions(options) => manual::completions(options),
        Own::Man(options) => manual::pages(options),
    })
}
