//! Latin hypercubes.

use lhs::{LatinHypercube, LhsError, Marginal, Uniform, map};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

use crate::arrays;
use crate::arrays::rows_of;
use crate::errors::{ParameterError, raise};

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
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let bounds = rows_of::<ParameterError>(bounds, "bounds", 2)?;
    let dims = bounds.len() / 2;
    let drawn = py.detach(|| -> Result<Vec<f64>, LhsError> {
        let hypercube = LatinHypercube::new(n, dims, seed)?;
        let hypercube = match centred {
            true => hypercube.centred(),
            false => hypercube,
        };
        let marginals = bounds.chunks(2).map(|pair| Uniform::new(pair[0], pair[1]));
        let marginals = marginals.collect::<Result<Vec<_>, _>>()?;
        let marginals: Vec<&dyn Marginal> = marginals.iter().map(|m| m as &dyn Marginal).collect();
        Ok(map(&hypercube.design()?, &marginals)?.into_values())
    });
    let drawn = drawn.map_err(raise::<ParameterError>)?;
    drawn.into_pyarray(py).reshape([n, dims])
}
