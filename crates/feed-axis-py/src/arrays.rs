//! Arrays as callers give them: whatever NumPy makes numbers of; refused in words otherwise.

use numpy::PyReadonlyArrayDyn;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::type_object::PyTypeInfo;
use pyo3::types::{PyDict, PyString};

/// Numbers and their shape, the last dimension running fastest.
struct Numbers {
    values: Vec<f64>,
    shape: Vec<usize>,
}

impl Numbers {
    /// What `given` holds, integers and other floats too, in any order of memory; `name` is what
    /// messages call it.
    fn of(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Self> {
        let py = given.py();
        let numpy = py.import("numpy")?;
        let refused = |what: String| {
            PyTypeError::new_err(format!(
                "{name} {what}; valid: real numbers, as an array, a list or one alone"
            ))
        };
        let words =
            |error: PyErr| refused(format!("makes no array of numbers ({})", error.value(py)));
        let given = &without_masks(given).map_err(words)?;
        let array = numpy.call_method1("asarray", (given,)).map_err(words)?;
        let dtype = array.getattr("dtype")?;
        let kind: String = dtype.getattr("kind")?.extract()?;
        let is_one: bool = array.getattr("ndim")?.extract::<usize>()? == 0;
        // What is an object to NumPy may still be numbers, with None for what is missing.
        let may_be = "biuf".contains(&kind) || kind == "O" && !is_one;
        if !may_be {
            return Err(refused(match kind.as_str() {
                "O" => format!("is a {}", given.get_type().name()?),
                _ => format!("holds {dtype}"),
            }));
        }
        let array = numpy
            .call_method1("asarray", (given, "float64"))
            .map_err(words)?;
        let array: PyReadonlyArrayDyn<'_, f64> = array.extract()?;
        let view = array.as_array();
        Ok(Self {
            values: view.iter().copied().collect(),
            shape: view.shape().to_vec(),
        })
    }

    /// Its shape as Python writes it.
    fn shape(&self) -> String {
        match self.shape[..] {
            [one] => format!("({one},)"),
            _ => {
                let sizes: Vec<String> = self.shape.iter().map(usize::to_string).collect();
                format!("({})", sizes.join(", "))
            }
        }
    }

    fn refused<E: PyTypeInfo>(&self, name: &str, valid: &str) -> PyErr {
        PyErr::new::<E, _>(format!(
            "{name} has the shape {}; valid: {valid}",
            self.shape()
        ))
    }
}

/// What stands behind a mask or for a missing value, as NaN; all else as it was.
fn without_masks<'py>(given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let masked = given.py().import("numpy")?.getattr("ma")?;
    if given.is_instance(&masked.getattr("MaskedArray")?)? {
        let kind: String = given.getattr("dtype")?.getattr("kind")?.extract()?;
        if "biuf".contains(&kind) {
            let numbers = given.call_method1("astype", ("float64",))?;
            return numbers.call_method1("filled", (f64::NAN,));
        }
    }
    // Columns of pandas whose kind knows missing values: NumPy would make objects of them.
    if given.hasattr("isna")? && given.hasattr("to_numpy")? {
        let is_own = given.getattr("dtype")?.hasattr("na_value")?;
        let is_number = is_own && given.getattr("dtype")?.hasattr("numpy_dtype")?;
        if is_number {
            let how = PyDict::new(given.py());
            how.set_item("dtype", "float64")?;
            how.set_item("na_value", f64::NAN)?;
            return given.call_method("to_numpy", (), Some(&how));
        }
    }
    Ok(given.clone())
}

/// Numbers in a row: an array of one dimension, or one number.
pub(crate) fn line<E: PyTypeInfo>(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<f64>> {
    let numbers = Numbers::of(given, name)?;
    match numbers.shape.len() {
        0 | 1 => Ok(numbers.values),
        _ => Err(numbers.refused::<E>(name, "an array of one dimension, or one number")),
    }
}

/// Samples of a channel: an array of one dimension.
pub(crate) fn samples<E: PyTypeInfo>(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<f64>> {
    let numbers = Numbers::of(given, name)?;
    match numbers.shape.len() {
        1 => Ok(numbers.values),
        _ => Err(numbers.refused::<E>(name, "an array of one dimension, a number a sample")),
    }
}

/// Numbers in rows, and how many a row has. What has one dimension is a column.
pub(crate) fn rows<E: PyTypeInfo>(
    given: &Bound<'_, PyAny>,
    name: &str,
) -> PyResult<(Vec<f64>, usize)> {
    let numbers = Numbers::of(given, name)?;
    match numbers.shape[..] {
        [_] => Ok((numbers.values, 1)),
        [_, columns] => Ok((numbers.values, columns)),
        _ => Err(numbers.refused::<E>(name, "a row a sample, or one dimension for one column")),
    }
}

/// Rows of so many numbers. What has one dimension is one of them where that is its length, or
/// a column; a number is a row of one.
pub(crate) fn rows_of<E: PyTypeInfo>(
    given: &Bound<'_, PyAny>,
    name: &str,
    columns: usize,
) -> PyResult<Vec<f64>> {
    let numbers = Numbers::of(given, name)?;
    let fits = match numbers.shape[..] {
        [] => columns == 1,
        [count] => columns == 1 || count == columns,
        [_, own] => own == columns,
        _ => false,
    };
    let valid = format!("rows of {columns} number(s), or one such row");
    match fits {
        true => Ok(numbers.values),
        false => Err(numbers.refused::<E>(name, &valid)),
    }
}

/// Position, speed and acceleration of a reference.
#[derive(Clone, Copy, Default)]
pub(crate) struct Triple(pub f64, pub f64, pub f64);

impl Triple {
    /// As Python has it.
    pub(crate) fn tuple(self) -> (f64, f64, f64) {
        (self.0, self.1, self.2)
    }
}

impl FromPyObject<'_, '_> for Triple {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let name = "a reference";
        let numbers = Numbers::of(&given, name)?;
        match (&numbers.shape[..], &numbers.values[..]) {
            ([3], [position, speed, acceleration]) => Ok(Self(*position, *speed, *acceleration)),
            _ => Err(numbers
                .refused::<PyValueError>(name, "three numbers: position, speed, acceleration")),
        }
    }
}

/// Neurons of the hidden layers: whole numbers, or one.
pub(crate) struct Layers(pub Vec<usize>);

impl FromPyObject<'_, '_> for Layers {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let sizes = line::<PyValueError>(&given, "hidden")?;
        let whole = |size: &f64| size.fract() == 0.0 && (1.0..=1e4).contains(size);
        match sizes.iter().find(|size| !whole(size)) {
            None => Ok(Self(sizes.iter().map(|size| *size as usize).collect())),
            Some(bad) => Err(PyValueError::new_err(format!(
                "a hidden layer has {bad} neurons; valid: whole numbers from 1 to 10000"
            ))),
        }
    }
}

macro_rules! whole {
    ($($name:ident: $kind:ty, up to $most:expr;)*) => {$(
        /// The argument of that name, a whole number.
        pub(crate) fn $name(given: &Bound<'_, PyAny>) -> PyResult<$kind> {
            whole(given, stringify!($name), $most)
        }
    )*};
}

// What takes memory by its size ends where no machine has that much.
whole! {
    count: usize, up to 100_000_000;
    elements: usize, up to 100_000;
    epochs: usize, up to 1_000_000_000;
    laps: u32, up to 100;
    n: usize, up to 100_000_000;
    poles: usize, up to 16;
    seed: u64, up to u64::MAX;
    start: u64, up to 1 << 53;
    threads: usize, up to 1024;
}

/// A whole number of Python or NumPy. What is none is Python's own `TypeError`; one that is not
/// in its range is a `ValueError`, as a number out of any other range is.
fn whole<T: TryFrom<u64>>(given: &Bound<'_, PyAny>, name: &str, most: u64) -> PyResult<T> {
    let number = given
        .py()
        .import("operator")?
        .call_method1("index", (given,))?;
    let found = number.extract::<u64>().ok().filter(|found| *found <= most);
    found
        .and_then(|found| T::try_from(found).ok())
        .ok_or_else(|| {
            PyValueError::new_err(format!(
                "{name} is {number}; valid: a whole number from 0 to {most}"
            ))
        })
}

/// Noise of the sensors, in multiples of good ones.
pub(crate) fn noise(given: &Bound<'_, PyAny>) -> PyResult<f64> {
    let noise = given.extract::<f64>()?;
    match noise.is_finite() && noise >= 0.0 {
        true => Ok(noise),
        false => Err(PyValueError::new_err(format!(
            "noise is {noise}, but must be 0 or a finite factor above it"
        ))),
    }
}

/// The key of a dict or the name of a column, which must be a string.
pub(crate) fn key(given: &Bound<'_, PyAny>, of: &str) -> PyResult<String> {
    let refused = |_| {
        let shown = given
            .repr()
            .map_or_else(|_| "one".to_owned(), |r| r.to_string());
        PyTypeError::new_err(format!("{of} has the key {shown}; valid: strings as keys"))
    };
    given.extract::<String>().map_err(refused)
}

/// Several names, such as those of effects.
pub(crate) struct Names(pub Vec<String>);

impl FromPyObject<'_, '_> for Names {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let refused =
            |words: String| PyTypeError::new_err(format!("{words}; valid: a list of names"));
        let kind = |thing: &Bound<'_, PyAny>| Ok::<_, PyErr>(thing.get_type().name()?.to_string());
        if given.is_instance_of::<PyString>() {
            return Err(refused(format!("{} is one name", given.repr()?)));
        }
        let Ok(names) = given.try_iter() else {
            return Err(refused(format!("a {} is no list", kind(&given)?)));
        };
        let name = |name: PyResult<Bound<'_, PyAny>>| {
            let name = name?;
            match name.extract::<String>() {
                Ok(name) => Ok(name),
                Err(_) => Err(refused(format!("a {} is no name", kind(&name)?))),
            }
        };
        names.map(name).collect::<PyResult<_>>().map(Self)
    }
}

/// Several logs.
pub(crate) struct Logs<'py>(pub Vec<Bound<'py, PyAny>>);

impl<'py> FromPyObject<'_, 'py> for Logs<'py> {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let is_one = given.hasattr("keys")? || given.hasattr("columns")?;
        if is_one || given.extract::<std::path::PathBuf>().is_ok() {
            return Err(PyTypeError::new_err(format!(
                "a {} is one log; valid: a list of logs",
                given.get_type().name()?
            )));
        }
        let logs = given.try_iter().map_err(|_| {
            let kind = given.get_type().name();
            let kind = kind.map_or_else(|_| "this".to_owned(), |kind| kind.to_string());
            PyTypeError::new_err(format!("a {kind} is no list; valid: a list of logs"))
        })?;
        logs.collect::<PyResult<_>>().map(Self)
    }
}
