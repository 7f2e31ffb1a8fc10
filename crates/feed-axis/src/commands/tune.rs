//! `tune`: gains of the drive's loops, within limits of the sensitivity.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use axis_pipeline::drive_terms::{Term, gain_terms};
use axis_report::{Cell, Page, Section, Table, engineering};
use axis_sim::{Axis, SixDigits};
use clap::Args;
use drive_loop::{LoopAnalysis, MeasureSettings, TuneSettings, TunedKey, Tuning};
use miette::{IntoDiagnostic, Result};
use schemars::JsonSchema;
use serde::Serialize;

use super::analyse::Ranges;
use super::control_table::with_tuned;
use super::export::drive::entered;
use super::frf;
use super::moved_file::moved;
use crate::context::{DEFAULT_AXIS, axis_with, read_text};
use crate::out_file;
use crate::output::{Worded, print, ready, write_whole};
use crate::page::loops as loops_page;
use crate::page::loops::place;
use crate::set_key::{SetKey, with_keys};

/// Options of `tune`.
#[derive(Args)]
pub struct Options {
    /// Axis file
    #[arg(long, value_name = "FILE", default_value = DEFAULT_AXIS)]
    axis: PathBuf,
    /// Set a key of the axis file to another value first, such as mechanism.table_mass_kg=415 (may be
    /// repeated); it is written too
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<SetKey>,
    /// Axis file to write, with the new gains; everything else unchanged
    #[arg(long, value_name = "FILE", value_parser = out_file::file())]
    out: PathBuf,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    ranges: Ranges,
    /// Maximum sensitivity at the command and at the position, in every case
    #[arg(long, value_name = "MS", default_value_t = 1.6)]
    sensitivity: f64,
    /// The same with one more cycle of delay
    #[arg(long, value_name = "MS", default_value_t = 2.0)]
    sensitivity_late: f64,
    /// Limit of the command's ripple caused by the resolution of the speed's sensor, % of
    /// the greatest command (RMS)
    #[arg(long, value_name = "PERCENT", default_value_t = 2.0)]
    ripple: f64,
    /// Leave the acceleration feed-forward as it is
    #[arg(long)]
    no_acceleration: bool,
    /// Set no notch filter
    #[arg(long)]
    no_notch: bool,
    /// Set the current controllers too, to the magnitude optimum
    #[arg(long)]
    current: bool,
    /// Logs of the excited axis (docs/frequency-response.md): limits hold for the loops with these measured
    /// responses too, and the delay that they show is in the model's
    #[arg(long, value_name = "LOG", num_args = 1..)]
    frf: Vec<PathBuf>,
    /// Page with the tuned loops
    #[arg(long, value_name = "OUT.html", value_parser = out_file::page())]
    report: Option<PathBuf>,
}

/// What `tune` writes as JSON.
#[derive(Serialize, JsonSchema)]
pub struct TuneFound {
    #[serde(flatten)]
    tuning: Tuning,
    /// Keys that were set, in the units of the file.
    keys: Vec<TunedKey>,
    /// Gains and filters of the tuned file in the units of drives, with the parameters that take them.
    drive: Vec<Term>,
    /// The axis file that was written.
    axis_file: PathBuf,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    out_file::spare(&options.out, options.force)?;
    let axis = axis_with(&options.axis, &options.set)?;
    let folder = match options.out.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    ready(&folder)?;
    let measured = frf::measured(&axis, &options.frf, &MeasureSettings::default())?;
    let set = options.ranges.set(0.0);
    let set = set.with_measured(&axis, &measured).into_diagnostic()?;
    let settings = TuneSettings {
        sensitivity: options.sensitivity,
        sensitivity_late: options.sensitivity_late,
        ripple: 1e-2 * options.ripple,
        set,
        acceleration: !options.no_acceleration,
        notch: !options.no_notch,
        current: options.current,
        simulated: true,
    };
    let tuned = Tuning::of(&axis, &settings).into_diagnostic()?;
    let text = with_keys(&read_text(&options.axis)?, &options.set)?;
    let (text, keys) = file_of(&text, &options.axis, &folder, tuned.keys(&axis))?;
    let written = Axis::parse(&options.out.display().to_string(), &text)?;
    write_whole(&options.out, text.as_bytes())?;
    let found = TuneFound {
        tuning: tuned.report,
        keys,
        drive: of_drive(&written, options.current),
        axis_file: options.out.clone(),
    };
    let mut text = words(&found);
    if let Some(path) = &options.report {
        let loops = LoopAnalysis::of(&written, &settings.set).into_diagnostic()?;
        axis_report::write_atomic(path, &report_page(&found, &loops)).into_diagnostic()?;
        let _ = writeln!(text, "{}", path.display());
    }
    text += &shown(&options.out);
    print("tune", &Worded { text, value: found })
}

/// Gains in the units of drives; of the current controllers where they were set.
fn of_drive(axis: &Axis, current: bool) -> Vec<Term> {
    let mut all = gain_terms(axis);
    all.retain(|term| current || !term.name.starts_with("current_"));
    all
}

/// The text of an axis file `from`, with the keys of its tuned axis, for a file in another folder; and
/// the keys as they stand there.
pub fn file_of(
    text: &str,
    from: &Path,
    folder: &Path,
    keys: Vec<TunedKey>,
) -> Result<(String, Vec<TunedKey>)> {
    with_tuned(&moved(text, from, folder)?, from, keys)
}

fn shown(path: &Path) -> String {
    format!("{}\n", path.display())
}

/// What was found, as people read it.
fn words(found: &TuneFound) -> String {
    let t = &found.tuning;
    let mut text = format!("{}: gains for the drive\n", t.axis);
    for key in &found.keys {
        let before = match key.before {
            Some(before) => format!("was {}", SixDigits(before)),
            None => "new".to_owned(),
        };
        let _ = writeln!(
            text,
            "  {:<44} {:>12}   {before}",
            key.key,
            SixDigits(key.value).to_string()
        );
    }
    text += "in a drive (`export drive` has more)\n";
    for term in &found.drive {
        let value = SixDigits(term.drive_value).to_string();
        let _ = writeln!(text, "  {:<44} {value:>12} {}", term.name, term.drive_unit);
        if let Some(line) = entered(term) {
            let _ = writeln!(text, "      {line}");
        }
    }
    for line in lines(t) {
        let _ = writeln!(text, "{line}");
    }
    text
}

/// Figures, limits, helps and moves, a line each.
fn lines(t: &Tuning) -> Vec<String> {
    let sensitivity = |s: Option<f64>| s.map_or("not stable".to_owned(), |s| format!("{s:.2}"));
    let mut all = vec![format!(
        "maximum sensitivity {} (was {}), with one more cycle of delay {} (was {})",
        sensitivity(t.tuned.sensitivity),
        sensitivity(t.file.sensitivity),
        sensitivity(t.tuned.sensitivity_late),
        sensitivity(t.file.sensitivity_late),
    )];
    let ratio = |before: f64, after: f64| format!("× {:.3}", after / before);
    let slope = t.file.compliance_slope.zip(t.tuned.compliance_slope);
    all.push(format!(
        "compliance at the load: {} from 1 to 300 Hz{}",
        ratio(t.file.compliance_rms, t.tuned.compliance_rms),
        slope.map_or(String::new(), |(before, after)| format!(
            ", {} at low frequencies while sliding",
            ratio(before, after)
        ))
    ));
    if t.proven_stable {
        all.push(
            "stable in every case: all eigenvalues of the sampled loop lie within the unit circle"
                .to_owned(),
        );
    } else {
        all.push(
            "not every case is proven stable by its eigenvalues: look at `analyse`".to_owned(),
        );
    }
    for limit in t.limiting.iter().filter(|l| l.value > 0.98 * l.limit) {
        let corner = limit.corner.map_or(String::new(), |at| {
            format!(" ({}", place(&at, &t.position_unit))
        });
        let at = match (limit.frequency_hz, limit.mode) {
            (Some(f), Some(mode)) => format!(", {f:.0} Hz, natural mode {mode})"),
            (Some(f), None) => format!(", {f:.0} Hz)"),
            _ => String::new(),
        };
        all.push(format!("limited by the {}{corner}{at}", limit.what));
    }
    for help in &t.helps {
        all.push(format!(
            "would help: {}: compliance × {:.2}{}",
            help.change,
            help.compliance_rms,
            help.compliance_slope
                .map_or(String::new(), |s| format!(", at low frequencies × {s:.2}"))
        ));
    }
    for check in &t.moves {
        let error = |e: Option<f64>| {
            e.map_or("given up".to_owned(), |e| {
                engineering(e, &t.position_unit, 3)
            })
        };
        all.push(format!(
            "trajectory {} (simulated, with noise): peak error {} (was {})",
            check.trajectory,
            error(check.tuned.peak_error),
            error(check.file.peak_error)
        ));
    }
    all.extend(t.notes.iter().map(|note| format!("note: {note}")));
    all
}

fn report_page(found: &TuneFound, loops: &LoopAnalysis) -> Page {
    let mut table = Table::new("Keys of the axis file", ["key", "before", "now"]);
    for key in &found.keys {
        let number = |v: f64| Cell::text(SixDigits(v).to_string());
        table = table.row([
            Cell::text(&key.key),
            key.before.map_or(Cell::Missing, number),
            number(key.value),
        ]);
    }
    let section = Section::new("Tuned gains").table(table);
    let section = lines(&found.tuning)
        .into_iter()
        .fold(section, |section, line| {
            section.paragraph(loops_page::sentence(&line))
        });
    let page = Page::new(format!("{}, tuned", found.tuning.axis))
        .lead("Gains within limits of the sensitivity over stroke, mass and one more cycle of delay. Computed and simulated, not measured.")
        .section(section);
    loops_page::sections(loops)
        .into_iter()
        .fold(page, |page, section| page.section(section))
}
