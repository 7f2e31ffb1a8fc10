//! `cargo xtask <command>`: the commands of users, from the crate `feed-axis`, and those of
//! developers, one file each. Nothing here knows physics.

mod commands;
mod jobs;
mod packages;
mod page;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use feed_axis::cli::{Global, finish, parse, start};
use feed_axis::commands::export::drive;

use commands::{
    bench, contour, crates, heat, independent, layers, names, peers_cases, publish, torture, tuning,
};
use jobs::Job;

/// Feed axes: the commands of feed-axis, and those for its developers.
///
/// Start with `cargo xtask pipeline`: it takes the axis of Liu et al. 2025
/// (Machines 13(5), 433) through every stage and writes a report to
/// runs/liu2025/report.html. The stages can also be run one by one; each needs
/// the results of those above it.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version)]
struct Cli {
    #[command(flatten)]
    global: Global,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[command(flatten)]
    User(Box<feed_axis::commands::Command<Job>>),
    /// The same as `export drive`
    ExportDrive(drive::Options),
    /// Search logs of a simulator that shares no code with this one, and score the answers
    Independent(independent::Options),
    /// Write cases of the second matrix as folders, for other programs to search (docs/peers.md)
    PeersCases(peers_cases::Options),
    /// Measure the speed of every hot path (docs/performance.md)
    Bench(bench::Options),
    /// Tune the example axes, and compare with the figures of an independent search
    Tuning(tuning::Options),
    /// Errors of an hour of heat against brute force, of fitted models, and of both corrections together
    HeatProof(heat::Options),
    /// Contour errors of machines beside what was set as a goal: a Markdown table; rows that are there are kept
    ContourTable(contour::Options),
    /// Try damaged inputs and disturbed runs, and check how they end
    Torture(torture::Options),
    /// Check that every crate depends strictly downward, and that no files of one take from one another in a circle
    Layers,
    /// Check that no two crates use one name for different public types
    Names,
    /// Check, or write, the table of crates (docs/crates.md) and the dependencies that READMEs name
    Crates(crates::Options),
    /// Check and package all crates in the order of publishing
    Publish(publish::Options),
}

fn main() -> ExitCode {
    let cli: Cli = parse("cargo xtask");
    start(&cli.global);
    finish(match &cli.command {
        Command::User(command) => command.run(),
        Command::ExportDrive(options) => drive::command(options),
        Command::Independent(options) => independent::command(options),
        Command::PeersCases(options) => peers_cases::command(options),
        Command::Bench(options) => bench::command(options),
        Command::Tuning(options) => tuning::command(options),
        Command::HeatProof(options) => heat::command(options),
        Command::ContourTable(options) => contour::command(options),
        Command::Torture(options) => torture::command(options),
        Command::Layers => layers::command(),
        Command::Names => names::command(),
        Command::Crates(options) => crates::command(options),
        Command::Publish(options) => publish::command(options),
    })
}
