//! `heat --fit`: the thermal model of logs of hours, as an axis file.

use std::fmt::{self, Write};
use std::path::{Path, PathBuf};

use axis_pipeline::heat::{HeatFit, HeldOut, SlowLog, fit};
use axis_pipeline::strategies::SharedMotion;
use axis_sim::{Axis, SixDigits};
use miette::{IntoDiagnostic, Result};
use serde::Serialize;

use super::heat_slow::{Options, of_log, slow_log};
use super::moved_file::moved;
use crate::context::read_text;
use crate::out_file::spare;
use crate::output::{print, ready, write_whole};
use crate::program;
use crate::set_key::{SetKey, with_keys};

/// What the command is about.
pub(super) struct Given<'a> {
    pub axis: &'a Axis,
    pub file: &'a Path,
    pub set: &'a [SetKey],
    pub duties: &'a [SharedMotion],
    pub air: f64,
}

/// Runs the fit.
pub(super) fn command(given: &Given<'_>, options: &Options) -> Result<()> {
    let held_out = options.held_out()?;
    if let Some(out) = &options.out {
        spare(out, options.force.force)?;
    }
    let reading = options.reading(given.duties, given.air);
    let logs: Vec<_> = (options.fit.iter())
        .map(|file| slow_log(given.axis, file))
        .collect::<Result<_>>()?;
    let slow = logs.iter().zip(&options.fit).map(|(log, file)| {
        of_log(
            file,
            SlowLog::new(given.axis, log, &reading).into_diagnostic(),
        )
    });
    let slow: Vec<SlowLog<'_>> = slow.collect::<Result<_>>()?;
    let found = fit(given.axis, &slow, held_out).into_diagnostic()?;
    let names = options.fit.iter().map(|log| log.display().to_string());
    let mut fitted = Fitted::of(given.axis, names.collect(), options.held_out, &found);
    fitted.axis_file = options.out.clone();
    if let Some(out) = &options.out {
        write(given, &fitted, out)?;
    }
    print("heat", &fitted)
}

/// Writes the axis file with what was fitted; none that could not be read.
fn write(given: &Given<'_>, fitted: &Fitted, out: &Path) -> Result<()> {
    let folder = match out.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    ready(&folder)?;
    let text = with_keys(&read_text(given.file)?, given.set)?;
    let text = moved(&text, given.file, &folder)?;
    let key = |number: &Number| format!("thermal.{}={}", number.key, SixDigits(number.fitted));
    let keys: std::result::Result<Vec<SetKey>, String> = fitted
        .numbers
        .iter()
        .map(|number| key(number).parse())
        .collect();
    let text = with_keys(&text, &keys.map_err(miette::Report::msg)?)?;
    let text = format!("{}{}", fitted.comment(), without_comment(&text));
    Axis::parse(&out.display().to_string(), &text)?;
    write_whole(out, text.as_bytes())
}

/// How the lines at the head of a fitted file begin and end.
const FITTED: &str = "# [thermal] fitted by `";
const SEVERAL: &str =
    "# Such logs do not determine each number: several sets of them give the same growth.\n\n";

/// The text without the lines of a fit before, wherever among the comments at its head they are.
fn without_comment(text: &str) -> String {
    let is_comment = |line: &&str| line.starts_with('#') || line.trim().is_empty();
    let head: usize = text
        .split_inclusive('\n')
        .take_while(is_comment)
        .map(str::len)
        .sum();
    let (head, rest) = text.split_at(head);
    let old = head.find(FITTED).and_then(|begin| {
        let end = begin + head[begin..].find(SEVERAL)? + SEVERAL.len();
        Some(begin..end)
    });
    match old {
        Some(old) => format!("{}{}{rest}", &head[..old.start], &head[old.end..]),
        None => text.to_owned(),
    }
}

/// A number of [thermal].
#[derive(Serialize)]
struct Number {
    key: String,
    assumed: Option<f64>,
    fitted: f64,
}

/// Errors on what was held out.
#[derive(Serialize)]
struct Errors {
    greatest_um: f64,
    rms_um: f64,
    friction_percent: Option<f64>,
}

impl Errors {
    fn of(held: &HeldOut) -> Self {
        Self {
            greatest_um: 1e6 * held.greatest,
            rms_um: 1e6 * held.rms,
            friction_percent: held.friction.map(|share| 100.0 * share),
        }
    }
}

/// What was fitted, and how well.
#[derive(Serialize)]
pub struct Fitted {
    axis: String,
    logs: Vec<String>,
    hours: f64,
    readings: usize,
    friction_readings: usize,
    /// Of model less log, where it was fitted.
    fitted_rms_um: f64,
    held_out_percent: f64,
    held_out_readings: usize,
    /// Greatest growth that was read there.
    held_out_growth_um: f64,
    assumed_numbers: Errors,
    fitted_numbers: Errors,
    numbers: Vec<Number>,
    axis_file: Option<PathBuf>,
}

impl Fitted {
    /// The keys of `[thermal]` that were fitted, with their values.
    pub fn keys(&self) -> impl Iterator<Item = (&str, f64)> {
        let numbers = self.numbers.iter();
        numbers.map(|number| (number.key.as_str(), number.fitted))
    }

    /// Of a fit to logs of these names, so many percent of each held out.
    pub fn of(axis: &Axis, logs: Vec<String>, held_out_percent: f64, found: &HeatFit) -> Self {
        let own = axis.thermal_keys();
        let number = |(key, fitted): (String, f64)| Number {
            assumed: own.iter().find(|(name, _)| *name == key).map(|(_, v)| *v),
            key,
            fitted,
        };
        let numbers = axis.thermal_keys_of(&found.fitted.parameters);
        Self {
            axis: axis.name.clone(),
            logs,
            hours: found.duration / 3600.0,
            readings: found.readings,
            friction_readings: found.friction_readings,
            fitted_rms_um: 1e6 * found.fitted.rms,
            held_out_percent,
            held_out_readings: found.after.readings,
            held_out_growth_um: 1e6 * found.after.of,
            assumed_numbers: Errors::of(&found.before),
            fitted_numbers: Errors::of(&found.after),
            numbers: numbers.into_iter().map(number).collect(),
            axis_file: None,
        }
    }

    /// Lines at the head of the axis file.
    fn comment(&self) -> String {
        let mut text = format!("{FITTED}{} heat --fit`.\n", program::name());
        for line in self.summary() {
            let _ = writeln!(text, "# {line}");
        }
        text.push_str(SEVERAL);
        text
    }

    fn summary(&self) -> Vec<String> {
        let friction = match self.friction_readings {
            0 => String::new(),
            n => format!(" and {n} of the friction's power"),
        };
        let mut lines = vec![format!(
            "{}: fitted to {:.2} h, {} of growth{friction}; RMS of model less log {:.2} µm.",
            self.logs.join(", "),
            self.hours,
            readings(self.readings),
            self.fitted_rms_um
        )];
        if self.held_out_readings == 0 {
            lines.push("Nothing was held out: how well it predicts is not known.".to_owned());
            return lines;
        }
        let errors = |errors: &Errors| {
            let friction = errors.friction_percent.map_or(String::new(), |percent| {
                format!("; friction's power {percent:.1} %")
            });
            format!(
                "{:.2} µm (RMS {:.2} µm{friction})",
                errors.greatest_um, errors.rms_um
            )
        };
        lines.push(format!(
            "Held out: the last {} %, {}, growth of up to {:.1} µm. Greatest error {}, with the numbers before {}.",
            SixDigits(self.held_out_percent),
            readings(self.held_out_readings),
            self.held_out_growth_um,
            errors(&self.fitted_numbers),
            errors(&self.assumed_numbers)
        ));
        lines
    }
}

fn readings(count: usize) -> String {
    match count {
        1 => "1 reading".to_owned(),
        _ => format!("{count} readings"),
    }
}

impl fmt::Display for Fitted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: thermal model", self.axis)?;
        for line in self.summary() {
            writeln!(f, "{line}")?;
        }
        for number in &self.numbers {
            write!(
                f,
                "  {:<42} {:>12}",
                number.key,
                SixDigits(number.fitted).to_string()
            )?;
            match number.assumed {
                Some(before) => writeln!(f, "   before {}", SixDigits(before))?,
                None => writeln!(f)?,
            }
        }
        match &self.axis_file {
            Some(path) => write!(f, "{}", path.display()),
            None => Ok(()),
        }
    }
}
