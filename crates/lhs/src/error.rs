//! The one error type of the crate.

use thiserror::Error;

/// Why a design, a marginal or a mapping was refused. Each message names the
/// field, its value and what would have been valid.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LhsError {
    /// The number of points is zero or too large for f64 strata.
    #[error("n = {n} points: n must be between 1 and 2^53 = 9007199254740992")]
    Points {
        /// The number of points asked for.
        n: usize,
    },
    /// The number of variables is zero, or too large.
    #[error("dims = {dims} variables: dims must be between 1 and 1024")]
    Dims {
        /// The number of variables asked for.
        dims: usize,
    },
    /// A range of rows is empty or leaves the design.
    #[error("rows {start}..{end}: must be a non-empty range within 0..{n}")]
    Rows {
        /// First row asked for.
        start: usize,
        /// One past the last row asked for.
        end: usize,
        /// Rows that the design has.
        n: usize,
    },
    /// A range of points of a sequence is empty, or leaves it.
    #[error("points {start}..{end}: must be a non-empty range within 0..2^53")]
    SequenceRows {
        /// First point asked for.
        start: u64,
        /// One past the last point asked for.
        end: u64,
    },
    /// A point that a sequence has not.
    #[error("point {row}: must be below 2^53 = 9007199254740992")]
    SequenceRow {
        /// The point asked for, from 0.
        row: u64,
    },
    /// A row or a variable that the design has not, or a buffer of another
    /// length than a row.
    #[error("{what} {found}: must be {valid} {limit}")]
    Index {
        /// What was asked for.
        what: &'static str,
        /// The number found.
        found: usize,
        /// How it must lie to the limit.
        valid: &'static str,
        /// The limit.
        limit: usize,
    },
    /// The values would not fit in memory.
    #[error(
        "{rows} rows of {dims} values do not fit in memory: ask for a shorter shard, or for single rows"
    )]
    Memory {
        /// Rows asked for.
        rows: usize,
        /// Values in a row.
        dims: usize,
    },
    /// A list of values is not a whole number of rows, or is empty.
    #[error("{len} values: must be a positive multiple of dims = {dims}")]
    Shape {
        /// Values given.
        len: usize,
        /// Values in a row.
        dims: usize,
    },
    /// A value of a design is NaN or infinite.
    #[error("row {row}, column {dim}: value {value} is not finite")]
    NotFinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        dim: usize,
        /// The value.
        value: f64,
    },
    /// The number of marginals differs from the number of columns.
    #[error("{marginals} marginals for {dims} columns: exactly one for each column is needed")]
    MarginalCount {
        /// Marginals given.
        marginals: usize,
        /// Columns of the design.
        dims: usize,
    },
    /// A design to be mapped holds a value that is not a probability.
    #[error(
        "row {row}, column {dim}: {value} is not a probability; values to map must lie in [0, 1)"
    )]
    NotProbability {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        dim: usize,
        /// The value.
        value: f64,
    },
    /// A parameter of a marginal is out of its range.
    #[error("{marginal}: {field} = {value}: must be {valid}")]
    Parameter {
        /// Name of the marginal.
        marginal: &'static str,
        /// Name of the parameter.
        field: &'static str,
        /// The value given.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A tabulated distribution function has a bad entry.
    #[error("Tabulated: point {index} is ({x}, {p}): {valid}")]
    Table {
        /// Index of the point, from 0.
        index: usize,
        /// Its abscissa.
        x: f64,
        /// Its cumulative probability.
        p: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A list that must not be empty, or needs a least length, is too short.
    #[error("{marginal}: {len} entries: at least {least} are needed")]
    TooShort {
        /// Name of the marginal.
        marginal: &'static str,
        /// Entries given.
        len: usize,
        /// Entries needed.
        least: usize,
    },
    /// A number that a design cannot be made with.
    #[error("{what} = {found}: must be {valid}")]
    Argument {
        /// Name of the number.
        what: &'static str,
        /// The number found.
        found: usize,
        /// What would be valid.
        valid: &'static str,
    },
    /// An entry of a correlation matrix is not valid.
    #[error("correlation matrix, row {row}, column {column}: {value}: must be {valid}")]
    Correlation {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The entry.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A correlation matrix that no variables can have together.
    #[error(
        "correlation matrix: the correlations of variable {variable} with those before it contradict \
         theirs: the matrix must be positive definite, as it is with all entries off the diagonal \
         multiplied by {factor}"
    )]
    NotPositiveDefinite {
        /// The first variable, from 0, whose pivot of the Cholesky factor is
        /// not positive.
        variable: usize,
        /// A factor of the entries off the diagonal that would be valid.
        factor: f64,
    },
    /// The columns of a design depend on each other linearly.
    #[error(
        "column {column}: its ranks are a linear combination of those of columns before it: \
         must be independent, as in a random Latin hypercube"
    )]
    DependentColumns {
        /// The column, from 0.
        column: usize,
    },
    /// The strata of a value that must lie in [0, 1) are not known.
    #[error("row {row}, column {dim}: {value} lies in no stratum: must be in [0, 1)")]
    NoStratum {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        dim: usize,
        /// The value.
        value: f64,
    },
}
