//! A compensator as C, as a component of LinuxCNC, as ONNX.

use std::path::{Path, PathBuf};

use axis_sim::Axis;
use compensator::GuardLimits;
use controller_export::{ExportedController, NamedText, c, linuxcnc, onnx};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::compensation::PyCompensator;
use crate::errors::{StrategyError, of_file, raise};

/// What `export` writes.
const TARGETS: [&str; 3] = ["c", "linuxcnc", "onnx"];

/// Limits of the guard; the default of each is the axis' own limit.
struct Limits {
    position: Option<f64>,
    command: Option<f64>,
    surprise: Option<f64>,
    patience_s: f64,
    fade_s: f64,
}

impl Limits {
    fn of(&self, axis: &Axis, strategy: &str) -> PyResult<GuardLimits> {
        let missing = |name: &str, why: &str| {
            StrategyError::new_err(format!(
                "{name} is missing: {why}; valid: a number above 0 (`feed-axis export` finds one by simulation)"
            ))
        };
        let own = Some(axis.actuator.limit()).filter(|limit| limit.is_finite());
        let command = self
            .command
            .or(own)
            .ok_or_else(|| missing("limit_command", "the actuator of this axis has no limit"))?;
        // Without an observer there is no surprise, and its limit is never met.
        let surprise = match (self.surprise, strategy) {
            (None, "feedback") => {
                let why = "the observer of a feedback is guarded by it";
                return Err(missing("limit_surprise", why));
            }
            (given, _) => given.unwrap_or(10.0),
        };
        let cycles = |name: &str, time: f64| {
            let count = (time / axis.period).round();
            match (0.0..=1e6).contains(&count) {
                true => Ok(count as u32),
                false => Err(PyValueError::new_err(format!(
                    "{name} is {time}; valid: from 0 to {} s, a million control cycles",
                    1e6 * axis.period
                ))),
            }
        };
        Ok(GuardLimits {
            position: self.position.unwrap_or(axis.following_error_limit),
            effort: command,
            surprise,
            patience: cycles("patience_s", self.patience_s)?,
            fade: cycles("fade_s", self.fade_s)?,
        })
    }
}

/// One of several words.
fn one_of<'a>(name: &str, given: &'a str, valid: &[&str]) -> PyResult<&'a str> {
    match valid.contains(&given) {
        true => Ok(given),
        false => Err(PyValueError::new_err(format!(
            "{name} is {given:?}; valid: {}",
            valid.join(", ")
        ))),
    }
}

fn write(py: Python<'_>, folder: &Path, name: &str, bytes: &[u8]) -> PyResult<String> {
    let path = folder.join(name);
    std::fs::write(&path, bytes).map_err(|error| of_file(py, &error, &path))?;
    Ok(path.display().to_string())
}

#[pymethods]
impl PyCompensator {
    /// Writes the strategy for a controller into a folder, and gives the files' paths.
    #[pyo3(signature = (folder, *, target = "c", name = None, precision = "f64", limit_position = None, limit_command = None, limit_surprise = None, patience_s = 0.002, fade_s = 0.1))]
    fn export(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        target: &str,
        name: Option<&str>,
        precision: &str,
        limit_position: Option<f64>,
        limit_command: Option<f64>,
        limit_surprise: Option<f64>,
        patience_s: f64,
        fade_s: f64,
    ) -> PyResult<Vec<String>> {
        let target = one_of("target", target, &TARGETS)?;
        let precision = match one_of("precision", precision, &["f32", "f64"])? {
            "f32" => c::Precision::F32,
            _ => c::Precision::F64,
        };
        let (kind, predictors) = self.parts();
        if target == "onnx" {
            let bytes = onnx::one_cycle(predictors).map_err(raise::<StrategyError>)?;
            let file = format!("{}.onnx", name.unwrap_or("network"));
            return Ok(vec![write(py, &folder, &file, &bytes)?]);
        }
        let limits = Limits {
            position: limit_position,
            command: limit_command,
            surprise: limit_surprise,
            patience_s,
            fade_s,
        };
        controller_export::exportable(kind).map_err(raise::<StrategyError>)?;
        let limits = limits.of(&predictors.axis, kind)?;
        let made = ExportedController::of(predictors, kind, limits);
        let made = made.and_then(|made| match name {
            Some(name) => made.named(name),
            None => Ok(made),
        });
        let made = made.map_err(raise::<StrategyError>)?;
        let texts: [NamedText; 2] = match target {
            "linuxcnc" => {
                let made = linuxcnc::export(&made).map_err(raise::<StrategyError>)?;
                [made.component, made.example]
            }
            _ => {
                let made = c::export(&made, precision, None).map_err(raise::<StrategyError>)?;
                [made.header, made.source]
            }
        };
        let one = |text: &NamedText| write(py, &folder, &text.name, text.text.as_bytes());
        texts.iter().map(one).collect()
    }
}
