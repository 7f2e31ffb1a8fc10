//! LuGre friction.

use lugre::{LuGre, Parameters};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};

use crate::arrays::line;
use crate::errors::{ParameterError, raise};
use crate::value::{Value, value};

/// LuGre friction: bristles, Stribeck curve, viscous share. For a contact that slides along a
/// line read N for N·m and m for rad.
#[pyclass(module = "feed_axis", name = "LuGre", frozen)]
pub(crate) struct PyLuGre(pub(crate) LuGre);

impl Value for PyLuGre {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let p = self.0.parameters();
        (
            p.coulomb,
            p.stiction,
            p.stribeck_speed,
            p.stiffness,
            p.damping,
            p.viscous,
        )
            .into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (coulomb, stiction, stribeck, stiffness, damping, viscous) = state.extract()?;
        Self::new(coulomb, stiction, stribeck, stiffness, damping, viscous)
    }
}

value!(PyLuGre, hash);

/// What `friction` gives at each of the speeds that lie `dt_s` apart, of the speed before, if any, and of this one.
pub(crate) fn along(
    speed_rad_s: &Bound<'_, PyAny>,
    dt_s: f64,
    mut friction: impl FnMut(Option<f64>, f64) -> f64,
) -> PyResult<Vec<f64>> {
    if !(dt_s > 0.0 && dt_s.is_finite()) {
        return Err(ParameterError::new_err(format!(
            "dt_s is {dt_s}, but must be finite and greater than 0"
        )));
    }
    let speeds = line::<ParameterError>(speed_rad_s, "speed_rad_s")?;
    let mut before = None;
    let torques = speeds
        .iter()
        .map(|&speed| friction(before.replace(speed), speed));
    Ok(torques.collect())
}

#[pymethods]
impl PyLuGre {
    #[new]
    #[pyo3(signature = (*, coulomb_n_m, stiction_n_m, stribeck_speed_rad_s, stiffness_n_m_rad, damping_n_m_s_rad, viscous_n_m_s_rad))]
    fn new(
        coulomb_n_m: f64,
        stiction_n_m: f64,
        stribeck_speed_rad_s: f64,
        stiffness_n_m_rad: f64,
        damping_n_m_s_rad: f64,
        viscous_n_m_s_rad: f64,
    ) -> PyResult<Self> {
        let law = LuGre::new(Parameters {
            coulomb: coulomb_n_m,
            stiction: stiction_n_m,
            stribeck_speed: stribeck_speed_rad_s,
            stiffness: stiffness_n_m_rad,
            damping: damping_n_m_s_rad,
            viscous: viscous_n_m_s_rad,
        });
        law.map(Self).map_err(raise::<ParameterError>)
    }

    /// The parameters that Liu et al. 2025 print, at the screw of their axis.
    #[classmethod]
    fn liu2025(_: &Bound<'_, PyType>) -> PyResult<Self> {
        let law = LuGre::new(Parameters::LIU_2025);
        law.map(Self).map_err(raise::<ParameterError>)
    }

    /// T_C, N·m.
    #[getter]
    fn coulomb_n_m(&self) -> f64 {
        self.0.parameters().coulomb
    }

    /// T_S, N·m.
    #[getter]
    fn stiction_n_m(&self) -> f64 {
        self.0.parameters().stiction
    }

    /// Ω_S, rad/s.
    #[getter]
    fn stribeck_speed_rad_s(&self) -> f64 {
        self.0.parameters().stribeck_speed
    }

    /// σ0, N·m/rad.
    #[getter]
    fn stiffness_n_m_rad(&self) -> f64 {
        self.0.parameters().stiffness
    }

    /// σ1, N·m·s/rad.
    #[getter]
    fn damping_n_m_s_rad(&self) -> f64 {
        self.0.parameters().damping
    }

    /// σ2, N·m·s/rad.
    #[getter]
    fn viscous_n_m_s_rad(&self) -> f64 {
        self.0.parameters().viscous
    }

    /// Friction at constant speeds (rad/s), N·m; of one speed an array of one number.
    fn steady_state<'py>(
        &self,
        py: Python<'py>,
        speed_rad_s: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let speeds = line::<ParameterError>(speed_rad_s, "speed_rad_s")?;
        let torques: Vec<f64> = speeds.iter().map(|&w| self.0.steady_state(w)).collect();
        Ok(torques.into_pyarray(py))
    }

    /// Friction (N·m) along speeds (rad/s) that lie `dt_s` apart, linear between; bristles
    /// at rest at the first.
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        speed_rad_s: &Bound<'py, PyAny>,
        dt_s: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut bristle = 0.0;
        let torques = along(speed_rad_s, dt_s, |before, speed| {
            if let Some(before) = before {
                bristle = self.0.step(bristle, before, speed, dt_s);
            }
            self.0.torque(bristle, speed)
        })?;
        Ok(torques.into_pyarray(py))
    }

    fn __repr__(&self) -> String {
        let p = self.0.parameters();
        format!(
            "LuGre(coulomb_n_m={}, stiction_n_m={}, stribeck_speed_rad_s={}, stiffness_n_m_rad={}, damping_n_m_s_rad={}, viscous_n_m_s_rad={})",
            p.coulomb, p.stiction, p.stribeck_speed, p.stiffness, p.damping, p.viscous
        )
    }
}
