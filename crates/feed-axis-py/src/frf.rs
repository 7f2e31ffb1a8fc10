//! Frequency responses of an axis, estimated from its logs.

use axis_log::intake::Options;
use axis_sim::{known_channels, needed_position};
use drive_loop::{MeasureSettings, MeasuredDrive};
use pyo3::prelude::*;

use crate::arrays::poles;
use crate::axis::PyAxis;
use crate::errors::LoopError;
use crate::log::{Given, Renamed, each_log};
use crate::long::long;
use crate::loops::plain;

#[pymethods]
impl PyAxis {
    /// Frequency responses from logs of the excited axis, one for each log: modes, margins and what
    /// differs from the model.
    #[pyo3(signature = (logs, *, columns = Renamed::default(), step_hz = None, coherence = 0.9, poles = 10))]
    fn frf<'py>(
        &self,
        py: Python<'py>,
        logs: &Bound<'py, PyAny>,
        columns: Renamed,
        step_hz: Option<f64>,
        coherence: f64,
        #[pyo3(from_py_with = poles)] poles: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let settings = MeasureSettings {
            step_hz,
            coherence,
            most_poles: poles,
        };
        plain(py, &self.measured(py, "logs", logs, &columns, settings)?)
    }
}

impl PyAxis {
    /// The responses of logs that were given under a name.
    pub(crate) fn measured(
        &self,
        py: Python<'_>,
        name: &str,
        logs: &Bound<'_, PyAny>,
        columns: &Renamed,
        settings: MeasureSettings,
    ) -> PyResult<Vec<MeasuredDrive>> {
        // Short pulses of the command look like outliers, and another rate has another response.
        let exact: Vec<&str> = known_channels().collect();
        let options = Options {
            exact: &exact,
            ..Options::default()
        };
        let needed: Vec<&str> = needed_position(&self.axis).into_iter().collect();
        let mut read = Vec::new();
        for (i, log) in each_log(logs)?.iter().enumerate() {
            let name = format!("{name}[{i}]");
            let mut notes = Vec::new();
            let given = Given {
                value: log,
                name: &name,
                columns,
            };
            let found = given.whole_by(&self.axis, &needed, options, &mut notes)?;
            read.push((found, notes));
        }
        let axis = self.axis.clone();
        long(py, None, move |_| {
            let mut all = Vec::with_capacity(read.len());
            for ((name, log), notes) in read {
                let found = MeasuredDrive::of(&axis, &log, &settings);
                let mut found =
                    found.map_err(|error| LoopError::new_err(format!("{name}: {error}")))?;
                found.notes.splice(0..0, notes);
                all.push(found);
            }
            Ok(all)
        })
    }
}
