//! `simulate`: one motion, its error and its log.

use std::path::{Path, PathBuf};

use axis_log::write_csv;
use axis_sim::{ClosedLoop, Recorder};
use clap::{Args, ValueEnum};
use discrepancy::hidden::Noise;
use feed_dynamics::NutCoupling;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use pipeline::Figures;
use pipeline::strategies::Strategy;
use trajectories::{Motion, Program};

use super::validate;
use crate::context::{Common, Context, read_text};
use crate::output::say;

/// Options of `simulate`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    common: Common,
    /// Trajectory of the axis file, from 1
    #[arg(
        long,
        value_name = "N",
        conflicts_with = "program",
        required_unless_present = "program"
    )]
    trajectory: Option<usize>,
    /// Motion program (TOML; see docs/theory/trajectories.md)
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// Compensation; all but `none` need `train` and `identify` first
    #[arg(long, value_enum, default_value_t = Compensation::None)]
    compensation: Compensation,
    /// Noise of every sensor, in multiples of a good linear scale's (10 nm), a
    /// good motor encoder's and current sensor's; 0 for perfect ones. With
    /// noise the axis is simulated the slow, exact way, to stand for a machine
    #[arg(long, value_name = "FACTOR", default_value_t = 0.0)]
    noise: f64,
    /// Where to write the log (CSV, a row each control cycle)
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Compensation {
    None,
    Network,
    NetworkLugre,
    TransferFunction,
    TransferFunctionLugre,
    Lugre,
    NetworkLugrePrinted,
}

impl Compensation {
    fn strategy(self) -> Strategy {
        match self {
            Self::None => Strategy::None,
            Self::Network => Strategy::Network,
            Self::NetworkLugre => Strategy::NetworkLugre,
            Self::TransferFunction => Strategy::TransferFunction,
            Self::TransferFunctionLugre => Strategy::TransferFunctionLugre,
            Self::Lugre => Strategy::Lugre,
            Self::NetworkLugrePrinted => Strategy::NetworkLugrePrinted,
        }
    }
}

/// Runs the command: the axis file itself is simulated, not its machine.
pub fn command(options: &Options) -> Result<()> {
    let context = options.common.open()?;
    let motion = motion(options, &context)?;
    let closed_loop = if options.noise > 0.0 {
        let mut exact = context.axis.clone();
        exact.coupling = NutCoupling::MovingNode;
        exact.simulation.step = exact.simulation.step.min(2e-5);
        ClosedLoop::implicit(&exact)
    } else {
        ClosedLoop::new(&context.axis)
    }
    .into_diagnostic()?;
    let mut recorder = Recorder::default();
    let observe = |cycle: &axis_sim::Cycle| recorder.push(cycle);
    if !(options.noise.is_finite() && options.noise >= 0.0) {
        return Err(miette!(
            "--noise {}: give 0 or a factor above it",
            options.noise
        ));
    }
    let mut sensors = Noise::GOOD.scaled(options.noise).sensors(context.seed);
    let sense = |seen: &mut axis_sim::Measured| {
        if options.noise > 0.0 {
            sensors(seen);
        }
    };
    let outcome = if options.compensation == Compensation::None {
        closed_loop.run_sensed(&*motion, &mut compensator::NoCompensation, sense, observe)
    } else {
        let strategy = options.compensation.strategy();
        let mut law = validate::predictors(&context)?
            .compensator(strategy)
            .into_diagnostic()?;
        closed_loop.run_sensed(&*motion, &mut *law, sense, observe)
    };
    // What was computed before the run stopped is kept.
    if let Some(file) = &options.log {
        write_csv(file, &recorder.log().into_diagnostic()?)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write the log {}", file.display()))?;
    }
    outcome.completed().into_diagnostic()?;
    let errors: Vec<f64> = recorder.cycles().iter().map(|c| c.error()).collect();
    let figures = Figures::of_metres(&errors).into_diagnostic()?;
    say(format!(
        "{} s, {} cycles: tracking error max {:.3} µm, mean {:.4} µm (simulated)",
        motion.duration(),
        errors.len(),
        figures.max,
        figures.mean
    ))
}

fn motion(options: &Options, context: &Context) -> Result<Box<dyn Motion>> {
    if let Some(file) = &options.program {
        return Ok(Box::new(program(file)?));
    }
    let number = options.trajectory.unwrap_or(0);
    let count = context.axis.trajectories.len();
    let spec = number
        .checked_sub(1)
        .and_then(|index| context.axis.trajectories.get(index))
        .ok_or_else(|| {
            miette!("--trajectory {number}: the axis file has trajectories 1 to {count}")
        })?;
    Ok(Box::new(context.axis.plan(spec).into_diagnostic()?))
}

/// Reads a motion program.
pub(super) fn program(file: &Path) -> Result<Program> {
    toml::from_str(&read_text(file)?)
        .into_diagnostic()
        .wrap_err_with(|| format!("{} is not a motion program", file.display()))
}
