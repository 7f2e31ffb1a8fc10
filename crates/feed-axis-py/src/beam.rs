//! Timoshenko beams.

use beam_fem::{Beam, BeamError, CrossSection, Dof, Material, Mesh, lowest_modes};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays;
use crate::errors::{ParameterError, raise};
use crate::value::{Value, value};

/// A round solid shaft of Timoshenko elements.
#[pyclass(module = "feed_axis", name = "Beam", frozen)]
pub(crate) struct PyBeam {
    beam: Beam,
    elements: usize,
    /// Length, diameter, Young's modulus, Poisson's ratio, density.
    given: [f64; 5],
}

impl Value for PyBeam {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (self.elements, PyTuple::new(py, self.given)?).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (elements, (length, diameter, modulus, poisson, density)) = state.extract()?;
        Self::new(length, diameter, elements, modulus, poisson, density)
    }
}

value!(PyBeam, hash);

#[pymethods]
impl PyBeam {
    /// The default material is steel.
    #[new]
    #[pyo3(signature = (*, length_m, diameter_m, elements = 10, youngs_modulus_pa = 206e9, poisson_ratio = 0.3, density_kg_m3 = 7850.0))]
    fn new(
        length_m: f64,
        diameter_m: f64,
        #[pyo3(from_py_with = arrays::elements)] elements: usize,
        youngs_modulus_pa: f64,
        poisson_ratio: f64,
        density_kg_m3: f64,
    ) -> PyResult<Self> {
        let made = || -> Result<Beam, BeamError> {
            let material = Material::new(youngs_modulus_pa, poisson_ratio, density_kg_m3)?;
            let section = CrossSection::solid_circle(diameter_m, &material)?;
            Ok(Beam::new(
                section,
                material,
                Mesh::uniform(length_m, elements)?,
            ))
        };
        let beam = made().map_err(raise::<ParameterError>)?;
        let given = [
            length_m,
            diameter_m,
            youngs_modulus_pa,
            poisson_ratio,
            density_kg_m3,
        ];
        Ok(Self {
            beam,
            elements,
            given,
        })
    }

    /// The lowest natural frequencies, Hz; the rigid motions of a free beam among them, as 0.
    /// `supports`: "free" or "pinned" (both ends hold deflection, stretch and twist).
    #[pyo3(signature = (count, *, supports = "free"))]
    fn frequencies_hz<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arrays::count)] count: usize,
        supports: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let last = self.beam.order() / 6 - 1;
        let held: Vec<usize> = match supports {
            "free" => Vec::new(),
            "pinned" => {
                let all = [Dof::U, Dof::V, Dof::W, Dof::ThetaX];
                let ends = all.iter().flat_map(|dof| [dof.at(0), dof.at(last)]);
                ends.collect()
            }
            other => {
                return Err(ParameterError::new_err(format!(
                    "supports is {other:?}; valid: free, pinned"
                )));
            }
        };
        let matrices = self.beam.assemble_banded();
        let fixed = matrices.fixed(&held).map_err(raise::<ParameterError>)?;
        let modes = py.detach(|| lowest_modes(&fixed, count));
        let modes = modes.map_err(raise::<ParameterError>)?;
        Ok(modes.frequencies_hz().into_pyarray(py))
    }

    fn __repr__(&self) -> String {
        let [length, diameter, modulus, poisson, density] = self.given;
        format!(
            "Beam(length_m={length}, diameter_m={diameter}, elements={}, youngs_modulus_pa={modulus}, poisson_ratio={poisson}, density_kg_m3={density})",
            self.elements
        )
    }
}
