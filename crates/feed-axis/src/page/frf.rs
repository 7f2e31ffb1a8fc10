//! The page of measured frequency responses.

use axis_log::PlusMinus;
use axis_report::{Cell, Figure, Notice, Page, Section, Series, Table, engineering};
use axis_sim::Axis;
use drive_loop::{ComplianceLine, MeasuredDrive, WithDeviation};

use super::loops::{phases, sentence, sized};

/// Figures share the frequency.
const FREQUENCY: &str = "frequency";

/// The page.
pub fn page(axis: &Axis, all: &[MeasuredDrive]) -> Page {
    let page = Page::new(format!("Frequency responses of {}", axis.name)).lead(
        "Estimated from logs of the excited axis, beside the model of the axis file with its load sliding at the same place.",
    );
    let page = page
        .section(margins(all))
        .section(modes(all))
        .section(compliance(all));
    all.iter()
        .fold(page, |page, found| page.section(response(found)))
}

fn place(found: &MeasuredDrive) -> String {
    engineering(found.position, &found.position_unit, 4)
}

fn pair(of: WithDeviation, scale: f64, digits: usize) -> Cell {
    let (value, deviation) = (scale * of.value, scale * of.deviation);
    let pair = PlusMinus::new(value, deviation, digits).to_string();
    // The page's minus sign.
    Cell::text(pair.replacen('-', "\u{2212}", usize::from(value < 0.0)))
}

fn margins(all: &[MeasuredDrive]) -> Section {
    let mut table = Table::new(
        "Maximum sensitivity with the gains of the file, and delay beside the model's",
        ["load at", "from the command", "from the responses", "model", "position loop", "delay, ms"],
    )
    .note("From the command: its answer to the excitation is 1/(1 + L). From the responses: the file's controller with the measured drive. ± is a standard deviation.");
    let mut section = Section::new("Margins");
    for found in all {
        let m = found.margins.as_ref();
        let number = |value: Option<f64>| value.map_or(Cell::Missing, |v| Cell::number(v, 3));
        let delay = found.comparison.as_ref().map(|c| c.delay_s);
        table = table.row([
            Cell::text(place(found)),
            m.map_or(Cell::Missing, |m| pair(m.sensitivity, 1.0, 3)),
            m.map_or(Cell::Missing, |m| pair(m.by_response, 1.0, 3)),
            number(m.and_then(|m| m.model)),
            number(m.map(|m| m.position)),
            delay.map_or(Cell::Missing, |d| pair(d, 1e3, 4)),
        ]);
        for trap in &found.traps {
            let text = format!("At {}: {}.", place(found), trap.what);
            section = section.notice(Notice::Warn, text);
        }
        let said = found.comparison.iter().flat_map(|c| &c.said);
        for line in said.chain(&found.notes) {
            section = section.paragraph(sentence(line));
        }
    }
    section.table(table)
}

fn modes(all: &[MeasuredDrive]) -> Section {
    let mut table = Table::new(
        "Modes of the motor's speed",
        ["load at", "frequency, Hz", "damping, %", "model, Hz"],
    );
    for found in all {
        let compared = found.comparison.as_ref();
        for mode in found.fit.iter().flat_map(|fit| &fit.modes) {
            let same = compared.and_then(|c| {
                let mut modes = c.modes.iter();
                modes.find(|m| m.measured_hz == mode.frequency_hz)?.model_hz
            });
            table = table.row([
                Cell::text(place(found)),
                pair(mode.frequency_hz, 1.0, 2),
                pair(mode.damping, 100.0, 2),
                same.map_or(Cell::Missing, |f| Cell::number(f, 2)),
            ]);
        }
    }
    Section::new("Modes").table(table)
}

/// The compliance at the load, or why there is none.
fn compliance(all: &[MeasuredDrive]) -> Section {
    let mut table = Table::new(
        "Compliance at the load with the gains of the file, from the responses",
        ["load at", "greatest", "at, Hz", "model", "RMS", "model"],
    )
    .note("RMS over the logarithm of the frequency, of the lines up to 300 Hz. ± is a standard deviation.");
    let mut section = Section::new("Compliance");
    let mut figures = Vec::new();
    for found in all {
        let Some(c) = &found.compliance else {
            let why = found.compliance_missing.as_deref().unwrap_or_default();
            section = section.paragraph(sentence(&format!("at {}: none, as {why}", place(found))));
            continue;
        };
        let unit = match found.position_unit.as_str() {
            "m" => "nm/N",
            _ => "nrad/(N·m)",
        };
        table = table.row([
            Cell::text(format!("{} ({unit})", place(found))),
            pair(c.peak, 1e9, 3),
            Cell::number(c.peak_at_hz, 2),
            Cell::number(1e9 * c.model[0], 3),
            pair(c.rms, 1e9, 3),
            Cell::number(1e9 * c.model[1], 3),
        ]);
        for note in &c.notes {
            section = section.paragraph(sentence(note));
        }
        let f: Vec<f64> = c.lines.iter().map(|l| l.frequency_hz).collect();
        let values = |of: fn(&ComplianceLine) -> [f64; 2]| -> Vec<[f64; 2]> {
            let all = c.lines.iter().map(of);
            all.map(|[re, im]| [1e9 * re, 1e9 * im]).collect()
        };
        figures.push(
            Figure::new(
                format!("Compliance with the load at {}", place(found)),
                "frequency",
                "compliance",
            )
            .units("Hz", unit)
            .log_x()
            .log_y()
            .linked(FREQUENCY)
            .series(sized("from the responses", &f, &values(|l| l.value)))
            .series(sized("model", &f, &values(|l| l.model)).dashed()),
        );
    }
    let section = section.table(table);
    figures.into_iter().fold(section, Section::figure)
}

fn response(found: &MeasuredDrive) -> Section {
    let lines: Vec<_> = found.motor_speed.iter().collect();
    let counted: Vec<_> = lines
        .iter()
        .filter(|l| l.coherence >= found.coherence)
        .collect();
    let f: Vec<f64> = counted.iter().map(|l| l.frequency_hz).collect();
    let values: Vec<[f64; 2]> = counted.iter().map(|l| l.value).collect();
    let all_f: Vec<f64> = lines.iter().map(|l| l.frequency_hz).collect();
    let unit = format!("rad/s/{}", found.command_unit);
    let magnitude = Figure::new(
        "Command to motor speed: magnitude",
        "frequency",
        "magnitude",
    )
    .units("Hz", unit)
    .log_x()
    .log_y()
    .linked(FREQUENCY)
    .series(sized("measured", &f, &values))
    .series(sized("model", &all_f, &found.motor_speed_model).dashed());
    let phase = Figure::new("Command to motor speed: phase", "frequency", "phase")
        .units("Hz", "°")
        .log_x()
        .linked(FREQUENCY)
        .series(Series::line("measured", f, phases(&values)))
        .series(Series::line("model", all_f.clone(), phases(&found.motor_speed_model)).dashed());
    let coherence = lines.iter().map(|l| l.coherence).collect();
    let share = lines
        .iter()
        .map(|l| (100.0 * l.deviation / l.value[0].hypot(l.value[1])).min(1e3))
        .collect();
    let coherence = Figure::new("Coherence", "frequency", "coherence")
        .units("Hz", "")
        .log_x()
        .linked(FREQUENCY)
        .series(Series::line("coherence", all_f.clone(), coherence));
    let deviation = Figure::new("Standard deviation", "frequency", "deviation")
        .units("Hz", "%")
        .log_x()
        .log_y()
        .linked(FREQUENCY)
        .series(Series::line("deviation", all_f, share));
    Section::new(format!("Response with the load at {}", place(found)))
        .paragraph(sentence(&found.method))
        .figure(magnitude)
        .figure(phase)
        .figure(coherence)
        .figure(deviation)
}
