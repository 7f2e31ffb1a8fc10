//! Paths of machines: circles, NURBS, points, G-code.

use std::path::PathBuf;

use feed_axis::commands::contour_route::{AnyPath, PathChoice};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple, PyType};
use toolpath::named::butterfly;
use toolpath::{Blend, Nurbs, NurbsData, Path, PathBlending, PathTolerances, gcode};

use crate::arrays::{line, rows};
use crate::errors::{MotionError, raise, text_of};
use crate::value::{Value, value};

/// A path of two or three axes, m.
#[pyclass(module = "feed_axis", name = "Toolpath", frozen, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyToolpath {
    pub(crate) choice: PathChoice,
    made: Made,
}

/// What it was made from.
#[derive(Clone)]
enum Made {
    Circle(f64, Option<f64>),
    Butterfly,
    Nurbs(Curve),
    Points(Vec<f64>, usize, Corners),
    Gcode(String, String, Corners),
}

/// Whether corners of lines are blended: tolerance (m), shape.
type Corners = (Option<f64>, String);

fn shape_of(name: &str) -> PyResult<Blend> {
    Ok(match name {
        "quintic" => Blend::Quintic,
        "arc" => Blend::Arc,
        "parabola" => Blend::Parabola,
        _ => {
            return Err(MotionError::new_err(format!(
                "blend_shape is {name:?}; valid: quintic, arc, parabola"
            )));
        }
    })
}

/// Control points, coordinates of each, knots, degree, weights.
#[derive(Clone)]
struct Curve {
    points: Vec<f64>,
    columns: usize,
    knots: Vec<f64>,
    degree: usize,
    weights: Vec<f64>,
}

/// Points of `D` coordinates; none if they have another number.
fn points<const D: usize>(values: &[f64], columns: usize) -> Option<Vec<[f64; D]>> {
    let (points, rest) = values.as_chunks::<D>();
    (columns == D && rest.is_empty()).then(|| points.to_vec())
}

/// A path through what `flat` or `space` makes of points of two or three coordinates.
fn any(
    (values, columns): (&[f64], usize),
    flat: impl FnOnce(Vec<[f64; 2]>) -> PyResult<Path<2>>,
    space: impl FnOnce(Vec<[f64; 3]>) -> PyResult<Path<3>>,
) -> PyResult<AnyPath> {
    match (points::<2>(values, columns), points::<3>(values, columns)) {
        (Some(points), _) => flat(points).map(AnyPath::Flat),
        (_, Some(points)) => space(points).map(AnyPath::Space),
        _ => Err(MotionError::new_err(format!(
            "points have {columns} coordinate(s); valid: a row a point, of 2 or 3 coordinates in m"
        ))),
    }
}

impl Curve {
    fn path<const D: usize>(&self, points: Vec<[f64; D]>) -> PyResult<Path<D>> {
        let curve = Nurbs::new(&NurbsData {
            degree: self.degree,
            points,
            weights: self.weights.clone(),
            knots: self.knots.clone(),
        });
        let curve = curve.map_err(raise::<MotionError>)?;
        Path::new(vec![curve.into()]).map_err(raise::<MotionError>)
    }
}

fn whole(name: &str, path: AnyPath) -> PathChoice {
    PathChoice::Whole {
        name: name.to_owned(),
        part: name.to_owned(),
        path,
    }
}

impl PyToolpath {
    fn of(made: Made) -> PyResult<Self> {
        let choice = match &made {
            Made::Circle(radius, tilt) => {
                let choice = PathChoice::Circle {
                    radius: *radius,
                    tilt: *tilt,
                };
                choice.check().map_err(raise::<MotionError>)?;
                choice
            }
            Made::Butterfly => {
                let path = butterfly().map_err(raise::<MotionError>)?;
                whole("butterfly", AnyPath::Flat(path))
            }
            Made::Nurbs(curve) => {
                let values = (&curve.points[..], curve.columns);
                whole("curve", any(values, |p| curve.path(p), |p| curve.path(p))?)
            }
            Made::Points(values, columns, (tolerance, shape)) => {
                let shape = shape_of(shape)?;
                let flat = |p: Vec<_>| Path::polyline(&p).map_err(raise::<MotionError>);
                let space = |p: Vec<_>| Path::polyline(&p).map_err(raise::<MotionError>);
                let choice = whole("points", any((values, *columns), flat, space)?);
                match *tolerance {
                    None => choice,
                    Some(tolerance) => {
                        let blended = choice.blended(&PathBlending { tolerance, shape });
                        blended.map_err(raise::<MotionError>)?
                    }
                }
            }
            Made::Gcode(text, name, (tolerance, shape)) => {
                let blending = (shape_of(shape)?, *tolerance);
                let tolerances = PathTolerances::default();
                let runs = gcode::read_blended(text, [0.0; 3], &tolerances, blending);
                let runs = runs.map_err(raise::<MotionError>)?;
                if runs.is_empty() {
                    return Err(MotionError::new_err(format!(
                        "{name}: no motion is in it; valid: G-code, G0 to G3 with X, Y, Z"
                    )));
                }
                PathChoice::Program {
                    name: name.clone(),
                    runs,
                }
            }
        };
        Ok(Self { choice, made })
    }
}

impl Value for PyToolpath {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        match &self.made {
            Made::Circle(radius, tilt) => ("circle", *radius, *tilt).into_pyobject(py),
            Made::Butterfly => ("butterfly",).into_pyobject(py),
            Made::Nurbs(c) => {
                let tuple = |numbers: &[f64]| PyTuple::new(py, numbers);
                let (points, knots) = (tuple(&c.points)?, tuple(&c.knots)?);
                let weights = tuple(&c.weights)?;
                ("nurbs", points, c.columns, knots, c.degree, weights).into_pyobject(py)
            }
            Made::Points(values, columns, corners) => {
                let values = PyTuple::new(py, values)?;
                ("points", values, *columns, corners.clone()).into_pyobject(py)
            }
            Made::Gcode(text, name, corners) => {
                ("gcode", text, name, corners.clone()).into_pyobject(py)
            }
        }
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let kind: String = state.get_item(0)?.extract()?;
        Self::of(match kind.as_str() {
            "circle" => {
                let (_, radius, tilt): (String, f64, Option<f64>) = state.extract()?;
                Made::Circle(radius, tilt)
            }
            "nurbs" => {
                type State = (String, Vec<f64>, usize, Vec<f64>, usize, Vec<f64>);
                let (_, points, columns, knots, degree, weights): State = state.extract()?;
                Made::Nurbs(Curve {
                    points,
                    columns,
                    knots,
                    degree,
                    weights,
                })
            }
            "points" => {
                let (_, values, columns, corners): (String, Vec<f64>, usize, Corners) =
                    state.extract()?;
                Made::Points(values, columns, corners)
            }
            "gcode" => {
                let (_, text, name, corners): (String, String, String, Corners) =
                    state.extract()?;
                Made::Gcode(text, name, corners)
            }
            _ => Made::Butterfly,
        })
    }
}

value!(PyToolpath, hash);

#[pymethods]
impl PyToolpath {
    /// A circular test, run in both directions; tilted about X it needs three axes.
    #[staticmethod]
    #[pyo3(signature = (radius_m, *, tilt_rad = None))]
    fn circle(radius_m: f64, tilt_rad: Option<f64>) -> PyResult<Self> {
        Self::of(Made::Circle(radius_m, tilt_rad))
    }

    /// The butterfly, a NURBS curve of 383 mm on which feed planners are compared.
    #[staticmethod]
    fn butterfly() -> PyResult<Self> {
        Self::of(Made::Butterfly)
    }

    /// A NURBS curve.
    #[staticmethod]
    #[pyo3(signature = (points_m, knots, *, degree = 3, weights = None))]
    fn nurbs(
        points_m: &Bound<'_, PyAny>,
        knots: &Bound<'_, PyAny>,
        degree: usize,
        weights: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (points, columns) = rows::<MotionError>(points_m, "points_m")?;
        let weights = weights.map(|given| line::<MotionError>(given, "weights"));
        Self::of(Made::Nurbs(Curve {
            points,
            columns,
            knots: line::<MotionError>(knots, "knots")?,
            degree,
            weights: weights.transpose()?.unwrap_or_default(),
        }))
    }

    /// Straight lines through points, a row a point.
    #[staticmethod]
    #[pyo3(signature = (points_m, *, blend_m = None, blend_shape = "quintic"))]
    fn points(
        points_m: &Bound<'_, PyAny>,
        blend_m: Option<f64>,
        blend_shape: &str,
    ) -> PyResult<Self> {
        let (values, columns) = rows::<MotionError>(points_m, "points_m")?;
        Self::of(Made::Points(
            values,
            columns,
            (blend_m, blend_shape.to_owned()),
        ))
    }

    /// A program in G-code, from its text.
    #[staticmethod]
    #[pyo3(signature = (text, *, blend_m = None, blend_shape = "quintic"))]
    fn gcode(text: String, blend_m: Option<f64>, blend_shape: &str) -> PyResult<Self> {
        let corners = (blend_m, blend_shape.to_owned());
        Self::of(Made::Gcode(text, "program".to_owned(), corners))
    }

    /// A program in G-code, from a file.
    #[classmethod]
    #[pyo3(signature = (path, *, blend_m = None, blend_shape = "quintic"))]
    fn load(
        kind: &Bound<'_, PyType>,
        path: PathBuf,
        blend_m: Option<f64>,
        blend_shape: &str,
    ) -> PyResult<Self> {
        let text = text_of::<MotionError>(kind.py(), &path)?;
        let (name, corners) = (
            format!("program {}", path.display()),
            (blend_m, blend_shape.to_owned()),
        );
        let made = Self::of(Made::Gcode(text, name, corners));
        made.map_err(|error| {
            let py = kind.py();
            match error.is_instance_of::<MotionError>(py) {
                true => MotionError::new_err(format!("{}: {}", path.display(), error.value(py))),
                false => error,
            }
        })
    }

    /// What it is called.
    #[getter]
    fn name(&self) -> String {
        self.choice.name()
    }

    /// Length, m; of a program that of all its parts, of a circular test that of one turn.
    #[getter]
    fn length_m(&self) -> f64 {
        match &self.choice {
            PathChoice::Circle { radius, .. } => std::f64::consts::TAU * radius,
            PathChoice::Whole { path, .. } => match path {
                AnyPath::Flat(path) => path.length(),
                AnyPath::Space(path) => path.length(),
            },
            PathChoice::Program { runs, .. } => runs.iter().map(|run| run.path.length()).sum(),
        }
    }

    /// Positions at even steps of the arc length, a row a position, m.
    #[pyo3(signature = (count = 1000))]
    fn positions<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = crate::arrays::count)] count: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        if count < 2 {
            return Err(MotionError::new_err(format!(
                "count is {count}; valid: at least 2"
            )));
        }
        let (values, columns) = self.choice.positions(count).map_err(raise::<MotionError>)?;
        let rows = values.len() / columns;
        values.into_pyarray(py).reshape([rows, columns])
    }

    fn __repr__(&self) -> String {
        format!("Toolpath({}, {:.6} m)", self.choice.name(), self.length_m())
    }
}

/// The shape of blends where none is named.
const QUINTIC: &str = "quintic";

/// A path as a caller may give it.
pub(crate) struct AnyToolpath(pub PathChoice);

impl FromPyObject<'_, '_> for AnyToolpath {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        if let Ok(path) = given.cast::<PyToolpath>() {
            return Ok(Self(path.get().choice.clone()));
        }
        if given.is_instance_of::<PyString>() {
            return Ok(Self(
                PyToolpath::gcode(given.extract()?, None, QUINTIC)?.choice,
            ));
        }
        if given.len().is_err() || given.hasattr("keys")? {
            return Err(PyTypeError::new_err(format!(
                "a {} is no path; valid: a Toolpath, points (a row a point, m), or the text of a program in G-code",
                given.get_type().name()?
            )));
        }
        Ok(Self(PyToolpath::points(&given, None, QUINTIC)?.choice))
    }
}
