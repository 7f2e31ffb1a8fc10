//! Circular tests: squareness and cross-talk of two axes.

use axis_machine::{CircleEstimate, CirclesFound, MeasuredCircle, fit_circles as fit};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use toolpath::iso230_4::NominalCircle;
use toolpath::named::Direction;

use crate::arrays::{line, rows};
use crate::errors::{MotionError, SearchError, raise};
use crate::value::{Value, value};

/// What circular tests show of two axes; each value with its standard error.
#[pyclass(module = "feed_axis", name = "CirclesFound", frozen)]
pub(crate) struct PyCirclesFound(pub(crate) CirclesFound);

/// A value and its standard error.
type Pair = (f64, f64);

fn pair(one: &CircleEstimate) -> Pair {
    (one.value, one.standard_error)
}

impl Value for PyCirclesFound {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let found = &self.0;
        let [x, y] = found.centre.each_ref().map(pair);
        let lag = found.lag.as_ref().map(pair);
        let (phi, k) = (pair(&found.squareness), pair(&found.crosstalk));
        (x, y, pair(&found.radius), phi, k, lag, found.residual).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        type State = (Pair, Pair, Pair, Pair, Pair, Option<Pair>, f64);
        let (x, y, radius, squareness, crosstalk, lag, residual): State = state.extract()?;
        let of = |(value, standard_error): Pair| CircleEstimate {
            value,
            standard_error,
        };
        Ok(Self(CirclesFound {
            centre: [of(x), of(y)],
            radius: of(radius),
            squareness: of(squareness),
            crosstalk: of(crosstalk),
            lag: lag.map(of),
            residual,
        }))
    }
}

value!(PyCirclesFound, hash);

#[pymethods]
impl PyCirclesFound {
    /// Squareness error of both axes, rad (m/m), and its standard error.
    #[getter]
    fn squareness(&self) -> Pair {
        pair(&self.0.squareness)
    }

    /// Cross-talk, m/(m/s²), and its standard error.
    #[getter]
    fn crosstalk(&self) -> Pair {
        pair(&self.0.crosstalk)
    }

    /// Centre less the nominal one, m, with standard errors.
    #[getter]
    fn centre(&self) -> (Pair, Pair) {
        let [x, y] = self.0.centre.each_ref().map(pair);
        (x, y)
    }

    /// Radius less the nominal one, m, and its standard error.
    #[getter]
    fn radius(&self) -> Pair {
        pair(&self.0.radius)
    }

    /// Lag of Y less that of X, s, and its standard error; None if all circles had one direction.
    #[getter]
    fn lag(&self) -> Option<Pair> {
        self.0.lag.as_ref().map(pair)
    }

    /// Root mean square of the radial residuals, m.
    #[getter]
    fn residual(&self) -> f64 {
        self.0.residual
    }

    fn __repr__(&self) -> String {
        let [(phi, d_phi), (k, d_k)] = [&self.0.squareness, &self.0.crosstalk].map(|one| {
            let (value, error) = pair(one);
            (1e6 * value, 1e6 * error)
        });
        format!(
            "CirclesFound(squareness {phi:.2} ± {d_phi:.2} µm/m, cross-talk {k:.2} ± {d_k:.2} µm/(m/s²))"
        )
    }
}

/// A circular test: feed, direction, points.
type Turn<'py> = (f64, String, Bound<'py, PyAny>);

/// Squareness and cross-talk of two axes from measured circles: feed, direction and points of each.
#[pyfunction]
#[pyo3(signature = (circles, *, radius, centre = None))]
pub(crate) fn fit_circles(
    circles: Vec<Turn<'_>>,
    radius: &Bound<'_, PyAny>,
    centre: Option<(f64, f64)>,
) -> PyResult<PyCirclesFound> {
    let radii = line::<MotionError>(radius, "radius")?;
    if radii.len() != 1 && radii.len() != circles.len() {
        return Err(SearchError::new_err(format!(
            "there are {} radii for {} circles; valid: one for all, or one for each",
            radii.len(),
            circles.len()
        )));
    }
    let mut points = Vec::new();
    for (i, (.., given)) in circles.iter().enumerate() {
        let name = format!("points of circle {}", i + 1);
        let (values, columns) = rows::<MotionError>(given, &name)?;
        if columns != 2 {
            return Err(SearchError::new_err(format!(
                "{name} have {columns} column(s); valid: two, x and y in m, a row a point"
            )));
        }
        points.push(values.as_chunks::<2>().0.to_vec());
    }
    let centre = centre.unwrap_or((0.0, 0.0));
    let mut measured = Vec::new();
    for (i, (feed, direction, _)) in circles.iter().enumerate() {
        let direction = match direction.as_str() {
            "clockwise" => Direction::Clockwise,
            "counterclockwise" => Direction::Counterclockwise,
            other => {
                return Err(SearchError::new_err(format!(
                    "the direction of circle {} is {other:?}; valid: \"clockwise\" or \"counterclockwise\"",
                    i + 1
                )));
            }
        };
        measured.push(MeasuredCircle {
            nominal: NominalCircle {
                centre: [centre.0, centre.1],
                radius: radii[if radii.len() == 1 { 0 } else { i }],
            },
            feed: *feed,
            direction,
            points: &points[i],
        });
    }
    fit(&measured)
        .map(PyCirclesFound)
        .map_err(raise::<SearchError>)
}
