//! Saturation as a table over the currents.

use super::{FluxMap, IncrementalInductances, newton};
use crate::error::{FocError, check};
use crate::frames::Dq;
use axis_scalar::Scalar;

/// The parts of a [`FluxTable`], borrowed: a table in a controller's flash stays there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluxTableParts<'a, T = f64> {
    /// The d currents of the rows, A: two or more, ascending.
    pub id: &'a [T],
    /// The q currents of the columns, A: two or more, ascending.
    pub iq: &'a [T],
    /// λ_d, V·s, row by row: that of row r and column c is at r · columns + c.
    pub flux_d: &'a [T],
    /// λ_q, V·s, in the same order.
    pub flux_q: &'a [T],
}

/// A flux map measured or computed on a grid of currents, bilinear in between. Beyond the
/// grid its outermost cells go on. Both ways are continuous, since validation refuses a
/// cell in which the flux does not grow with the current.
///
/// ```
/// use foc_pmsm::saturation::{FluxMap, FluxTable, FluxTableParts};
/// use foc_pmsm::Dq;
///
/// let table = FluxTable::new(FluxTableParts {
///     id: &[-10.0, 0.0], iq: &[-10.0, 0.0, 10.0],
///     flux_d: &[0.20, 0.21, 0.20, 0.25, 0.27, 0.25],
///     flux_q: &[-0.11, 0.0, 0.11, -0.10, 0.0, 0.10],
/// })?;
/// let flux = table.flux(Dq { d: -5.0, q: 5.0 });
/// assert!((flux.d - 0.2325_f64).abs() < 1e-12 && (flux.q - 0.0525_f64).abs() < 1e-12);
/// # Ok::<(), foc_pmsm::FocError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluxTable<'a, T = f64> {
    parts: FluxTableParts<'a, T>,
}

/// The bilinear map of one cell, with x and y from 0 to 1 inside.
struct Cell<T> {
    /// Currents of its first corner, and its widths, A.
    first: Dq<T>,
    widths: Dq<T>,
    /// Flux of the first corner; what x adds to it, what y adds, what both add.
    flux: Dq<T>,
    along_d: Dq<T>,
    along_q: Dq<T>,
    twist: Dq<T>,
}

impl<'a, T: Scalar> FluxTable<'a, T> {
    /// Validates the parts.
    ///
    /// # Errors
    /// [`FocError`] for a table without a cell or whose lengths do not fit together, a
    /// number that is not finite, currents that do not ascend, and a cell that is folded:
    /// whose incremental inductances dd or qq are not greater than 0, or whose determinant
    /// is not, at one of its corners (in between the determinant lies between theirs).
    pub fn new(parts: FluxTableParts<'a, T>) -> Result<Self, FocError> {
        let FluxTableParts {
            id,
            iq,
            flux_d,
            flux_q,
        } = parts;
        ascending("id", id)?;
        ascending("iq", iq)?;
        let nodes = id.len().saturating_mul(iq.len());
        for (field, values) in [("flux_d", flux_d), ("flux_q", flux_q)] {
            if values.len() != nodes {
                return Err(FocError::TableShape {
                    field,
                    length: values.len(),
                    valid: "rows times columns",
                });
            }
            for &value in values {
                check(value.is_finite(), field, value, "finite")?;
            }
        }
        let table = Self { parts };
        for row in 0..id.len() - 1 {
            for column in 0..iq.len() - 1 {
                if !table.cell(row, column).grows() {
                    return Err(FocError::FoldedCell { row, column });
                }
            }
        }
        Ok(table)
    }

    /// The parts that the table was built from.
    pub fn parts(&self) -> &FluxTableParts<'a, T> {
        &self.parts
    }

    fn cell(&self, row: usize, column: usize) -> Cell<T> {
        let FluxTableParts {
            id,
            iq,
            flux_d,
            flux_q,
        } = self.parts;
        let node = |r: usize, c: usize| Dq {
            d: flux_d[r * iq.len() + c],
            q: flux_q[r * iq.len() + c],
        };
        let flux = node(row, column);
        let along_d = node(row + 1, column) - flux;
        let along_q = node(row, column + 1) - flux;
        let far = node(row + 1, column + 1);
        Cell {
            first: Dq {
                d: id[row],
                q: iq[column],
            },
            widths: Dq {
                d: id[row + 1] - id[row],
                q: iq[column + 1] - iq[column],
            },
            flux,
            along_d,
            along_q,
            twist: far - flux - along_d - along_q,
        }
    }

    /// The cell of a current; of what is not a number the first.
    fn cell_of(&self, current: Dq<T>) -> Cell<T> {
        let place = |grid: &[T], i: T| {
            let beyond = grid.partition_point(|&x| x <= i);
            beyond.clamp(1, grid.len() - 1) - 1
        };
        let row = place(self.parts.id, current.d);
        self.cell(row, place(self.parts.iq, current.q))
    }
}

impl<T: Scalar> Cell<T> {
    fn at(&self, current: Dq<T>) -> (T, T) {
        let inside = current - self.first;
        (inside.d / self.widths.d, inside.q / self.widths.q)
    }

    fn flux(&self, current: Dq<T>) -> Dq<T> {
        let (x, y) = self.at(current);
        self.flux + self.along_d * x + (self.along_q + self.twist * x) * y
    }

    fn inductances(&self, x: T, y: T) -> IncrementalInductances<T> {
        let d = (self.along_d + self.twist * y) * (T::ONE / self.widths.d);
        let q = (self.along_q + self.twist * x) * (T::ONE / self.widths.q);
        IncrementalInductances {
            dd: d.d,
            dq: q.d,
            qd: d.q,
            qq: q.q,
        }
    }

    fn grows(&self) -> bool {
        let ends = [T::ZERO, T::ONE];
        ends.iter().all(|&x| {
            ends.iter().all(|&y| {
                let l = self.inductances(x, y);
                l.dd > T::ZERO && l.qq > T::ZERO && l.determinant() > T::ZERO
            })
        })
    }
}

impl<T: Scalar> FluxMap<T> for FluxTable<'_, T> {
    fn flux(&self, current: Dq<T>) -> Dq<T> {
        self.cell_of(current).flux(current)
    }

    /// By Newton's method, from the middle of the grid, in at most 40 steps.
    fn current(&self, flux: Dq<T>) -> Dq<T> {
        let FluxTableParts { id, iq, .. } = self.parts;
        let middle = |grid: &[T]| T::HALF * grid[0] + T::HALF * grid[grid.len() - 1];
        let start = Dq {
            d: middle(id),
            q: middle(iq),
        };
        let size = self.parts.flux_d.iter().chain(self.parts.flux_q);
        let size = size.fold(flux.d.abs() + flux.q.abs(), |most, x| most.max(x.abs()));
        newton(
            start,
            |x| self.flux(x) - flux,
            |x, e| {
                let cell = self.cell_of(x);
                let (x, y) = cell.at(x);
                cell.inductances(x, y).solve(e)
            },
            size,
        )
    }

    /// Of the cell; on the line between two, that of the larger current.
    fn inductances(&self, current: Dq<T>) -> IncrementalInductances<T> {
        let cell = self.cell_of(current);
        let (x, y) = cell.at(current);
        cell.inductances(x, y)
    }
}

fn ascending<T: Scalar>(field: &'static str, grid: &[T]) -> Result<(), FocError> {
    if grid.len() < 2 {
        return Err(FocError::TableShape {
            field,
            length: grid.len(),
            valid: "2 or more",
        });
    }
    for &x in grid {
        check(x.is_finite(), field, x, "finite")?;
    }
    for pair in grid.windows(2) {
        check(pair[0] < pair[1], field, pair[1], "ascending")?;
    }
    Ok(())
}
