//! Exceptions: the library's words, by kind.

use std::error::Error;

use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
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
