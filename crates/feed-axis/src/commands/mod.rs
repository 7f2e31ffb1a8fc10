//! One file a command.

pub(crate) mod analyse;
pub(crate) mod campaign;
pub(crate) mod check;
pub mod check_words;
pub(crate) mod compensate;
mod compensate_moves;
mod compensate_warm;
pub(crate) mod contour;
pub(crate) mod contour_circle;
pub mod contour_drives;
pub mod contour_found;
pub mod contour_laps;
mod contour_paths;
pub mod contour_places;
pub mod contour_results;
pub mod contour_route;
pub mod control_table;
pub mod discover;
mod discover_files;
mod discover_heat;
mod discover_slow;
mod discover_words;
mod excitation;
pub mod export;
pub(crate) mod frf;
pub mod heat;
mod heat_course;
pub mod heat_fit;
pub mod heat_predict;
mod heat_program;
mod heat_slow;
mod heat_time;
pub(crate) mod heat_words;
pub mod identify;
pub(crate) mod identify_control;
pub(crate) mod learn;
pub(crate) mod log;
pub mod manual;
pub(crate) mod merge;
pub mod motions;
mod moved_file;
pub(crate) mod new;
pub(crate) mod pipeline;
pub(crate) mod report;
pub(crate) mod residuals;
pub(crate) mod robustness;
pub(crate) mod sample;
pub mod schema;
pub mod simulate;
pub(crate) mod study;
pub mod train;
pub mod tune;
mod user_job;
pub(crate) mod validate;

use clap::Subcommand;
use miette::Result;
pub use user_job::UserJob;

use crate::context::Common;
use crate::jobs::Jobs;

/// The commands of users, with the jobs of a program.
#[derive(Subcommand)]
pub enum Command<J: Jobs> {
    /// Write a commented axis file to begin with
    New(new::Options),
    /// All stages: sample, train, identify, validate, compensate, study, report
    Pipeline(Common),
    /// A job of independent cases.
    #[command(flatten)]
    Job(J),
    /// Train the cascade-forward network on the samples (Section 4.3)
    Train(Common),
    /// Identify friction from logs of the axis or of a simulated machine, and the transfer
    /// function of the tracking error from the model
    Identify(identify::Options),
    /// Estimate structure, gains and delay of an unknown controller from logs
    IdentifyControl(identify_control::Options),
    /// Compare the model and both predictors of the error with the machine (Tables 13, 14)
    Validate(Common),
    /// Run the machine with every compensation (Tables 15, 16), or a sequence of moves with one
    Compensate(compensate::Options),
    /// Write summary.json and report.html from the stages' results, or compare two runs
    Report(report::Options),
    /// Compare tables, a network and named effects as models of forces that no parameter describes
    Residuals(Common),
    /// Learn the correction of a move from the log of a repetition
    Learn(learn::Options),
    /// Margins, bandwidths and compliance of the drive's loops, over stroke, mass, friction and delay
    Analyse(analyse::Options),
    /// Gains of the drive's loops within limits of the sensitivity; writes an axis file
    Tune(tune::Options),
    /// Frequency responses from logs of an excited axis: coherence, modes, margins, against the model
    Frf(frf::Options),
    /// Simulate one motion, write its log and a page of figures
    Simulate(simulate::Options),
    /// Simulate a machine of two or three axes on a circle or another path: contour error, figures like those of
    /// ISO 230-4, laps
    Contour(Box<contour::Options>),
    /// Hours of a duty: temperatures, growth by position and time, thermal force
    Heat(heat::Options),
    /// Check the axis against the data sheets of its parts, under a duty: value, limit, margin
    Check(check::Options),
    /// Name what a model lacks, from logs of the real axis
    Discover(discover::Options),
    /// Inspect a log (channels, sampling, noise, a proposed mapping) or convert it
    Log(log::Options),
    /// Write and submit the scripts that run a job's shards on a cluster (docs/campaigns.md)
    Campaign(campaign::Options),
    /// Write a job's results from its shards
    Merge(merge::Options<J>),
    /// Export a compensation or a model for controllers, drives and other simulators
    #[command(subcommand)]
    Export(export::Export),
    /// Write the JSON Schema of a file, for completion and checking in editors
    Schema(schema::Options),
}

impl<J: Jobs> Command<J> {
    /// Runs the command.
    pub fn run(&self) -> Result<()> {
        match self {
            Self::New(options) => new::command(options),
            Self::Pipeline(common) => pipeline::run(common),
            Self::Job(job) => job.run(),
            Self::Train(common) => train::command(common),
            Self::Identify(options) => identify::command(options),
            Self::IdentifyControl(options) => identify_control::command(options),
            Self::Validate(common) => validate::command(common),
            Self::Compensate(options) => compensate::command(options),
            Self::Report(options) => report::command(options),
            Self::Residuals(common) => residuals::command(common),
            Self::Learn(options) => learn::command(options),
            Self::Analyse(options) => analyse::command(options),
            Self::Tune(options) => tune::command(options),
            Self::Frf(options) => frf::command(options),
            Self::Simulate(options) => simulate::command(options),
            Self::Contour(options) => contour::command(options),
            Self::Heat(options) => heat::command(options),
            Self::Check(options) => check::command(options),
            Self::Discover(options) => discover::command(options),
            Self::Log(options) => log::command(options),
            Self::Campaign(options) => campaign::command::<J>(options),
            Self::Merge(options) => merge::command(options),
            Self::Export(options) => export::command(options),
            Self::Schema(options) => schema::command(options),
        }
    }
}
