//! `export linuxcnc`: a strategy as a component of LinuxCNC.

use std::fmt;
use std::path::Path;

use clap::Args;
use controller_export::linuxcnc;
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use super::controller;
use super::guard::Guard;
use crate::output::print;

/// Options of `export linuxcnc`.
#[derive(Args)]
pub struct Options {
    #[command(flatten)]
    controller: controller::Options,
}

/// What was written.
#[derive(Serialize)]
struct Exported<'a> {
    axis: &'a str,
    axis_fingerprint: &'a str,
    strategy: &'a str,
    period_s: f64,
    guard: Guard,
    #[serde(skip)]
    guard_words: String,
    files: [&'a str; 2],
    out: &'a Path,
}

impl fmt::Display for Exported<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [component, example] = self.files;
        write!(
            f,
            "{} of {} as a LinuxCNC component, for servo threads of {} s\n  {}\n\
             written to {}: {component} (`halcompile --install {component}`), {example}",
            self.strategy,
            self.axis,
            self.period_s,
            self.guard_words,
            self.out.display()
        )
    }
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let made = options.controller.controller()?;
    let controller = &made.controller;
    let texts = linuxcnc::export(controller).into_diagnostic()?;
    let (component, example) = (&texts.component, &texts.example);
    options.controller.write(&[component, example])?;
    print(
        "export-linuxcnc",
        &Exported {
            axis: &controller.axis,
            axis_fingerprint: &controller.fingerprint,
            strategy: &controller.strategy,
            period_s: controller.period,
            guard: made.guard(),
            guard_words: made.words(),
            files: [&component.name, &example.name],
            out: &options.controller.out,
        },
    )
}
