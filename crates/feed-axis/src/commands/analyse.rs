//! `analyse`: margins of the drive's loops.

use std::fmt::Write;
use std::path::PathBuf;

use axis_report::engineering;
use axis_sim::SixDigits;
use clap::Args;
use drive_loop::{CornerMargins, CutMargins, LoopAnalysis, LoopSet, MASSES};
use miette::{IntoDiagnostic, Result};

use crate::context::{DEFAULT_AXIS, axis_with};
use crate::out_file;
use crate::output::{Worded, print};
use crate::page::loops as loops_page;
use crate::page::loops::{compliance_unit, place};
use crate::set_key::SetKey;

/// Options of `analyse`.
#[derive(Args)]
pub struct Options {
    /// Axis file
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    axis: PathBuf,
    /// Set a key of the axis file to another value, such as control.kv_per_s=30 (may be repeated)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<SetKey>,
    #[command(flatten)]
    ranges: Ranges,
    /// Cycles of delay besides those of the file
    #[arg(long, value_name = "CYCLES", default_value_t = 0.0)]
    delay: f64,
    /// Page with Bode's and Nyquist's plots, sensitivities and compliance
    #[arg(long, value_name = "OUT.html", value_parser = out_file::page())]
    report: Option<PathBuf>,
}

/// The set of corners: each position with each mass and friction, sliding and stuck.
#[derive(Args)]
pub struct Ranges {
    /// Positions of the load, m or rad [default: start, ends and middle of the stroke]
    #[arg(long, value_name = "POSITION", num_args = 1.., value_delimiter = ',', allow_negative_numbers = true)]
    position: Vec<f64>,
    /// Masses or inertias of the load, as shares of the file's
    #[arg(long, value_name = "SHARE", num_args = 1.., value_delimiter = ',', default_values_t = MASSES)]
    mass: Vec<f64>,
    /// Frictions (stiffness and damping of bristles, viscous part), as shares of the file's
    #[arg(long, value_name = "SHARE", num_args = 1.., value_delimiter = ',', default_values_t = [1.0])]
    friction: Vec<f64>,
}

impl Ranges {
    /// As a set, with that many cycles of delay besides the file's.
    pub fn set(&self, delay: f64) -> LoopSet {
        LoopSet {
            positions: self.position.clone(),
            masses: self.mass.clone(),
            frictions: self.friction.clone(),
            delay,
            ..LoopSet::default()
        }
    }
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let axis = axis_with(&options.axis, &options.set)?;
    let set = options.ranges.set(options.delay);
    let value = LoopAnalysis::of(&axis, &set).into_diagnostic()?;
    let mut text = words(&value);
    if let Some(path) = &options.report {
        axis_report::write_atomic(path, &loops_page::page(&value)).into_diagnostic()?;
        text += &format!("{}\n", path.display());
    }
    print("analyse", &Worded { text, value })
}

/// The analysis as people read it.
fn words(found: &LoopAnalysis) -> String {
    let mut text = format!("loops of {}\n", found.axis);
    let modes: Vec<String> = found.modes_hz.iter().map(|f| format!("{f:.1}")).collect();
    if !modes.is_empty() {
        let _ = writeln!(text, "natural modes: {} Hz", modes.join(", "));
    }
    for corner in found.corners.iter().take(2) {
        text += &one(found, corner);
    }
    let worst = &found.worst;
    let _ = writeln!(
        text,
        "maximum sensitivity of {} corners: {}; with one more cycle of delay: {}",
        found.corners.len(),
        of_corner(found, worst.sensitivity, worst.sensitivity_corner),
        of_corner(found, worst.sensitivity_late, worst.sensitivity_late_corner),
    );
    if worst.unstable > 0 {
        let _ = writeln!(text, "{} corners are not stable", worst.unstable);
    }
    for note in &found.notes {
        let _ = writeln!(text, "note: {note}");
    }
    text
}

fn of_corner(found: &LoopAnalysis, value: Option<f64>, corner: usize) -> String {
    let at = &found.corners[corner].at;
    let place = place(at, &found.position_unit);
    match value {
        Some(value) => format!("{value:.3} ({place})"),
        None => format!("not stable ({place})"),
    }
}

fn one(found: &LoopAnalysis, m: &CornerMargins) -> String {
    let mut text = format!("{}:\n", place(&m.at, &found.position_unit));
    if !m.stable {
        let _ = writeln!(
            text,
            "  not stable: greatest eigenvalue {} per cycle",
            SixDigits(m.radius)
        );
        return text;
    }
    for (what, cut) in [("command", &m.command), ("position", &m.position)] {
        let _ = writeln!(text, "  cut at the {what:<8} {}", margins(cut));
    }
    let hertz = |f: Option<f64>| f.map_or("none".to_owned(), |f| format!("{f:.1} Hz"));
    let _ = writeln!(
        text,
        "  bandwidth (-3 dB): speed {}, position {}",
        hertz(m.speed_bandwidth_hz),
        hertz(m.position_bandwidth_hz)
    );
    let per = compliance_unit(found);
    let _ = writeln!(
        text,
        "  compliance at the load: peak {} at {:.1} Hz, {} RMS from 1 to 300 Hz",
        engineering(m.compliance_peak, &per, 3),
        m.compliance_peak_at_hz,
        engineering(m.compliance_rms, &per, 3)
    );
    if m.ripple > 0.0 {
        let _ = writeln!(
            text,
            "  ripple of the command by the sensor's steps: {:.2} % of the greatest (RMS)",
            100.0 * m.ripple
        );
    }
    text
}

fn margins(cut: &CutMargins) -> String {
    let or =
        |value: Option<f64>, shown: &dyn Fn(f64) -> String| value.map_or("none".to_owned(), shown);
    let plain = |v: f64| format!("{v:.3}");
    format!(
        "sensitivity {} at {:.1} Hz (late {}), gain × {} to × {}, phase {}, delay {}, crossover {}",
        or(cut.sensitivity, &plain),
        cut.sensitivity_at_hz,
        or(cut.sensitivity_late, &plain),
        or(cut.gain_down, &plain),
        or(cut.gain_up, &plain),
        or(cut.phase_deg, &|v| format!("{v:.1}°")),
        or(cut.delay_s, &|v| format!("{:.3} ms", 1e3 * v)),
        or(cut.crossover_hz, &|v| format!("{v:.1} Hz")),
    )
}
