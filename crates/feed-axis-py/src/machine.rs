//! Machines of several axes on one path.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use axis_machine::{Coupling, MachineFile, MachineFileError, MachineText};
use axis_pipeline::strategies::{NONE, Predictors, STRATEGIES, StrategyKind, named};
use axis_sim::Axis;
use feed_axis::commands::contour_drives::{ContourError, DriveCompensations};
use feed_axis::commands::contour_laps::{ReferenceCorrection, Run, coupling_of, identify, run};
use feed_axis::commands::contour_route::{PathChoice, Wanted};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyMapping, PyString, PyTuple, PyType};
use toml::{Table, Value as Toml};

use crate::arrays::{self, line};
use crate::axis::PyAxis;
use crate::circles::PyCirclesFound;
use crate::compensation::PyCompensator;
use crate::contour::PyContour;
use crate::dict::table_of;
use crate::errors::{
    MachineError, MotionError, SearchError, SimulationError, StrategyError, raise, text_of,
};
use crate::long::{Hook, long};
use crate::toolpath::AnyToolpath;
use crate::value::{Value, value};

/// Two or three axes that carry a tool, and what lies between them.
#[pyclass(module = "feed_axis", name = "Machine", frozen, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyMachine {
    file: Arc<MachineFile>,
    /// Axes of the coordinates, then the second drives.
    axes: Vec<PyAxis>,
}

/// An error of a machine file as an exception.
fn of_file(error: MachineFileError) -> PyErr {
    raise::<MachineError>(error)
}

/// An error of a run as an exception of its kind.
fn of_run(error: ContourError) -> PyErr {
    match error {
        ContourError::Path(_) => raise::<MotionError>(error),
        ContourError::File(_) | ContourError::Dimensions { .. } => raise::<MachineError>(error),
        ContourError::Strategy { .. } | ContourError::Drives { .. } => {
            raise::<StrategyError>(error)
        }
        ContourError::Circles(_) | ContourError::NoCircle => raise::<SearchError>(error),
        _ => raise::<SimulationError>(error),
    }
}

/// Names of the axes in their order.
const NAMES: [&str; 3] = ["x", "y", "z"];

impl PyMachine {
    fn of_text(text: MachineText, path: PathBuf, axes: Vec<PyAxis>) -> PyResult<Self> {
        let count = text.axes.files().len().min(axes.len());
        let plain = |axes: &[PyAxis]| axes.iter().map(|one| Axis::clone(&one.axis)).collect();
        let (firsts, seconds) = axes.split_at(count);
        let file = MachineFile::of_parts(text, path, plain(firsts), plain(seconds));
        let file = file.map_err(of_file)?;
        // Refused here, so that no run can be for what the axes cannot do together.
        match file.dimensions() {
            3 => drop(file.machine::<3>().map_err(of_file)?),
            _ => drop(file.machine::<2>().map_err(of_file)?),
        }
        Ok(Self {
            file: Arc::new(file),
            axes,
        })
    }

    /// Of axes by their names and the tables of a machine file.
    fn of_axes(
        axes: Vec<PyAxis>,
        name: Option<String>,
        tables: Vec<(&str, Vec<Table>)>,
        seconds: Vec<PyAxis>,
    ) -> PyResult<Self> {
        let names = || axes.iter().map(|one| one.axis.name.clone());
        let own = NAMES.iter().zip(names());
        let own = own.map(|(axis, name)| format!("{} {name}", axis.to_uppercase()));
        let files = NAMES.iter().zip(names());
        let files = files.map(|(axis, name)| ((*axis).to_owned(), Toml::String(name)));
        let mut all = Table::new();
        all.insert("schema".to_owned(), Toml::Integer(1));
        let name = name.unwrap_or_else(|| own.collect::<Vec<_>>().join(", "));
        all.insert("name".to_owned(), Toml::String(name.clone()));
        all.insert("axes".to_owned(), Toml::Table(files.collect()));
        for (key, rows) in tables {
            let rows = rows.into_iter().map(Toml::Table).collect();
            all.insert(key.to_owned(), Toml::Array(rows));
        }
        let path = PathBuf::from(format!("<{name}>"));
        let text = MachineText::parse(&path, &all.to_string()).map_err(of_file)?;
        Self::of_text(text, path, [axes, seconds].concat())
    }
}

impl Value for PyMachine {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let text = toml::to_string(&self.file.text).map_err(raise::<MachineError>)?;
        let axes = PyTuple::new(py, self.axes.iter().cloned())?;
        (text, self.file.path.clone(), axes).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (text, path, axes): (String, PathBuf, Vec<PyRef<'_, PyAxis>>) = state.extract()?;
        let axes = axes.iter().map(|one| PyAxis::clone(one)).collect();
        let text = MachineText::parse(&path, &text).map_err(of_file)?;
        Self::of_text(text, path, axes)
    }

    /// Where the file lies does not count.
    fn key<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let text = toml::to_string(&self.file.text).map_err(raise::<MachineError>)?;
        let prints = self.axes.iter().map(|one| one.axis.fingerprint.clone());
        (text, PyTuple::new(py, prints)?).into_pyobject(py)
    }
}

value!(PyMachine, hash);

/// Axes in a sequence, or by their names.
fn axes_of(given: &Bound<'_, PyAny>) -> PyResult<Vec<PyAxis>> {
    let refused = |what: String| {
        PyTypeError::new_err(format!(
            "axes {what}; valid: the path of a machine file, two or three Axis in a list, or a dict of them by x, y and z"
        ))
    };
    let all: Vec<Bound<'_, PyAny>> = match given.cast::<PyMapping>() {
        Ok(mapping) => {
            let keys: Vec<String> = mapping.keys()?.extract()?;
            if let Some(other) = keys.iter().find(|key| !NAMES.contains(&key.as_str())) {
                return Err(refused(format!("has the key {other:?}")));
            }
            let here = NAMES
                .iter()
                .filter(|name| keys.iter().any(|key| key == *name));
            here.map(|name| mapping.get_item(name))
                .collect::<PyResult<_>>()?
        }
        Err(_) => match given.try_iter() {
            Ok(items) => items.collect::<PyResult<_>>()?,
            Err(_) => return Err(refused(format!("is a {}", given.get_type().name()?))),
        },
    };
    if !(2..=3).contains(&all.len()) {
        return Err(refused(format!("holds {}", all.len())));
    }
    let one = |item: &Bound<'_, PyAny>| match item.extract::<PyRef<'_, PyAxis>>() {
        Ok(axis) => Ok(PyAxis::clone(&axis)),
        Err(_) => Err(refused(format!("holds a {}", item.get_type().name()?))),
    };
    all.iter().map(one).collect()
}

/// Tables of a machine file as dicts; the `second` of a gantry is an Axis.
fn tables_of(
    name: &str,
    given: Option<&Bound<'_, PyAny>>,
    seconds: &mut Vec<PyAxis>,
) -> PyResult<Vec<Table>> {
    let Some(given) = given else {
        return Ok(Vec::new());
    };
    let refused = |what: String| {
        PyTypeError::new_err(format!(
            "{name} {what}; valid: a list of dicts with the keys of [[{name}]] of a machine file"
        ))
    };
    if given.cast::<PyMapping>().is_ok() || given.try_iter().is_err() {
        return Err(refused(format!("is a {}", given.get_type().name()?)));
    }
    let mut tables = Vec::new();
    for row in given.try_iter()? {
        let row = row?;
        let Ok(mapping) = row.cast::<PyMapping>() else {
            return Err(refused(format!("holds a {}", row.get_type().name()?)));
        };
        let own = PyDict::new(row.py());
        own.update(mapping)?;
        if name == "gantry" {
            let second = own.get_item("second")?;
            let axis = second.and_then(|s| {
                s.extract::<PyRef<'_, PyAxis>>()
                    .ok()
                    .map(|a| PyAxis::clone(&a))
            });
            let axis = axis.ok_or_else(|| refused("has no Axis as its second".to_owned()))?;
            own.set_item("second", &axis.axis.name)?;
            seconds.push(axis);
        }
        tables.push(table_of(own.as_any().cast::<PyMapping>()?)?);
    }
    Ok(tables)
}

/// What is taken off the references, as a caller gives it.
fn correction_of(given: &Bound<'_, PyAny>) -> PyResult<ReferenceCorrection> {
    if let Ok(found) = given.cast::<PyCirclesFound>() {
        let coupling: Coupling = coupling_of(&found.get().0).map_err(of_run)?;
        return Ok(ReferenceCorrection::Known(coupling));
    }
    match given.cast::<PyBool>() {
        Ok(truth) if truth.is_true() => Ok(ReferenceCorrection::FileOrFound),
        Ok(_) => Ok(ReferenceCorrection::Nothing),
        Err(_) => Err(PyTypeError::new_err(format!(
            "correct is a {}; valid: True for what the machine file says, what identify found, or False",
            given.get_type().name()?
        ))),
    }
}

/// The strategy of a name, with - or _ between words.
fn kind_of(name: &str) -> PyResult<&'static StrategyKind> {
    let found = named(STRATEGIES, &name.replace('-', "_"));
    match (found, name) {
        (Some(kind), _) => Ok(kind),
        (None, "none") => Ok(&NONE),
        _ => {
            let names = STRATEGIES.iter().map(|kind| kind.name);
            let names: Vec<_> = ["none"].into_iter().chain(names).collect();
            Err(StrategyError::new_err(format!(
                "there is no strategy {name:?}; valid: {}, or a list of Compensator, one for each drive",
                names.join(", ")
            )))
        }
    }
}

/// Options of a run that `contour` and `identify` share.
struct Shared {
    wanted: Wanted,
    compensation: DriveCompensations,
    noise: f64,
    seed: u64,
}

impl PyMachine {
    /// The compensation of each drive.
    fn compensation(&self, given: Option<&Bound<'_, PyAny>>) -> PyResult<DriveCompensations> {
        let Some(given) = given else {
            return DriveCompensations::of(&NONE, &self.file).map_err(of_run);
        };
        if let Ok(name) = given.cast::<PyString>() {
            let kind = kind_of(name.to_str()?)?;
            return DriveCompensations::of(kind, &self.file).map_err(of_run);
        }
        let refused = |what: String| {
            PyTypeError::new_err(format!(
                "compensation {what}; valid: the name of a strategy, or a list of Compensator, one for each drive"
            ))
        };
        let Ok(items) = given.try_iter() else {
            return Err(refused(format!("is a {}", given.get_type().name()?)));
        };
        let mut drives: Vec<(&'static StrategyKind, Predictors)> = Vec::new();
        for item in items {
            let item = item?;
            let Ok(made) = item.cast::<PyCompensator>() else {
                return Err(refused(format!("holds a {}", item.get_type().name()?)));
            };
            let (name, predictors) = made.get().parts();
            drives.push((kind_of(name)?, predictors.clone()));
        }
        let (given, drives_there) = (drives.len(), self.file.drives().len());
        if given != drives_there {
            let drives = drives_there;
            return Err(of_run(ContourError::Drives { given, drives }));
        }
        DriveCompensations::new(drives).map_err(of_run)
    }

    /// Runs `work` on a thread of its own, laps counted.
    fn at_work<T: Send + 'static>(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        (path, shared): (PathChoice, Shared),
        change: impl FnOnce(&mut Run<'_>) + Send + 'static,
        work: impl FnOnce(&Run<'_>) -> Result<T, ContourError> + Send + 'static,
    ) -> PyResult<T> {
        let file = self.file.clone();
        long(py, progress, move |hook| {
            let mut run = Run {
                file: &file,
                path: &path,
                wanted: shared.wanted,
                laps: 1,
                identify: Vec::new(),
                correct: ReferenceCorrection::Nothing,
                feeds: Vec::new(),
                compensation: shared.compensation,
                noise: shared.noise,
                seed: shared.seed,
                each: &|| (),
            };
            change(&mut run);
            let each = counting(hook, run.laps_in_all());
            run.each = &each;
            work(&run).map_err(of_run)
        })
    }
}

/// Counts laps, from any thread.
fn counting(hook: &Hook, total: u64) -> impl Fn() + Sync + '_ {
    let done = AtomicU64::new(0);
    let hook = Mutex::new(hook.clone());
    move || {
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        let hook = hook.lock().map(|hook| hook.clone());
        if let Ok(hook) = hook {
            hook.done("laps", done, total);
        }
    }
}

/// Numbers of a feed and its limits.
fn wanted(values: [f64; 5]) -> Wanted {
    let [feed, acceleration, jerk, rapid, acceleration_step] = values;
    Wanted {
        feed,
        acceleration,
        jerk,
        rapid,
        acceleration_step,
    }
}

#[pymethods]
impl PyMachine {
    /// Of a machine file, or of two or three axes with the tables of such a file.
    #[new]
    #[pyo3(signature = (axes, *, name = None, coupling = None, base = None, gantry = None))]
    fn new(
        axes: &Bound<'_, PyAny>,
        name: Option<String>,
        coupling: Option<&Bound<'_, PyAny>>,
        base: Option<&Bound<'_, PyAny>>,
        gantry: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        if let Ok(path) = axes.extract::<PathBuf>() {
            let others = coupling.is_some() || base.is_some() || gantry.is_some();
            if others || name.is_some() {
                return Err(PyTypeError::new_err(
                    "a machine file says its name and tables itself; valid: the file alone, or axes with tables",
                ));
            }
            return Self::load(&axes.py().get_type::<Self>(), path);
        }
        let mut seconds = Vec::new();
        let tables = [("coupling", coupling), ("base", base), ("gantry", gantry)]
            .into_iter()
            .map(|(name, given)| Ok((name, tables_of(name, given, &mut seconds)?)))
            .collect::<PyResult<_>>()?;
        Self::of_axes(axes_of(axes)?, name, tables, seconds)
    }

    /// Reads a machine file.
    #[classmethod]
    fn load(kind: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        let text = text_of::<MachineError>(kind.py(), &path)?;
        let text = MachineText::parse(&path, &text).map_err(of_file)?;
        let folder = path.parent().unwrap_or(Path::new("."));
        let seconds = text.gantry.iter().map(|gantry| &gantry.second);
        let files = text.axes.files().into_iter().chain(seconds);
        let axes = files.map(|file| PyAxis::read(kind.py(), &folder.join(file)));
        let axes = axes.collect::<PyResult<_>>()?;
        Self::of_text(text, path, axes)
    }

    /// Short name.
    #[getter]
    fn name(&self) -> &str {
        &self.file.text.name
    }

    /// The axes of x, y and, of three, z.
    #[getter]
    fn axes(&self) -> Vec<PyAxis> {
        self.axes[..self.file.dimensions()].to_vec()
    }

    /// The drives in the order of their compensations: of each axis its own, then the second of a gantry.
    #[getter]
    fn drives(&self) -> Vec<PyAxis> {
        let all = self.file.drives();
        let of = |print: &str| {
            let mut all = self.axes.iter();
            all.find(|one| one.axis.fingerprint == print).cloned()
        };
        all.iter()
            .filter_map(|drive| of(&drive.nominal.fingerprint))
            .collect()
    }

    /// Runs the machine along a path.
    #[pyo3(signature = (path, *, feed = 0.05, compensation = None, laps = 1, correct = None, feeds = None, acceleration = 1.0, jerk = 20.0, acceleration_step = 0.0, rapid = 0.25, noise = 0.0, seed = 1, progress = None))]
    fn contour<'py>(
        &self,
        py: Python<'py>,
        path: AnyToolpath,
        feed: f64,
        compensation: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = arrays::laps)] laps: u32,
        correct: Option<&Bound<'py, PyAny>>,
        feeds: Option<&Bound<'py, PyAny>>,
        acceleration: f64,
        jerk: f64,
        acceleration_step: f64,
        rapid: f64,
        #[pyo3(from_py_with = arrays::noise)] noise: f64,
        #[pyo3(from_py_with = arrays::seed)] seed: u64,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<PyContour> {
        if laps == 0 {
            return Err(PyValueError::new_err(
                "laps is 0; valid: a whole number from 1 to 100",
            ));
        }
        let correct = correct.map_or(Ok(ReferenceCorrection::Nothing), correction_of)?;
        let feeds = feeds.map(|given| line::<MotionError>(given, "feeds"));
        let feeds = feeds.transpose()?.unwrap_or_default();
        let shared = Shared {
            wanted: wanted([feed, acceleration, jerk, rapid, acceleration_step]),
            compensation: self.compensation(compensation)?,
            noise,
            seed,
        };
        let radius = path.0.radius();
        let change = move |run: &mut Run<'_>| {
            (run.laps, run.correct, run.feeds) = (laps, correct, feeds);
        };
        let found = self.at_work(py, progress, (path.0, shared), change, run)?;
        Ok(PyContour { found, radius })
    }

    /// Squareness and cross-talk of X and Y from simulated circular tests at several feeds, in both directions.
    #[pyo3(signature = (feeds, *, radius = 0.05, compensation = None, acceleration = 1.0, jerk = 20.0, noise = 0.0, seed = 1, progress = None))]
    fn identify<'py>(
        &self,
        py: Python<'py>,
        feeds: &Bound<'py, PyAny>,
        radius: f64,
        compensation: Option<&Bound<'py, PyAny>>,
        acceleration: f64,
        jerk: f64,
        #[pyo3(from_py_with = arrays::noise)] noise: f64,
        #[pyo3(from_py_with = arrays::seed)] seed: u64,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<PyCirclesFound> {
        let feeds = line::<MotionError>(feeds, "feeds")?;
        let path = PathChoice::Circle { radius, tilt: None };
        let shared = Shared {
            wanted: wanted([0.05, acceleration, jerk, 0.25, 0.0]),
            compensation: self.compensation(compensation)?,
            noise,
            seed,
        };
        let change = move |run: &mut Run<'_>| (run.laps, run.identify) = (0, feeds);
        let found = self.at_work(py, progress, (path, shared), change, identify)?;
        Ok(PyCirclesFound(found))
    }

    fn __repr__(&self) -> String {
        let names: Vec<String> = (NAMES.iter().zip(&self.file.axes))
            .map(|(name, axis)| format!("{name} {}", axis.name))
            .collect();
        format!("Machine({:?}: {})", self.file.text.name, names.join(", "))
    }
}
