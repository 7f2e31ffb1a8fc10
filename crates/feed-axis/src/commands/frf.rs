//! `frf`: frequency responses from logs.

use std::fmt::Write;
use std::path::PathBuf;

use axis_log::intake::Options as Intake;
use axis_log::{PlusMinus, never_zero};
use axis_sim::{Axis, SixDigits, known_channels, needed_position};
use clap::Args;
use drive_loop::{MeasureSettings, MeasuredDrive, WithDeviation};
use miette::{IntoDiagnostic, Result, WrapErr};
use schemars::JsonSchema;
use serde::Serialize;

use super::discover::read_with;
use crate::context::{DEFAULT_AXIS, axis_with};
use crate::out_file;
use crate::output::{Worded, note, print};
use crate::page::frf as frf_page;
use crate::set_key::SetKey;

/// Frequencies of the table on the terminal, Hz.
const SHOWN: [f64; 10] = [
    2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0,
];

/// Options of `frf`.
#[derive(Args)]
pub struct Options {
    /// Logs of the excited axis, one for each place of the load; several files of one log with + between
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Axis file; its [[log.column]] map the columns of the logs
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    axis: PathBuf,
    /// Set a key of the axis file to another value, such as control.kv_per_s=30 (may be repeated)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<SetKey>,
    /// Spacing of the frequency lines, Hz [default: those of a periodic excitation, or 1.2]
    #[arg(long, value_name = "HZ")]
    step: Option<f64>,
    /// Minimum coherence of a line that is used
    #[arg(long, value_name = "SHARE", default_value_t = 0.9)]
    coherence: f64,
    /// Most poles of the fit; a mode has two
    #[arg(long, value_name = "N", default_value_t = 10)]
    poles: usize,
    /// Page with Bode plots of the responses and the model's, coherence, modes and margins
    #[arg(long, value_name = "OUT.html", value_parser = out_file::page())]
    report: Option<PathBuf>,
}

/// What `frf` writes as JSON.
#[derive(Serialize, JsonSchema)]
pub struct FrfFound {
    /// One for each log.
    pub measurements: Vec<MeasuredDrive>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let axis = axis_with(&options.axis, &options.set)?;
    let settings = MeasureSettings {
        step_hz: options.step,
        coherence: options.coherence,
        most_poles: options.poles,
    };
    let measurements = measured(&axis, &options.logs, &settings)?;
    let mut text = String::new();
    for (path, found) in options.logs.iter().zip(&measurements) {
        let _ = writeln!(text, "{}", path.display());
        text += &words(found);
    }
    if let Some(path) = &options.report {
        let page = frf_page::page(&axis, &measurements);
        axis_report::write_atomic(path, &page).into_diagnostic()?;
        let _ = writeln!(text, "{}", path.display());
    }
    let value = FrfFound { measurements };
    print("frf", &Worded { text, value })
}

/// The response of each log.
pub fn measured(
    axis: &Axis,
    logs: &[PathBuf],
    settings: &MeasureSettings,
) -> Result<Vec<MeasuredDrive>> {
    let mut notes = Vec::new();
    let mut one = |path: &PathBuf| {
        // Short pulses of the command look like outliers, and another rate has another response.
        let exact: Vec<&str> = known_channels().collect();
        let options = Intake {
            exact: &exact,
            ..Intake::default()
        };
        let needed: Vec<&str> = needed_position(axis).into_iter().collect();
        let log = read_with(path, axis, &needed, options, &mut notes)?;
        MeasuredDrive::of(axis, &log, settings)
            .into_diagnostic()
            .wrap_err_with(|| path.display().to_string())
    };
    let all = logs.iter().map(&mut one).collect();
    notes.iter().for_each(note);
    all
}

fn pair(of: WithDeviation, scale: f64, digits: usize) -> String {
    PlusMinus::new(scale * of.value, scale * of.deviation, digits).to_string()
}

/// A measurement as people read it.
fn words(found: &MeasuredDrive) -> String {
    let mut text = String::new();
    let unit = &found.position_unit;
    let _ = writeln!(
        text,
        "  {:.2} s at {} {unit}/s, load at {} {unit}; {}",
        found.excited_s,
        SixDigits(found.speed),
        SixDigits(found.position),
        found.method
    );
    match found.band_hz {
        Some([low, high]) => {
            let _ = writeln!(
                text,
                "  lines of {:.2} Hz, coherence {} and more from {low:.1} to {high:.1} Hz",
                found.step_hz, found.coherence
            );
        }
        None => {
            let _ = writeln!(text, "  no line has a coherence of {}", found.coherence);
        }
    }
    for trap in &found.traps {
        let kind = if trap.refused {
            "not usable"
        } else {
            "warning"
        };
        let _ = writeln!(text, "  {kind}: {}", trap.what);
    }
    for note in &found.notes {
        let _ = writeln!(text, "  note: {note}");
    }
    text += &table(found);
    text += &fitted(found);
    if let Some(m) = &found.margins {
        let model = m
            .model
            .map_or("not stable".to_owned(), |s| format!("{s:.3}"));
        let _ = writeln!(
            text,
            "  maximum sensitivity with the gains of the file: {} at {:.1} Hz from the command, {} from the responses; model {model}",
            pair(m.sensitivity, 1.0, 3),
            m.sensitivity_at_hz,
            pair(m.by_response, 1.0, 3)
        );
        let _ = writeln!(
            text,
            "  maximum sensitivity of the position loop: {:.3}",
            m.position
        );
        if let (Some(phase), Some(delay), Some(at)) = (m.phase_deg, m.delay_s, m.crossover_hz) {
            let _ = writeln!(
                text,
                "  phase margin {phase:.1}°, delay margin {:.3} ms, crossover {at:.1} Hz",
                1e3 * delay
            );
        }
    }
    text += &compliance(found);
    if let Some(c) = &found.comparison {
        let _ = writeln!(
            text,
            "  against the model: {:.1} % apart (median), {:.1} % but for a factor of {:.3} and a delay of {} ms",
            100.0 * c.distance,
            100.0 * c.distance_corrected,
            c.gain,
            pair(c.delay_s, 1e3, 4)
        );
        for said in &c.said {
            let _ = writeln!(text, "  {said}");
        }
    }
    text
}

/// The compliance at the load, from the responses.
fn compliance(found: &MeasuredDrive) -> String {
    let Some(c) = &found.compliance else {
        let why = found.compliance_missing.as_deref().unwrap_or("no reason");
        return format!("  compliance at the load: none, as {why}\n");
    };
    let scale = 1e9;
    let unit = match found.position_unit.as_str() {
        "m" => "nm/N",
        _ => "nrad/(N·m)",
    };
    let mut text = format!(
        "  compliance at the load from the responses: greatest {} {unit} at {:.1} Hz, {} from {:.0} to {:.0} Hz (RMS); model {} and {}\n",
        pair(c.peak, scale, 3),
        c.peak_at_hz,
        pair(c.rms, scale, 3),
        c.rms_band_hz[0],
        c.rms_band_hz[1],
        SixDigits(scale * c.model[0]),
        SixDigits(scale * c.model[1]),
    );
    let modes: Vec<String> = c
        .modes
        .iter()
        .map(|m| format!("{:.1}", m.frequency_hz))
        .collect();
    if !modes.is_empty() {
        let _ = writeln!(
            text,
            "  modes in it, from its own fit: {} Hz",
            modes.join(", ")
        );
    }
    for note in &c.notes {
        let _ = writeln!(text, "  note: {note}");
    }
    text
}

/// Lines next to the frequencies that are shown.
fn table(found: &MeasuredDrive) -> String {
    let mut text = format!(
        "  {:>8}  {:>11}  {:>8}  {:>7}  {:>9}  {:>11}\n",
        "Hz", "magnitude", "± %", "phase°", "coherence", "model"
    );
    for at in SHOWN {
        let lines = found.motor_speed.iter().zip(&found.motor_speed_model);
        let distance = |hz: f64| (hz / at).ln().abs();
        let nearest =
            lines.min_by(|a, b| distance(a.0.frequency_hz).total_cmp(&distance(b.0.frequency_hz)));
        let Some((line, model)) = nearest.filter(|(l, _)| distance(l.frequency_hz) < 0.3) else {
            continue;
        };
        let [re, im] = line.value;
        let magnitude = re.hypot(im);
        let _ = writeln!(
            text,
            "  {:>8.2}  {:>11.4e}  {:>8}  {:>7.1}  {:>9.4}  {:>11.4e}",
            line.frequency_hz,
            magnitude,
            never_zero(100.0 * line.deviation / magnitude, 2),
            im.atan2(re).to_degrees(),
            line.coherence,
            model[0].hypot(model[1])
        );
    }
    text
}

fn fitted(found: &MeasuredDrive) -> String {
    let mut text = String::new();
    let Some(fit) = &found.fit else {
        return text;
    };
    let compared = found.comparison.as_ref();
    for mode in &fit.modes {
        let of_model = compared.and_then(|c| {
            let mut modes = c.modes.iter();
            let same = modes.find(|m| m.measured_hz == mode.frequency_hz)?;
            Some(
                same.model_hz
                    .map_or("none".to_owned(), |f| format!("{f:.1} Hz")),
            )
        });
        let _ = writeln!(
            text,
            "  mode at {} Hz, damping {} %{}",
            pair(mode.frequency_hz, 1.0, 3),
            pair(mode.damping, 100.0, 3),
            of_model.map_or(String::new(), |model| format!("; the model's: {model}"))
        );
    }
    for missing in compared.iter().flat_map(|c| &c.missing_hz) {
        let _ = writeln!(
            text,
            "  no mode measured beside the model's at {missing:.1} Hz"
        );
    }
    let _ = writeln!(
        text,
        "  delay of the fit {} ms; it is {:.2} deviations off the lines (RMS) from {:.1} to {:.1} Hz",
        pair(fit.delay_s, 1e3, 3),
        fit.misfit,
        fit.band_hz[0],
        fit.band_hz[1]
    );
    text
}
