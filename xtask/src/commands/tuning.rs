//! `tuning`: the example axes tuned, beside the figures of an independent search.

use std::fmt::Write;

use axis_sim::Axis;
use drive_loop::{LoopSet, TuneSettings, Tuning, moves, with_acceleration};
use feed_axis::output::{Worded, note, print};
use miette::{IntoDiagnostic, Result, miette};
use serde::Serialize;

use super::tuning_files;
pub use super::tuning_options::Options;
use super::tuning_options::three;

/// An axis, and what an independent search under the same constraints (maximum sensitivity 1.6, 2
/// with one more cycle, over stroke ends, mass −10 and +40 %, sliding and stuck) left of its peak error
/// on the first trajectory: without and with the acceleration fed forward, µm or µrad.
const AXES: [(&str, [f64; 2]); 7] = [
    ("liu2025", [28.3, 23.5]),
    ("screw-datasheet", [30.3, 27.1]),
    ("belt", [107.0, 105.0]),
    ("rack", [9.3, 3.0]),
    ("joint", [1540.0, 1530.0]),
    ("linear-motor", [3.8, 2.0]),
    ("rotary-table", [7.3, 6.0]),
];

/// A row of the table.
#[derive(Serialize)]
struct Row {
    axis: &'static str,
    /// Without and with the acceleration fed forward.
    file_peak_um: [f64; 2],
    tuned_peak_um: [f64; 2],
    /// What the independent search has.
    reference_peak_um: [f64; 2],
    file_sensitivity: Option<f64>,
    tuned_sensitivity: Option<f64>,
    tuned_sensitivity_late: Option<f64>,
    /// k_p as a multiple of the file's, T_n in ms, k_v in 1/s.
    gains: [f64; 3],
    compliance_peak: [f64; 2],
    compliance_slope: [Option<f64>; 2],
    proven_stable: bool,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    if options.write {
        return tuning_files::command(options);
    }
    let settings = |axis: &Axis| {
        let stroke = &axis.stroke;
        let [least, most] = [stroke.minimum, stroke.maximum];
        TuneSettings {
            ripple: f64::INFINITY,
            notch: false,
            simulated: false,
            set: LoopSet {
                positions: vec![least, 0.5 * (least + most), most],
                ..LoopSet::default()
            },
            ..TuneSettings::default()
        }
    };
    let mut rows = Vec::new();
    for (name, reference) in AXES.into_iter().filter(|(name, _)| options.asked(name)) {
        let axis = Axis::read(&options.axes.join(format!("{name}.toml")))?;
        let begun = std::time::Instant::now();
        let tuned = Tuning::of(&axis, &settings(&axis)).into_diagnostic()?;
        note(format!(
            "{name}: tuned in {:.1} s",
            begun.elapsed().as_secs_f64()
        ));
        let report = &tuned.report;
        let gains = |g: &drive_loop::TunedGains| {
            [
                g.speed_proportional,
                1e3 * g.integral_time_s.unwrap_or(0.0),
                g.kv_per_s,
            ]
        };
        let [before, after] = [gains(&report.file_gains), gains(&report.tuned_gains)];
        rows.push(Row {
            axis: name,
            file_peak_um: peaks(&axis)?,
            tuned_peak_um: peaks(&tuned.axis)?,
            reference_peak_um: reference,
            file_sensitivity: report.file.sensitivity,
            tuned_sensitivity: report.tuned.sensitivity,
            tuned_sensitivity_late: report.tuned.sensitivity_late,
            gains: [after[0] / before[0], after[1], after[2]],
            compliance_peak: [report.file.compliance_peak, report.tuned.compliance_peak],
            compliance_slope: [report.file.compliance_slope, report.tuned.compliance_slope],
            proven_stable: report.proven_stable,
        });
    }
    if rows.is_empty() {
        let all: Vec<&str> = AXES.iter().map(|(name, _)| *name).collect();
        return Err(miette!(
            "no axis is named {}; valid: {}",
            options.names.join(", "),
            all.join(", ")
        ));
    }
    let text = words(&rows);
    print("tuning", &Worded { text, value: rows })
}

/// Peak error of the first trajectory, without and with the acceleration fed forward.
fn peaks(axis: &Axis) -> Result<[f64; 2]> {
    let mut both = [f64::NAN; 2];
    for (peak, share) in both.iter_mut().zip([0.0, 1.0]) {
        let fed = with_acceleration(axis, share).into_diagnostic()?;
        let first = moves(&fed).into_diagnostic()?.into_iter().next();
        *peak = 1e6 * first.and_then(|m| m.peak_error).unwrap_or(f64::NAN);
    }
    Ok(both)
}

fn words(rows: &[Row]) -> String {
    let mut text = String::from(
        "peak error, µm or µrad, without / with acceleration feed-forward\n\
         axis             file              tuned             reference         Ms file  tuned  late   k_p ×  T_n, ms  k_v, 1/s  compliance peak ×  slope ×\n",
    );
    let pair = |[a, b]: [f64; 2]| format!("{} / {}", three(a), three(b));
    let sensitivity = |s: Option<f64>| s.map_or("-".to_owned(), |s| format!("{s:.2}"));
    for row in rows {
        let [kp, time, kv] = row.gains;
        let slope = match row.compliance_slope {
            [Some(before), Some(after)] => three(after / before),
            _ => "-".to_owned(),
        };
        let _ = writeln!(
            text,
            "{:<16} {:<17} {:<17} {:<17} {:>7} {:>6} {:>5} {:>7} {:>8} {:>9} {:>18} {:>8}{}",
            row.axis,
            pair(row.file_peak_um),
            pair(row.tuned_peak_um),
            pair(row.reference_peak_um),
            sensitivity(row.file_sensitivity),
            sensitivity(row.tuned_sensitivity),
            sensitivity(row.tuned_sensitivity_late),
            three(kp),
            three(time),
            three(kv),
            three(row.compliance_peak[1] / row.compliance_peak[0]),
            slope,
            if row.proven_stable {
                ""
            } else {
                "  not proven stable"
            },
        );
    }
    text
}
