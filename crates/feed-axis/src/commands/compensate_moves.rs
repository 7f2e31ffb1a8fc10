//! `compensate --strategy`: moves one after the other under one strategy.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use axis_log::fixed;
use axis_pipeline::measured::Errors;
use axis_pipeline::moves::{MoveRun, Moves, NamedMotion};
use axis_pipeline::strategies::{LearnedValues, NONE, Predictors, StrategyKind};
use axis_pipeline::{ErrorUnit, Figures};
use axis_sim::Measured;
use axis_sim::NoiseLevels;
use clap::Args;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use super::compensate_warm;
use super::motions::{program_on, trajectory};
use super::simulate::{EXACT, NOISE, closed_loop, factor};
use super::validate;
use crate::context::{Context, warn_of_control};
use crate::out_file;
use crate::output::{print, write_whole};
use crate::progress::bar;
use crate::strategy_name::strategy_name;

/// Options for moves under one strategy.
// A group by itself: clap names groups after their type, and the command's own options
// have that name.
#[derive(Args)]
#[group(id = "moves-options")]
pub struct Options {
    /// Make the moves of --moves with this strategy, which keeps what it learns from move to move.
    /// Without it, every trajectory runs with every strategy. The axis file is the strategy's
    /// model; the file of --machine is what moves
    #[arg(long, value_name = "NAME", value_parser = strategy_name(), requires = "moves")]
    pub strategy: Option<&'static StrategyKind>,
    /// Moves in their order: a trajectory's number in the axis file, or the file of a
    /// motion program. A move that begins where the last one ended starts from the state in which
    /// that one left the axis; before any other move the axis settles to standstill
    #[arg(long, value_name = "MOVE", num_args = 1.., requires = "strategy")]
    moves: Vec<String>,
    #[arg(
        long,
        help = NOISE,
        value_name = "FACTOR",
        default_value_t = 0.0,
        value_parser = factor,
        allow_negative_numbers = true,
        requires = "strategy"
    )]
    noise: f64,
    #[arg(long, help = EXACT, requires = "strategy")]
    exact: bool,
    #[command(flatten)]
    warm: compensate_warm::Options,
    /// Where to write the moves' errors, and what was learned, as JSON
    #[arg(long, value_name = "FILE", requires = "strategy", value_parser = out_file::file())]
    json: Option<PathBuf>,
}

/// What `--json` writes.
#[derive(Serialize)]
struct Report<'a> {
    axis: &'a str,
    axis_fingerprint: &'a str,
    /// What stands for the machine. Simulated, never measured.
    machine: &'a str,
    machine_fingerprint: &'a str,
    /// Keys of the controller that the machine's file has otherwise.
    control_differences: Vec<String>,
    strategy: &'a str,
    noise: f64,
    seed: u64,
    version: &'a str,
    /// Those that came to their end with and without the strategy.
    moves: Vec<Entry<'a>>,
    /// Where the moves ended before the last that was asked for.
    stopped: Vec<Stopped<'a>>,
}

/// A move that did not come to its end, nor were those after it made.
#[derive(Serialize)]
struct Stopped<'a> {
    strategy: &'a str,
    #[serde(rename = "move")]
    name: &'a str,
    why: String,
}

#[derive(Serialize)]
struct Entry<'a> {
    #[serde(rename = "move")]
    name: &'a str,
    #[serde(flatten)]
    errors: Errors<Pair>,
    learned: &'a LearnedValues,
}

#[derive(Serialize)]
struct Pair {
    none: Figures,
    compensated: Figures,
}

impl Pair {
    fn of(none: Figures, compensated: Figures) -> Self {
        Self { none, compensated }
    }
}

/// Makes the moves.
pub fn run(context: &Context, options: &Options, kind: &'static StrategyKind) -> Result<()> {
    let motions: Vec<NamedMotion> = options
        .moves
        .iter()
        .map(|name| motion(name, context))
        .collect::<Result<_>>()?;
    let predictors = validate::predictors(context, kind.needs)?;
    // Refused before anything is computed.
    kind.strategy(&predictors).into_diagnostic()?;
    if options.warm.is_asked() {
        let run = compensate_warm::Run {
            context,
            kind,
            predictors: &predictors,
            motions: &motions,
            noise: options.noise,
            json: options.json.as_deref(),
        };
        return run.command(&options.warm, options.exact);
    }
    let closed_loop = closed_loop(&context.machine, options.exact)?;
    let progress = bar("compensate", 2 * motions.len() as u64);
    let made = |kind| -> Made {
        let sensors = NoiseLevels::good(&context.machine).scaled(options.noise);
        let mut sensors = sensors.sensors(context.seed);
        let sense = |seen: &mut Measured| {
            if options.noise > 0.0 {
                sensors(seen);
            }
        };
        series(
            kind,
            &predictors,
            Moves::new(&closed_loop, sense),
            &motions,
            || {
                progress.inc(1);
            },
        )
    };
    let (none, compensated) = rayon::join(|| made(&NONE), || made(kind));
    progress.finish_and_clear();
    let unit = context.unit();
    let entries = none.runs.iter().zip(&compensated.runs).zip(&motions);
    let entries = entries.map(|((none, with), motion)| Entry {
        name: &motion.name,
        errors: Errors::new(unit, Pair::of(none.figures, with.figures)),
        learned: &with.learned,
    });
    let report = Report {
        axis: &context.axis.name,
        axis_fingerprint: &context.axis.fingerprint,
        machine: &context.machine.name,
        machine_fingerprint: &context.machine.fingerprint,
        control_differences: context.other_control(),
        strategy: kind.name,
        noise: options.noise,
        seed: context.seed,
        version: env!("CARGO_PKG_VERSION"),
        moves: entries.collect(),
        stopped: [(NONE.name, &none), (kind.name, &compensated)]
            .into_iter()
            .filter_map(|(strategy, made)| made.stopped(strategy, &motions))
            .collect(),
    };
    // What was computed before a move stopped is kept.
    if let Some(path) = &options.json {
        let bytes = crate::json::pretty(&report).into_diagnostic()?;
        write_whole(path, &bytes)?;
    }
    let made = Moved {
        unit,
        label: kind.label,
        report,
    };
    print("compensate", &made)?;
    match none.stopped.or(compensated.stopped) {
        Some(error) => Err(error).into_diagnostic(),
        None => Ok(()),
    }
}

/// The moves up to the first that did not come to its end.
struct Made {
    runs: Vec<MoveRun>,
    stopped: Option<axis_pipeline::PipelineError>,
}

impl Made {
    /// Which move stopped, and why.
    fn stopped<'a>(&self, strategy: &'a str, motions: &'a [NamedMotion]) -> Option<Stopped<'a>> {
        let (error, motion) = (self.stopped.as_ref()?, motions.get(self.runs.len())?);
        Some(Stopped {
            strategy,
            name: &motion.name,
            why: error.to_string(),
        })
    }
}

fn series<S: FnMut(&mut Measured)>(
    kind: &StrategyKind,
    predictors: &Predictors,
    mut moves: Moves<'_, S>,
    motions: &[NamedMotion],
    each: impl Fn(),
) -> Made {
    let mut runs = Vec::new();
    let mut attempt = || {
        let mut strategy = kind.strategy(predictors)?;
        for motion in motions {
            // A move's errors, one a cycle, are in its figures.
            runs.push(MoveRun {
                errors: Vec::new(),
                ..moves.make(&mut *strategy, motion)?
            });
            each();
        }
        Ok(())
    };
    let stopped = attempt().err();
    Made { runs, stopped }
}

/// The moves, with the words of their table.
#[derive(Serialize)]
struct Moved<'a> {
    #[serde(skip)]
    unit: ErrorUnit,
    #[serde(skip)]
    label: &'static str,
    #[serde(flatten)]
    report: Report<'a>,
}

impl fmt::Display for Moved<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (report, unit) = (&self.report, self.unit);
        writeln!(
            f,
            "{} on {} (simulated): tracking error, max / mean in {unit}",
            self.label, report.machine
        )?;
        warn_of_control(f, &report.control_differences)?;
        writeln!(
            f,
            "        none                 compensated            taken away"
        )?;
        for entry in &report.moves {
            let (a, b) = (&entry.errors.none, &entry.errors.compensated);
            writeln!(
                f,
                "  {:>9.3} / {:<9.4} {:>9.4} / {:<9.5} {:>6} / {} %   {}",
                a.max,
                a.mean,
                b.max,
                b.mean,
                fixed(100.0 * (1.0 - b.max / a.max), 2),
                fixed(100.0 * (1.0 - b.mean / a.mean), 2),
                entry.name
            )?;
        }
        for stopped in &report.stopped {
            writeln!(
                f,
                "  stopped at {} under {}, and made no more moves: {}",
                stopped.name, stopped.strategy, stopped.why
            )?;
        }
        if let Some(last) = report.moves.last().filter(|last| !last.learned.is_empty()) {
            writeln!(f, "  learned:")?;
            for (name, value) in last.learned {
                writeln!(f, "    {name:<32} {}", axis_sim::SixDigits(*value))?;
            }
        }
        Ok(())
    }
}

/// A trajectory's number, or a program's file.
fn motion(name: &str, context: &Context) -> Result<NamedMotion> {
    let motion = match name.parse::<usize>() {
        Ok(number) => trajectory("--moves", number, context)?,
        Err(_) => Arc::new(program_on(Path::new(name), &context.axis)?),
    };
    Ok(NamedMotion {
        name: name.to_owned(),
        motion,
        learned: None,
    })
}
