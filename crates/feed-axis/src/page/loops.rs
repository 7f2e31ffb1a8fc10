//! The page of the drive's loops: margins, Bode's and Nyquist's plots, sensitivities, compliance.

use axis_report::{Cell, Figure, Mark, Notice, Page, Section, Series, Table};
use axis_sim::SixDigits;
use drive_loop::{CornerMargins, LoopAnalysis, LoopCurves};

use crate::context::Context;
use crate::program;
use crate::results::Loops;

/// Figures share the frequency.
const FREQUENCY: &str = "frequency";
/// Title of the section of margins.
const MARGINS: &str = "The loop's margins";
/// Nyquist's plot shows gains up to this one.
const SHOWN: f64 = 3.0;

/// The page.
pub fn page(found: &LoopAnalysis) -> Page {
    let page = Page::new(format!("Loops of {}", found.axis))
        .lead("The linear loop of the drive, sampled as in the axis file, with filters, delays and loops at their own rates. Computed, not measured.");
    sections(found)
        .into_iter()
        .fold(page, |page, section| page.section(section))
}

/// Its sections.
pub fn sections(found: &LoopAnalysis) -> Vec<Section> {
    vec![
        margins(found),
        bode(found),
        sensitivity(found),
        compliance(found),
    ]
}

/// The section of the pipeline's report: margins of the model's loops, and the machine's in a line.
pub fn of_pipeline(context: &Context, loops: &Loops) -> Section {
    let found = match &loops.model {
        Ok(found) => found,
        Err(error) => {
            let why = sentence(&error.to_string());
            return Section::new(MARGINS).paragraph(why);
        }
    };
    let section = margins(found).figure(sensitivity_figure(found));
    let machine = match &loops.machine {
        None => None,
        Some(Ok(machine)) => Some(match machine.worst.sensitivity {
            Some(most) => format!(
                "On the machine, {}, the maximum sensitivity over the same cases is {most:.2}.",
                context.machine.name
            ),
            None => format!(
                "On the machine, {}, {} of {} cases are not stable.",
                context.machine.name,
                machine.worst.unstable,
                machine.corners.len()
            ),
        }),
        Some(Err(error)) => Some(sentence(&format!("of the machine: {error}"))),
    };
    let section = machine
        .into_iter()
        .fold(section, |section, line| section.paragraph(line));
    section.paragraph(format!(
        "These are the loops of the drive without compensation. {program} analyse shows them over the frequency; {program} tune finds gains within the limits.",
        program = program::name()
    ))
}

/// Margins of all corners.
pub fn margins(found: &LoopAnalysis) -> Section {
    let margins = Table::new(
        "Margins of each case",
        [
            "case",
            "sensitivity, command",
            "sensitivity, position",
            "late, command",
            "late, position",
            "gain up",
            "gain down",
            "phase, °",
            "delay, ms",
        ],
    )
    .note("Sensitivity: greatest 1/|1 + L|, of the loop cut at the command and of the position loop; late: with one more cycle of delay. Gain, phase and delay: of the loop cut at the command.");
    let others = Table::new(
        "Bandwidths and compliance of each case",
        ["case", "speed, Hz", "position, Hz", "compliance peak"],
    )
    .note("Speed and position: frequencies up to which they follow to −3 dB.");
    let corners = found.corners.iter();
    let [margins, others] = corners.fold([margins, others], |[margins, others], corner| {
        [
            margins.row(margins_of(found, corner)),
            others.row(others_of(found, corner)),
        ]
    });
    let mut section = Section::new(MARGINS);
    section = match found.worst.sensitivity {
        Some(most) => section.notice(
            if most <= 1.605 { Notice::Good } else { Notice::Warn },
            format!("The maximum sensitivity over {} cases is {most:.2}; at 1.6 a drive tolerates what the model lacks, from 2 on it rings.", found.corners.len()),
        ),
        None => section.notice(
            Notice::Warn,
            format!("{} of {} cases are not stable.", found.worst.unstable, found.corners.len()),
        ),
    };
    let section = found
        .notes
        .iter()
        .fold(section, |section, note| section.paragraph(sentence(note)));
    section.table(margins).table(others)
}

/// A line of the terminal as a sentence of a page.
pub fn sentence(line: &str) -> String {
    let mut letters = line.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}

fn number(value: Option<f64>, digits: usize) -> Cell {
    value.map_or(Cell::Missing, |v| Cell::number(v, digits))
}

fn margins_of(found: &LoopAnalysis, m: &CornerMargins) -> [Cell; 9] {
    let sensitivity = |value: Option<f64>, most: f64| match value {
        Some(v) if v > most => Cell::number(v, 2).marked(Mark::Failing),
        Some(v) => Cell::number(v, 2),
        None => Cell::text("not stable"),
    };
    let cut = &m.command;
    [
        Cell::text(place(&m.at, &found.position_unit)),
        sensitivity(m.command.sensitivity, 1.605),
        sensitivity(m.position.sensitivity, 1.605),
        sensitivity(m.command.sensitivity_late, 2.005),
        sensitivity(m.position.sensitivity_late, 2.005),
        number(cut.gain_up, 2),
        number(cut.gain_down, 2),
        number(cut.phase_deg, 1),
        number(cut.delay_s.map(|s| 1e3 * s), 3),
    ]
}

fn others_of(found: &LoopAnalysis, m: &CornerMargins) -> [Cell; 4] {
    [
        Cell::text(place(&m.at, &found.position_unit)),
        number(m.speed_bandwidth_hz, 1),
        number(m.position_bandwidth_hz, 1),
        Cell::quantity(m.compliance_peak, compliance_unit(found), 3),
    ]
}

fn state(curves: &LoopCurves) -> &'static str {
    if curves.stuck { "stuck" } else { "sliding" }
}

fn sizes(values: &[[f64; 2]]) -> Vec<f64> {
    values.iter().map(|[re, im]| re.hypot(*im)).collect()
}

/// Phases in degrees, without jumps.
pub fn phases(values: &[[f64; 2]]) -> Vec<f64> {
    let mut turns = 0.0;
    let mut before: Option<f64> = None;
    let mut all = Vec::with_capacity(values.len());
    for [re, im] in values {
        let phase = im.atan2(*re).to_degrees();
        if let Some(before) = before {
            turns -= 360.0 * ((phase - before) / 360.0).round();
        }
        before = Some(phase);
        all.push(phase + turns);
    }
    all
}

/// Least gain that is drawn, as a share of the greatest, −160 dB: a loop that is sampled more slowly
/// than the control lets nothing through at some frequencies, and an axis down to rounding would hide
/// the rest.
const DRAWN: f64 = 1e-8;

/// The magnitudes over the frequency; what is less than can be drawn stands at the lower edge.
pub fn sized(name: impl Into<String>, frequency_hz: &[f64], values: &[[f64; 2]]) -> Series {
    let sizes = sizes(values);
    let most = sizes.iter().copied().fold(0.0, f64::max);
    let drawn = sizes.iter().map(|size| size.max(DRAWN * most)).collect();
    Series::line(name, frequency_hz.to_vec(), drawn)
}

/// Bode's plots and Nyquist's.
fn bode(found: &LoopAnalysis) -> Section {
    let size = Figure::new("Open loop, cut at the command: gain", "frequency", "gain");
    let phase = Figure::new("Open loop, cut at the command: phase", "frequency", "phase");
    let nyquist = Figure::new("Nyquist's plot", "real part", "imaginary part")
        .caption("The point −1 is where the loop would be unstable; its distance from the curve is the inverse of the maximum sensitivity.");
    let speed = Figure::new(
        "Speed per set point of the speed controller",
        "frequency",
        "gain",
    );
    let mut size = size.units("Hz", "").log_x().log_y().linked(FREQUENCY);
    let mut phase = phase.units("Hz", "°").log_x().linked(FREQUENCY);
    let mut speed = speed.units("Hz", "").log_x().log_y().linked(FREQUENCY);
    let mut has_speed = false;
    let mut nyquist = nyquist.series(Series::dots("−1", vec![-1.0], vec![0.0]));
    for curves in &found.curves {
        let f = || curves.frequency_hz.clone();
        let name = |what: &str| format!("{what}, {}", state(curves));
        for (what, open) in [
            ("whole loop", &curves.open_command),
            ("position loop", &curves.open_position),
        ] {
            size = size.series(sized(name(what), &curves.frequency_hz, open));
            phase = phase.series(Series::line(name(what), f(), phases(open)));
            let near: Vec<[f64; 2]> = open
                .iter()
                .copied()
                .filter(|[re, im]| re.hypot(*im) <= SHOWN)
                .collect();
            nyquist = nyquist.series(Series::line(
                name(what),
                near.iter().map(|v| v[0]).collect(),
                near.iter().map(|v| v[1]).collect(),
            ));
        }
        if !curves.speed_followed.is_empty() {
            has_speed = true;
            speed = speed.series(sized(
                state(curves),
                &curves.frequency_hz,
                &curves.speed_followed,
            ));
        }
    }
    let section = Section::new("Open and closed loop")
        .figure(size)
        .figure(phase)
        .figure(nyquist);
    match has_speed {
        true => section.figure(speed),
        false => section,
    }
}

fn sensitivity(found: &LoopAnalysis) -> Section {
    Section::new("Sensitivity").figure(sensitivity_figure(found))
}

/// 1/|1 + L| of both cuts.
fn sensitivity_figure(found: &LoopAnalysis) -> Figure {
    let mut figure = Figure::new("Sensitivity", "frequency", "1/|1 + L|")
        .units("Hz", "")
        .log_x()
        .log_y()
        .linked(FREQUENCY);
    for curves in &found.curves {
        for (what, open) in [
            ("command", &curves.open_command),
            ("position", &curves.open_position),
        ] {
            let of = open.iter().map(|[re, im]| 1.0 / (re + 1.0).hypot(*im));
            figure = figure.series(Series::line(
                format!("at the {what}, {}", state(curves)),
                curves.frequency_hz.clone(),
                of.collect(),
            ));
        }
    }
    figure
}

fn compliance(found: &LoopAnalysis) -> Section {
    let mut figure = Figure::new("Compliance at the load", "frequency", "motion per force")
        .units("Hz", compliance_unit(found))
        .log_x()
        .log_y()
        .linked(FREQUENCY);
    for curves in &found.curves {
        figure = figure.series(sized(
            state(curves),
            &curves.frequency_hz,
            &curves.compliance,
        ));
    }
    Section::new("Compliance")
        .paragraph("How far the load gives way to a force on it, the loops closed.")
        .figure(figure)
}

/// A corner in words.
pub fn place(at: &drive_loop::Corner, unit: &str) -> String {
    let state = if at.stuck { "stuck" } else { "sliding" };
    let mut text = format!("{state} at {} {unit}", SixDigits(at.position));
    for (what, share) in [("mass", at.mass), ("friction", at.friction)] {
        if share != 1.0 {
            text += &format!(", {what} × {}", SixDigits(share));
        }
    }
    text
}

/// m/N or rad/(N·m).
pub fn compliance_unit(found: &LoopAnalysis) -> String {
    match found.force_unit.as_str() {
        "N" => format!("{}/N", found.position_unit),
        other => format!("{}/({other})", found.position_unit),
    }
}
