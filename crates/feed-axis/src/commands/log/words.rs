//! What `log` says: for people, and as JSON.

use std::fmt;
use std::path::PathBuf;

use axis_log::quality::{ChannelQuality, Colour, CrossCheckVerdict};
use axis_log::{Channel, ColumnSummary, MappingProposal};
use serde::Serialize;

use super::Seen;

/// Logs as they were seen, and the pages that show them.
#[derive(Serialize)]
pub struct Inspected<'a> {
    logs: Vec<OneLog<'a>>,
    pages: Vec<&'a PathBuf>,
}

/// One log.
#[derive(Serialize)]
struct OneLog<'a> {
    #[serde(skip)]
    seen: &'a Seen,
    name: &'a str,
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
    /// Lines for the axis file; none where all is mapped.
    proposed: Option<String>,
    /// Columns of which the name does not tell what they are.
    others: &'a [String],
    caution: &'static str,
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
    /// agrees, unsure or contradicts.
    verdict: &'static str,
    what: String,
    /// Lines for the axis file that would mend it.
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
        let channels = seen.channels.iter().zip(&seen.log.channels()[1..]);
        let found = |finding: &axis_log::quality::Finding| Found {
            verdict: match finding.verdict {
                CrossCheckVerdict::Agrees => "agrees",
                CrossCheckVerdict::Unsure => "unsure",
                CrossCheckVerdict::Contradicts => "contradicts",
            },
            what: finding.to_string(),
            proposed: finding.lines(),
        };
        Self {
            seen,
            name: &seen.name,
            samples: seen.log.len(),
            rate_hz: 1.0 / seen.clock.period,
            duration_s: seen.clock.period * (seen.log.len() - 1) as f64,
            jitter_periods: seen.clock.jitter,
            missing_rows: seen.clock.missing_rows,
            done: &seen.done,
            channels: channels.map(|(q, c)| OneChannel::of(seen, q, c)).collect(),
            findings: seen.findings.iter().map(found).collect(),
            imported: seen.proposals.iter().map(Imported::of).collect(),
            columns: seen.columns.iter().map(OneColumn::of).collect(),
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

/// What a file holds, as text.
pub fn columns(columns: &[ColumnSummary]) -> String {
    let columns: Vec<OneColumn<'_>> = columns.iter().map(OneColumn::of).collect();
    Columns(&columns).to_string().trim_end().to_owned()
}

impl<'a> Imported<'a> {
    fn of(proposal: &'a MappingProposal) -> Self {
        let lines = proposal.lines();
        Self {
            format: proposal.format,
            proposed: (!lines.is_empty()).then_some(lines),
            others: &proposal.others,
            caution: proposal.caution,
        }
    }
}

impl fmt::Display for Imported<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.format, self.caution)?;
        if !self.others.is_empty() {
            writeln!(f, "not known by name: {}", self.others.join(", "))?;
        }
        match &self.proposed {
            Some(lines) => writeln!(f, "  proposed, for the axis file:\n{lines}"),
            None => Ok(()),
        }
    }
}

impl<'a> OneChannel<'a> {
    fn of(seen: &Seen, quality: &'a ChannelQuality, channel: &Channel) -> Self {
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

/// What the mapping of a file could have.
pub fn proposed(proposal: &MappingProposal) -> String {
    Imported::of(proposal).to_string()
}

/// Sampling of a log, in a line.
pub fn heading(seen: &Seen) -> String {
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

impl fmt::Display for OneLog<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", heading(self.seen))?;
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
        let channels = self.seen.channels.iter();
        channels.clone().try_for_each(|c| writeln!(f, "{c}"))?;
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
        self.imported
            .iter()
            .try_for_each(|file| write!(f, "{file}"))
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
