//! The guard of an exported compensator: its limits, as given, or the axis' own.

use axis_pipeline::PipelineError;
use axis_pipeline::corrections::{Greatest, greatest};
use axis_pipeline::strategies::{Predictors, StrategyKind};
use axis_sim::{Axis, SixDigits};
use clap::Args;
use compensator::GuardLimits;
use controller_export::ExportedController;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use crate::context::Context;
use crate::exit::wrong_use;
use crate::progress::bar;

/// A limit over the greatest correction that was simulated.
const MARGIN: f64 = 2.0;
/// Least limits of the offsets, in SI units, for strategies that leave one at 0.
const LEAST_OFFSET: f64 = 1e-6;
/// Least limit of the surprise, which is about 1 where the axis is as it was designed for.
const LEAST_SURPRISE: f64 = 10.0;
/// Options of limits that an axis need not have.
const EFFORT: &str = "--limit-effort";
const SURPRISE: &str = "--limit-surprise";

/// What the guard keeps to.
#[derive(Args)]
#[group(id = "guard-options")]
pub struct Options {
    /// Greatest offset of the position, m or rad [default: the axis' following_error_limit]
    #[arg(help_heading = "Guard", long = "limit-position", value_name = "SI", value_parser = positive, allow_negative_numbers = true)]
    position: Option<f64>,
    /// Greatest offset of the command, in the actuator's unit: A, N·m, N, V [default: the
    /// actuator's limit; twice the greatest on the axis file's trajectories, simulated, if
    /// it has none]
    #[arg(help_heading = "Guard", long = "limit-effort", value_name = "SI", value_parser = positive, allow_negative_numbers = true)]
    effort: Option<f64>,
    /// Greatest deviation of the measurement from what a feedback's observer expects, in standard
    /// deviations [default: twice the greatest on the axis file's trajectories, simulated, at
    /// least 10]
    #[arg(help_heading = "Guard", long = "limit-surprise", value_name = "FACTOR", value_parser = positive, allow_negative_numbers = true)]
    surprise: Option<f64>,
    /// Time for which a limit may be exceeded before the guard trips, s
    #[arg(help_heading = "Guard", long, value_name = "S", default_value_t = 0.002, value_parser = time, allow_negative_numbers = true)]
    patience: f64,
    /// Time in which corrections are faded in and out, s
    #[arg(help_heading = "Guard", long, value_name = "S", default_value_t = 0.1, value_parser = time, allow_negative_numbers = true)]
    fade: f64,
}

impl Options {
    /// The greatest corrections in simulation, where a limit is to be made of them.
    ///
    /// # Errors
    /// Wrong use, where the axis file has no trajectory and limits are missing.
    pub fn simulated(
        &self,
        context: &Context,
        predictors: &Predictors,
        kind: &StrategyKind,
    ) -> Result<Option<Greatest>> {
        let names = self.missing(&context.axis, kind);
        if names.is_empty() {
            return Ok(None);
        }
        let progress = bar("limits", context.axis.trajectories.len() as u64);
        let found = greatest(&context.machine, predictors, kind, || {
            progress.inc(1);
        });
        progress.finish_and_clear();
        match found {
            Err(PipelineError::NoTrajectories) => Err(wrong_use(format!(
                "the axis file has no [[trajectory]] on which the guard's limits could be found; \
                 give {}",
                names.join(" and ")
            ))),
            found => found.into_diagnostic().map(Some),
        }
    }

    /// Options of limits that are neither given nor the axis' own.
    fn missing(&self, axis: &Axis, kind: &StrategyKind) -> Vec<&'static str> {
        let mut names = Vec::new();
        if self.effort.is_none() && own_effort(axis).is_none() {
            names.push(EFFORT);
        }
        // Without an observer there is no surprise.
        if self.surprise.is_none() && kind.name == "feedback" {
            names.push(SURPRISE);
        }
        names
    }

    /// The limits for an axis: what it may be off by at most, and what its actuator takes. A move
    /// that the axis can make stays within them, however fast.
    pub fn of(&self, simulated: Option<Greatest>, axis: &Axis) -> GuardLimits {
        let simulated = simulated.unwrap_or_default();
        let cycles = |time: f64| (time / axis.period).round() as u32;
        let of = |given: Option<f64>, greatest: f64, least: f64| {
            given.unwrap_or((MARGIN * greatest).max(least))
        };
        GuardLimits {
            position: self.position.unwrap_or(axis.following_error_limit),
            effort: of(
                self.effort.or(own_effort(axis)),
                simulated.effort,
                LEAST_OFFSET,
            ),
            surprise: of(self.surprise, simulated.surprise, LEAST_SURPRISE),
            patience: cycles(self.patience),
            fade: cycles(self.fade),
        }
    }
}

/// What the actuator takes at most, where that is limited.
fn own_effort(axis: &Axis) -> Option<f64> {
    Some(axis.actuator.limit()).filter(|limit| limit.is_finite())
}

/// A compensator with its guard.
pub struct Guarded {
    /// The compensator.
    pub controller: ExportedController,
    /// Whether limits are made of simulated corrections.
    pub is_simulated: bool,
}

/// What commands tell of a guard, for programs.
#[derive(Serialize)]
pub struct Guard {
    position: f64,
    effort: f64,
    surprise: f64,
    patience_cycles: u32,
    fade_cycles: u32,
    /// Whether limits are made of simulated corrections.
    from_simulation: bool,
}

impl Guarded {
    /// The guard, for programs.
    pub fn guard(&self) -> Guard {
        let limits = &self.controller.limits;
        Guard {
            position: limits.position,
            effort: limits.effort,
            surprise: limits.surprise,
            patience_cycles: limits.patience,
            fade_cycles: limits.fade,
            from_simulation: self.is_simulated,
        }
    }

    /// Its limits in a line, for people.
    pub fn words(&self) -> String {
        let ExportedController { limits, units, .. } = &self.controller;
        let mut words = format!(
            "guard: at most {} µ{} and {} {}",
            SixDigits(1e6 * limits.position),
            units.load,
            SixDigits(limits.effort),
            units.effort
        );
        words += " (the axis' own limits unless an option sets them";
        if self.is_simulated {
            words +=
                "; without a limit of its own, twice the greatest of the simulated trajectories";
        }
        words.push(')');
        words
    }
}

/// A number above 0.
fn positive(text: &str) -> std::result::Result<f64, String> {
    let number = text.parse::<f64>().ok();
    let number = number.filter(|limit| limit.is_normal() && *limit > 0.0);
    number.ok_or_else(|| "give a number above 0".to_owned())
}

/// A time from 0 to 100 s.
fn time(text: &str) -> std::result::Result<f64, String> {
    let number = text.parse::<f64>().ok();
    let number = number.filter(|time| (0.0..=100.0).contains(time));
    number.ok_or_else(|| "give a time from 0 to 100 s".to_owned())
}
