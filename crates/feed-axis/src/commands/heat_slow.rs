//! `heat --fit`, `heat --predict`: slow logs, and the thermal model that they are fitted or predicted by.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use axis_log::{Log, read_log};
use axis_pipeline::heat::SlowLogOptions;
use axis_pipeline::strategies::SharedMotion;
use axis_sim::{Axis, SixDigits};
use axis_thermal::{GrowthOf, GrowthZero};
use clap::{Args, ValueEnum};
use miette::{IntoDiagnostic, Result, WrapErr};
use trajectories::Program;

use super::heat_time::time;
use crate::exit::wrong_use;
use crate::out_file::{self, Force};

/// Group of the options that name logs: --fit and --predict.
const LOGS: &str = "slow-logs";

/// Options for slow logs.
// A group by itself: clap names groups after their type, and the command's own options have that name.
#[derive(Args)]
#[group(id = "slow-log-options")]
pub(super) struct Options {
    /// Fit the thermal model to logs of hours, each begun cold, and write an axis file with what was
    /// fitted in its [thermal]
    #[arg(long, value_name = "LOG", num_args = 1.., group = LOGS, requires = "out", conflicts_with_all = ["predict", "report"])]
    pub(super) fit: Vec<PathBuf>,
    /// Predict growth along a log of hours from its reference, compared with the readings in it
    #[arg(long, value_name = "LOG", group = LOGS, conflicts_with = "report")]
    pub(super) predict: Option<PathBuf>,
    /// Motion programs that the logs' channel duty_1 counts from 1, each repeated [default: the duty of
    /// --trajectory or --program alone]
    #[arg(long, value_name = "FILE", num_args = 1.., requires = LOGS)]
    pub(super) duties: Vec<PathBuf>,
    /// Where to write: with --fit the axis file, with --predict the log with growth (.csv, .parquet or .mat)
    #[arg(long, value_name = "FILE", value_parser = out_file::file(), requires = LOGS)]
    pub(super) out: Option<PathBuf>,
    #[command(flatten)]
    pub(super) force: Force,
    /// Last part of each log that is not fitted but predicted, %
    #[arg(
        long,
        value_name = "PERCENT",
        default_value_t = 25.0,
        requires = "fit",
        allow_negative_numbers = true
    )]
    pub(super) held_out: f64,
    /// What a probe reads the screw's growth against
    #[arg(long, value_enum, default_value_t = ProbeAgainst::Bearing, requires = LOGS)]
    probe_against: ProbeAgainst,
    /// What readings of a probe count from
    #[arg(long, value_enum, default_value_t = ProbeZero::Begin, requires = LOGS)]
    probe_zero: ProbeZero,
    /// Correct the prediction with one reading of the log every so often, such as 10min; the others check it
    #[arg(long, value_name = "TIME", value_parser = time, requires = "predict")]
    pub(super) probe_each: Option<f64>,
    /// When the axis was homed, after the log's begin: growth counts from then [default: at the begin]
    #[arg(long, value_name = "TIME", value_parser = time, requires = "predict")]
    pub(super) homed: Option<f64>,
}

/// What a probe reads growth against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum ProbeAgainst {
    /// The bed at the front bearing
    Bearing,
    /// A gauge that is clamped to the bed at the same position
    Bed,
}

/// What readings of a probe count from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum ProbeZero {
    /// The beginning of the log
    Begin,
    /// The first reading at each position
    First,
}

impl ProbeAgainst {
    /// What a reading shows.
    pub(super) fn of(self) -> GrowthOf {
        match self {
            Self::Bearing => GrowthOf::Screw,
            Self::Bed => GrowthOf::ScrewLessBed,
        }
    }
}

impl ProbeZero {
    /// What a reading counts from.
    pub(super) fn of(self) -> GrowthZero {
        match self {
            Self::Begin => GrowthZero::Begin,
            Self::First => GrowthZero::FirstAtPlace,
        }
    }
}

impl Options {
    /// Whether a log was given.
    pub(super) fn is_asked(&self) -> bool {
        !self.fit.is_empty() || self.predict.is_some()
    }

    /// The duties of the logs: those named, or `own` if there is one.
    pub(super) fn programs(&self, axis: &Axis, own: Option<Program>) -> Result<Vec<SharedMotion>> {
        let shared = |program| Arc::new(program) as SharedMotion;
        match self.duties.is_empty() {
            true => Ok(own.into_iter().map(shared).collect()),
            false => super::heat_program::shared_programs(axis, &self.duties),
        }
    }

    /// How logs are read.
    pub(super) fn reading<'a>(&self, duties: &'a [SharedMotion], air: f64) -> SlowLogOptions<'a> {
        SlowLogOptions {
            duties,
            air,
            probe: self.probe_against.of(),
            zero: self.probe_zero.of(),
            ..SlowLogOptions::default()
        }
    }

    /// Share of the logs that is held out.
    pub(super) fn held_out(&self) -> Result<f64> {
        match (0.0..=90.0).contains(&self.held_out) {
            true => Ok(0.01 * self.held_out),
            false => Err(wrong_use(format!(
                "--held-out is {} %; valid: from 0 to 90",
                SixDigits(self.held_out)
            ))),
        }
    }
}

/// A log as its file has it, with the columns that the axis file's [log] renames.
pub(super) fn slow_log(axis: &Axis, file: &Path) -> Result<Log> {
    read_log(file, &axis.log, &[]).into_diagnostic()
}

/// Names the log in an error.
pub(super) fn of_log<T>(file: &Path, result: Result<T>) -> Result<T> {
    result.wrap_err_with(|| file.display().to_string())
}
