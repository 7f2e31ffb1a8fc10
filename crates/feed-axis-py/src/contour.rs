//! What a machine leaves on a path: figures, arrays, pages.

use std::f64::consts::TAU;
use std::path::PathBuf;

use feed_axis::commands::contour_found::{Contoured, LapFigures, MachineContoured, Shown};
use feed_axis::commands::contour_places::Place;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyTuple};
use toolpath::iso230_4::{CircleFigures, DirectionFigures, NominalCircle, figures};

use crate::errors::{SimulationError, package, raise};
use crate::html::{page_to, table};
use crate::value::{Value, value};

/// A machine on a path: contour errors of its last lap as arrays, figures of all laps.
#[pyclass(module = "feed_axis", name = "Contour", frozen, mapping)]
pub(crate) struct PyContour {
    pub(crate) found: MachineContoured,
    /// Radius of a circular test, m.
    pub(crate) radius: Option<f64>,
}

/// Names of the columns of position and foot.
const AXES: [[&str; 2]; 3] = [
    ["x_m", "foot_x_m"],
    ["y_m", "foot_y_m"],
    ["z_m", "foot_z_m"],
];

/// Columns of a sense's last lap: arc length, error, position and foot; of a circle angle and radial deviation.
fn columns(shown: &Shown, radius: Option<f64>) -> Vec<(&'static str, Vec<f64>)> {
    let mut all = vec![("s_m", shown.s.clone()), ("error_m", shown.error.clone())];
    let count = if shown.space.is_empty() { 2 } else { 3 };
    for (axis, names) in AXES.iter().enumerate().take(count) {
        for (which, name) in names.iter().enumerate() {
            let values = match count {
                2 => shown.at.iter().map(|at| at[which][axis]).collect(),
                _ => shown.space.iter().map(|at| at[which][axis]).collect(),
            };
            all.push((name, values));
        }
    }
    if let Some(radius) = radius {
        let tool = || shown.at.iter().map(|at| at[0]);
        let angle = tool().map(|[x, y]| y.atan2(x).rem_euclid(TAU));
        all.push(("angle_rad", angle.collect()));
        all.push((
            "deviation_m",
            tool().map(|[x, y]| x.hypot(y) - radius).collect(),
        ));
    }
    all
}

/// The numbers of a sense as bytes.
fn bytes(shown: &Shown) -> Vec<u8> {
    let plane = shown.at.iter().flatten().flatten();
    let space = shown.space.iter().flatten().flatten();
    let all = shown.s.iter().chain(&shown.error).chain(plane).chain(space);
    all.flat_map(|x| x.to_le_bytes()).collect()
}

/// As [`bytes`] wrote them, of so many positions.
fn shown_of(bytes: &[u8], count: usize) -> Shown {
    let numbers: Vec<f64> = (bytes.as_chunks::<8>().0.iter())
        .map(|number| f64::from_le_bytes(*number))
        .collect();
    let part = |from: usize, to: usize| numbers.get(from * count..to * count).unwrap_or_default();
    let pairs = |numbers: &[f64]| numbers.as_chunks::<2>().0.to_vec();
    let triples = |numbers: &[f64]| numbers.as_chunks::<3>().0.to_vec();
    Shown {
        s: part(0, 1).to_vec(),
        error: part(1, 2).to_vec(),
        at: pairs(part(2, 6)).as_chunks::<2>().0.to_vec(),
        space: triples(part(6, 12)).as_chunks::<2>().0.to_vec(),
    }
}

impl Value for PyContour {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let text = serde_json::to_string(&self.found).map_err(raise::<SimulationError>)?;
        let senses = self.found.directions.iter();
        let senses = senses.map(|one| (one.shown.s.len(), PyBytes::new(py, &bytes(&one.shown))));
        let senses = PyTuple::new(py, senses.collect::<Vec<_>>())?;
        (text, self.found.path_at_feed.clone(), self.radius, senses).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        type State<'py> = (
            String,
            String,
            Option<f64>,
            Vec<(usize, Bound<'py, PyBytes>)>,
        );
        let (text, path_at_feed, radius, senses): State<'_> = state.extract()?;
        let mut found: MachineContoured =
            serde_json::from_str(&text).map_err(raise::<SimulationError>)?;
        found.path_at_feed = path_at_feed;
        for (one, (count, bytes)) in found.directions.iter_mut().zip(senses) {
            one.shown = shown_of(bytes.as_bytes(), count);
        }
        Ok(Self { found, radius })
    }
}

value!(PyContour);

/// SI units of a figure in µm.
fn metres(micro: f64) -> f64 {
    1e-6 * micro
}

impl PyContour {
    /// The figures of a circle that was run in both directions.
    fn circle(&self) -> PyResult<Option<CircleFigures>> {
        let (Some(radius), [there, back]) = (self.radius, &self.found.directions[..]) else {
            return Ok(None);
        };
        let nominal = NominalCircle {
            centre: [0.0; 2],
            radius,
        };
        let points = |one: &Contoured| one.shown.at.iter().map(|at| at[0]).collect::<Vec<_>>();
        let found = figures(&nominal, &points(there), &points(back));
        found.map(Some).map_err(raise::<SimulationError>)
    }

    fn lap_rows(&self) -> impl Iterator<Item = (&str, &LapFigures)> {
        let senses = self.found.directions.iter();
        senses.flat_map(|one| one.laps.iter().map(|lap| (one.direction.as_str(), lap)))
    }

    fn places<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Contoured) -> &[Place],
    ) -> PyResult<Bound<'py, PyList>> {
        let rows = PyList::empty(py);
        for one in &self.found.directions {
            for place in of(one) {
                let row = PyDict::new(py);
                row.set_item("part", &place.part)?;
                row.set_item("s_m", 1e-3 * place.s_mm)?;
                if let Some(angle) = place.angle_deg {
                    row.set_item("angle_rad", angle.to_radians())?;
                }
                if let Some(radius) = place.radius_mm {
                    row.set_item("radius_m", 1e-3 * radius)?;
                }
                row.set_item("error_m", metres(place.error_um))?;
                rows.append(row)?;
            }
        }
        Ok(rows)
    }

    /// All senses in one dict of columns.
    fn frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let frame = PyDict::new(py);
        let senses = &self.found.directions;
        let names = senses
            .iter()
            .flat_map(|one| std::iter::repeat_n(one.direction.as_str(), one.shown.s.len()));
        frame.set_item("direction", names.collect::<Vec<_>>())?;
        let all: Vec<_> = senses
            .iter()
            .map(|one| columns(&one.shown, self.radius))
            .collect();
        for (i, (name, _)) in all.first().into_iter().flatten().enumerate() {
            let column = all.iter().flat_map(|columns| columns[i].1.iter().copied());
            frame.set_item(name, column.collect::<Vec<_>>().into_pyarray(py))?;
        }
        Ok(frame)
    }
}

#[pymethods]
impl PyContour {
    /// Arrays of one direction's last lap, by name.
    fn __getitem__<'py>(&self, py: Python<'py>, direction: &str) -> PyResult<Bound<'py, PyDict>> {
        let found = self.found.directions.iter();
        let found = found
            .clone()
            .find(|one| one.direction == direction)
            .ok_or_else(|| {
                PyKeyError::new_err(format!(
                    "there is no direction {direction:?}; there are: {}",
                    self.keys().join(", ")
                ))
            })?;
        let dict = PyDict::new(py);
        for (name, values) in columns(&found.shown, self.radius) {
            let values: Bound<'_, PyArray1<f64>> = values.into_pyarray(py);
            dict.set_item(name, values)?;
        }
        Ok(dict)
    }

    fn __contains__(&self, direction: &str) -> bool {
        self.keys().contains(&direction)
    }

    /// Number of directions.
    fn __len__(&self) -> usize {
        self.found.directions.len()
    }

    fn __iter__(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let names = self.keys().into_pyobject(py)?;
        Ok(names.try_iter()?.into_any().unbind())
    }

    /// Directions of a circle; of another path the name of its one.
    fn keys(&self) -> Vec<&str> {
        let senses = self.found.directions.iter();
        senses.map(|one| one.direction.as_str()).collect()
    }

    /// Greatest contour error of the last lap, m.
    #[getter]
    fn max_error(&self) -> f64 {
        let last = self
            .found
            .directions
            .iter()
            .filter_map(|one| one.laps.last());
        metres(last.map(|lap| lap.contour_error_um).fold(0.0, f64::max))
    }

    /// Contour error of every lap: greatest, that of which 99 % are below, root mean square.
    #[getter]
    fn laps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let rows = PyList::empty(py);
        for (direction, lap) in self.lap_rows() {
            let row = PyDict::new(py);
            row.set_item("direction", direction)?;
            row.set_item("lap", lap.lap)?;
            row.set_item("max_error_m", metres(lap.contour_error_um))?;
            row.set_item("p99_error_m", metres(lap.p99_um))?;
            row.set_item("rms_error_m", metres(lap.rms_um))?;
            rows.append(row)?;
        }
        Ok(rows)
    }

    /// Figures of a circular test in the manner of ISO 230-4, by name; None of another path.
    #[getter]
    fn figures<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(found) = self.circle()? else {
            return Ok(None);
        };
        let one = |of: &DirectionFigures| -> PyResult<Bound<'py, PyDict>> {
            let dict = PyDict::new(py);
            dict.set_item("g_m", of.g)?;
            dict.set_item("f_max_m", of.f_max)?;
            dict.set_item("f_min_m", of.f_min)?;
            Ok(dict)
        };
        let dict = PyDict::new(py);
        dict.set_item("clockwise", one(&found.clockwise)?)?;
        dict.set_item("counterclockwise", one(&found.counterclockwise)?)?;
        dict.set_item("g_bidirectional_m", found.g_bidirectional)?;
        dict.set_item("h_m", found.h)?;
        dict.set_item("d_m", found.d)?;
        Ok(Some(dict))
    }

    /// Peaks of the radial deviation after an axis of a circle has reversed, in the last lap.
    #[getter]
    fn reversals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let rows = PyList::empty(py);
        for one in &self.found.directions {
            for reversal in &one.reversals {
                let row = PyDict::new(py);
                row.set_item("direction", &one.direction)?;
                row.set_item("axis", &reversal.axis)?;
                row.set_item("angle_rad", reversal.angle_deg.to_radians())?;
                row.set_item("peak_m", metres(reversal.peak_um))?;
                rows.append(row)?;
            }
        }
        Ok(rows)
    }

    /// Corners with the contour error near them, in the last lap.
    #[getter]
    fn corners<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        self.places(py, |one| &one.corners)
    }

    /// Tightest curves with the contour error near them, in the last lap.
    #[getter]
    fn curves<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        self.places(py, |one| &one.curves)
    }

    /// Feed against contour error, a row a feed.
    #[getter]
    fn feeds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let rows = PyList::empty(py);
        for feed in &self.found.feeds {
            let row = PyDict::new(py);
            row.set_item("feed_m_s", feed.feed_m_per_min / 60.0)?;
            row.set_item("fastest_m_s", feed.fastest_m_per_min / 60.0)?;
            row.set_item("duration_s", feed.duration_s)?;
            row.set_item("first_max_error_m", metres(feed.first_um))?;
            row.set_item("last_max_error_m", metres(feed.last_um))?;
            rows.append(row)?;
        }
        Ok(rows)
    }

    /// Time of one lap in one direction, run-in and run-out included, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        let first = self.found.directions.first();
        first.map_or(0.0, |one| one.duration_s)
    }

    /// Radius of a circular test, m; None of another path.
    #[getter]
    fn radius_m(&self) -> Option<f64> {
        self.radius
    }

    /// The last lap of all directions as a pandas DataFrame.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let pandas = package(py, "pandas", "to_pandas")?;
        pandas.getattr("DataFrame")?.call1((self.frame(py)?,))
    }

    /// The last lap of all directions as a polars DataFrame.
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let polars = package(py, "polars", "to_polars")?;
        polars.getattr("DataFrame")?.call1((self.frame(py)?,))
    }

    /// Draws the radial deviation of a circle over the angle, or the contour error along the path.
    #[pyo3(signature = (ax = None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        ax: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let plots = slf.py().import("feed_axis._plot")?;
        plots.call_method1("plot_contour", (slf, ax))
    }

    /// The page that the command writes; to a file too where one is named.
    #[pyo3(signature = (path = None))]
    fn to_html(&self, py: Python<'_>, path: Option<PathBuf>) -> PyResult<String> {
        let page = feed_axis::machine_page(&self.found, self.radius);
        let text = axis_report::render(&page).map_err(raise::<SimulationError>)?;
        page_to(py, text, path)
    }

    fn _repr_html_(&self) -> String {
        let value = |um: f64| format!("{um:.3} µm");
        let rows = self.lap_rows().map(|(direction, lap)| {
            let errors = [lap.contour_error_um, lap.p99_um, lap.rms_um];
            let mut row = vec![format!("{direction}, lap {}", lap.lap)];
            row.extend(errors.map(value));
            row
        });
        let heads = ["contour error", "greatest", "99 %", "rms"];
        table(&self.found.title(), &heads, &rows.collect::<Vec<_>>())
    }

    fn __repr__(&self) -> String {
        let laps = self
            .found
            .directions
            .first()
            .map_or(0, |one| one.laps.len());
        format!(
            "Contour({}, {laps} lap(s), contour error max {:.4} µm in the last)",
            self.found.title(),
            1e6 * self.max_error()
        )
    }
}
