//! `simulate`: one motion, its error and its log.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use atomic_write_file::AtomicWriteFile;
use axis_pipeline::Figures;
use axis_pipeline::measured::Errors;
use axis_pipeline::strategies::{Build, NextMove, SharedMotion, StrategyKind};
use axis_sim::{
    Axis, ClosedLoop, Cycle, FlowRecorder, Measured, Recorder, RunStopped, SixDigits,
    excitation_channel,
};
use axis_sim::{MACHINE_STEP, NoiseLevels};
use clap::Args;
use compensator::Compensator;
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::Serialize;

use super::motions::{excited_program, listed, trajectory};
use super::{learn, validate};
use crate::context::{Common, Context};
use crate::exit::wrong_use;
use crate::log_out::{self, LogOut};
use crate::out_file;
use crate::output::{note, print, write_whole};
use crate::page::motion::{self as motion_page, Ran, Shown};
use crate::progress::bar;
use crate::strategy_name::strategy_name;

/// Options of `simulate`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Trajectory of the axis file, from 1
    #[arg(long, value_name = "N", conflicts_with = "program")]
    trajectory: Option<usize>,
    /// Motion program (TOML; see docs/theory/trajectories.md)
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// Compensation; a network needs `train` first, transfer functions and identified
    /// friction `identify`
    #[arg(long, value_parser = strategy_name(), default_value = "none")]
    compensation: &'static StrategyKind,
    /// Correction of this move as `learn` has written it, for a compensation that plans
    #[arg(long, value_name = "FILE")]
    correction: Option<PathBuf>,
    #[arg(long, help = NOISE, value_name = "FACTOR", default_value_t = 0.0, value_parser = factor, allow_negative_numbers = true)]
    noise: f64,
    #[arg(long, help = EXACT)]
    exact: bool,
    /// Where to write the log, one row for each control cycle: .csv, .parquet or .mat (version 5); - for CSV on
    /// standard output, results then on standard error
    #[arg(long, value_name = "FILE", value_parser = log_out::log())]
    log: Option<PathBuf>,
    /// Where to write a page of the motion: position and error, speed, current or torque
    /// over time, a table of figures
    #[arg(long, value_name = "OUT.html", value_parser = out_file::page())]
    report: Option<PathBuf>,
}

/// What `--noise` is, of every command that has it.
pub(super) const NOISE: &str = "Noise of every sensor, added to that of the axis file, in multiples of a good sensor's: scale 10 nm (0.1 µrad if the load turns), motor encoder 2 µrad and 0.01 rad/s, current sensor 1/3000 of the greatest command; 0 for none";

/// What `--exact` is, of every command that has it.
pub(super) const EXACT: &str = "Simulate by the mechanism's slow, exact method (another method than the model's, or shorter steps): for logs that stand for those of a real machine";

/// Runs the command: the axis file itself is simulated, not its machine.
pub fn command(options: &Options) -> Result<()> {
    let context = options.common.open()?;
    let (motion, excitation) = motion(options, &context)?;
    let mut closed_loop = closed_loop(&context.axis, options.exact)?;
    let is_excited = excitation.is_some();
    if let Some(samples) = excitation {
        closed_loop = closed_loop.with_excitation(samples);
    }
    let mut law = compensator(options, &context, &motion)?;
    let log = options.log.as_deref();
    let mut rows = log
        .map(|path| begun(path, &context.axis, is_excited))
        .transpose()?;
    if let Some(path) = &options.report {
        check_writable(path)?;
    }
    let mut shown = options.report.as_ref().map(|_| Shown::of(&context.axis));
    let bar = bar("simulate", closed_loop.cycles(&*motion));
    let mut tracking = Tracking::default();
    let observe = |cycle: &Cycle| {
        tracking.push(cycle.error());
        tracking.limited += u64::from(cycle.command.saturated);
        if let Some(rows) = &mut rows {
            rows.push(cycle);
        }
        if let Some(shown) = &mut shown {
            shown.push(cycle);
        }
        if tracking.cycles % 4096 == 0 {
            bar.set_position(tracking.cycles);
        }
    };
    let mut sensors = NoiseLevels::good(&context.axis)
        .scaled(options.noise)
        .sensors(context.seed);
    let sense = |seen: &mut Measured| {
        if options.noise > 0.0 {
            sensors(seen);
        }
    };
    let outcome = closed_loop.run_sensed(&*motion, &mut *law, sense, observe);
    bar.finish_and_clear();
    let stopped = outcome.completed().err();
    if let (0, Some(stopped)) = (tracking.cycles, stopped) {
        return Err(stopped).into_diagnostic();
    }
    // What was computed before the run stopped is kept, and says that it did.
    if let Some((path, rows)) = log.zip(rows) {
        let placed = match &stopped {
            Some(why) => rows.finish_stopped(why),
            None => rows.finish(),
        };
        log_out::written(path, placed)?;
    }
    if let (Some(path), Some(shown)) = (&options.report, &shown) {
        write_page(path, options, &context, shown, stopped.as_ref())?;
    }
    print_found(options, &context, &motion, &tracking, stopped.as_ref())?;
    // No motion that an axis can follow is at a limit for most of its time.
    if 2 * tracking.limited > tracking.cycles {
        note(format!(
            "note: a limit of the controller or the drive was active in {} of {} cycles: the loop may be unstable, or a limit too low for this motion; `feed-axis analyse` shows the loop's margins",
            tracking.limited, tracking.cycles
        ));
    }
    match stopped {
        Some(stopped) => Err(stopped).into_diagnostic(),
        None => Ok(()),
    }
}

/// The strategy that was asked for, with the motion ahead and what was learned of it.
fn compensator(
    options: &Options,
    context: &Context,
    motion: &SharedMotion,
) -> Result<Box<dyn Compensator + Send>> {
    let strategy = options.compensation;
    let predictors = validate::predictors(context, strategy.needs)?;
    if options.correction.is_some() && matches!(strategy.build, Build::Each(_)) {
        return Err(wrong_use(format!(
            "--correction: {} does not know a motion ahead; give a --compensation that plans, such as plan",
            strategy.label
        )));
    }
    let learned = match &options.correction {
        Some(file) => Some(Arc::new(learn::correction(file, &context.axis, &**motion)?)),
        None => None,
    };
    let mut law = strategy.strategy(&predictors).into_diagnostic()?;
    let next = NextMove {
        motion: motion.clone(),
        continued: None,
        learned,
    };
    law.compensator(&next).into_diagnostic()
}

/// What the run showed, as the command's result.
fn print_found(
    options: &Options,
    context: &Context,
    motion: &SharedMotion,
    tracking: &Tracking,
    stopped: Option<&RunStopped>,
) -> Result<()> {
    let axis = &context.axis;
    let figures = Figures {
        max: 1e6 * tracking.most,
        mean: 1e6 * tracking.sum / tracking.cycles as f64,
    };
    print(
        "simulate",
        &Simulated {
            axis: &axis.name,
            axis_fingerprint: &axis.fingerprint,
            compensation: options.compensation.name,
            duration_s: motion.duration(),
            cycles: tracking.cycles,
            tracking_error: Errors::new(context.unit(), figures),
            stopped: stopped.map(ToString::to_string),
            log: options.log.as_deref(),
            report: options.report.as_deref(),
        },
    )
}

/// Asks whether the page can be written, before the work that makes it.
fn check_writable(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path.parent().unwrap_or(path))
        .and_then(|()| AtomicWriteFile::open(path))
        .map(drop)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write the page {}", path.display()))
}

fn write_page(
    path: &Path,
    options: &Options,
    context: &Context,
    shown: &Shown,
    stopped: Option<&RunStopped>,
) -> Result<()> {
    let next = match options.compensation.name {
        _ if stopped.is_some() => "Correct what stopped it, and run it again.",
        "none" => {
            "Run it again with --compensation, such as plan or drive-terms, and compare the peaks."
        }
        _ => "Run it again with --compensation none to see what the compensation takes away.",
    };
    let mut next = vec![next.to_owned()];
    let file = options.log.as_ref().filter(|log| !log_out::is_piped(log));
    next.extend(file.map(|log| {
        format!(
            "The log is {}; log inspect shows what it holds.",
            log.display()
        )
    }));
    let page = motion_page::page(&Ran {
        axis: &context.axis,
        compensation: options.compensation.label,
        noise: options.noise,
        seed: context.seed,
        shown,
        stopped,
        next,
    });
    let html = axis_report::render(&page)
        .into_diagnostic()
        .wrap_err("the page of the motion cannot be made")?;
    write_whole(path, html.as_bytes())
}

/// One simulated motion.
#[derive(Serialize)]
struct Simulated<'a> {
    axis: &'a str,
    axis_fingerprint: &'a str,
    compensation: &'a str,
    /// Of the motion; a run that stopped has fewer cycles.
    duration_s: f64,
    cycles: u64,
    /// Why the run stopped before the motion's end, where it did: the errors are those until then.
    stopped: Option<String>,
    #[serde(flatten)]
    tracking_error: Errors<Figures>,
    log: Option<&'a Path>,
    report: Option<&'a Path>,
}

impl fmt::Display for Simulated<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (errors, unit) = (&*self.tracking_error, self.tracking_error.unit());
        if self.stopped.is_some() {
            write!(f, "stopped before its end, figures until then: ")?;
        }
        write!(
            f,
            "{} s, {} cycles: tracking error max {} {unit}, mean {} {unit} (simulated)",
            SixDigits(self.duration_s),
            self.cycles,
            SixDigits(errors.max),
            SixDigits(errors.mean)
        )
    }
}

/// Reads a factor of noise.
pub(super) fn factor(text: &str) -> std::result::Result<f64, String> {
    let number = text.parse::<f64>().ok();
    let number = number.filter(|factor| factor.is_finite() && *factor >= 0.0);
    number.ok_or_else(|| "give 0 or a factor above it".to_owned())
}

/// The axis' loop as its file says, or exact.
pub(super) fn closed_loop(axis: &Axis, exact: bool) -> Result<ClosedLoop> {
    match exact {
        true => ClosedLoop::exact(axis, MACHINE_STEP),
        false => ClosedLoop::new(axis),
    }
    .into_diagnostic()
}

/// The tracking error so far, m.
#[derive(Default)]
struct Tracking {
    cycles: u64,
    /// Cycles in which a limit was active.
    limited: u64,
    most: f64,
    sum: f64,
}

impl Tracking {
    fn push(&mut self, error: f64) {
        self.cycles += 1;
        self.most = self.most.max(error.abs());
        self.sum += error.abs();
    }
}

/// A log that is written while the run goes on.
fn begun(path: &Path, axis: &Axis, is_excited: bool) -> Result<FlowRecorder<LogOut>> {
    let out = LogOut::begin(path)?;
    let mut recorder = Recorder::as_logged(axis, axis.period).into_diagnostic()?;
    if is_excited {
        recorder = recorder.with(excitation_channel(axis));
    }
    Ok(FlowRecorder::to(out, recorder))
}

/// The motion, and what its program adds to the command.
fn motion(options: &Options, context: &Context) -> Result<(SharedMotion, Option<Vec<f64>>)> {
    if let Some(file) = &options.program {
        let (program, excitation) = excited_program(file, &context.axis)?;
        return Ok((Arc::new(program), excitation));
    }
    match options.trajectory {
        Some(number) => Ok((trajectory("--trajectory", number, context)?, None)),
        None => Err(wrong_use(format!(
            "the motion is missing; valid: --program FILE, or --trajectory N; the axis file has {}",
            listed(&context.axis)
        ))),
    }
}

#[cfg(test)]
mod tests {
    use clap::{Command, CommandFactory, FromArgMatches, Parser};

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        options: Options,
    }

    fn parse(value: &str) -> std::result::Result<&'static StrategyKind, String> {
        let command: Command = Line::command();
        let line = ["simulate", "--trajectory", "1", "--compensation", value];
        let matches = command
            .try_get_matches_from(line)
            .map_err(|e| e.to_string())?;
        let line = Line::from_arg_matches(&matches).map_err(|e| e.to_string())?;
        Ok(line.options.compensation)
    }

    /// The names that scripts give and results carry.
    #[test]
    fn compensations_have_the_names_of_results_with_dashes() {
        for (value, name) in [
            ("none", "none"),
            ("network", "network"),
            ("network-lugre", "network_lugre"),
            ("transfer-function", "transfer_function"),
            ("transfer-function-lugre", "transfer_function_lugre"),
            ("lugre", "lugre"),
            ("network-lugre-printed", "network_lugre_printed"),
            ("drive-terms", "drive_terms"),
            ("plan", "plan"),
        ] {
            assert_eq!(parse(value).unwrap().name, name);
        }
        let message = parse("lurge").unwrap_err();
        assert!(
            message.contains("none, network, network-lugre") && message.contains("'lugre'"),
            "{message}"
        );
    }
}
