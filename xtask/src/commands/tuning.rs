//! `tuning`: the example axes tuned, beside the figures of an independent search.

use std::fmt::Write;

use axis_sim::Axis;
use axis_sim::control::CascadeGains;
use axis_sim::part::Values;
use drive_loop::{LoopAnalysis, LoopSet, TuneSettings, Tuning, moves, with_acceleration};
use feed_axis::output::{Worded, note, print};
use miette::{IntoDiagnostic, Result, miette};
use serde::Serialize;

use super::tuning_files;
pub use super::tuning_options::Options;
use super::tuning_options::three;

/// An axis, and what an independent search found for it under the limits of this command (maximum
/// sensitivity 1.6, 2 with one more cycle, over stroke ends, mass −10 and +40 %, sliding and stuck).
struct Reference {
    /// As the table names it.
    axis: &'static str,
    /// Name of the file.
    file: &'static str,
    /// Keys of its mechanism that the search had otherwise.
    other: &'static [(&'static str, f64)],
    /// Peak error of the first trajectory without and with the acceleration fed forward, µm or µrad.
    peak_um: [f64; 2],
    /// Its gains, rounded to two or three digits: k_p as a multiple of the file's, T_n in ms, k_v in 1/s.
    gains: [f64; 3],
}

const fn same(axis: &'static str, peak_um: [f64; 2], gains: [f64; 3]) -> Reference {
    Reference {
        axis,
        file: axis,
        other: &[],
        peak_um,
        gains,
    }
}

/// The search had the screw from data sheets without twist of shaft and couplings, which the file has: the
/// axis is there twice.
const AXES: [Reference; 8] = [
    same("liu2025", [28.3, 23.5], [1.09, 22.0, 54.0]),
    Reference {
        axis: "screw, no twist",
        file: "screw-datasheet",
        other: &[("coupling_stiffness", 1e12), ("shear_modulus", 1e15)],
        ..SCREW
    },
    SCREW,
    same("belt", [107.0, 105.0], [4.1, 9.4, 91.0]),
    same("rack", [9.3, 3.0], [4.7, 6.9, 46.0]),
    same("joint", [1540.0, 1530.0], [3.2, 19.0, 37.0]),
    same("linear-motor", [3.8, 2.0], [3.3, 2.6, 368.0]),
    same("rotary-table", [7.3, 6.0], [4.6, 2.6, 364.0]),
];
const SCREW: Reference = same("screw-datasheet", [30.3, 27.1], [1.60, 11.0, 16.5]);

/// A row of the table.
#[derive(Serialize)]
struct Row {
    axis: &'static str,
    /// Without and with the acceleration fed forward.
    file_peak_um: [f64; 2],
    tuned_peak_um: [f64; 2],
    /// What the independent search has.
    reference_peak_um: [f64; 2],
    /// The gains of that search in this model: peak errors, and maximum sensitivities without and with
    /// one more cycle of delay; none where a corner is unstable.
    their_peak_um: [f64; 2],
    their_sensitivity: [Option<f64>; 2],
    /// Peak errors of gains that were tuned to the maximum sensitivities of those, as far as they exceed the
    /// limits; none where theirs are not stable.
    alike_peak_um: Option<[f64; 2]>,
    /// What the search makes least (a mean compliance, the exponential of the objective), theirs over these.
    their_compliance: Option<f64>,
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
    let mut rows = Vec::new();
    for reference in AXES.iter().filter(|one| options.asked(one.file)) {
        rows.push(row(options, reference)?);
    }
    if rows.is_empty() {
        let mut all: Vec<&str> = AXES.iter().map(|one| one.file).collect();
        all.dedup();
        return Err(miette!(
            "no axis is named {}; valid: {}",
            options.names.join(", "),
            all.join(", ")
        ));
    }
    let text = words(&rows);
    print("tuning", &Worded { text, value: rows })
}

/// Limits of the table: those of the independent search.
fn settings(axis: &Axis) -> TuneSettings {
    let [least, most] = [axis.stroke.minimum, axis.stroke.maximum];
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
}

fn row(options: &Options, reference: &Reference) -> Result<Row> {
    let name = reference.axis;
    let mut axis = Axis::read(&options.axes.join(format!("{}.toml", reference.file)))?;
    let change = |values: &mut Values| {
        let others = reference.other.iter();
        others.for_each(|(key, value)| values.set(key, *value));
    };
    axis.mechanism.change(change).into_diagnostic()?;
    let settings = settings(&axis);
    let begun = std::time::Instant::now();
    let tuned = Tuning::of(&axis, &settings).into_diagnostic()?;
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
    let theirs = with_reference(&axis, before[0], reference)?;
    let analysed = |axis: &Axis| LoopAnalysis::of(axis, &settings.set).into_diagnostic();
    let found = analysed(&theirs)?;
    let their_sensitivity = [found.worst.sensitivity, found.worst.sensitivity_late];
    let (mut alike_peak_um, mut their_compliance) = (None, None);
    if let [Some(now), Some(late)] = their_sensitivity {
        let alike = TuneSettings {
            sensitivity: now.max(settings.sensitivity),
            sensitivity_late: late.max(settings.sensitivity_late),
            ..settings.clone()
        };
        let alike = Tuning::of(&axis, &alike).into_diagnostic()?;
        alike_peak_um = Some(peaks(&alike.axis)?);
        let of_these = objective(&analysed(&alike.axis)?, gains(&alike.report.tuned_gains));
        let [ratio, time, position] = reference.gains;
        let of_theirs = objective(&found, [ratio * before[0], time, position]);
        their_compliance = Some((of_theirs - of_these).exp());
    }
    Ok(Row {
        axis: name,
        file_peak_um: peaks(&axis)?,
        tuned_peak_um: peaks(&tuned.axis)?,
        reference_peak_um: reference.peak_um,
        their_peak_um: peaks(&theirs)?,
        their_sensitivity,
        alike_peak_um,
        their_compliance,
        file_sensitivity: report.file.sensitivity,
        tuned_sensitivity: report.tuned.sensitivity,
        tuned_sensitivity_late: report.tuned.sensitivity_late,
        gains: [after[0] / before[0], after[1], after[2]],
        compliance_peak: [report.file.compliance_peak, report.tuned.compliance_peak],
        compliance_slope: [report.file.compliance_slope, report.tuned.compliance_slope],
        proven_stable: report.proven_stable,
    })
}

/// ½ ln(1/(k_i k_v)) + mean ln RMS|y/F| over the corners of the file's mass: what the search makes least, but for a
/// constant of the axis.
fn objective(of: &LoopAnalysis, [speed, time, position]: [f64; 3]) -> f64 {
    let own = of.corners.iter().filter(|corner| corner.at.mass == 1.0);
    let all: Vec<f64> = own.map(|corner| corner.compliance_rms.ln()).collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    mean - 0.5 * (speed / time * position).ln()
}

/// The axis with the gains of the independent search, `own` being the file's k_p.
fn with_reference(axis: &Axis, own: f64, reference: &Reference) -> Result<Axis> {
    let [ratio, time, position] = reference.gains;
    let speed = ratio * own;
    let gains = CascadeGains {
        position,
        speed,
        speed_integral: speed / (1e-3 * time),
        acceleration_feedforward: None,
        notch: None,
    };
    let mut theirs = axis.clone();
    let travel = axis.travel_per_radian();
    let values = axis.control.retuned(axis.control.values(), &gains, travel);
    let values = values.ok_or_else(|| miette!("{} has no such gains", reference.file))?;
    let changed = theirs.control.change(|all| *all = values);
    changed.into_diagnostic()?;
    Ok(theirs)
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
    text += "gains of the reference (rounded) in this model\n\
         axis             their error       Ms     late  error tuned to these  compliance, theirs over these\n";
    for row in rows {
        let [now, late] = row.their_sensitivity;
        let _ = writeln!(
            text,
            "{:<16} {:<17} {:<6} {:<5} {:<21} {}",
            row.axis,
            pair(row.their_peak_um),
            now.map_or("-".to_owned(), |s| format!("{s:.3}")),
            sensitivity(late),
            row.alike_peak_um.map_or("-".to_owned(), pair),
            row.their_compliance
                .map_or("-".to_owned(), |c| format!("{c:.3}")),
        );
    }
    text
}
