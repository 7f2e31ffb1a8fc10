//! Axes to begin with, without a file.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use toml::Value;

use crate::axis::PyAxis;
use crate::errors::AxisError;

/// The paper's axis, and an example of each kind of mechanism.
const EXAMPLES: [(&str, &str); 9] = [
    ("liu2025", include_str!("../templates/liu2025.toml")),
    ("ball-screw", include_str!("../templates/ball-screw.toml")),
    (
        "screw-datasheet",
        include_str!("../templates/screw-datasheet.toml"),
    ),
    ("rack", include_str!("../templates/rack.toml")),
    ("belt", include_str!("../templates/belt.toml")),
    ("joint", include_str!("../templates/joint.toml")),
    (
        "linear-motor",
        include_str!("../templates/linear-motor.toml"),
    ),
    (
        "rotary-table",
        include_str!("../templates/rotary-table.toml"),
    ),
    ("rigid-mass", include_str!("../templates/rigid-mass.toml")),
];

/// Axes to begin with, by kind: `liu2025` is the paper's, the others are one for each mechanism.
#[pyfunction]
pub(crate) fn examples(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for (kind, text) in EXAMPLES {
        all.set_item(kind, PyAxis::parsed(kind, text.to_owned())?)?;
    }
    Ok(all)
}

/// The example of a kind, under a name of one's own.
#[pyfunction]
#[pyo3(signature = (kind, name = None))]
pub(crate) fn new(kind: &str, name: Option<String>) -> PyResult<PyAxis> {
    let Some((_, text)) = EXAMPLES.iter().find(|(known, _)| *known == kind) else {
        let kinds: Vec<_> = EXAMPLES.iter().map(|(kind, _)| *kind).collect();
        return Err(AxisError::new_err(format!(
            "there is no example {kind:?}; valid: {}",
            kinds.join(", ")
        )));
    };
    let Some(name) = name else {
        return PyAxis::parsed(kind, (*text).to_owned());
    };
    let own = format!("name = {}", Value::String(name));
    let mut is_named = false;
    let line = |line: &str| match !is_named && line.starts_with("name = ") {
        true => {
            is_named = true;
            format!("{own}\n")
        }
        false => format!("{line}\n"),
    };
    PyAxis::parsed(kind, text.lines().map(line).collect())
}
