//! What `log` says: for people, and as JSON.

use std::fmt;
use std::path::{Path, PathBuf};

use axis_log::quality::{ChannelQuality, Colour, CrossCheckVerdict};
use axis_log::{AxisProposal, Channel, ColumnSummary, FileSummary, MappingProposal};
use serde::Serialize;

use super::{Seen, SeenLog};

/// Logs as they were seen, and the pages that show them.
#[derive(Serialize)]
pub struct Inspected<'a> {
    logs: Vec<OneLog<'a>>,
    pages: Vec<&'a PathBuf>,
}

/// One log, or what is none yet.
#[derive(Serialize)]
struct OneLog<'a> {
    #[serde(skip)]
    seen: &'a Seen,
    name: &'a str,
    /// Its files, before any mapping.
    files: Vec<OneFile<'a>>,
    /// What it lacks to be a log; what follows is then 0 or empty.
    lacks: Option<&'a str>,
    samples: usize,
    rate_hz: f64,
    duration_s: f64,
    /// Greatest distance of an instant from the even grid, in periods.
    jitter_periods: f64,
    /// Rows missing between time stamps that were not put back.
    missing_rows: usize,
    done: &'a [String],
    channels: Vec<OneChannel<'a>>,
    findings: Vec<Found>,
    /// Files with more than their channels, and what their mapping could have besides.
    imported: Vec<Imported<'a>>,
    /// What the files hold, where no column is a channel yet.
    columns: Vec<OneColumn<'a>>,
}

/// A file as it is before any mapping.
#[derive(Serialize)]
struct OneFile<'a> {
    name: String,
    looks_like: &'a str,
    rows: usize,
    columns: usize,
}

/// A column as its file has it.
#[derive(Serialize)]
struct OneColumn<'a> {
    name: &'a str,
    /// Where the file has one beside the name.
    unit: Option<&'a str>,
    least: f64,
    greatest: f64,
    mean: f64,
    /// Of the rows.
    numbers: usize,
}

/// A file with more than its channels.
#[derive(Serialize)]
struct Imported<'a> {
    format: &'static str,
    /// Lines for the axis file; none if all is mapped.
    proposed: Option<String>,
    /// The sampling rate that the file has so.
    rate_hz: Option<f64>,
    /// Which axis the lines are of, where the file holds several.
    axis: Option<&'a str>,
    /// The other axes, to be chosen instead.
    other_axes: Vec<OtherAxis<'a>>,
    /// What the numbers say of names and units.
    remarks: &'a [String],
    /// Columns of which the name does not tell what they are.
    others: &'a [String],
    caution: &'static str,
}

/// Another axis of a file.
#[derive(Serialize)]
struct OtherAxis<'a> {
    axis: &'a str,
    /// Lines for the axis file.
    proposed: String,
}

/// One channel; what has no unit in its name is in the channel's.
#[derive(Serialize)]
struct OneChannel<'a> {
    name: &'a str,
    unit: &'a str,
    least: f64,
    greatest: f64,
    mean: f64,
    rms: f64,
    missing_samples: usize,
    gaps: Vec<Gap>,
    outliers: usize,
    /// How often it changes, where that is more slowly than it is recorded.
    update_rate_hz: Option<f64>,
    /// Quantisation.
    step: Option<f64>,
    /// Standard deviation.
    noise: Option<f64>,
    /// white, falling or rising.
    noise_colour: Option<&'static str>,
    /// From where on its spectrum falls off.
    filtered_from_hz: Option<f64>,
    /// Standard deviation of the samples' instants about their even stamps.
    sample_jitter_s: Option<f64>,
    delay_s: Option<f64>,
    delay_against: Option<&'a str>,
    /// Limits that it runs into.
    stays_at: Vec<f64>,
}

/// Samples in a row that are missing.
#[derive(Serialize)]
struct Gap {
    from_s: f64,
    to_s: f64,
    samples: usize,
}

/// What two channels say of each other.
#[derive(Serialize)]
struct Found {
    /// agrees, unclear or contradicts.
    verdict: &'static str,
    what: String,
    /// Lines for the axis file that would correct it.
    proposed: Option<String>,
}

impl<'a> Inspected<'a> {
    /// Of logs and the pages that were written.
    pub fn of(seen: &'a [Seen], pages: impl Iterator<Item = &'a PathBuf>) -> Self {
        Self {
            logs: seen.iter().map(OneLog::of).collect(),
            pages: pages.collect(),
        }
    }
}

impl<'a> OneLog<'a> {
    fn of(seen: &'a Seen) -> Self {
        let file = |(path, file): &'a (PathBuf, FileSummary)| OneFile {
            name: path.display().to_string(),
            looks_like: &file.looks_like,
            rows: file.rows,
            columns: file.all_columns,
        };
        let empty = Self {
            seen,
            name: &seen.name,
            files: seen.files.iter().map(file).collect(),
            lacks: seen.log.as_ref().err().map(String::as_str),
            samples: 0,
            rate_hz: 0.0,
            duration_s: 0.0,
            jitter_periods: 0.0,
            missing_rows: 0,
            done: &[],
            channels: Vec::new(),
            findings: Vec::new(),
            imported: seen.proposals.iter().map(Imported::of).collect(),
            columns: Vec::new(),
        };
        let all = seen.files.iter().flat_map(|(_, file)| &file.columns);
        let columns = || all.clone().map(OneColumn::of).collect();
        let Ok(log) = &seen.log else {
            return Self {
                columns: columns(),
                ..empty
            };
        };
        let channels = log.channels.iter().zip(&log.log.channels()[1..]);
        let found = |finding: &axis_log::quality::Finding| Found {
            verdict: match finding.verdict {
                CrossCheckVerdict::Agrees => "agrees",
                CrossCheckVerdict::Unclear => "unclear",
                CrossCheckVerdict::Contradicts => "contradicts",
            },
            what: finding.to_string(),
            proposed: finding.lines(),
        };
        Self {
            samples: log.log.len(),
            rate_hz: 1.0 / log.clock.period,
            duration_s: log.clock.period * (log.log.len() - 1) as f64,
            jitter_periods: log.clock.jitter,
            missing_rows: log.clock.missing_rows,
            done: &log.done,
            channels: channels.map(|(q, c)| OneChannel::of(log, q, c)).collect(),
            findings: log.findings.iter().map(found).collect(),
            columns: match log.channels.is_empty() {
                true => columns(),
                false => Vec::new(),
            },
            ..empty
        }
    }
}

impl<'a> OneColumn<'a> {
    fn of(column: &'a ColumnSummary) -> Self {
        Self {
            name: &column.name,
            unit: column.unit.as_deref(),
            least: column.least,
            greatest: column.greatest,
            mean: column.mean,
            numbers: column.numbers,
        }
    }

    /// The cells of its row.
    fn cells(&self) -> [String; 6] {
        let number = |value: f64| format!("{value:.4e}");
        [
            self.name.to_owned(),
            self.unit.unwrap_or("?").to_owned(),
            number(self.least),
            number(self.greatest),
            number(self.mean),
            self.numbers.to_string(),
        ]
    }
}

/// Columns of a file that are no channels yet.
struct Columns<'a>(&'a [OneColumn<'a>]);

impl fmt::Display for Columns<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let heads = ["column", "unit", "least", "greatest", "mean", "numbers"];
        let mut rows = vec![heads.map(str::to_owned)];
        rows.extend(self.0.iter().map(OneColumn::cells));
        table(f, &rows)
    }
}

/// What a file is, in a line.
pub fn file_words(path: &Path, file: &FileSummary) -> String {
    let plural = |n: usize| if n == 1 { "" } else { "s" };
    format!(
        "{}: {}; {} row{}, {} column{}",
        path.display(),
        file.looks_like,
        file.rows,
        plural(file.rows),
        file.all_columns,
        plural(file.all_columns)
    )
}

impl<'a> Imported<'a> {
    fn of(proposal: &'a MappingProposal) -> Self {
        let lines = proposal.lines();
        let other = |axis: &'a AxisProposal| OtherAxis {
            axis: &axis.axis,
            proposed: axis.lines(),
        };
        Self {
            format: proposal.format,
            proposed: (!lines.is_empty()).then_some(lines),
            rate_hz: proposal.rate_hz,
            axis: proposal.axis.as_deref(),
            other_axes: proposal.other_axes.iter().map(other).collect(),
            remarks: &proposal.remarks,
            others: &proposal.others,
            caution: proposal.caution,
        }
    }
}

impl fmt::Display for Imported<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.format, self.caution)?;
        let mut remarks = self.remarks.iter();
        remarks.try_for_each(|remark| writeln!(f, "- {remark}"))?;
        if !self.others.is_empty() {
            writeln!(f, "not known by name: {}", self.others.join(", "))?;
        }
        let at = match self.rate_hz {
            Some(rate) => format!(", {rate:.4} Hz"),
            None => String::new(),
        };
        match (&self.proposed, self.axis) {
            (Some(lines), None) => writeln!(f, "  proposed, for the axis file{at}:\n{lines}")?,
            (Some(lines), Some(axis)) => writeln!(
                f,
                "  proposed, for the axis file{at}; the file holds several axes, choose one.\n  Axis {axis}:\n{lines}"
            )?,
            (None, _) => {}
        }
        let mut others = self.other_axes.iter();
        others.try_for_each(|other| writeln!(f, "  or axis {}:\n{}", other.axis, other.proposed))
    }
}

impl<'a> OneChannel<'a> {
    fn of(seen: &SeenLog, quality: &'a ChannelQuality, channel: &Channel) -> Self {
        let time = seen.log.time();
        let gaps = seen.log.missing(&channel.name).iter().map(|gap| Gap {
            from_s: time[gap.start],
            to_s: time[gap.end - 1],
            samples: gap.len(),
        });
        let count = channel.samples.len() as f64;
        let mean = channel.samples.iter().sum::<f64>() / count;
        let square = channel.samples.iter().map(|x| x * x).sum::<f64>() / count;
        let delay = quality.delay.as_ref();
        Self {
            name: &quality.name,
            unit: &quality.unit,
            least: quality.range[0],
            greatest: quality.range[1],
            mean,
            rms: square.sqrt(),
            missing_samples: quality.missing[0],
            gaps: gaps.collect(),
            outliers: quality.outliers,
            update_rate_hz: quality.hold.map(|hold| 1.0 / hold.period),
            step: quality.quantum.map(|quantum| quantum.step),
            noise: quality.noise.map(|noise| noise.level),
            noise_colour: quality.noise.map(|noise| match noise.colour {
                Colour::White => "white",
                Colour::Falling => "falling",
                Colour::Rising => "rising",
            }),
            filtered_from_hz: quality.corner,
            sample_jitter_s: quality.jitter.map(|jitter| jitter.rms),
            delay_s: delay.map(|delay| delay.seconds),
            delay_against: delay.map(|delay| delay.against.as_str()),
            stays_at: quality.saturation.iter().map(|s| s.value).collect(),
        }
    }

    /// The cells of its row.
    fn cells(&self) -> [String; 9] {
        let number = |value: f64| format!("{value:.4e}");
        let optional = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), number);
        let missing = match self.missing_samples {
            0 => "-".to_owned(),
            count => format!("{count} in {}", self.gaps.len()),
        };
        [
            self.name.to_owned(),
            if self.unit.is_empty() { "?" } else { self.unit }.to_owned(),
            number(self.least),
            number(self.greatest),
            number(self.mean),
            missing,
            optional(self.update_rate_hz),
            optional(self.step),
            optional(self.noise),
        ]
    }
}

/// Heads of the table.
const HEADS: [&str; 9] = [
    "channel",
    "unit",
    "least",
    "greatest",
    "mean",
    "missing",
    "changes, Hz",
    "step",
    "noise",
];

/// Sampling of a log, in a line.
pub fn heading(name: &str, seen: &SeenLog) -> String {
    let c = &seen.clock;
    format!(
        "{name}: {} samples at {:.4} Hz, {:.3} s; jitter up to {:.2} % of a period ({:.3} % RMS)",
        seen.log.len(),
        1.0 / c.period,
        c.period * (seen.log.len() - 1) as f64,
        100.0 * c.jitter,
        100.0 * c.jitter_rms
    )
}

impl fmt::Display for OneLog<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut files = self.seen.files.iter();
        files.try_for_each(|(path, file)| writeln!(f, "{}", file_words(path, file)))?;
        match &self.seen.log {
            Ok(log) => self.log(f, log)?,
            Err(lacks) => writeln!(f, "{lacks}\n\n{}", Columns(&self.columns))?,
        }
        self.imported
            .iter()
            .try_for_each(|file| write!(f, "{file}"))
    }
}

impl OneLog<'_> {
    fn log(&self, f: &mut fmt::Formatter<'_>, log: &SeenLog) -> fmt::Result {
        writeln!(f, "{}", heading(self.name, log))?;
        self.done
            .iter()
            .try_for_each(|line| writeln!(f, "- {line}"))?;
        let mut rows = vec![HEADS.map(str::to_owned)];
        rows.extend(self.channels.iter().map(OneChannel::cells));
        writeln!(f)?;
        match self.channels.is_empty() {
            true => writeln!(
                f,
                "no column is a channel yet: give it a name that ends in its unit, or a mapping\n\n{}",
                Columns(&self.columns)
            )?,
            false => table(f, &rows)?,
        }
        writeln!(f)?;
        let mut channels = log.channels.iter();
        channels.try_for_each(|c| writeln!(f, "{c}"))?;
        for found in &self.findings {
            let word = match found.verdict {
                "contradicts" => "CONTRADICTS",
                other => other,
            };
            writeln!(f, "{word}: {}", found.what)?;
            if let Some(lines) = &found.proposed {
                writeln!(f, "  proposed, for the axis file:\n{lines}")?;
            }
        }
        Ok(())
    }
}

/// Rows with their columns below each other: words to the left, numbers to the right.
fn table<const N: usize>(f: &mut fmt::Formatter<'_>, rows: &[[String; N]]) -> fmt::Result {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: [usize; N] = std::array::from_fn(|column| width(column).unwrap_or(0));
    for row in rows {
        let cell = |(i, (cell, width)): (usize, (&String, usize))| match i {
            0 | 1 => format!("{cell:<width$}"),
            _ => format!("{cell:>width$}"),
        };
        let cells: Vec<String> = row.iter().zip(widths).enumerate().map(cell).collect();
        writeln!(f, "{}", cells.join("  ").trim_end())?;
    }
    Ok(())
}

impl fmt::Display for Inspected<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, log) in self.logs.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{log}")?;
        }
        let mut pages = self.pages.iter();
        pages.try_for_each(|page| write!(f, "\n{}", page.display()))
    }
}
