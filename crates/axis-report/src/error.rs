//! What cannot be shown, and what cannot be written.

use std::fmt;

use thiserror::Error;

/// Which coordinate of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlotAxis {
    /// Horizontal.
    X,
    /// Vertical.
    Y,
}

impl fmt::Display for PlotAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::X => "x",
            Self::Y => "y",
        })
    }
}

/// A page that cannot be rendered. Rows, columns and points count from 1.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A number in a table that is NaN or infinite.
    #[error(
        "table \"{table}\", row {row}, column {column} (\"{name}\"): {value} is not a finite \
         number; use Cell::Missing for no value"
    )]
    TableValue {
        /// Caption of the table.
        table: String,
        /// Row of the cell.
        row: usize,
        /// Column of the cell.
        column: usize,
        /// Header of the column.
        name: String,
        /// The number.
        value: f64,
    },
    /// A row with more or fewer cells than there are columns.
    #[error("table \"{table}\", row {row}: {found} cells, but {expected} columns")]
    RowLength {
        /// Caption of the table.
        table: String,
        /// The row.
        row: usize,
        /// Its cells.
        found: usize,
        /// Columns of the table.
        expected: usize,
    },
    /// Column groups that do not cover the columns.
    #[error("table \"{table}\": the column groups span {found} of {expected} columns")]
    GroupSpan {
        /// Caption of the table.
        table: String,
        /// Sum of the spans.
        found: usize,
        /// Columns of the table.
        expected: usize,
    },
    /// A figure without series.
    #[error("figure \"{figure}\" has no series: it needs at least one")]
    NoSeries {
        /// Title of the figure.
        figure: String,
    },
    /// A series without points.
    #[error("figure \"{figure}\", series \"{series}\" has no points: it needs at least one")]
    EmptySeries {
        /// Title of the figure.
        figure: String,
        /// Name of the series.
        series: String,
    },
    /// A series whose coordinates differ in number.
    #[error(
        "figure \"{figure}\", series \"{series}\": {x} x values and {y} y values; the numbers \
         must agree"
    )]
    SeriesLength {
        /// Title of the figure.
        figure: String,
        /// Name of the series.
        series: String,
        /// Number of x values.
        x: usize,
        /// Number of y values.
        y: usize,
    },
    /// A coordinate that is NaN or infinite, or not positive on a logarithmic
    /// scale.
    #[error("figure \"{figure}\", series \"{series}\", point {point}: {axis} = {value}; {valid}")]
    PointValue {
        /// Title of the figure.
        figure: String,
        /// Name of the series.
        series: String,
        /// The point.
        point: usize,
        /// Which coordinate.
        axis: PlotAxis,
        /// Its value.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
}

/// A page that cannot be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PageWriteError {
    /// The page cannot be rendered; no file was touched.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// The file cannot be written; one that stood there before is unchanged.
    #[error("{path}: cannot {action}: {source}")]
    Io {
        /// Path of the page.
        path: String,
        /// What was being done.
        action: &'static str,
        /// Why it failed.
        source: std::io::Error,
    },
}
