//! Sampled, named channels of a machine axis: the log; CSV, Parquet and MAT in
//! and out; whether a log can be trusted; and the error metrics taken from it.
//!
//! # The problem
//!
//! A drive, or its simulation, records `C` quantities at `N` instants. The log
//! is the matrix `Y` of shape `N × C` with the instants in its first column,
//!
//! ```text
//! t_0 < t_1 < … < t_{N-1}   [s],      Y = [ t | y_1 | … | y_{C-1} ],
//! ```
//!
//! every entry a finite `f64`, every column named, and the unit of a column
//! written as the suffix of its name: `position_ref_m`, `motor_speed_rad_s`,
//! `iq_a` ([`unit_of`]). A [`Log`] holds such a matrix column by column; once
//! built it is sorted, rectangular and finite, so code that reads it cannot
//! meet a hole.
//!
//! From an error sequence `e_k = r_k − y_k`, `k = 0 … N−1`, [`metrics`] takes
//!
//! ```text
//! max |e|,    (1/N) Σ |e_k|,    sqrt( (1/N) Σ e_k² ).
//! ```
//!
//! [`write()`] followed by [`read_log`] gives back the same bits, and a
//! reader never sees half a file: it goes to a temporary file in the same
//! folder, which then takes the final name.
//!
//! Drives export their own names and units. [`read_log`] reads CSV, Parquet and
//! MAT files and makes each channel `scale · column + offset` as a [`Mapping`]
//! says. [`quality`] then judges what was read: instants on an even grid
//! `t_k ≈ t_0 + k T` without gaps, channels that move, units that agree with the
//! reference. Logs with holes, spikes, delays or in several files are made one by
//! [`intake::prepare`].
//!
//! # Example
//!
//! ```
//! use axis_log::{Channel, Log, metrics::ErrorSummary};
//!
//! let log = Log::new(vec![
//!     Channel::new("t_s", vec![0.0, 1e-3, 2e-3])?,
//!     Channel::new("position_ref_m", vec![0.6, 0.601, 0.602])?,
//!     Channel::new("position_m", vec![0.6, 0.6009, 0.6021])?,
//! ])?;
//! let error = ErrorSummary::between(log.channel("position_ref_m")?, log.channel("position_m")?)?;
//! assert!((error.max - 1e-4).abs() < 1e-12);
//!
//! let mut text = Vec::new();
//! axis_log::write_csv_to(&mut text, &log)?;
//! let again = axis_log::read_csv_from(text.as_slice(), "memory", &["position_m"])?;
//! assert_eq!(again, log);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A drive's export in milliseconds and millimetres:
//!
//! ```
//! use axis_log::{ColumnMap, Mapping, read_log};
//!
//! # let folder = tempfile::tempdir()?;
//! let path = folder.path().join("drive.csv");
//! std::fs::write(&path, "Time,Pos SP,Pos PV\n0,600,600\n1,601,600.9\n")?;
//! let map = |source: &str, channel: &str, scale| ColumnMap {
//!     source: source.into(),
//!     channel: channel.into(),
//!     scale,
//!     is_scale_stated: true,
//!     offset: 0.0,
//!     delay: 0.0,
//! };
//! let mapping = Mapping {
//!     columns: vec![
//!         map("Time", "t_s", 1e-3),
//!         map("Pos SP", "position_ref_m", 1e-3),
//!         map("Pos PV", "position_m", 1e-3),
//!     ],
//!     sample_rate_hz: None,
//! };
//! let log = read_log(&path, &mapping, &["position_ref_m", "position_m"])?;
//! assert_eq!(log.time(), [0.0, 1e-3]);
//! assert!((log.channel("position_m")?[1] - 0.6009).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! `parquet` and `mat` make [`read_log`] read and [`write()`] write those formats; without
//! them there is CSV, and of the others it is said which feature is missing.
//!
//! # What it knows nothing of
//!
//! Machines, controllers and models: what channels should be of each other comes from
//! the caller ([`quality::Relation`]). It converts units only as a [`Mapping`] tells it to:
//! [`quality::cross_check`] proposes another and changes nothing.
#![forbid(unsafe_code)]

mod by_extension;
mod channel;
mod columns;
mod csv_in;
mod csv_table;
mod csv_text;
mod encoding;
mod error;
mod import;
pub mod intake;
mod log;
mod mapping;
mod mapping_error;
#[cfg(feature = "mat")]
mod mat_element;
#[cfg(feature = "mat")]
mod mat_path;
#[cfg(feature = "mat")]
mod mat_table;
pub mod metrics;
mod numeric;
#[cfg(feature = "parquet")]
mod parquet_codec;
#[cfg(feature = "parquet")]
mod parquet_hybrid;
#[cfg(feature = "parquet")]
mod parquet_pages;
#[cfg(feature = "parquet")]
mod parquet_table;
mod plus_minus;
pub mod quality;
mod read;
mod read_error;
mod select;
mod source_unit;
mod table;
mod text_dialect;
mod text_lines;
mod text_titles;
#[cfg(feature = "parquet")]
mod thrift;
mod unit;
mod unit_table;
mod write;

pub use channel::Channel;
pub use columns::{ColumnSummary, FileSummary, columns};
pub use csv_in::{read_csv, read_csv_from};
pub use encoding::{read_text, text_of};
pub use error::{CsvError, CsvProblem, LogError};
pub use import::{AxisProposal, MappingProposal, ProposedColumn, propose};
pub use log::{Log, TIME_CHANNEL};
pub use mapping::{ColumnMap, ColumnUnit, Mapping};
pub use mapping_error::MappingError;
pub use plus_minus::{PlusMinus, fixed, never_zero};
pub use read::read_log;
pub use read_error::{Place, ReadError, ReadProblem};
pub use table::{Note, OtherUnit};
pub use unit::{unit_of, unit_suffixes};
pub use write::{
    CsvSink, LAYOUT, LogFile, LogSink, WriteError, WriteProblem, write, write_csv, write_csv_to,
};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
