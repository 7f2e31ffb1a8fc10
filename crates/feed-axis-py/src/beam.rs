//! Timoshenko beams.

use beam_fem::{Beam, BeamError, CrossSection, Dof, Material, Mesh, lowest_modes};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;

use crate::errors::{ParameterError, raise};

/// A round solid shaft of Timoshenko elements.
#[pyclass(module = "feed_axis", name = "Beam", frozen)]
pub(crate) struct PyBeam(Beam, [f64; 2]);

#[pymethods]
impl PyBeam {
    /// The default material is steel.
    #[new]
    #[pyo3(signature = (*, length_m, diameter_m, elements = 10, youngs_modulus_pa = 206e9, poisson_ratio = 0.3, density_kg_m3 = 7850.0))]
    fn new(
        length_m: f64,
        diameter_m: f64,
        elements: usize,
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
        Ok(Self(beam, [length_m, diameter_m]))
    }

    /// The lowest natural frequencies, Hz; the rigid motions of a free beam among them, as 0.
    /// `supports`: "free" or "pinned" (both ends hold deflection, stretch and twist).
    #[pyo3(signature = (count, *, supports = "free"))]
    fn frequencies_hz<'py>(
        &self,
        py: Python<'py>,
        count: usize,
        supports: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let last = self.0.order() / 6 - 1;
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
        let matrices = self.0.assemble_banded();
        let fixed = matrices.fixed(&held).map_err(raise::<ParameterError>)?;
        let modes = py.detach(|| lowest_modes(&fixed, count));
        let modes = modes.map_err(raise::<ParameterError>)?;
        Ok(modes.frequencies_hz().into_pyarray(py))
    }

    fn __repr__(&self) -> String {
        let Self(beam, [length, diameter]) = self;
        format!(
            "Beam(length_m={length}, diameter_m={diameter}, elements={})",
            beam.order() / 6 - 1
        )
    }
}
