//! Logs as they come: several files, missing values, spikes, delays; made one [`Log`](crate::Log).
//!
//! [`prepare`] reads files by a [`Mapping`](crate::Mapping) and does, in this order:
//!
//! 1. Angles and counters that plainly begin anew after a turn, or after all their bits, go on.
//!    Rows that are in a file twice are taken once.
//! 2. A file whose time stamps are more than 5 % of a period off an even grid is put on one:
//!    values by a cubic between stamps where these are the instants of the samples, or of the
//!    samples in the next or the last row; as they are where samples are even and stamps are not.
//!    What moves smoothly tells which.
//!    Rows that are missing between time stamps are put back, empty.
//! 3. Isolated outliers (Hampel's test, [`outliers`](crate::quality::outliers)) are taken out.
//! 4. Several files are joined on one even grid, of the slowest or a given rate, and
//!    delays are taken out, with a filter without phase ([`prepare`] says how).
//! 5. What has no value is bridged by a straight line, for display, and marked as
//!    [missing](crate::Log::missing).
//!
//! A file without any of that gives the same log as [`read_log`](crate::read_log), to the
//! bit. Everything that was done is told, as [`Done`]. [`prepare_channels`]
//! does the same to channels that a program has.
//!
//! # Memory
//! A file is read whole (a CSV's text beside its numbers), and numbers take 8 bytes each.
//! Where delays or several files are resampled, all channels are there twice, and 12 bytes
//! a row more. Ten minutes at 20 kHz with eight channels are 770 MB, or 1.7 GB resampled.

mod delay;
mod done;
mod error;
mod evened;
mod join;
mod prepare;
mod recording;
mod repair;
mod unwrapped;

pub use done::{Done, FileDelay};
pub use error::IntakeError;
pub use prepare::{Options, PreparedLog, files, prepare, prepare_channels};
pub use repair::SHORT_GAP;
