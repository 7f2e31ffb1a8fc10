//! Tables and series to one HTML page that needs nothing but itself.
//!
//! # The problem
//!
//! A [`Page`] is a list of [`Section`]s, a section a list of [`Block`]s: text,
//! notices, [`Table`]s, [`Figure`]s, [`KeyValues`]. [`render`] maps a page to
//! one HTML text with its style, its plots (SVG) and the script that makes them
//! zoom (uPlot) inline: no request to any address, the same text for the same page.
//!
//! A plot maps data `(x, y)` to a canvas of `W × H` pixels through
//!
//! ```text
//! u = W · (f(x) − f(x0)) / (f(x1) − f(x0)),    f = identity or log10,
//! ```
//!
//! and likewise for `y`. Of `N` points of a line, at most two in each pixel
//! column can be told apart by eye: the lowest and the highest. Of each run of
//! consecutive points with the same `floor(u)` these two are kept, so that the
//! plot of a sampled signal holds at most about `2 W` points whatever `N`, and
//! no peak is lost ([`Style`]).
//!
//! A number that is NaN or infinite is an error that names its place
//! ([`ReportError`]); it is never shown. All text is escaped.
//!
//! # Example
//!
//! ```
//! use axis_report::{Cell, Figure, Notice, Page, Section, Series, Table, render};
//!
//! let t: Vec<f64> = (0..36_000).map(|k| f64::from(k) * 1e-4).collect();
//! let e: Vec<f64> = t.iter().map(|t| 50.0 * (3.0 * t).sin()).collect();
//! let page = Page::new("Tracking error")
//!     .lead("One run at 10 kHz.")
//!     .section(
//!         Section::new("Result")
//!             .notice(Notice::Good, "The peak is below 60 µm.")
//!             .figure(Figure::new("Error", "time", "error").units("s", "µm").series(Series::line("run 1", t, e)))
//!             .table(
//!                 Table::new("Peaks", ["run", "max (µm)"])
//!                     .row([Cell::text("1"), Cell::number(50.0, 2)]),
//!             ),
//!     );
//! let html = render(&page)?;
//! assert!(html.starts_with("<!DOCTYPE html>") && html.len() < 300_000);
//! # Ok::<(), axis_report::ReportError>(())
//! ```
//!
//! # What it knows nothing of
//!
//! Axes, simulations: labels, numbers and their units come from the caller. Of units
//! it knows which take an SI prefix ([`engineering`]). It reads no files.
#![forbid(unsafe_code)]

mod decimate;
mod error;
mod figure;
mod html;
mod interactive;
mod number;
mod page;
mod plot;
mod scale;
mod svg;
mod table;
mod unit;
mod write;

pub use error::{PageWriteError, PlotAxis, ReportError};
pub use figure::{Figure, Scale, Series, Style};
pub use html::render;
pub use number::fixed;
pub use page::{Block, KeyValues, Notice, Page, Section};
pub use table::{Cell, ColumnGroup, Mark, Table};
pub use unit::engineering;
pub use write::write_atomic;

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
