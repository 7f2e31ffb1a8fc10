//! `compensate --strategy --after`: moves made again after minutes of them, on an axis that warms up.

use std::fmt;
use std::path::Path;

use axis_pipeline::heat::{ModelHeat, WarmMoves};
use axis_pipeline::measured::Errors;
use axis_pipeline::moves::{MoveRun, NamedMotion};
use axis_pipeline::strategies::{NONE, Predictors, SharedMotion, StrategyKind};
use axis_pipeline::{ErrorUnit, Figures};
use axis_sim::NoiseLevels;
use axis_sim::{Axis, Measured, SixDigits};
use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::Serialize;

use super::heat_time::time;
use crate::context::{Context, warn_of_control};
use crate::exit::wrong_use;
use crate::output::{print, write_whole};
use crate::progress::bar;

/// Options for an axis that warms up.
#[derive(Args)]
#[group(id = "warm-options")]
pub(super) struct Options {
    /// Make the moves cold, and again after repeating them for these times, such as 5min 20min 1h, each at least
    /// as long as the moves themselves. The machine warms up
    /// by the [thermal] of its file; the strategy predicts growth and friction by that of the axis file
    #[arg(long, value_name = "TIME", num_args = 1.., value_parser = time, requires = "strategy")]
    after: Vec<f64>,
    /// With --after: temperature of the air, and of the whole axis at the start, °C
    #[arg(
        long,
        value_name = "DEG_C",
        default_value_t = 20.0,
        allow_negative_numbers = true,
        requires = "after"
    )]
    air: f64,
}

/// What is run.
pub(super) struct Run<'a> {
    pub context: &'a Context,
    pub kind: &'static StrategyKind,
    pub predictors: &'a Predictors,
    pub motions: &'a [NamedMotion],
    pub noise: f64,
    pub json: Option<&'a Path>,
}

impl Options {
    pub(super) fn is_asked(&self) -> bool {
        !self.after.is_empty()
    }

    /// Seconds before each pass, the cold one first.
    fn times(&self) -> Result<Vec<f64>> {
        match self.after.windows(2).all(|pair| pair[0] < pair[1]) {
            true => Ok([&[0.0], &self.after[..]].concat()),
            false => Err(wrong_use(
                "--after: the times do not rise; give each once, the shortest first".to_owned(),
            )),
        }
    }
}

impl Run<'_> {
    /// Runs the moves without, with and with the predicted heat, and prints the errors.
    pub(super) fn command(&self, options: &Options, exact: bool) -> Result<()> {
        if exact {
            return Err(wrong_use(
                "--exact: not with --after; leave out one of them".to_owned(),
            ));
        }
        let times = options.times()?;
        let duty = self.duty()?;
        let machine = &self.context.machine;
        stated(machine)?;
        stated(&self.context.axis)?;
        let mut truth = ModelHeat::new(machine, &duty, options.air).into_diagnostic()?;
        let model = ModelHeat::new(&self.context.axis, &duty, options.air).into_diagnostic()?;
        let pass = duty.iter().map(|motion| motion.duration()).sum::<f64>();
        let warm = WarmMoves::new(machine, &mut truth, &times, pass);
        let warm = warm.into_diagnostic().wrap_err("--after")?;
        let progress = bar("compensate", (3 * times.len() * self.motions.len()) as u64);
        let made = |kind: &StrategyKind, model: Option<ModelHeat>| {
            let mut strategy = kind.strategy(self.predictors).into_diagnostic()?;
            let mut sensors = NoiseLevels::good(machine)
                .scaled(self.noise)
                .sensors(self.context.seed);
            let sense = |seen: &mut Measured| {
                if self.noise > 0.0 {
                    sensors(seen);
                }
            };
            let each = || progress.inc(1);
            let all = warm.run(&mut *strategy, self.motions, model, sense, each);
            Ok(all
                .into_diagnostic()?
                .iter()
                .map(|pass| worst(pass))
                .collect())
        };
        let cases: [Result<Vec<Figures>>; 3] = [
            made(&NONE, None),
            made(self.kind, None),
            made(self.kind, Some(model)),
        ];
        progress.finish_and_clear();
        let [none, cold, warm] = cases;
        let found = self.found(options, &times, [none?, cold?, warm?]);
        if let Some(path) = self.json {
            let bytes = crate::json::pretty(&found).into_diagnostic()?;
            write_whole(path, &bytes)?;
        }
        print("compensate", &found)
    }

    /// The moves as a duty: they end where they began.
    fn duty(&self) -> Result<Vec<SharedMotion>> {
        let all: Vec<SharedMotion> = self.motions.iter().map(|m| m.motion.clone()).collect();
        let ends = all.first().zip(all.last());
        let away = ends.map_or(0.0, |(first, last)| {
            (last.at(f64::INFINITY).position - first.at(0.0).position).abs()
        });
        match away < 1e-9 {
            true => Ok(all),
            false => Err(wrong_use(format!(
                "--after: the moves are repeated, and end {} {} from where they begin; give moves that end where they begin",
                SixDigits(away),
                self.context.axis.freedom().unit()
            ))),
        }
    }

    fn found<'a>(
        &'a self,
        options: &Options,
        times: &[f64],
        [none, cold, warm]: [Vec<Figures>; 3],
    ) -> Warmed<'a> {
        let unit = self.context.unit();
        let passes = times.iter().zip(none).zip(cold.into_iter().zip(warm));
        let pass = |((time, none), (cold, warm)): ((&f64, Figures), (Figures, Figures))| Pass {
            after_min: time / 60.0,
            errors: Errors::new(
                unit,
                Three {
                    none,
                    without_heat: cold,
                    with_heat: warm,
                },
            ),
        };
        Warmed {
            unit,
            label: self.kind.label,
            axis: &self.context.axis.name,
            machine: &self.context.machine.name,
            control_differences: self.context.other_control(),
            strategy: self.kind.name,
            air_c: options.air,
            noise: self.noise,
            seed: self.context.seed,
            passes: passes.map(pass).collect(),
        }
    }
}

/// Refuses an axis of whose heat nothing is known.
fn stated(axis: &Axis) -> Result<()> {
    match axis.thermal_keys_stated() {
        0 => Err(wrong_use(format!(
            "--after: the file of {} says nothing of its heat; valid: an axis file with a table [thermal], such as one of `heat --fit`",
            axis.name
        ))),
        _ => Ok(()),
    }
}

/// The greatest of the figures of a pass.
fn worst(pass: &[MoveRun]) -> Figures {
    let mut all = pass.iter().map(|run| run.figures);
    let first = all.next().unwrap_or_default();
    all.fold(first, |a, b| Figures {
        max: a.max.max(b.max),
        mean: a.mean.max(b.mean),
    })
}

/// Errors of the table on an axis that warms up.
#[derive(Serialize)]
struct Warmed<'a> {
    #[serde(skip)]
    unit: ErrorUnit,
    #[serde(skip)]
    label: &'static str,
    axis: &'a str,
    /// What stands for the machine. Simulated, never measured.
    machine: &'a str,
    /// Keys of the controller that the machine's file has otherwise.
    control_differences: Vec<String>,
    strategy: &'a str,
    air_c: f64,
    noise: f64,
    seed: u64,
    passes: Vec<Pass>,
}

#[derive(Serialize)]
struct Pass {
    after_min: f64,
    #[serde(flatten)]
    errors: Errors<Three>,
}

#[derive(Serialize)]
struct Three {
    none: Figures,
    without_heat: Figures,
    with_heat: Figures,
}

impl fmt::Display for Warmed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = self.unit;
        writeln!(
            f,
            "{} on {} (simulated), air of {} °C: error of the table, growth included, greatest of the moves, max in {unit}",
            self.label,
            self.machine,
            SixDigits(self.air_c)
        )?;
        warn_of_control(f, &self.control_differences)?;
        writeln!(
            f,
            "  {:>8} {:>10} {:>12} {:>10}",
            "min", "none", "without heat", "with heat"
        )?;
        for pass in &self.passes {
            let three = &*pass.errors;
            writeln!(
                f,
                "  {:>8.1} {:>10.3} {:>12.3} {:>10.3}",
                pass.after_min, three.none.max, three.without_heat.max, three.with_heat.max
            )?;
        }
        Ok(())
    }
}
