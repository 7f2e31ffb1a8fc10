//! `learn`: the next correction of a move, from the log of a repetition.

use std::path::{Path, PathBuf};

use axis_log::read_log;
use axis_pipeline::ErrorUnit;
use axis_pipeline::learning::StoredCorrection;
use axis_pipeline::measured::Errors;
use axis_sim::{Axis, SixDigits, needed_position};
use clap::Args;
use compensator::{Advice, LearnedMove, Round};
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::Serialize;
use trajectories::Motion;

use crate::context::{DEFAULT_AXIS, read_axis, read_text};
use crate::out_file;
use crate::output::{Worded, note, print, write_whole};

/// Options of `learn`.
#[derive(Args)]
pub struct Options {
    /// Axis file
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    axis: PathBuf,
    /// Log of the move as it was made with the correction: time, reference and position
    /// of the load, as `[log]` of the axis file names them
    #[arg(long, value_name = "FILE")]
    log: PathBuf,
    /// The correction: read if the file exists, then written for the next repetition
    #[arg(long, value_name = "FILE", value_parser = out_file::file())]
    correction: PathBuf,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let axis = read_axis(&options.axis)?;
    let position = needed_position(&axis).into_iter();
    let required: Vec<&str> = [axis.reference_channel()]
        .into_iter()
        .chain(position)
        .collect();
    let log = read_log(&options.log, &axis.log, &required).into_diagnostic()?;
    if needed_position(&axis).is_none() {
        note(format!(
            "{} has no sensor at the load: what is learned is the error at the motor, which takes back what a plan does against the wind-up between motor and load",
            axis.name
        ));
    }
    let of_log = || format!("in {}", options.log.display());
    let mut correction = match options.correction.exists() {
        true => read(&options.correction)?,
        false => StoredCorrection::of(&axis, &log)
            .into_diagnostic()
            .wrap_err_with(of_log)?,
    };
    let round = correction
        .learn(&axis, &log)
        .into_diagnostic()
        .wrap_err_with(of_log)?;
    let bytes = serde_json::to_vec(&correction).into_diagnostic()?;
    write_whole(&options.correction, &bytes)?;
    tell(&axis, &round, &options.correction)
}

fn tell(axis: &Axis, round: &Round, file: &Path) -> Result<()> {
    let unit = ErrorUnit::of(axis);
    let micro = |value: f64| SixDigits((1e10 * value).round() / 1e4);
    let error = format!(
        "round {}: tracking error up to {} {unit}; of which {} {unit} (RMS) can be learned; noise there is {} {unit}",
        round.rounds,
        micro(round.peak),
        micro(round.learnable),
        micro(round.floor),
    );
    let words = match round.advice {
        Advice::Again => format!(
            "{} holds the next correction: make the move again",
            file.display()
        ),
        Advice::Done => "the residual is noise: keep the correction, and stop".to_owned(),
        Advice::Enough => "more rounds would learn noise: keep the correction, and stop".to_owned(),
        Advice::Restarted => format!(
            "the move has become worse than without the correction: something has changed. {} is empty again: make the move with it",
            file.display()
        ),
    };
    let value = Learned {
        rounds: round.rounds,
        errors: Errors::new(
            unit,
            Left {
                max: 1e6 * round.peak,
                learnable_rms: 1e6 * round.learnable,
                noise_rms: 1e6 * round.floor,
            },
        ),
        advice: match round.advice {
            Advice::Again => "again",
            Advice::Done => "done",
            Advice::Enough => "enough",
            Advice::Restarted => "restarted",
        },
        correction: file,
    };
    let text = format!("{error}\n{words}");
    print("learn", &Worded { text, value })
}

/// One round.
#[derive(Serialize)]
struct Learned<'a> {
    rounds: u32,
    #[serde(flatten)]
    errors: Errors<Left>,
    /// What to do next: again, done, enough or restarted.
    advice: &'static str,
    correction: &'a Path,
}

/// The tracking error, and what of it can be learned.
#[derive(Serialize)]
struct Left {
    max: f64,
    learnable_rms: f64,
    noise_rms: f64,
}

fn read(file: &Path) -> Result<StoredCorrection> {
    serde_json::from_str(&read_text(file)?)
        .into_diagnostic()
        .wrap_err_with(|| {
            format!(
                "{} is not a correction that `learn` has written",
                file.display()
            )
        })
}

/// The correction of a file, on the cycles of a motion.
pub fn correction(file: &Path, axis: &Axis, motion: &dyn Motion) -> Result<LearnedMove> {
    let correction = read(file)?.on(axis, motion);
    correction
        .into_diagnostic()
        .wrap_err_with(|| format!("in {}", file.display()))
}
