//! A beam and its assembled matrices, dense and banded.

use nalgebra::DMatrix;

use crate::banded::free_dofs;
use crate::element::Coefficients;
use crate::error::check_size;
use crate::modes::check_square;
use crate::{BandedMatrices, BeamError, CrossSection, Material, Mesh};

/// A straight beam of one section and material on a mesh. Any combination of
/// checked parts is valid.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Cross-section.
    pub section: CrossSection,
    /// Material.
    pub material: Material,
    /// Nodes along the axis.
    pub mesh: Mesh,
}

/// Assembled matrices of `M q̈ + K q = F`, each (6N + 6)², rows as [`Dof::at`](crate::Dof::at).
#[derive(Clone, Debug, PartialEq)]
pub struct BeamMatrices {
    /// Mass M, kg, kg·m and kg·m².
    pub mass: DMatrix<f64>,
    /// Stiffness K, N/m, N and N·m.
    pub stiffness: DMatrix<f64>,
}

impl Beam {
    /// Puts the parts together.
    pub fn new(section: CrossSection, material: Material, mesh: Mesh) -> Self {
        Self {
            section,
            material,
            mesh,
        }
    }

    /// Number of degrees of freedom, 6 N + 6.
    pub fn order(&self) -> usize {
        6 * self.mesh.nodes().len()
    }

    /// Dense M and K of the free beam (paper, Eqs. A52 and A53). Memory
    /// grows with N²: for many elements use [`Beam::assemble_banded`].
    ///
    /// # Errors
    /// [`BeamError::TooLarge`] for more entries than are sensible to store, from
    /// some 1900 elements on.
    pub fn assemble(&self) -> Result<BeamMatrices, BeamError> {
        let order = self.order();
        check_size("a dense matrix", order, order)?;
        let mut mass = DMatrix::zeros(order, order);
        let mut stiffness = DMatrix::zeros(order, order);
        for (element, length) in self.mesh.lengths().enumerate() {
            let first = 6 * element;
            for e in Coefficients::new(&self.section, &self.material, length).lower() {
                let (row, column) = (first + e.row, first + e.column);
                mass[(row, column)] += e.mass;
                stiffness[(row, column)] += e.stiffness;
            }
        }
        mass.fill_upper_triangle_with_lower_triangle();
        stiffness.fill_upper_triangle_with_lower_triangle();
        Ok(BeamMatrices { mass, stiffness })
    }

    /// M and K of the free beam in banded storage: memory and time
    /// proportional to N.
    pub fn assemble_banded(&self) -> BandedMatrices {
        let mut matrices = BandedMatrices::sized(self.order());
        self.add_to(&mut matrices);
        matrices
    }

    /// The same into matrices made before, without allocation.
    ///
    /// # Errors
    /// [`BeamError::Shape`] if they are not those of a beam with as many nodes.
    pub fn assemble_banded_into(&self, matrices: &mut BandedMatrices) -> Result<(), BeamError> {
        matrices.check(self.order())?;
        matrices.clear();
        self.add_to(matrices);
        Ok(())
    }

    /// Adds every element; elements of one length are computed once.
    fn add_to(&self, matrices: &mut BandedMatrices) {
        let mut known = 0.0;
        let mut entries = None;
        for (element, length) in self.mesh.lengths().enumerate() {
            if length != known || entries.is_none() {
                entries = Some(Coefficients::new(&self.section, &self.material, length).lower());
                known = length;
            }
            if let Some(entries) = &entries {
                matrices.add_element(6 * element, entries);
            }
        }
    }
}

impl BeamMatrices {
    /// The matrices with the `fixed` degrees of freedom held at zero: their
    /// rows and columns are left out. The others keep their order.
    ///
    /// # Errors
    /// [`BeamError::Index`] for a degree of freedom that does not exist,
    /// [`BeamError::Shape`] if M and K are not square and of one order.
    pub fn fixed(&self, fixed: &[usize]) -> Result<Self, BeamError> {
        let order = self.mass.nrows();
        check_square("mass", &self.mass, order)?;
        check_square("stiffness", &self.stiffness, order)?;
        let free = free_dofs(order, fixed)?;
        let pick = |m: &DMatrix<f64>| {
            DMatrix::from_fn(free.len(), free.len(), |i, j| m[(free[i], free[j])])
        };
        Ok(Self {
            mass: pick(&self.mass),
            stiffness: pick(&self.stiffness),
        })
    }
}
