//! What was done to a log, to be told.

use std::fmt;

use crate::plus_minus::PlusMinus;
use crate::table::Note;

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

impl FileDelay {
    fn milliseconds(&self) -> PlusMinus {
        PlusMinus::new(1e3 * self.delay, 1e3 * self.standard_error, 4)
    }
}

/// Something that was done to a log, or could not be.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Done {
    /// What had to be assumed or left out to read a file.
    Read {
        /// The file.
        file: String,
        /// What.
        note: Note,
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
    /// What was done to single samples of a channel.
    fn fmt_samples(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unwrapped {
                channel,
                period,
                jumps,
                unit,
            } => write!(
                f,
                "{channel}: it wraps around after {period:.6} {unit}, {jumps} time(s); unwrapped"
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
            _ => Ok(()),
        }
    }

    /// What was done about uneven time stamps.
    fn fmt_uneven(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (file, jitter, rate, samples) = match self {
            Self::Shifted {
                file,
                rows,
                jitter,
                rate,
            } => {
                let side = if *rows < 0 { "before" } else { "behind" };
                let rows = rows.unsigned_abs();
                let samples = format!(
                    "and so were the samples, {rows} row {side} their stamps; interpolated to"
                );
                (file, jitter, rate, samples)
            }
            Self::Interpolated { file, jitter, rate } => (
                file,
                jitter,
                rate,
                "and so were the samples; interpolated to".to_owned(),
            ),
            Self::Evened { file, jitter, rate } => (
                file,
                jitter,
                rate,
                "the samples not; taken as even at".to_owned(),
            ),
            _ => return Ok(()),
        };
        write!(
            f,
            "{file}: time stamps up to {:.0} % of a period off an even grid, {samples} {rate:.4} Hz",
            100.0 * jitter
        )
    }
}

impl fmt::Display for Done {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { file, note } => write!(f, "{file}: {note}"),
            Self::Unwrapped { .. } | Self::Outliers { .. } | Self::Bridged { .. } => {
                self.fmt_samples(f)
            }
            Self::Shifted { .. } | Self::Interpolated { .. } | Self::Evened { .. } => {
                self.fmt_uneven(f)
            }
            Self::Rows { file, rows, gaps } => write!(
                f,
                "{file}: {rows} rows missing in {gaps} place(s); inserted without values"
            ),
            Self::Slowed {
                file,
                samples,
                rates: [from, to],
            } => write!(
                f,
                "{file}: {samples} samples at {from:.4} Hz; resampled to {to:.4} Hz, as so long a log needs no more"
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
                found.milliseconds(),
                found.channels[1],
                found.channels[0],
                found.correlation
            ),
            Self::DelayDiffers { file, found } => write!(
                f,
                "{file}: after its delay_ms it is {} ms late ({} against {}); left unchanged",
                found.milliseconds(),
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
