//! What was done to a log, to be told.

use std::fmt;

use crate::error::clip;
use crate::plus_minus::PlusMinus;
use crate::table::{Note, OtherUnit};
use crate::unit::unit_of;

/// The delay of one file's clock against another's, found from their channels.
#[derive(Debug, Clone, PartialEq)]
pub struct FileDelay {
    /// Channels that it was found from: of the first file, of this one.
    pub channels: [String; 2],
    /// By how much this file shows things late, s; negative where early.
    pub delay: f64,
    /// Standard error of the delay, s.
    pub standard_error: f64,
    /// Correlation of the two channels at that delay.
    pub correlation: f64,
}

/// Something that was done to a log, or could not be.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Done {
    /// A file without names: its first row holds numbers, and is data.
    NoNames {
        /// The file.
        file: String,
        /// Its columns, which are called `column 1` and so on.
        columns: usize,
    },
    /// Lines above the names of a text, which were passed over.
    Titles {
        /// The file.
        file: String,
        /// The lines.
        lines: Vec<String>,
    },
    /// A file whose last row has no line end; it was taken as a row.
    NoLineEnd {
        /// The file.
        file: String,
    },
    /// Rows that the program left out because nothing changed; the values were held.
    Held {
        /// The file.
        file: String,
        /// Rows.
        rows: usize,
    },
    /// A column whose mapping states no unit; it was read in that which the file states.
    UnitOfFile {
        /// The file.
        file: String,
        /// The column.
        column: String,
        /// Its unit.
        unit: String,
    },
    /// A column that its mapping reads in another unit than that which the file states.
    OtherUnit {
        /// The file.
        file: String,
        /// The column.
        what: OtherUnit,
    },
    /// A column that the mapping names and the file has not.
    NoColumn {
        /// The file.
        file: String,
        /// The column.
        column: String,
        /// Those that there are.
        there: Vec<String>,
    },
    /// Rows that were there twice, the same in every column; taken once.
    Repeated {
        /// The file.
        file: String,
        /// Rows that were dropped.
        rows: usize,
        /// Time of the first, s.
        first: f64,
    },
    /// An angle or a counter that began anew after a turn or after all its bits; it goes on.
    Unwrapped {
        /// The channel.
        channel: String,
        /// After how much it began anew, in its unit.
        period: f64,
        /// How often.
        jumps: usize,
        /// Unit of the channel.
        unit: String,
    },
    /// Time stamps that were uneven, of samples that stand so many rows behind their stamps.
    Shifted {
        /// The file.
        file: String,
        /// Rows by which samples come late; negative where early.
        rows: i64,
        /// Farthest of a stamp from an even grid, periods.
        jitter: f64,
        /// Rate of the grid, Hz.
        rate: f64,
    },
    /// Rows that were missing between time stamps.
    Rows {
        /// The file.
        file: String,
        /// Rows put back, empty.
        rows: usize,
        /// In so many places.
        gaps: usize,
    },
    /// Time stamps that were uneven; the samples were too.
    Interpolated {
        /// The file.
        file: String,
        /// Farthest of a stamp from an even grid, periods.
        jitter: f64,
        /// Rate of the grid, Hz.
        rate: f64,
    },
    /// Time stamps that were uneven, of samples that are not.
    Evened {
        /// The file.
        file: String,
        /// Farthest of a stamp from the samples' grid, periods.
        jitter: f64,
        /// Rate of the grid, Hz.
        rate: f64,
    },
    /// A log of more samples than were asked for, at a lower rate.
    Slowed {
        /// The file.
        file: String,
        /// Samples that it had.
        samples: usize,
        /// Its rate and the new one, Hz.
        rates: [f64; 2],
    },
    /// Isolated outliers taken out.
    Outliers {
        /// The channel.
        channel: String,
        /// Samples.
        samples: usize,
        /// The instant of the first, s.
        first: f64,
        /// The farthest from its neighbours, in the channel's unit.
        farthest: f64,
        /// Unit of the channel.
        unit: String,
    },
    /// Samples without a value, bridged by a straight line and marked.
    Bridged {
        /// The channel.
        channel: String,
        /// Samples, outliers among them.
        samples: usize,
        /// Samples of the longest run.
        longest: usize,
        /// The instant at which that begins, s.
        at: f64,
    },
    /// A channel moved in time, as its column's delay says.
    Delayed {
        /// The channel.
        channel: String,
        /// s.
        delay: f64,
    },
    /// Files that were joined.
    Joined {
        /// The files.
        files: Vec<String>,
        /// Sampling period, s.
        period: f64,
        /// First and last instant, s.
        span: [f64; 2],
    },
    /// The delay of a file against the first one, found and taken out.
    Aligned {
        /// The file.
        file: String,
        /// What was found.
        found: FileDelay,
    },
    /// A delay that was found beside another that was given; the given one was taken.
    DelayDiffers {
        /// The file.
        file: String,
        /// What is left after the given one.
        found: FileDelay,
    },
    /// A file with no channel that tells its delay, and no delay given.
    DelayUnknown {
        /// The file.
        file: String,
        /// The first file.
        against: String,
    },
    /// A channel that an earlier file has too; that one was taken.
    Twice {
        /// The file whose channel was left out.
        file: String,
        /// The channel.
        channel: String,
    },
}

impl Done {
    /// What a file says of itself.
    pub(super) fn of(note: Note, file: String) -> Self {
        match note {
            Note::NoNames { columns } => Self::NoNames { file, columns },
            Note::Titles { lines } => Self::Titles { file, lines },
            Note::NoLineEnd => Self::NoLineEnd { file },
            Note::Held { rows } => Self::Held { file, rows },
            Note::UnitOfFile { column, unit } => Self::UnitOfFile { file, column, unit },
            Note::OtherUnit(what) => Self::OtherUnit { file, what },
            Note::NoColumn { column, there } => Self::NoColumn {
                file,
                column,
                there,
            },
            Note::Repeated { rows, first } => Self::Repeated { file, rows, first },
        }
    }
}

impl fmt::Display for Done {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoNames { file, columns } => write!(
                f,
                "{file}: its first row holds numbers, so it is data and there are no names; the columns are called \"column 1\" to \"column {columns}\""
            ),
            Self::Titles { file, lines } => write!(
                f,
                "{file}: {} passed over, as the names for its rows stand below: {}",
                match lines.len() {
                    1 => "its first line was".to_owned(),
                    many => format!("its first {many} lines were"),
                },
                clip(&lines.join(" | "))
            ),
            Self::NoLineEnd { file } => write!(
                f,
                "{file}: its last row has no line end; it was taken as it stands, and if the file was cut there, its last number may be too"
            ),
            Self::Held { file, rows } => write!(
                f,
                "{file}: {rows} rows that the control left out because nothing changed; the last values are held there"
            ),
            Self::UnitOfFile { file, column, unit } => write!(
                f,
                "{file}: column \"{column}\" is read in {unit}, the unit that the file states, as its mapping states none (unit or factor)"
            ),
            Self::OtherUnit { file, what } => {
                let [stated, taken] = what.scales;
                let of_channel = unit_of(&what.channel).unwrap_or_default();
                let (column, unit) = (&what.column, &what.unit);
                write!(
                    f,
                    "{file}: column \"{column}\": the file states {unit} ({stated} {of_channel}), and its mapping takes 1 of it for {taken} {of_channel}; it is read as the mapping says"
                )
            }
            Self::NoColumn {
                file,
                column,
                there,
            } => write!(
                f,
                "{file}: the mapping names a column \"{column}\" (source), which is not there; the file has: {}",
                there.join(", ")
            ),
            Self::Repeated { file, rows, first } => write!(
                f,
                "{file}: {rows} row(s) occur twice, the first at t = {first:.4} s; each is read once"
            ),
            Self::Unwrapped {
                channel,
                period,
                jumps,
                unit,
            } => write!(
                f,
                "{channel}: it wraps around after {period:.6} {unit}, {jumps} time(s); unwrapped"
            ),
            Self::Shifted {
                file,
                rows,
                jitter,
                rate,
            } => {
                let (count, way) = match *rows < 0 {
                    true => (-rows, "before"),
                    false => (*rows, "behind"),
                };
                write!(
                    f,
                    "{file}: time stamps up to {:.0} % of a period off an even grid, and so were the samples, {count} row {way} their stamps; interpolated to {rate:.4} Hz",
                    100.0 * jitter
                )
            }
            Self::Rows { file, rows, gaps } => {
                write!(
                    f,
                    "{file}: {rows} rows missing in {gaps} place(s); inserted without values"
                )
            }
            Self::Interpolated { file, jitter, rate } => write!(
                f,
                "{file}: time stamps up to {:.0} % of a period off an even grid, and so were the samples; interpolated to {rate:.4} Hz",
                100.0 * jitter
            ),
            Self::Evened { file, jitter, rate } => write!(
                f,
                "{file}: time stamps up to {:.0} % of a period off an even grid, the samples not; taken as even at {rate:.4} Hz",
                100.0 * jitter
            ),
            Self::Slowed {
                file,
                samples,
                rates: [from, to],
            } => write!(
                f,
                "{file}: {samples} samples at {from:.4} Hz; resampled to {to:.4} Hz, as so long a log needs no more"
            ),
            Self::Outliers {
                channel,
                samples,
                first,
                farthest,
                unit,
            } => write!(
                f,
                "{channel}: {samples} isolated outlier(s), the first at t = {first:.4} s, up to {farthest:.3e} {unit} from its neighbours; removed"
            ),
            Self::Bridged {
                channel,
                samples,
                longest,
                at,
            } => write!(
                f,
                "{channel}: {samples} sample(s) without a value, at most {longest} in a row (from t = {at:.4} s); interpolated there by a straight line, with zero weight"
            ),
            Self::Delayed { channel, delay } => {
                write!(
                    f,
                    "{channel}: shifted by {:.4} ms, its delay_ms",
                    -1e3 * delay
                )
            }
            Self::Joined {
                files,
                period,
                span,
            } => write!(
                f,
                "{}: joined from t = {:.4} to {:.4} s at {:.6} Hz",
                files.join(" + "),
                span[0],
                span[1],
                1.0 / period
            ),
            Self::Aligned { file, found } => write!(
                f,
                "{file}: its clock is {} ms late ({} against {}, correlation {:.4}); corrected",
                PlusMinus::new(1e3 * found.delay, 1e3 * found.standard_error, 4),
                found.channels[1],
                found.channels[0],
                found.correlation
            ),
            Self::DelayDiffers { file, found } => write!(
                f,
                "{file}: after its delay_ms it is {} ms late ({} against {}); left unchanged",
                PlusMinus::new(1e3 * found.delay, 1e3 * found.standard_error, 4),
                found.channels[1],
                found.channels[0]
            ),
            Self::DelayUnknown { file, against } => write!(
                f,
                "{file}: its delay against {against} is unknown, as they share no quantity; time stamps are taken as they are; if it is known, set delay_ms of its columns"
            ),
            Self::Twice { file, channel } => {
                write!(
                    f,
                    "{file}: {channel} is in an earlier file too and is taken from there"
                )
            }
        }
    }
}
