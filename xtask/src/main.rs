//! Commands of the project, `cargo xtask <command>`: one file each, which
//! parses, calls one library function and writes. Nothing here knows physics.

mod commands;
mod context;
mod diagnostic;
mod jobs;
mod output;
mod page;
mod paper;
mod program;
mod progress;
mod results;
mod store;
mod strategy_name;

use std::io::Write;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use commands::{
    bench, campaign, compensate, discover, export_drive, identify, identify_control, independent,
    layers, learn, log, merge, pipeline, report, residuals, simulate, torture, train, validate,
};
use context::Common;
use diagnostic::Compiler;
use jobs::JobCommand;

/// Dynamic error of ball-screw axes: simulate, predict, compensate.
///
/// Start with `cargo xtask pipeline`: it takes the axis of Liu et al. 2025
/// (Machines 13(5), 433) through every stage and writes a report to
/// runs/liu2025/report.html. The stages can also be run one by one; each needs
/// the results of those above it.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version)]
struct Cli {
    /// Say on stderr what a search or a training tries; results are the same
    #[arg(long, short, global = true)]
    verbose: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// All stages: sample, train, identify, validate, compensate, study, report
    Pipeline(Common),
    #[command(flatten)]
    Job(JobCommand),
    /// Train the cascade-forward network on the samples (Section 4.3)
    Train(Common),
    /// Identify friction on the machine, and the transfer function from the model
    Identify(Common),
    /// Structure, gains and delay of an unknown controller, from logs
    IdentifyControl(identify_control::Options),
    /// Model against machine, and both predictors against the machine (Tables 13, 14)
    Validate(Common),
    /// Run the machine under every compensation (Tables 15, 16), or moves under one
    Compensate(compensate::Options),
    /// Write summary.json and report.html from the stages' results
    Report(Common),
    /// Learn what no parameter holds by tables, a network and named effects, side by side
    Residuals(Common),
    /// Learn the correction of a move from the log of a repetition
    Learn(learn::Options),
    /// Simulate one motion and write its log
    Simulate(simulate::Options),
    /// Name what a model lacks, from logs of the real axis
    Discover(discover::Options),
    /// Look at a log: channels, sampling, noise, and what its mapping should be
    Log(log::Options),
    /// Write and submit the scripts that run a job's shards on a cluster (docs/campaigns.md)
    Campaign(campaign::Options),
    /// Write a job's results from its shards
    Merge(merge::Options),
    /// Search logs of a simulator that shares no code with this one, and score it
    Independent(independent::Options),
    /// Write cases of the second matrix as folders, for other programs to search (docs/peers.md)
    PeersCases(commands::peers_cases::Options),
    /// Write what of the correction a drive or CNC can be given (docs/drive-terms.md)
    ExportDrive(export_drive::Options),
    /// Measure the speed of every hot path (docs/performance.md)
    Bench(bench::Options),
    /// Try damaged inputs and disturbed runs, and judge what comes of them
    Torture(torture::Options),
    /// Check that every crate depends strictly downward
    Layers,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    // Fails only where a handler was set before.
    let _ = miette::set_hook(Box::new(|_| Box::new(Compiler::for_terminal())));
    let level = if cli.verbose {
        tracing::Level::DEBUG
    } else {
        tracing::Level::WARN
    };
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_max_level(level)
        .init();
    match run(cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Where standard error is closed, the exit code still tells.
            let _ = writeln!(std::io::stderr(), "{error:?}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: Command) -> miette::Result<()> {
    match command {
        Command::Pipeline(common) => pipeline::run(&common),
        Command::Job(job) => job.run(),
        Command::Train(common) => train::command(&common),
        Command::Identify(common) => identify::command(&common),
        Command::IdentifyControl(options) => identify_control::command(&options),
        Command::Validate(common) => validate::command(&common),
        Command::Compensate(options) => compensate::command(&options),
        Command::Report(common) => report::command(&common),
        Command::Simulate(options) => simulate::command(&options),
        Command::Discover(options) => discover::command(&options),
        Command::Log(options) => log::command(&options),
        Command::Campaign(options) => campaign::command(&options),
        Command::Merge(options) => merge::command(&options),
        Command::Independent(options) => independent::command(&options),
        Command::PeersCases(options) => commands::peers_cases::command(&options),
        Command::ExportDrive(options) => export_drive::command(&options),
        Command::Bench(options) => bench::command(&options),
        Command::Torture(options) => torture::command(&options),
        Command::Residuals(common) => residuals::command(&common),
        Command::Learn(options) => learn::command(&options),
        Command::Layers => layers::command(),
    }
}
