//! Symmetric matrices in banded storage.

use nalgebra::DMatrix;

use crate::BeamError;
use crate::element::Entry;
use crate::error::check_size;

/// A symmetric matrix of which only entries near the diagonal are stored:
/// |row − column| ≤ half bandwidth. Column j of the lower triangle lies
/// contiguously, its diagonal first.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricBanded {
    order: usize,
    half_bandwidth: usize,
    data: Vec<f64>,
}

impl SymmetricBanded {
    /// Zeros, `order` × `order`.
    ///
    /// # Errors
    /// [`BeamError::TooLarge`] for more entries, `order` × (`half_bandwidth` + 1),
    /// than are sensible to store.
    pub fn zeros(order: usize, half_bandwidth: usize) -> Result<Self, BeamError> {
        check_size("a band", order.max(1), half_bandwidth.saturating_add(1))?;
        Ok(Self::sized(order, half_bandwidth))
    }

    /// Zeros of a size that was checked.
    fn sized(order: usize, half_bandwidth: usize) -> Self {
        Self {
            order,
            half_bandwidth,
            data: vec![0.0; order * (half_bandwidth + 1)],
        }
    }

    /// Number of rows and columns.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Largest |row − column| that is stored.
    pub fn half_bandwidth(&self) -> usize {
        self.half_bandwidth
    }

    /// The entry at (row, column), 0 outside the band; none if the row or
    /// column does not exist.
    pub fn get(&self, row: usize, column: usize) -> Option<f64> {
        let (low, high) = (row.min(column), row.max(column));
        let stored = || self.column(low).get(high - low).copied();
        (high < self.order).then(|| stored().unwrap_or(0.0))
    }

    /// Adds `value` to the entry at (row, column) and its mirror image: a
    /// support spring, a lumped mass.
    ///
    /// # Errors
    /// [`BeamError::Index`] outside the matrix or the band.
    pub fn add(&mut self, row: usize, column: usize, value: f64) -> Result<(), BeamError> {
        let (low, high) = (row.min(column), row.max(column));
        let bound = self.order.min(low.saturating_add(self.half_bandwidth + 1));
        if high >= bound {
            return Err(BeamError::Index {
                field: "row or column",
                index: high,
                bound,
            });
        }
        self.data[low * (self.half_bandwidth + 1) + high - low] += value;
        Ok(())
    }

    /// Entries (j, j), (j+1, j), … of column j.
    pub(crate) fn column(&self, j: usize) -> &[f64] {
        let width = self.half_bandwidth + 1;
        &self.data[j * width..(j + 1) * width]
    }

    /// All columns, one after the other.
    pub(crate) fn data(&self) -> &[f64] {
        &self.data
    }

    /// The whole matrix, dense.
    ///
    /// # Errors
    /// [`BeamError::TooLarge`] for more entries, order squared, than are
    /// sensible to store.
    pub fn to_dense(&self) -> Result<DMatrix<f64>, BeamError> {
        check_size("a dense matrix", self.order, self.order)?;
        let entry = |i, j| self.get(i, j).unwrap_or(0.0);
        Ok(DMatrix::from_fn(self.order, self.order, entry))
    }

    /// Rows and columns `kept` (ascending) of this matrix, in a band no wider
    /// than they need.
    pub(crate) fn select(&self, kept: &[usize]) -> Self {
        let mut place = vec![usize::MAX; self.order];
        for (i, &k) in kept.iter().enumerate() {
            place[k] = i;
        }
        let stored = |j: usize| {
            let near = self.column(kept[j]).iter().zip(&place[kept[j]..]);
            near.filter(|(value, row)| **value != 0.0 && **row != usize::MAX)
        };
        let width = (0..kept.len())
            .flat_map(|j| stored(j).map(move |(_, row)| row - j))
            .max()
            .unwrap_or(0);
        let mut out = Self::sized(kept.len(), width);
        for j in 0..kept.len() {
            for (value, row) in stored(j) {
                out.data[j * (width + 1) + row - j] = *value;
            }
        }
        out
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.data.iter().all(|v| v.is_finite())
    }
}

/// M and K of `M q̈ + K q = F` in banded storage.
#[derive(Clone, Debug, PartialEq)]
pub struct BandedMatrices {
    /// Mass M, kg, kg·m and kg·m².
    pub mass: SymmetricBanded,
    /// Stiffness K, N/m, N and N·m.
    pub stiffness: SymmetricBanded,
}

impl BandedMatrices {
    /// Half bandwidth of a beam: an element couples 12 neighbouring rows.
    pub const HALF_BANDWIDTH: usize = 11;

    /// Zeros, to assemble a beam into.
    ///
    /// # Errors
    /// As [`SymmetricBanded::zeros`].
    pub fn zeros(order: usize) -> Result<Self, BeamError> {
        check_size("a band", order, Self::HALF_BANDWIDTH + 1)?;
        Ok(Self::sized(order))
    }

    /// Zeros of a size that was checked.
    pub(crate) fn sized(order: usize) -> Self {
        Self {
            mass: SymmetricBanded::sized(order, Self::HALF_BANDWIDTH),
            stiffness: SymmetricBanded::sized(order, Self::HALF_BANDWIDTH),
        }
    }

    /// The matrices with the `fixed` degrees of freedom held at zero: their
    /// rows and columns are left out. The others keep their order.
    ///
    /// # Errors
    /// [`BeamError::Index`] for a degree of freedom that does not exist,
    /// [`BeamError::Shape`] if M and K are not of one order.
    pub fn fixed(&self, fixed: &[usize]) -> Result<Self, BeamError> {
        self.check_orders()?;
        let free = free_dofs(self.mass.order(), fixed)?;
        Ok(Self {
            mass: self.mass.select(&free),
            stiffness: self.stiffness.select(&free),
        })
    }

    /// Refuses a K that is not of the order of M.
    pub(crate) fn check_orders(&self) -> Result<(), BeamError> {
        let (order, rows) = (self.mass.order, self.stiffness.order);
        if rows == order {
            return Ok(());
        }
        Err(BeamError::Shape {
            field: "stiffness",
            rows,
            columns: rows,
            order,
        })
    }

    pub(crate) fn check(&self, order: usize) -> Result<(), BeamError> {
        for (field, matrix) in [("mass", &self.mass), ("stiffness", &self.stiffness)] {
            let rows = matrix.order;
            if rows != order {
                return Err(BeamError::Shape {
                    field,
                    rows,
                    columns: rows,
                    order,
                });
            }
            let (found, needed) = (matrix.half_bandwidth, Self::HALF_BANDWIDTH);
            if found != needed {
                return Err(BeamError::Band {
                    field,
                    found,
                    needed,
                });
            }
        }
        Ok(())
    }

    pub(crate) fn clear(&mut self) {
        self.mass.data.fill(0.0);
        self.stiffness.data.fill(0.0);
    }

    /// Adds an element whose first row is `first`.
    #[inline]
    pub(crate) fn add_element(&mut self, first: usize, entries: &[Entry; 26]) {
        let width = Self::HALF_BANDWIDTH + 1;
        let window = first * width..(first + 12) * width;
        let mass = &mut self.mass.data[window.clone()];
        let stiffness = &mut self.stiffness.data[window];
        for e in entries {
            let place = e.column * width + e.row - e.column;
            mass[place] += e.mass;
            stiffness[place] += e.stiffness;
        }
    }
}

/// All of 0..order that is not in `fixed`, ascending.
pub(crate) fn free_dofs(order: usize, fixed: &[usize]) -> Result<Vec<usize>, BeamError> {
    let mut held = vec![false; order];
    for &index in fixed {
        *held.get_mut(index).ok_or(BeamError::Index {
            field: "fixed",
            index,
            bound: order,
        })? = true;
    }
    Ok((0..order).filter(|&i| !held[i]).collect())
}
