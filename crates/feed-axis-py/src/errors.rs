//! Exceptions: the library's words, by kind.

use std::error::Error;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use pyo3::create_exception;
use pyo3::exceptions::{PyImportError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::type_object::PyTypeInfo;

create_exception!(
    feed_axis,
    FeedAxisError,
    PyValueError,
    "What every error of this module is."
);
create_exception!(
    feed_axis,
    AxisError,
    FeedAxisError,
    "An axis file, or a dict in its place, that makes no axis. The words name file, line and field, and what would be valid."
);
create_exception!(
    feed_axis,
    MachineError,
    FeedAxisError,
    "A machine file, or axes in its place, that make no machine, or none for a path."
);
create_exception!(
    feed_axis,
    MotionError,
    FeedAxisError,
    "A motion that cannot be planned, or not on this axis."
);
create_exception!(
    feed_axis,
    SimulationError,
    FeedAxisError,
    "A run that did not come to its end: when, why, and in which state."
);
create_exception!(
    feed_axis,
    LogError,
    FeedAxisError,
    "A log of which no conclusion would be worth anything, or a channel that is not there."
);
create_exception!(
    feed_axis,
    SearchError,
    FeedAxisError,
    "A search that cannot be made as it was asked for."
);
create_exception!(
    feed_axis,
    LoopError,
    FeedAxisError,
    "Loops that cannot be analysed or tuned, or not as it was asked for."
);
create_exception!(
    feed_axis,
    StrategyError,
    FeedAxisError,
    "A compensation, or an identification for one, that cannot be made for this axis."
);
create_exception!(
    feed_axis,
    NetworkError,
    FeedAxisError,
    "Samples, a network or a training that are not valid."
);
create_exception!(
    feed_axis,
    ParameterError,
    FeedAxisError,
    "A number outside its range: friction, beam or design."
);

/// A library's error as an exception of a kind, in the same words. What caused it becomes
/// the exception's cause, where the words do not say it already.
pub(crate) fn raise<K: PyTypeInfo>(error: impl Error) -> PyErr {
    let words = error.to_string();
    let cause = error.source().map(ToString::to_string);
    let raised = PyErr::new::<K, _>(words.clone());
    if let Some(cause) = cause.filter(|cause| !words.contains(cause.as_str())) {
        Python::attach(|py| raised.set_cause(py, Some(FeedAxisError::new_err(cause))));
    }
    raised
}

/// Python's own error of a file: FileNotFoundError, IsADirectoryError, PermissionError, with the
/// file's name.
pub(crate) fn of_file(py: Python<'_>, error: &io::Error, path: &Path) -> PyErr {
    let Some(number) = error.raw_os_error() else {
        return PyValueError::new_err(format!("{}: {error}", path.display()));
    };
    let made = || {
        let words = py.import("os")?.call_method1("strerror", (number,))?;
        py.get_type::<PyOSError>()
            .call1((number, words, path.as_os_str()))
    };
    match made() {
        Ok(made) => PyErr::from_value(made),
        Err(error) => error,
    }
}

/// Refuses a file that cannot be read at all, as Python does.
pub(crate) fn readable(py: Python<'_>, path: &Path) -> PyResult<()> {
    // A folder opens, but is not read; what is no plain file must keep what it has.
    let tried = File::open(path).and_then(|mut file| match file.metadata()?.is_dir() {
        true => file.read(&mut [0]),
        false => Ok(0),
    });
    tried.map(drop).map_err(|error| of_file(py, &error, path))
}

/// The bytes of a file.
pub(crate) fn bytes_of(py: Python<'_>, path: &Path) -> PyResult<Vec<u8>> {
    std::fs::read(path).map_err(|error| of_file(py, &error, path))
}

/// The text of a file; one that is no text is refused as `K`.
pub(crate) fn text_of<K: PyTypeInfo>(py: Python<'_>, path: &Path) -> PyResult<String> {
    let text = axis_log::text_of(bytes_of(py, path)?);
    text.map_err(|error| PyErr::new::<K, _>(format!("cannot read {}: {error}", path.display())))
}

/// A package that only some calls need; without it the error says how it comes.
pub(crate) fn package<'py>(
    py: Python<'py>,
    name: &str,
    call: &str,
) -> PyResult<Bound<'py, PyModule>> {
    py.import(name).map_err(|error| {
        let words = format!("{call} needs {name}; install it: pip install {name}");
        let raised = PyImportError::new_err(words);
        raised.set_cause(py, Some(error));
        raised
    })
}
