//! Python dicts as tables of an axis file, and back.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyMapping, PySequence, PyString};
use toml::{Table, Value};

use crate::arrays::key as key_of;

/// A mapping as a table; keys of which the value is `None` are left out.
pub(crate) fn table_of(mapping: &Bound<'_, PyMapping>) -> PyResult<Table> {
    let mut table = Table::new();
    for pair in mapping.items()? {
        let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = pair.extract()?;
        let key = key_of(&key, "a dict of an axis")?;
        if !value.is_none() {
            let value = value_of(&key, &value)?;
            table.insert(key, value);
        }
    }
    Ok(table)
}

fn value_of(key: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    // A bool is an int to Python, a string a sequence.
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(value.extract()?));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(value.extract()?));
    }
    if value.is_instance_of::<PyString>() {
        return Ok(Value::String(value.extract()?));
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        return Ok(Value::Table(table_of(mapping)?));
    }
    if let Ok(sequence) = value.cast::<PySequence>() {
        let items = sequence.try_iter()?.map(|item| value_of(key, &item?));
        return Ok(Value::Array(items.collect::<PyResult<_>>()?));
    }
    // Floats, and NumPy's numbers.
    if value.is_instance_of::<PyFloat>() || value.hasattr("__float__")? {
        return Ok(Value::Float(value.extract()?));
    }
    Err(PyTypeError::new_err(format!(
        "{key}: a {} has no place in an axis; valid: numbers, strings, bools, lists and dicts",
        value.get_type().name()?
    )))
}

/// A table as a dict.
pub(crate) fn dict_of<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, value) in table {
        dict.set_item(key, object_of(py, value)?)?;
    }
    Ok(dict)
}

fn object_of<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(text) => text.into_pyobject(py)?.into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Float(number) => number.into_pyobject(py)?.into_any(),
        Value::Boolean(truth) => PyBool::new(py, *truth).to_owned().into_any(),
        Value::Datetime(time) => time.to_string().into_pyobject(py)?.into_any(),
        Value::Array(items) => {
            let items = items.iter().map(|item| object_of(py, item));
            items.collect::<PyResult<Vec<_>>>()?.into_pyobject(py)?
        }
        Value::Table(table) => dict_of(py, table)?.into_any(),
    })
}
