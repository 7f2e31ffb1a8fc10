//! The assembled matrices of a model.

use nalgebra::{Complex, DMatrix, DVector};

use crate::error::finite;
use crate::parts::Damping;
use crate::{BeamError, Dof, Modes, natural_modes};

/// M, K, C, G and the geometric stiffness of
/// `M q̈ + (C + Ω G) q̇ + (K + K_g + Ω K_c) q = F`, Ω the spin speed about x in rad/s, for
/// the rows that are free.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemMatrices {
    /// Mass M: kg, kg·m, kg·m².
    pub mass: DMatrix<f64>,
    /// Stiffness K without axial load: N/m, N, N·m.
    pub stiffness: DMatrix<f64>,
    /// Damping C: N·s/m, N·s, N·m·s.
    pub damping: DMatrix<f64>,
    /// Gyroscopic matrix G of a spin of 1 rad/s, antisymmetric: kg·m².
    pub gyroscopic: DMatrix<f64>,
    /// Geometric stiffness K_g of the axial forces: N/m, N, N·m.
    pub geometric: DMatrix<f64>,
    /// Circulatory matrix K_c of a spin of 1 rad/s, of damping that turns with the
    /// shaft: N·s/m, N·s, N·m·s. Not symmetric.
    pub circulatory: DMatrix<f64>,
    free: Vec<usize>,
    spinning: usize,
}

impl SystemMatrices {
    /// Keeps the rows `free` of mass, stiffness, damping, gyroscopic, geometric, circulatory; the
    /// first `spinning` nodes are those of the shaft.
    pub(crate) fn of(
        free: Vec<usize>,
        whole: [DMatrix<f64>; 6],
        spinning: usize,
    ) -> Result<Self, BeamError> {
        let order = whole[0].nrows();
        if free.is_empty() {
            return Err(BeamError::ModeCount { count: 0, order });
        }
        let names = [
            "mass",
            "stiffness",
            "damping",
            "gyroscopic",
            "geometric",
            "circulatory",
        ];
        for (matrix, field) in whole.iter().zip(names) {
            if !matrix.iter().all(|v| v.is_finite()) {
                return Err(BeamError::NotFinite { field });
            }
        }
        let [mass, stiffness, damping, gyroscopic, geometric, circulatory] =
            whole.map(|m| DMatrix::from_fn(free.len(), free.len(), |i, j| m[(free[i], free[j])]));
        Ok(Self {
            mass,
            stiffness,
            damping,
            gyroscopic,
            geometric,
            circulatory,
            free,
            spinning,
        })
    }

    /// Number of free rows.
    pub fn order(&self) -> usize {
        self.free.len()
    }

    /// For each row of the matrices its row before constraints, [`Dof::at`].
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// The row of these matrices that belongs to row `whole` ([`Dof::at`]) before
    /// constraints; none if it is held or does not exist.
    pub fn row(&self, whole: usize) -> Option<usize> {
        self.free.binary_search(&whole).ok()
    }

    /// The same, or an error that names it.
    pub(crate) fn free_row(&self, field: &'static str, whole: usize) -> Result<usize, BeamError> {
        self.row(whole).ok_or(BeamError::Held { field, row: whole })
    }

    /// Nodes of the shaft, the first ones.
    pub(crate) fn spinning(&self) -> usize {
        self.spinning
    }

    /// K + K_g.
    pub fn loaded_stiffness(&self) -> DMatrix<f64> {
        &self.stiffness + &self.geometric
    }

    /// The symmetric part of K + K_g.
    pub(crate) fn symmetric_stiffness(&self) -> DMatrix<f64> {
        let loaded = self.loaded_stiffness();
        (&loaded + loaded.transpose()) * 0.5
    }

    /// Refuses cross stiffness that is not symmetric.
    pub(crate) fn check_symmetric(&self, instead: &'static str) -> Result<(), BeamError> {
        if self.stiffness == self.stiffness.transpose() {
            return Ok(());
        }
        Err(BeamError::NotSymmetric {
            field: "stiffness",
            instead,
        })
    }

    /// Undamped modes at standstill under the axial forces.
    ///
    /// # Errors
    /// Those of [`natural_modes`]; [`BeamError::NotSymmetric`] with cross stiffness
    /// that is not symmetric, for which [`crate::WhirlAnalysis`] is.
    pub fn natural_modes(&self) -> Result<Modes, BeamError> {
        self.check_symmetric("WhirlAnalysis finds the modes of such bearings")?;
        natural_modes(&self.mass, &self.symmetric_stiffness())
    }

    /// Adds the matrix of a damping law.
    pub(crate) fn add_damping(&mut self, damping: &Damping) -> Result<(), BeamError> {
        match damping {
            Damping::None => {}
            Damping::Rayleigh { alpha, beta } => {
                self.damping += &self.mass * *alpha + self.symmetric_stiffness() * *beta;
            }
            Damping::Modal(ratios) => {
                let modes = natural_modes(&self.mass, &self.symmetric_stiffness())?;
                let order = self.order();
                if ratios.len() > order {
                    let count = ratios.len();
                    return Err(BeamError::ModeCount { count, order });
                }
                for (mode, ratio) in ratios.iter().enumerate() {
                    let momentum = &self.mass * modes.shapes.column(mode);
                    let rate = 2.0 * ratio * modes.frequencies_rad_s[mode];
                    self.damping += &momentum * momentum.transpose() * rate;
                }
            }
        }
        Ok(())
    }

    /// The complex amplitude q of the steady motion q e^{iωt} under F e^{iωt}:
    /// (K + K_g + ΩK_c − ω²M + iω(C + ΩG)) q = F, all rows free ones. `spin` is Ω and
    /// `frequency` ω, rad/s; with both 0 it is the static deflection.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for a spin or frequency that is not finite,
    /// [`BeamError::Shape`] for a force of another order, [`BeamError::Resonance`] at
    /// an undamped resonance.
    pub fn steady_response(
        &self,
        spin: f64,
        frequency: f64,
        force: &DVector<Complex<f64>>,
    ) -> Result<DVector<Complex<f64>>, BeamError> {
        finite("spin", spin)?;
        finite("frequency", frequency)?;
        let order = self.order();
        if force.len() != order {
            return Err(BeamError::Shape {
                field: "force",
                rows: force.len(),
                columns: 1,
                order,
            });
        }
        // Rows and columns scaled by √M_ii: metres and radians of one size.
        let scale: Vec<f64> = self.mass.diagonal().iter().map(|m| m.sqrt()).collect();
        if !scale.iter().all(|s| s.is_finite() && *s > 0.0) {
            return Err(BeamError::MassNotPositiveDefinite);
        }
        let dynamic = DMatrix::from_fn(order, order, |i, j| {
            let place = (i, j);
            let turning = spin * self.circulatory[place];
            let spring = self.stiffness[place] + self.geometric[place] + turning;
            let real = spring - frequency * frequency * self.mass[place];
            let rate = self.damping[place] + spin * self.gyroscopic[place];
            Complex::new(real, frequency * rate) / (scale[i] * scale[j])
        });
        let rhs = DVector::from_fn(order, |i, _| force[i] / scale[i]);
        let solved = dynamic
            .lu()
            .solve(&rhs)
            .filter(|q| q.iter().all(|v| v.re.is_finite() && v.im.is_finite()))
            .ok_or(BeamError::Resonance { frequency })?;
        Ok(DVector::from_fn(order, |i, _| solved[i] / scale[i]))
    }

    /// Frequency response between two rows ([`Dof::at`], before constraints): complex
    /// displacement at `to` per force at `from` (receptance: m/N, rad/N, rad/(N·m)), at
    /// each of `frequencies` (rad/s), the shaft spinning at `spin` rad/s. Times iω it is
    /// the mobility, times −ω² the accelerance.
    ///
    /// # Errors
    /// [`BeamError::Held`] for a row that is held or does not exist; those of
    /// [`SystemMatrices::steady_response`].
    pub fn receptance(
        &self,
        spin: f64,
        rows: Receptance,
        frequencies: &[f64],
    ) -> Result<Vec<Complex<f64>>, BeamError> {
        let from = self.free_row("from", rows.from)?;
        let to = self.free_row("to", rows.to)?;
        let mut force = DVector::zeros(self.order());
        force[from] = Complex::new(1.0, 0.0);
        let at = |w: &f64| self.steady_response(spin, *w, &force).map(|q| q[to]);
        frequencies.iter().map(at).collect()
    }

    /// Displacement of one degree of freedom in a vector over the free rows, 0 if held.
    pub(crate) fn component(
        &self,
        q: &DVector<Complex<f64>>,
        node: usize,
        dof: Dof,
    ) -> Complex<f64> {
        let zero = Complex::new(0.0, 0.0);
        self.row(dof.at(node)).map_or(zero, |row| q[row])
    }
}

/// The rows of a frequency response, as [`Dof::at`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Receptance {
    /// Where the force or moment acts.
    pub from: usize,
    /// Where the displacement or rotation is seen.
    pub to: usize,
}
