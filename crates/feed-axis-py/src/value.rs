//! Values: compared, hashed, copied and pickled by what they are made from.

use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// What stands for a value: of numbers, texts, bytes, arrays and other values.
pub(crate) trait Value: Sized {
    /// What [`restored`](Self::restored) makes the same value from.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>>;

    /// The value of a state.
    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self>;

    /// What equal values have in common, and others not.
    fn key<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.state(py)
    }
}

/// Gives a class of a [`Value`] what `pickle`, `copy` and `==` call; with `hash`, for what cannot
/// change, what `hash` and `set` call too.
macro_rules! value {
    ($class:ty) => {
        #[pymethods]
        impl $class {
            #[classmethod]
            fn _restored(
                _: &pyo3::Bound<'_, pyo3::types::PyType>,
                state: &pyo3::Bound<'_, pyo3::types::PyTuple>,
            ) -> pyo3::PyResult<Self> {
                $crate::value::Value::restored(state)
            }

            #[allow(clippy::type_complexity, reason = "as pickle wants it")]
            fn __reduce__<'py>(
                slf: &pyo3::Bound<'py, Self>,
            ) -> pyo3::PyResult<(
                pyo3::Bound<'py, pyo3::PyAny>,
                (pyo3::Bound<'py, pyo3::types::PyTuple>,),
            )> {
                let make = slf.get_type().getattr("_restored")?;
                let state = $crate::value::Value::state(&*slf.borrow(), slf.py())?;
                Ok((make, (state,)))
            }

            fn __eq__<'py>(
                slf: &pyo3::Bound<'py, Self>,
                other: &pyo3::Bound<'py, pyo3::PyAny>,
            ) -> pyo3::PyResult<pyo3::Bound<'py, pyo3::PyAny>> {
                use pyo3::types::PyAnyMethods;
                let py = slf.py();
                let Ok(other) = other.cast::<Self>() else {
                    return Ok(pyo3::types::PyNotImplemented::get(py).to_owned().into_any());
                };
                let own = $crate::value::Value::key(&*slf.borrow(), py)?;
                let others = $crate::value::Value::key(&*other.borrow(), py)?;
                let same = own.eq(others)?;
                Ok(pyo3::types::PyBool::new(py, same).to_owned().into_any())
            }
        }
    };
    ($class:ty, hash) => {
        $crate::value::value!($class);

        #[pymethods]
        impl $class {
            fn __hash__(&self, py: pyo3::Python<'_>) -> pyo3::PyResult<isize> {
                use pyo3::types::PyAnyMethods;
                $crate::value::Value::key(self, py)?.hash()
            }
        }
    };
}
pub(crate) use value;
