//! The page of logs.

use axis_log::quality::{ChannelQuality, CrossCheckVerdict};
use axis_report::{Cell, Figure, Notice, Page, Section, Series, Table};

use super::words::{file_words, heading};
use super::{Seen, SeenLog};
use crate::page::channel;

/// The page of one log.
pub fn of_one(seen: &Seen) -> Page {
    sections(
        seen,
        Page::new(format!("Log {}", channel::files(&seen.name))),
    )
}

/// One page of all logs.
pub fn of_all(seen: &[Seen]) -> Page {
    let names: Vec<String> = seen.iter().map(|seen| channel::files(&seen.name)).collect();
    let page = Page::new(format!("Logs {}", names.join(", ")));
    seen.iter().fold(page, |page, seen| sections(seen, page))
}

/// A value for a table: four digits, whatever its size.
fn short(value: f64, unit: &str) -> Cell {
    Cell::quantity(value, unit, 4)
}

/// The sections of what was asked for.
fn sections(seen: &Seen, page: Page) -> Page {
    match &seen.log {
        Ok(log) => of_log(&seen.name, log, page),
        Err(lacks) => {
            let files = seen.files.iter();
            let section = Section::new(format!("{}: {lacks}", channel::files(&seen.name)));
            page.section(files.fold(section, |section, (path, file)| {
                section.paragraph(file_words(path, file))
            }))
        }
    }
}

/// The sections of a log.
fn of_log(name: &str, seen: &SeenLog, page: Page) -> Page {
    let mut checks = Section::new("What was done, and how channels agree with each other");
    for line in &seen.done {
        checks = checks.notice(Notice::Info, line);
    }
    for f in &seen.findings {
        let kind = match f.verdict {
            CrossCheckVerdict::Agrees => Notice::Good,
            CrossCheckVerdict::Unclear | CrossCheckVerdict::Contradicts => Notice::Warn,
        };
        let lines = f.lines().map_or(String::new(), |l| {
            format!(" Proposed: {}", l.replace('\n', "  "))
        });
        checks = checks.notice(kind, format!("{f}.{lines}"));
    }
    let mut figures = Section::new("Channels");
    for (quality, channel) in seen.channels.iter().zip(&seen.log.channels()[1..]) {
        let (time, samples) = (seen.log.time().to_vec(), channel.samples.clone());
        let words = channel::words(&channel.name);
        let mut figure = Figure::new(format!("{words} ({})", channel.name), "time", &words)
            .units("s", &channel.unit)
            .linked(name)
            .series(Series::line(&words, time, samples))
            .caption(quality.to_string());
        // A straight line stands in a gap.
        let marked = seen.log.missing(&channel.name).iter().cloned().flatten();
        let (t, y): (Vec<f64>, Vec<f64>) = marked
            .map(|k| (seen.log.time()[k], channel.samples[k]))
            .unzip();
        if !t.is_empty() {
            figure = figure.series(Series::dots("gap: not measured", t, y));
        }
        figures = figures.figure(figure);
    }
    let title = format!("Log {}: table of channels", channel::files(name));
    page.section(
        Section::new(title)
            .paragraph(heading(name, seen))
            .table(table(seen)),
    )
    .section(checks)
    .section(figures)
}

/// Share of a channel's greatest value below which noise is that of rounding: files have nine digits
/// or more.
const ROUNDING: f64 = 1e-9;

fn table(seen: &SeenLog) -> Table {
    let heads = [
        "channel",
        "unit",
        "least",
        "greatest",
        "missing",
        "noise",
        "step",
        "held",
        "filtered from",
        "delay",
    ];
    // The residual of a channel without noise is rounding: it says nothing, and would be shown in a unit of its own (pm).
    let noise = |c: &ChannelQuality| {
        let greatest = c.range[0].abs().max(c.range[1].abs());
        let level = c.noise.map(|n| n.level);
        level.filter(|level| *level > ROUNDING * greatest)
    };
    let optional = |value: Option<f64>, unit: &str| value.map_or(Cell::Missing, |v| short(v, unit));
    let row = |table: Table, c: &ChannelQuality| {
        table.row([
            Cell::text(&c.name),
            Cell::text(&c.unit),
            short(c.range[0], &c.unit),
            short(c.range[1], &c.unit),
            Cell::text(c.missing[0].to_string()),
            optional(noise(c), &c.unit),
            optional(c.quantum.map(|q| q.step), &c.unit),
            optional(c.hold.map(|h| h.period), "s"),
            optional(c.corner, "Hz"),
            optional(c.delay.as_ref().map(|d| d.seconds), "s"),
        ])
    };
    seen.channels
        .iter()
        .fold(Table::new("Channels as they were read", heads), row)
}
