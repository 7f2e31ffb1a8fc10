//! A finished design: n points of m coordinates, in memory.

use crate::LhsError;

/// Most variables of a design. No factor of the discrepancy's products passes
/// 1.5, and 1.5^1024 is far below what f64 holds; a stored permutation takes
/// up to 16 kB for each.
pub const MAX_DIMS: usize = 1024;

/// An n × m table of coordinates, stored row after row (one row, one point).
///
/// Every constructor of this crate that returns a sample fills it with
/// cumulative probabilities, the matrix Q of Eq. (23); [`map`](crate::map)
/// turns it into physical values, the matrix V of Eq. (25), whose columns
/// then carry the units of their marginals.
///
/// With the feature `serde` it is written as `{dims, values}` and checked by
/// [`from_rows`](Self::from_rows) when it is read.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::stored::Stored"))]
pub struct Design {
    dims: usize,
    values: Vec<f64>,
}

impl Design {
    /// Takes `values`, row after row, as points of `dims` coordinates.
    ///
    /// # Errors
    /// `dims` is zero or above [`MAX_DIMS`], `values` is empty or not a whole
    /// number of rows, or a value is not finite.
    pub fn from_rows(dims: usize, values: Vec<f64>) -> Result<Self, LhsError> {
        check_dims(dims)?;
        let len = values.len();
        if len == 0 || !len.is_multiple_of(dims) {
            return Err(LhsError::Shape { len, dims });
        }
        match values.iter().position(|v| !v.is_finite()) {
            Some(at) => Err(LhsError::NotFinite {
                row: at / dims,
                dim: at % dims,
                value: values[at],
            }),
            None => Ok(Self { dims, values }),
        }
    }

    /// As [`from_rows`](Self::from_rows), for values known to be finite and
    /// of the right length.
    pub(crate) fn from_valid(dims: usize, values: Vec<f64>) -> Self {
        debug_assert!(dims > 0 && !values.is_empty() && values.len().is_multiple_of(dims));
        Self { dims, values }
    }

    /// Number of points n, at least 1.
    pub fn len(&self) -> usize {
        self.values.len() / self.dims
    }

    /// Always false: a design has at least one point.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Number of coordinates m of a point.
    pub fn dims(&self) -> usize {
        self.dims
    }

    /// The points, in order, each a slice of m coordinates.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> + DoubleEndedIterator + Clone {
        self.values.chunks_exact(self.dims)
    }

    /// Point `i`; none when `i` is not below [`len`](Self::len).
    pub fn row(&self, i: usize) -> Option<&[f64]> {
        self.rows().nth(i)
    }

    /// Coordinate `dim` of every point, in order. A `dim` that does not exist
    /// gives no items.
    pub fn column(&self, dim: usize) -> impl ExactSizeIterator<Item = f64> + Clone + '_ {
        let start = if dim < self.dims {
            dim
        } else {
            self.values.len()
        };
        self.values[start..].iter().step_by(self.dims).copied()
    }

    /// All n·m values, row after row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Gives the n·m values away, row after row.
    pub fn into_values(self) -> Vec<f64> {
        self.values
    }
}

/// Refuses a number of variables outside 1 to [`MAX_DIMS`].
pub(crate) fn check_dims(dims: usize) -> Result<(), LhsError> {
    if (1..=MAX_DIMS).contains(&dims) {
        Ok(())
    } else {
        Err(LhsError::Dims { dims })
    }
}

/// Room for `rows` rows, set to zero.
pub(crate) fn zeros(rows: usize, dims: usize) -> Result<Vec<f64>, LhsError> {
    let refused = LhsError::Memory { rows, dims };
    let len = rows.checked_mul(dims).ok_or(refused.clone())?;
    // Asked for first, because `vec!` ends the program where there is no room;
    // then by `vec!`, which leaves the zeros to the system.
    let mut room = Vec::<f64>::new();
    room.try_reserve_exact(len).map_err(|_| refused)?;
    drop(room);
    Ok(vec![0.0; len])
}
