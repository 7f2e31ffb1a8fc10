//! LuGre friction with levels by direction, Stribeck exponent and viscous friction of higher order.

use lugre::{
    BristleParameters, FrictionLaw, FrictionLevel, GeneralLuGre, LinearOnset, SteadyState,
};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::line;
use crate::errors::{ParameterError, raise};
use crate::lugre_law::along;
use crate::value::{Value, value};

/// LuGre friction with levels by direction, an exponent of the Stribeck curve and viscous friction
/// of second and third order: the keys of `friction` in an axis file. For a contact that slides
/// along a line read N for N·m and m for rad.
#[pyclass(module = "feed_axis", name = "GeneralLuGre", frozen)]
pub(crate) struct PyGeneralLuGre(GeneralLuGre);

/// Levels forward and backward, each coulomb and stiction; Stribeck speed and exponent; stiffness and damping of the bristles; viscous
/// friction of first to third order.
type Numbers = ([f64; 4], [f64; 2], [f64; 2], [f64; 3]);

impl PyGeneralLuGre {
    fn of((levels, stribeck, bristle, viscous): Numbers) -> PyResult<Self> {
        let [coulomb, stiction, coulomb_backward, stiction_backward] = levels;
        let law = GeneralLuGre::new(BristleParameters {
            steady: SteadyState {
                forward: FrictionLevel { coulomb, stiction },
                backward: FrictionLevel {
                    coulomb: coulomb_backward,
                    stiction: stiction_backward,
                },
                stribeck_speed: stribeck[0],
                stribeck_exponent: stribeck[1],
                viscous: viscous[0],
                viscous_quadratic: viscous[1],
                viscous_cubic: viscous[2],
            },
            stiffness: bristle[0],
            damping: bristle[1],
            onset: LinearOnset {},
        });
        law.map(Self).map_err(raise::<ParameterError>)
    }

    fn steady(&self) -> SteadyState {
        self.0.parameters().steady
    }
}

impl Value for PyGeneralLuGre {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let (p, s) = (self.0.parameters(), self.steady());
        let (ahead, back) = (s.forward, s.backward);
        (
            (ahead.coulomb, ahead.stiction, back.coulomb, back.stiction),
            (s.stribeck_speed, s.stribeck_exponent),
            (p.stiffness, p.damping),
            (s.viscous, s.viscous_quadratic, s.viscous_cubic),
        )
            .into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        type Stored = (
            (f64, f64, f64, f64),
            (f64, f64),
            (f64, f64),
            (f64, f64, f64),
        );
        let (levels, stribeck, bristle, viscous): Stored = state.extract()?;
        Self::of((
            levels.into(),
            stribeck.into(),
            bristle.into(),
            viscous.into(),
        ))
    }
}

value!(PyGeneralLuGre, hash);

#[pymethods]
impl PyGeneralLuGre {
    #[new]
    #[pyo3(signature = (*, coulomb_n_m, stiction_n_m, stribeck_speed_rad_s, stiffness_n_m_rad, damping_n_m_s_rad, viscous_n_m_s_rad, coulomb_backward_n_m = None, stiction_backward_n_m = None, stribeck_exponent = 2.0, viscous_quadratic_n_m_s2_rad2 = 0.0, viscous_cubic_n_m_s3_rad3 = 0.0))]
    fn new(
        coulomb_n_m: f64,
        stiction_n_m: f64,
        stribeck_speed_rad_s: f64,
        stiffness_n_m_rad: f64,
        damping_n_m_s_rad: f64,
        viscous_n_m_s_rad: f64,
        coulomb_backward_n_m: Option<f64>,
        stiction_backward_n_m: Option<f64>,
        stribeck_exponent: f64,
        viscous_quadratic_n_m_s2_rad2: f64,
        viscous_cubic_n_m_s3_rad3: f64,
    ) -> PyResult<Self> {
        let levels = [
            coulomb_n_m,
            stiction_n_m,
            coulomb_backward_n_m.unwrap_or(coulomb_n_m),
            stiction_backward_n_m.unwrap_or(stiction_n_m),
        ];
        let viscous = [
            viscous_n_m_s_rad,
            viscous_quadratic_n_m_s2_rad2,
            viscous_cubic_n_m_s3_rad3,
        ];
        let stribeck = [stribeck_speed_rad_s, stribeck_exponent];
        let bristle = [stiffness_n_m_rad, damping_n_m_s_rad];
        Self::of((levels, stribeck, bristle, viscous))
    }

    /// Coulomb level at positive speeds, N·m.
    #[getter]
    fn coulomb_n_m(&self) -> f64 {
        self.steady().forward.coulomb
    }

    /// Break-away level at positive speeds, N·m.
    #[getter]
    fn stiction_n_m(&self) -> f64 {
        self.steady().forward.stiction
    }

    /// Coulomb level at negative speeds, N·m.
    #[getter]
    fn coulomb_backward_n_m(&self) -> f64 {
        self.steady().backward.coulomb
    }

    /// Break-away level at negative speeds, N·m.
    #[getter]
    fn stiction_backward_n_m(&self) -> f64 {
        self.steady().backward.stiction
    }

    /// Stribeck speed, rad/s.
    #[getter]
    fn stribeck_speed_rad_s(&self) -> f64 {
        self.steady().stribeck_speed
    }

    /// Exponent of the Stribeck curve.
    #[getter]
    fn stribeck_exponent(&self) -> f64 {
        self.steady().stribeck_exponent
    }

    /// Stiffness of the bristles, N·m/rad.
    #[getter]
    fn stiffness_n_m_rad(&self) -> f64 {
        self.0.parameters().stiffness
    }

    /// Damping of the bristles, N·m·s/rad.
    #[getter]
    fn damping_n_m_s_rad(&self) -> f64 {
        self.0.parameters().damping
    }

    /// Viscous friction of first order, N·m·s/rad.
    #[getter]
    fn viscous_n_m_s_rad(&self) -> f64 {
        self.steady().viscous
    }

    /// Of second order, N·m·s²/rad².
    #[getter]
    fn viscous_quadratic_n_m_s2_rad2(&self) -> f64 {
        self.steady().viscous_quadratic
    }

    /// Of third order, N·m·s³/rad³.
    #[getter]
    fn viscous_cubic_n_m_s3_rad3(&self) -> f64 {
        self.steady().viscous_cubic
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
            self.0.force(&bristle, speed)
        })?;
        Ok(torques.into_pyarray(py))
    }

    fn __repr__(&self) -> String {
        let (p, s) = (self.0.parameters(), self.steady());
        format!(
            "GeneralLuGre(coulomb_n_m={}, stiction_n_m={}, stribeck_speed_rad_s={}, stiffness_n_m_rad={}, damping_n_m_s_rad={}, viscous_n_m_s_rad={}, coulomb_backward_n_m={}, stiction_backward_n_m={}, stribeck_exponent={}, viscous_quadratic_n_m_s2_rad2={}, viscous_cubic_n_m_s3_rad3={})",
            s.forward.coulomb,
            s.forward.stiction,
            s.stribeck_speed,
            p.stiffness,
            p.damping,
            s.viscous,
            s.backward.coulomb,
            s.backward.stiction,
            s.stribeck_exponent,
            s.viscous_quadratic,
            s.viscous_cubic
        )
    }
}
