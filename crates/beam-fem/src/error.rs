//! What can be wrong with the input of this crate.

use thiserror::Error;

/// An input that was refused, or a computation that did not end.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BeamError {
    /// A number lies outside its range.
    #[error("{field} = {value} is not valid: it must be {valid}")]
    Parameter {
        /// Name of the field or argument.
        field: &'static str,
        /// The value given.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// Too few or too many finite elements.
    #[error("elements = {elements} is not valid: it must lie between {minimum} and {maximum}")]
    Elements {
        /// The number given.
        elements: usize,
        /// The least that is valid.
        minimum: usize,
        /// The most that is valid.
        maximum: usize,
    },
    /// Mesh nodes that do not start at zero or do not ascend.
    #[error(
        "node {index} at {value} m is not valid: nodes must be finite, the first 0, each above the one before it"
    )]
    Node {
        /// Index of the first bad node.
        index: usize,
        /// Its coordinate, m.
        value: f64,
    },
    /// Two mesh nodes so close that the element between them would hide the rest
    /// of the beam.
    #[error(
        "nodes {} and {index}, at {before} m and {value} m, are {} m apart: neighbours must be at least {least} m apart ({} of the beam's length); leave one of them out",
        index - 1,
        value - before,
        crate::spacing::MIN_SPACING
    )]
    Spacing {
        /// Index of the second node of the first such pair.
        index: usize,
        /// Coordinate of the node before it, m.
        before: f64,
        /// Its coordinate, m.
        value: f64,
        /// The least distance that is valid, m.
        least: f64,
    },
    /// A degree of freedom or node that the model does not have.
    #[error("{field} = {index} is not valid: it must be below {bound}")]
    Index {
        /// Name of the argument.
        field: &'static str,
        /// The index given.
        index: usize,
        /// The first index that is out of range.
        bound: usize,
    },
    /// Two matrices that do not belong together, or one that is not square.
    #[error("{field} is {rows} x {columns}: it must be {order} x {order}")]
    Shape {
        /// Name of the matrix.
        field: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// The order it must have.
        order: usize,
    },
    /// A banded matrix whose band is not that of a beam.
    #[error("{field} has half bandwidth {found}: it must be {needed}")]
    Band {
        /// Name of the matrix.
        field: &'static str,
        /// Its half bandwidth.
        found: usize,
        /// The one that it must have.
        needed: usize,
    },
    /// A matrix with more entries than is sensible to store.
    #[error(
        "{field} of {rows} x {columns} entries is not valid: a matrix may have at most {maximum}"
    )]
    TooLarge {
        /// Name of the matrix.
        field: &'static str,
        /// Its rows.
        rows: usize,
        /// Its columns; for a banded matrix those that are stored.
        columns: usize,
        /// The most entries that are valid.
        maximum: usize,
    },
    /// A matrix with an infinite entry or a NaN.
    #[error("the {field} matrix holds an entry that is not finite")]
    NotFinite {
        /// Name of the matrix.
        field: &'static str,
    },
    /// A mass matrix that is not positive definite.
    #[error("the mass matrix is not positive definite: every degree of freedom must carry mass")]
    MassNotPositiveDefinite,
    /// A stiffness matrix with a negative eigenvalue beyond rounding.
    #[error("the stiffness matrix is not positive semidefinite: its spring energy can be negative")]
    StiffnessNegative,
    /// A motion so soft that it cannot be told from a rigid one, beside the
    /// rounding of stiffer parts.
    #[error(
        "a frequency above 0 is lost in the rounding of the stiffness matrix, which is greatest at row {row} (stiffness {stiffness}): elements there must be longer, or springs softer, or the supports stiffer"
    )]
    Unresolved {
        /// The row of the greatest ratio of stiffness to mass among those that
        /// take part in the motion.
        row: usize,
        /// Its diagonal entry of the stiffness matrix.
        stiffness: f64,
    },
    /// More modes asked for than there are degrees of freedom, or none.
    #[error("count = {count} modes is not valid: it must lie between 1 and {order}")]
    ModeCount {
        /// The number asked for.
        count: usize,
        /// Number of degrees of freedom.
        order: usize,
    },
    /// A taper between two shapes of different kinds.
    #[error("a taper from a {from} to a {to} is not valid: both ends must be of one kind")]
    Taper {
        /// Kind of the shape at the start.
        from: &'static str,
        /// Kind of the shape at the end.
        to: &'static str,
    },
    /// A list that must have entries and has none.
    #[error("{field} is empty: it must have at least one entry")]
    Empty {
        /// Name of the list.
        field: &'static str,
    },
    /// A degree of freedom that is held, or that no node has, where a free one is needed.
    #[error(
        "{field} = {row} (node {}, {:?}) is held, or no row of the model: it must be a free degree of freedom",
        row / 6,
        crate::Dof::ALL[row % 6]
    )]
    Held {
        /// Name of the argument.
        field: &'static str,
        /// The row, [`crate::Dof::at`].
        row: usize,
    },
    /// A stiffness that leaves a motion without spring energy.
    #[error(
        "the stiffness matrix is not positive definite: {task} needs a spring, a bearing or a hold against every rigid motion, stretch and twist included (BeamModel::fix_everywhere), and no load beyond buckling"
    )]
    Unsupported {
        /// What was to be computed.
        task: &'static str,
    },
    /// A matrix that must be symmetric.
    #[error("the {field} matrix is not symmetric: {instead}")]
    NotSymmetric {
        /// Name of the matrix.
        field: &'static str,
        /// What would be valid.
        instead: &'static str,
    },
    /// A harmonic force at an undamped resonance.
    #[error(
        "at {frequency} rad/s the dynamic stiffness is singular: an undamped resonance has no steady response; add damping or move the frequency"
    )]
    Resonance {
        /// The frequency, rad/s.
        frequency: f64,
    },
    /// The eigenvalue iteration stopped at its limit.
    #[error("the eigenvalue iteration did not converge")]
    NotConverged,
}

/// The most entries of a stored matrix, 1 GiB of them: a bound on memory, not
/// on theory. It lets through the band of a beam of [`crate::Mesh::MAX_ELEMENTS`].
pub(crate) const MAX_ENTRIES: usize = 1 << 27;

/// Refuses a matrix with more than [`MAX_ENTRIES`] entries.
pub(crate) fn check_size(
    field: &'static str,
    rows: usize,
    columns: usize,
) -> Result<(), BeamError> {
    match rows.checked_mul(columns) {
        Some(entries) if entries <= MAX_ENTRIES => Ok(()),
        _ => Err(BeamError::TooLarge {
            field,
            rows,
            columns,
            maximum: MAX_ENTRIES,
        }),
    }
}

/// Refuses what is not finite and above zero.
pub(crate) fn positive(field: &'static str, value: f64) -> Result<f64, BeamError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        let valid = "finite and above zero";
        Err(BeamError::Parameter {
            field,
            value,
            valid,
        })
    }
}

/// Refuses what is not finite and at least zero.
pub(crate) fn not_negative(field: &'static str, value: f64) -> Result<f64, BeamError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(value);
    }
    Err(BeamError::Parameter {
        field,
        value,
        valid: "finite and at least zero",
    })
}

/// Refuses what is not finite.
pub(crate) fn finite(field: &'static str, value: f64) -> Result<f64, BeamError> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(BeamError::Parameter {
        field,
        value,
        valid: "finite",
    })
}
