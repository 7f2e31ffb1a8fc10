//! Designs of experiments: Latin hypercubes, and the sequences of Sobol and Halton.

use lhs::{Design, Halton, LatinHypercube, LhsError, Marginal, Scrambling, Sobol, Uniform, map};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

use crate::arrays;
use crate::arrays::rows_of;
use crate::errors::{ParameterError, raise};

/// An array of a row a point.
type Points<'py> = Bound<'py, PyArray2<f64>>;

/// The points that `design` makes of a number of variables, between bounds (least, greatest) of each.
fn between<'py>(
    py: Python<'py>,
    bounds: &Bound<'py, PyAny>,
    design: impl FnOnce(usize) -> Result<Design, LhsError> + Send,
) -> PyResult<Points<'py>> {
    let bounds = rows_of::<ParameterError>(bounds, "bounds", 2)?;
    let dims = bounds.len() / 2;
    let drawn = py.detach(|| -> Result<Vec<f64>, LhsError> {
        let marginals = bounds.chunks(2).map(|pair| Uniform::new(pair[0], pair[1]));
        let marginals = marginals.collect::<Result<Vec<_>, _>>()?;
        let marginals: Vec<&dyn Marginal> = marginals.iter().map(|m| m as &dyn Marginal).collect();
        Ok(map(&design(dims)?, &marginals)?.into_values())
    });
    let drawn = drawn.map_err(raise::<ParameterError>)?;
    let points = drawn.len() / dims.max(1);
    drawn.into_pyarray(py).reshape([points, dims])
}

/// `n` points between bounds (least, greatest) of each variable: each of the n intervals of
/// each variable holds exactly one. An array of a row a point.
#[pyfunction]
#[pyo3(signature = (n, bounds, *, seed = 1, centred = false))]
pub(crate) fn latin_hypercube<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = arrays::n)] n: usize,
    bounds: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = arrays::seed)] seed: u64,
    centred: bool,
) -> PyResult<Points<'py>> {
    between(py, bounds, |dims| {
        let hypercube = LatinHypercube::new(n, dims, seed)?;
        match centred {
            true => hypercube.centred().design(),
            false => hypercube.design(),
        }
    })
}

/// `n` points of Sobol's sequence from point `start` on, between bounds of each variable.
/// `scrambling`: `owen`, `linear-matrix`, or none for the plain sequence.
#[pyfunction]
#[pyo3(signature = (n, bounds, *, scrambling = Some("owen".to_owned()), seed = 1, start = 0), text_signature = "(n, bounds, *, scrambling='owen', seed=1, start=0)")]
pub(crate) fn sobol<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = arrays::n)] n: usize,
    bounds: &Bound<'py, PyAny>,
    scrambling: Option<String>,
    #[pyo3(from_py_with = arrays::seed)] seed: u64,
    #[pyo3(from_py_with = arrays::start)] start: u64,
) -> PyResult<Points<'py>> {
    let scrambling = match scrambling.as_deref() {
        None => None,
        Some("owen") => Some(Scrambling::Owen),
        Some("linear-matrix") => Some(Scrambling::LinearMatrix),
        Some(other) => {
            return Err(ParameterError::new_err(format!(
                "scrambling is {other:?}; valid: \"owen\", \"linear-matrix\", None"
            )));
        }
    };
    between(py, bounds, |dims| {
        let sequence = match scrambling {
            None => Sobol::new(dims)?,
            Some(scrambling) => Sobol::scrambled(dims, scrambling, seed)?,
        };
        sequence.shard(rows(start, n))
    })
}

/// `n` points of Halton's sequence from point `start` on, between bounds of each variable; plain,
/// or with permuted digits.
#[pyfunction]
#[pyo3(signature = (n, bounds, *, scrambled = true, seed = 1, start = 0))]
pub(crate) fn halton<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = arrays::n)] n: usize,
    bounds: &Bound<'py, PyAny>,
    scrambled: bool,
    #[pyo3(from_py_with = arrays::seed)] seed: u64,
    #[pyo3(from_py_with = arrays::start)] start: u64,
) -> PyResult<Points<'py>> {
    between(py, bounds, |dims| {
        let sequence = match scrambled {
            true => Halton::scrambled(dims, seed)?,
            false => Halton::new(dims)?,
        };
        sequence.shard(rows(start, n))
    })
}

/// Which points of a sequence.
fn rows(start: u64, n: usize) -> std::ops::Range<u64> {
    start..start.saturating_add(n as u64)
}
