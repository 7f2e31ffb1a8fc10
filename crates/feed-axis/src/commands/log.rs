//! `log`: what a drive's log holds, how good it is, and what its mapping should be.

use std::path::{Path, PathBuf};

use axis_log::intake::{Options as Intake, prepare};
use axis_log::quality::{
    ChannelQuality, Clock, Finding, Law, Relation, Verdict, channel_quality, clock, cross_check,
};
use axis_log::{Log, Mapping};
use axis_sim::Axis;
use clap::Args;
use discrepancy::logs::{exact_channels, relations};
use miette::{IntoDiagnostic, Result, miette};
use report::{Cell, Figure, Notice, Page, Section, Series, Table, render};

use super::discover::files;
use crate::output::{say, write_whole};

/// Options of `log`.
#[derive(Args)]
pub struct Options {
    /// Logs: CSV, Parquet or MAT v5; several files of one log with + between
    #[arg(required = true, value_name = "FILE")]
    logs: Vec<PathBuf>,
    /// Axis file: its `[log]` maps columns, its sizes tell what channels should be of each other
    #[arg(long, value_name = "FILE")]
    axis: Option<PathBuf>,
    /// Sampling rate of the log, Hz [default: that of its slowest file]
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Folder for the page of each log
    #[arg(long, value_name = "DIR", default_value = "runs/logs")]
    out: PathBuf,
}

/// A log and all that was found.
struct Seen {
    name: String,
    log: Log,
    clock: Clock,
    done: Vec<String>,
    channels: Vec<ChannelQuality>,
    findings: Vec<Finding>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let axis = options.axis.as_deref().map(Axis::read).transpose()?;
    for path in &options.logs {
        let seen = look(path, axis.as_ref(), options.rate)?;
        tell(&seen)?;
        let stem = |p: &PathBuf| p.file_stem().map(|s| s.to_string_lossy().into_owned());
        let stems: Vec<String> = files(path).iter().filter_map(stem).collect();
        let page = options.out.join(stems.join("+") + ".html");
        write_whole(
            &page,
            render(&self::page(&seen)).into_diagnostic()?.as_bytes(),
        )?;
        say(format!("\n{}", page.display()))?;
    }
    Ok(())
}

fn look(path: &Path, axis: Option<&Axis>, rate_hz: Option<f64>) -> Result<Seen> {
    let none = Mapping::default();
    let mapping = axis.map_or(&none, |a| &a.log);
    let exact = axis.map(exact_channels).unwrap_or_default();
    let options = Intake {
        exact: &exact,
        rate_hz,
    };
    let prepared = prepare(&files(path), mapping, &[], options).into_diagnostic()?;
    let log = prepared.log;
    let clock = clock(&log).ok_or_else(|| {
        miette!(
            "{}: a single sample; at least two are needed",
            path.display()
        )
    })?;
    let relations = match axis {
        Some(axis) => relations(&log, axis),
        None => by_name(&log),
    };
    let against = |name: &str| {
        let with = relations.iter().find(|r| {
            r.channel == name && matches!(r.law, Law::Same | Law::Follows) && log.has(&r.from)
        });
        with.map(|r| r.from.as_str())
    };
    let names = log.channels()[1..].iter().map(|c| c.name.as_str());
    let channels = names.map(|name| channel_quality(&log, name, against(name)));
    Ok(Seen {
        name: path.display().to_string(),
        clock,
        done: prepared.done.iter().map(ToString::to_string).collect(),
        channels: channels.collect::<Result<_, _>>().into_diagnostic()?,
        findings: cross_check(&log, mapping, &relations),
        log,
    })
}

/// Relations that names and units alone tell.
fn by_name(log: &Log) -> Vec<Relation> {
    let one = Law::Integral { factor: 1.0 };
    let all = [
        Relation::new("position_m", "position_ref_m", Law::Same),
        Relation::new("position_rad", "position_ref_rad", Law::Same),
        Relation::new("position_m", "velocity_m_s", one),
        Relation::new("position_rad", "velocity_rad_s", one),
        Relation::new("motor_angle_rad", "motor_speed_rad_s", one),
        Relation::new("iq_a", "iq_ref_a", Law::Follows),
    ];
    let there = |r: &Relation| log.has(&r.channel) && log.has(&r.from);
    all.into_iter().filter(there).collect()
}

fn heading(seen: &Seen) -> String {
    let c = &seen.clock;
    format!(
        "{}: {} samples at {:.4} Hz, {:.3} s; jitter up to {:.2} % of a period ({:.3} % RMS)",
        seen.name,
        seen.log.len(),
        1.0 / c.period,
        c.period * (seen.log.len() - 1) as f64,
        100.0 * c.jitter,
        100.0 * c.jitter_rms
    )
}

fn tell(seen: &Seen) -> Result<()> {
    say(heading(seen))?;
    seen.done
        .iter()
        .try_for_each(|line| say(format!("- {line}")))?;
    seen.channels.iter().try_for_each(|c| say(c.to_string()))?;
    for finding in &seen.findings {
        let word = match finding.verdict {
            Verdict::Agrees => "agrees",
            Verdict::Unsure => "unsure",
            Verdict::Contradicts => "CONTRADICTS",
        };
        say(format!("{word}: {finding}"))?;
        if let Some(lines) = finding.lines() {
            say(format!("  proposed, for the axis file:\n{lines}"))?;
        }
    }
    Ok(())
}

/// A number for a table: four digits, whatever its size.
fn short(value: f64) -> Cell {
    Cell::scientific(value, 3)
}

fn page(seen: &Seen) -> Page {
    let mut checks = Section::new("What was done, and what channels say of each other");
    for line in &seen.done {
        checks = checks.notice(Notice::Info, line);
    }
    for f in &seen.findings {
        let kind = match f.verdict {
            Verdict::Agrees => Notice::Good,
            Verdict::Unsure | Verdict::Contradicts => Notice::Warn,
        };
        let lines = f.lines().map_or(String::new(), |l| {
            format!(" Proposed: {}", l.replace('\n', "  "))
        });
        checks = checks.notice(kind, format!("{f}.{lines}"));
    }
    let mut figures = Section::new("Channels");
    for (quality, channel) in seen.channels.iter().zip(&seen.log.channels()[1..]) {
        let (time, samples) = (seen.log.time().to_vec(), channel.samples.clone());
        let mut figure = Figure::new(
            &channel.name,
            "t (s)",
            format!("{} ({})", channel.name, channel.unit),
        )
        .series(Series::line(&channel.name, time, samples))
        .caption(quality.to_string());
        let marked = seen.log.missing(&channel.name).iter().cloned().flatten();
        let (t, y): (Vec<f64>, Vec<f64>) = marked
            .map(|k| (seen.log.time()[k], channel.samples[k]))
            .unzip();
        if !t.is_empty() {
            figure = figure.series(Series::dots("not measured", t, y));
        }
        figures = figures.figure(figure);
    }
    Page::new(format!("Log {}", seen.name))
        .lead(heading(seen))
        .section(Section::new("Table of channels").table(table(seen)))
        .section(checks)
        .section(figures)
}

fn table(seen: &Seen) -> Table {
    let heads = [
        "channel",
        "unit",
        "least",
        "greatest",
        "missing",
        "noise",
        "step",
        "held, ms",
        "filtered from, Hz",
        "delay, ms",
    ];
    let optional = |value: Option<f64>| value.map_or(Cell::Missing, short);
    let row = |table: Table, c: &ChannelQuality| {
        table.row([
            Cell::text(&c.name),
            Cell::text(&c.unit),
            short(c.range[0]),
            short(c.range[1]),
            Cell::text(c.missing[0].to_string()),
            optional(c.noise.map(|n| n.level)),
            optional(c.quantum.map(|q| q.step)),
            optional(c.hold.map(|h| 1e3 * h.period)),
            optional(c.corner),
            optional(c.delay.as_ref().map(|d| 1e3 * d.seconds)),
        ])
    };
    seen.channels
        .iter()
        .fold(Table::new("Channels as they were read", heads), row)
}
