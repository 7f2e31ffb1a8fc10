//! A rotor: shaft, masses, springs, bearings, constraints and damping, assembled.

use nalgebra::DMatrix;

use crate::error::{check_size, finite, not_negative};
use crate::field::ElementMatrices;
use crate::parts::{Bearing, Damping, LumpedMass};
use crate::system::SystemMatrices;
use crate::{BeamError, Dof, Shaft};

/// A shaft with what it carries and what carries it. Rows of its matrices before
/// constraints are [`Dof::at`] of nodes 0..[`BeamModel::nodes`]: those of the shaft, then
/// those that [`BeamModel::add_node`] made.
///
/// ```
/// use beam_fem::{Bearing, Dof, LumpedMass, Material, BeamModel, Shaft, SectionShape, Span, WhirlAnalysis};
///
/// let steel = Material::new(211e9, 0.3, 7810.0)?;
/// let round = SectionShape::solid(0.05).section(&steel)?;
/// let mut rotor = BeamModel::new(Shaft::new(&[Span::uniform(1.5, 6, round, steel.clone())?])?);
/// rotor.add_mass(2, LumpedMass::disc([0.28, 0.05], 0.07, &steel)?)?;
/// rotor.add_mass(4, LumpedMass::disc([0.35, 0.05], 0.07, &steel)?)?;
/// rotor.add_bearing(0, Bearing::isotropic(1e6, 0.0))?;
/// rotor.add_bearing(6, Bearing::isotropic(1e6, 0.0))?;
/// rotor.lateral_only();
/// let whirl = WhirlAnalysis::new(&rotor.matrices()?)?;
/// let spinning = whirl.at(4000.0 * std::f64::consts::PI / 30.0)?;
/// assert!((spinning.modes[0].frequency_rad_s() - 85.4).abs() < 0.1); // backward
/// assert!((spinning.modes[1].frequency_rad_s() - 87.8).abs() < 0.1); // forward
/// # Ok::<(), beam_fem::BeamError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct BeamModel {
    shaft: Shaft,
    nodes: usize,
    masses: Vec<(usize, LumpedMass)>,
    /// Entries of K and C: row, column, value.
    stiffness: Vec<(usize, usize, f64)>,
    damping: Vec<(usize, usize, f64)>,
    held: Vec<bool>,
    structural: Damping,
    /// β of the damping that turns with the shaft, s.
    rotating: f64,
    axial: Vec<f64>,
}

impl BeamModel {
    /// The free shaft alone.
    pub fn new(shaft: Shaft) -> Self {
        let nodes = shaft.mesh().nodes().len();
        Self {
            axial: vec![0.0; shaft.elements().len()],
            shaft,
            nodes,
            masses: Vec::new(),
            stiffness: Vec::new(),
            damping: Vec::new(),
            held: vec![false; 6 * nodes],
            structural: Damping::None,
            rotating: 0.0,
        }
    }

    /// The shaft.
    pub fn shaft(&self) -> &Shaft {
        &self.shaft
    }

    /// Number of nodes, those that were added included.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Adds a node off the shaft, which does not spin: a pedestal or a casing. Its
    /// degrees of freedom need mass ([`BeamModel::add_mass`]) or [`BeamModel::fix`]. Returns
    /// its number.
    pub fn add_node(&mut self) -> usize {
        self.nodes += 1;
        self.held.extend([false; 6]);
        self.nodes - 1
    }

    /// Puts a rigid body on a node, in addition to any that it has.
    ///
    /// # Errors
    /// [`BeamError::Index`] for a node that does not exist, [`BeamError::Parameter`]
    /// for what is not finite and at least zero.
    pub fn add_mass(&mut self, node: usize, mass: LumpedMass) -> Result<(), BeamError> {
        self.check_node(node)?;
        mass.check()?;
        self.masses.push((node, mass));
        Ok(())
    }

    /// Adds a spring between a row ([`Dof::at`]) and the ground, N/m or N·m/rad; a
    /// negative one is allowed.
    ///
    /// # Errors
    /// [`BeamError::Index`], [`BeamError::Parameter`] unless it is finite.
    pub fn add_ground_spring(&mut self, row: usize, stiffness: f64) -> Result<(), BeamError> {
        self.check_row(row)?;
        let value = finite("stiffness", stiffness)?;
        self.stiffness.push((row, row, value));
        Ok(())
    }

    /// Adds a viscous damper between a row ([`Dof::at`]) and the ground, N·s/m or
    /// N·m·s/rad.
    ///
    /// # Errors
    /// As [`BeamModel::add_ground_spring`].
    pub fn add_ground_damper(&mut self, row: usize, damping: f64) -> Result<(), BeamError> {
        self.check_row(row)?;
        let value = finite("damping", damping)?;
        self.damping.push((row, row, value));
        Ok(())
    }

    /// Adds a spring between two rows ([`Dof::at`]): its force is the stiffness times
    /// their difference.
    ///
    /// # Errors
    /// As [`BeamModel::add_ground_spring`].
    pub fn add_spring(&mut self, rows: [usize; 2], stiffness: f64) -> Result<(), BeamError> {
        self.check_row(rows[0])?;
        self.check_row(rows[1])?;
        let value = finite("stiffness", stiffness)?;
        couple(&mut self.stiffness, rows, rows, value);
        Ok(())
    }

    /// Adds a viscous damper between two rows ([`Dof::at`]).
    ///
    /// # Errors
    /// As [`BeamModel::add_ground_spring`].
    pub fn add_damper(&mut self, rows: [usize; 2], damping: f64) -> Result<(), BeamError> {
        self.check_row(rows[0])?;
        self.check_row(rows[1])?;
        let value = finite("damping", damping)?;
        couple(&mut self.damping, rows, rows, value);
        Ok(())
    }

    /// Adds a bearing between a node and the ground.
    ///
    /// # Errors
    /// [`BeamError::Index`], [`BeamError::Parameter`] for what is not finite.
    pub fn add_bearing(&mut self, node: usize, bearing: Bearing) -> Result<(), BeamError> {
        self.check_node(node)?;
        bearing.check()?;
        for (i, row) in [Dof::V, Dof::W].into_iter().enumerate() {
            for (j, column) in [Dof::V, Dof::W].into_iter().enumerate() {
                let place = (row.at(node), column.at(node));
                let entry = |value| (place.0, place.1, value);
                self.stiffness.push(entry(bearing.stiffness[i][j]));
                self.damping.push(entry(bearing.damping[i][j]));
            }
        }
        Ok(())
    }

    /// Adds a bearing between two nodes: shaft and pedestal, or two shafts' nodes.
    ///
    /// # Errors
    /// As [`BeamModel::add_bearing`].
    pub fn add_bearing_between(
        &mut self,
        nodes: [usize; 2],
        bearing: Bearing,
    ) -> Result<(), BeamError> {
        self.check_node(nodes[0])?;
        self.check_node(nodes[1])?;
        bearing.check()?;
        for (i, row) in [Dof::V, Dof::W].into_iter().enumerate() {
            for (j, column) in [Dof::V, Dof::W].into_iter().enumerate() {
                let rows = nodes.map(|node| row.at(node));
                let columns = nodes.map(|node| column.at(node));
                couple(&mut self.stiffness, rows, columns, bearing.stiffness[i][j]);
                couple(&mut self.damping, rows, columns, bearing.damping[i][j]);
            }
        }
        Ok(())
    }

    /// Holds one degree of freedom of a node at zero.
    ///
    /// # Errors
    /// [`BeamError::Index`] for a node that does not exist.
    pub fn fix(&mut self, node: usize, dof: Dof) -> Result<(), BeamError> {
        self.check_node(node)?;
        self.held[dof.at(node)] = true;
        Ok(())
    }

    /// Holds all six degrees of freedom of a node: a clamp.
    ///
    /// # Errors
    /// [`BeamError::Index`] for a node that does not exist.
    pub fn clamp(&mut self, node: usize) -> Result<(), BeamError> {
        Dof::ALL.into_iter().try_for_each(|dof| self.fix(node, dof))
    }

    /// Holds one degree of freedom of every node that there is now.
    pub fn fix_everywhere(&mut self, dof: Dof) {
        for node in 0..self.nodes {
            self.held[dof.at(node)] = true;
        }
    }

    /// Leaves lateral vibration alone: holds stretch and twist of every node.
    pub fn lateral_only(&mut self) {
        self.fix_everywhere(Dof::U);
        self.fix_everywhere(Dof::ThetaX);
    }

    /// Damping of the structure; the last one set holds.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for what is not finite, and a negative modal ratio.
    pub fn set_damping(&mut self, damping: Damping) -> Result<(), BeamError> {
        damping.check()?;
        self.structural = damping;
        Ok(())
    }

    /// Damping within the shaft, which turns with it: β in s, its stress E(ε + β ε̇), so
    /// that C_r = β K of the shaft alone acts on the rates that a turning observer sees,
    /// q̇ − Ω R q, R the quarter turn about x. Above a critical speed it drives forward
    /// whirl. The section of a shaft that spins is axisymmetric.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] unless it is finite and at least zero.
    pub fn set_rotating_damping(&mut self, beta: f64) -> Result<(), BeamError> {
        self.rotating = not_negative("beta", beta)?;
        Ok(())
    }

    /// Axial force in the whole shaft, N, tension positive.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] unless it is finite.
    pub fn set_axial_force(&mut self, force: f64) -> Result<(), BeamError> {
        finite("force", force)?;
        self.axial.fill(force);
        Ok(())
    }

    /// Axial force in each element, N, tension positive: a shaft's own weight, a
    /// load between two nodes.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] unless all are finite, [`BeamError::Shape`] if there
    /// are not as many as elements.
    pub fn set_axial_forces(&mut self, forces: &[f64]) -> Result<(), BeamError> {
        let order = self.axial.len();
        if forces.len() != order {
            return Err(BeamError::Shape {
                field: "forces",
                rows: forces.len(),
                columns: 1,
                order,
            });
        }
        for force in forces {
            finite("force", *force)?;
        }
        self.axial.copy_from_slice(forces);
        Ok(())
    }

    /// Assembles M, K, C, G and the geometric stiffness, without the rows that are
    /// held.
    ///
    /// # Errors
    /// [`BeamError::TooLarge`] for more entries than are sensible to store,
    /// [`BeamError::ModeCount`] if every row is held, [`BeamError::NotFinite`] for
    /// values so great that they overflow; those of [`crate::natural_modes`] with
    /// modal damping.
    pub fn matrices(&self) -> Result<SystemMatrices, BeamError> {
        let order = 6 * self.nodes;
        check_size("a dense matrix", order, order)?;
        let zeros = || DMatrix::zeros(order, order);
        let (mut mass, mut stiffness, mut damping) = (zeros(), zeros(), zeros());
        let (mut gyroscopic, mut geometric) = (zeros(), zeros());
        for (index, element) in self.shaft.elements().iter().enumerate() {
            let part = ElementMatrices::new(element)?;
            let add = |into: &mut DMatrix<f64>, from: &crate::element::ElementMatrix, scale| {
                let mut block = into.view_mut((6 * index, 6 * index), (12, 12));
                block += from * scale;
            };
            add(&mut mass, &part.mass, 1.0);
            add(&mut stiffness, &part.stiffness, 1.0);
            add(&mut gyroscopic, &part.gyroscopic, 1.0);
            add(&mut geometric, &part.geometric, self.axial[index]);
        }
        let inner = &stiffness * self.rotating;
        damping += &inner;
        let circulatory = self.circulatory(&inner);
        for (node, body) in &self.masses {
            let at = |dof: Dof| dof.at(*node);
            for dof in [Dof::U, Dof::V, Dof::W] {
                mass[(at(dof), at(dof))] += body.mass;
            }
            mass[(at(Dof::ThetaX), at(Dof::ThetaX))] += body.polar_inertia;
            for dof in [Dof::ThetaY, Dof::ThetaZ] {
                mass[(at(dof), at(dof))] += body.diametral_inertia;
            }
            if self.spins(*node) {
                gyroscopic[(at(Dof::ThetaY), at(Dof::ThetaZ))] += body.polar_inertia;
                gyroscopic[(at(Dof::ThetaZ), at(Dof::ThetaY))] -= body.polar_inertia;
            }
        }
        for (row, column, value) in &self.stiffness {
            stiffness[(*row, *column)] += value;
        }
        for (row, column, value) in &self.damping {
            damping[(*row, *column)] += value;
        }
        let free = (0..order).filter(|row| !self.held[*row]).collect();
        let mut system = SystemMatrices::of(
            free,
            [mass, stiffness, damping, gyroscopic, geometric, circulatory],
            self.shaft.mesh().nodes().len(),
        )?;
        system.add_damping(&self.structural)?;
        Ok(system)
    }

    /// −C_r R: R turns (v, w) and (θy, θz) of the shaft's nodes by a quarter about x.
    fn circulatory(&self, inner: &DMatrix<f64>) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(inner.nrows(), inner.ncols());
        for node in (0..self.nodes).filter(|node| self.spins(*node)) {
            for (y, z) in [(Dof::V, Dof::W), (Dof::ThetaY, Dof::ThetaZ)] {
                let (y, z) = (y.at(node), z.at(node));
                // R q has −z at y and y at z.
                out.column_mut(z).copy_from(&inner.column(y));
                out.column_mut(y).copy_from(&-inner.column(z));
            }
        }
        out
    }

    fn spins(&self, node: usize) -> bool {
        node < self.shaft.mesh().nodes().len()
    }

    fn check_node(&self, index: usize) -> Result<(), BeamError> {
        if index < self.nodes {
            return Ok(());
        }
        Err(BeamError::Index {
            field: "node",
            index,
            bound: self.nodes,
        })
    }

    fn check_row(&self, index: usize) -> Result<(), BeamError> {
        let bound = self.held.len();
        if index < bound {
            return Ok(());
        }
        Err(BeamError::Index {
            field: "row",
            index,
            bound,
        })
    }
}

/// Adds value · (e_r0 − e_r1)(e_c0 − e_c1)ᵀ.
fn couple(into: &mut Vec<(usize, usize, f64)>, rows: [usize; 2], columns: [usize; 2], value: f64) {
    for (row, s) in [(rows[0], 1.0), (rows[1], -1.0)] {
        for (column, t) in [(columns[0], 1.0), (columns[1], -1.0)] {
            into.push((row, column, s * t * value));
        }
    }
}
