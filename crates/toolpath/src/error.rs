//! Why a path, a profile or a measured circle was refused.

/// What was wrong, where, and what would be valid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ToolpathError {
    /// One value lies outside what is valid for it.
    #[error("{field} is {value} {unit}, but must be {valid}")]
    Invalid {
        /// Name of the field, as in this crate's structs.
        field: &'static str,
        /// The value, in SI units.
        value: f64,
        /// SI unit of the value; empty for a pure number.
        unit: &'static str,
        /// What would be valid.
        valid: &'static str,
    },
    /// An element of a list lies outside what is valid for it.
    #[error("{field} number {number} (from 1) is {value}, but must be {valid}")]
    Element {
        /// Name of the list.
        field: &'static str,
        /// Which element, counted from 1.
        number: usize,
        /// The value.
        value: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// A list has the wrong number of elements.
    #[error("{field} has {count} elements, but must have {valid}")]
    Count {
        /// Name of the list.
        field: &'static str,
        /// How many it has.
        count: usize,
        /// How many would be valid.
        valid: String,
    },
    /// The curve stands still or turns back at a parameter: no tangent exists there.
    #[error(
        "the curve has no tangent at u = {u}: control points must not coincide so that its \
         derivative vanishes there"
    )]
    Cusp {
        /// Parameter of the curve.
        u: f64,
    },
    /// Two segments do not meet.
    #[error(
        "segment {number} (from 1) begins {gap} m from the end of the one before; at most \
         {tolerance} m are allowed"
    )]
    Gap {
        /// Which segment, counted from 1.
        number: usize,
        /// Distance, m.
        gap: f64,
        /// `PathTolerances::position`, m.
        tolerance: f64,
    },
    /// No blend fits the two lines.
    #[error("the lines turn by {angle} rad, but a blend needs {valid}")]
    Blend {
        /// Angle between the directions of the two lines, rad.
        angle: f64,
        /// What would be valid.
        valid: &'static str,
    },
    /// The feed along a stretch of the path could not be planned.
    #[error("no feed found between s = {from} m and s = {to} m: {reason}")]
    Feed {
        /// Begin of the stretch between two stops, m.
        from: f64,
        /// Its end, m.
        to: f64,
        /// What stood against it, and what would be valid.
        reason: &'static str,
    },
    /// A motion along a line or a circle was refused.
    #[error(transparent)]
    Motion(#[from] trajectories::TrajectoryError),
}

/// `value` if it lies from 1e-9 to 1e9.
pub(crate) fn positive(
    field: &'static str,
    value: f64,
    unit: &'static str,
) -> Result<f64, ToolpathError> {
    // 1e-9 to 1e9: everything that a machine has, and nothing whose cube or square overflows.
    if (1e-9..=1e9).contains(&value) {
        Ok(value)
    } else {
        let valid = "from 1e-9 to 1e9";
        Err(ToolpathError::Invalid {
            field,
            value,
            unit,
            valid,
        })
    }
}

/// `values` if each is finite and at most 1e6 in size.
pub(crate) fn coordinates<const D: usize>(
    field: &'static str,
    values: [f64; D],
) -> Result<[f64; D], ToolpathError> {
    for value in values {
        within(field, value, "m", 1e6, "from -1e6 to 1e6")?;
    }
    Ok(values)
}

/// `value` if its size is at most `most`, which `valid` says.
pub(crate) fn within(
    field: &'static str,
    value: f64,
    unit: &'static str,
    most: f64,
    valid: &'static str,
) -> Result<f64, ToolpathError> {
    if value.abs() <= most {
        Ok(value)
    } else {
        Err(ToolpathError::Invalid {
            field,
            value,
            unit,
            valid,
        })
    }
}
