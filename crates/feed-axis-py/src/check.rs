//! An axis against the data sheets of its parts.

use axis_sim::rating::AxisDuty;
use feed_axis::commands::check_words::CheckedRow;
use pyo3::prelude::*;

use crate::axis::PyAxis;
use crate::errors::{AxisError, LogError, MotionError, SimulationError, raise};
use crate::log::{Given, Renamed, each_log};
use crate::long::long;
use crate::loops::plain;
use crate::motion::AnyMotion;

#[pymethods]
impl PyAxis {
    /// What a duty asks of the parts, beside what the file's `[rating]` allows.
    #[pyo3(signature = (*, motion = None, logs = None))]
    fn check<'py>(
        &self,
        py: Python<'py>,
        motion: Option<AnyMotion<'_>>,
        logs: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let axis = self.axis.clone();
        let duty = match (motion, logs) {
            (Some(_), Some(_)) => {
                let words = "a duty is a motion or logs; valid: one of them, or neither";
                return Err(MotionError::new_err(words));
            }
            (None, Some(logs)) => self.duty_of_logs(logs)?,
            (Some(motion), None) => {
                let motion = motion.on(&self.axis)?;
                let made = axis.clone();
                long(py, None, move |_| {
                    made.duty_of_motion(&*motion)
                        .map_err(raise::<SimulationError>)
                })?
            }
            (None, None) => {
                if axis.trajectories.is_empty() {
                    let words = "the axis has no [[trajectory]]; give a motion or logs";
                    return Err(MotionError::new_err(words));
                }
                let motion = axis.there_and_back(&axis.trajectories, 0.0);
                let motion = motion.map_err(raise::<MotionError>)?;
                let made = axis.clone();
                long(py, None, move |_| {
                    made.duty_of_motion(&motion)
                        .map_err(raise::<SimulationError>)
                })?
            }
        };
        let items = axis.checked(&duty).map_err(raise::<AxisError>)?;
        let rows: Vec<CheckedRow> = items.iter().map(CheckedRow::of).collect();
        plain(py, &rows)
    }
}

impl PyAxis {
    fn duty_of_logs(&self, logs: &Bound<'_, PyAny>) -> PyResult<AxisDuty> {
        let mut duty = AxisDuty::of(&self.axis).map_err(raise::<AxisError>)?;
        for (i, log) in each_log(logs)?.iter().enumerate() {
            let name = format!("logs[{i}]");
            let given = Given {
                value: log,
                name: &name,
                columns: &Renamed::default(),
            };
            let (_, log) = given.whole(&self.axis, &[], &mut Vec::new())?;
            duty.add_log(&self.axis, &log).map_err(raise::<LogError>)?;
        }
        Ok(duty)
    }
}
