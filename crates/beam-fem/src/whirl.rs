//! Damped eigenvalues of a spinning shaft, and the direction in which it whirls.

use nalgebra::{Cholesky, Complex, DMatrix, DVector, Schur};

use crate::dense;
use crate::error::finite;
use crate::orbit::Orbit;
use crate::system::SystemMatrices;
use crate::{BeamError, Dof, natural_modes};

const ZERO: Complex<f64> = Complex::new(0.0, 0.0);

/// Direction of a whirling motion against the spin (positive about x).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Whirl {
    /// Every node goes round with the spin.
    Forward,
    /// Every node goes round against the spin.
    Backward,
    /// Some nodes go round with the spin, others against it.
    Mixed,
    /// The nodes move on straight lines.
    Planar,
    /// Less than half of the kinetic energy is lateral: a stretching or twisting mode.
    NotLateral,
}

/// One oscillating mode at a spin speed: q(t) = Re(shape e^{λt}).
#[derive(Clone, Debug, PartialEq)]
pub struct WhirlMode {
    /// λ, rad/s, imaginary part above zero.
    pub eigenvalue: Complex<f64>,
    /// Complex shape over the free rows ([`SystemMatrices::free`]), φᴴMφ = 1, phase
    /// arbitrary.
    pub shape: DVector<Complex<f64>>,
    /// Direction of the shaft's nodes.
    pub direction: Whirl,
    /// Σ(f² − b²)/Σ(f² + b²) over the shaft's nodes, f and b the radii of the forward
    /// and backward circles that make up a node's orbit: 1 for circles with the spin,
    /// −1 for circles against it, 0 for lines.
    pub whirl_index: f64,
}

impl WhirlMode {
    /// Damped angular frequency Im λ, rad/s.
    pub fn frequency_rad_s(&self) -> f64 {
        self.eigenvalue.im
    }

    /// |λ|, rad/s: what is called the natural frequency of a damped mode.
    pub fn natural_rad_s(&self) -> f64 {
        self.eigenvalue.norm()
    }

    /// Damping ratio −Re λ/|λ|; below zero the motion grows.
    pub fn damping_ratio(&self) -> f64 {
        -self.eigenvalue.re / self.eigenvalue.norm()
    }

    /// Logarithmic decrement −2π Re λ/Im λ.
    pub fn log_decrement(&self) -> f64 {
        -std::f64::consts::TAU * self.eigenvalue.re / self.eigenvalue.im
    }
}

/// The eigenvalues at one spin speed.
#[derive(Clone, Debug, PartialEq)]
pub struct WhirlSpectrum {
    /// Spin speed, rad/s.
    pub spin: f64,
    /// Oscillating modes, by damped frequency.
    pub modes: Vec<WhirlMode>,
    /// Real eigenvalues (overdamped modes and rigid motions), rad/s, ascending.
    pub real: Vec<f64>,
}

/// Eigenvalues of a model at any spin speed, in the coordinates of its undamped
/// modes at standstill.
#[derive(Clone, Debug)]
pub struct WhirlAnalysis {
    pub(crate) system: SystemMatrices,
    /// Undamped modes at standstill, one a column, and their ω².
    pub(crate) shapes: DMatrix<f64>,
    pub(crate) squares: Vec<f64>,
    /// C, G, the antisymmetric part of K, and K_c in those modes.
    damping: DMatrix<f64>,
    pub(crate) gyroscopic: DMatrix<f64>,
    cross: DMatrix<f64>,
    circulatory: DMatrix<f64>,
}

impl WhirlAnalysis {
    /// All modes kept: exact for the matrices, at a cost of (2n)³ a speed.
    ///
    /// # Errors
    /// [`BeamError::MassNotPositiveDefinite`], and those of [`natural_modes`] but for
    /// a negative stiffness, which is allowed (a load beyond buckling).
    pub fn new(system: &SystemMatrices) -> Result<Self, BeamError> {
        Self::reduced(system, system.order())
    }

    /// The lowest `modes` of standstill kept: the cost falls with the cube of their
    /// number, and eigenvalues well below the highest that is kept are hardly changed.
    /// Bearings with strong damping or cross stiffness need more of them.
    ///
    /// # Errors
    /// As [`WhirlAnalysis::new`]; [`BeamError::ModeCount`] for none or more than rows.
    pub fn reduced(system: &SystemMatrices, modes: usize) -> Result<Self, BeamError> {
        let order = system.order();
        if modes == 0 || modes > order {
            return Err(BeamError::ModeCount {
                count: modes,
                order,
            });
        }
        let (squares, shapes) = basis(system)?;
        let shapes = shapes.columns(0, modes).into_owned();
        let inside = |matrix: &DMatrix<f64>| shapes.transpose() * (matrix * &shapes);
        let loaded = system.loaded_stiffness();
        let cross = (&loaded - loaded.transpose()) * 0.5;
        let gyroscopic = inside(&system.gyroscopic);
        Ok(Self {
            damping: inside(&system.damping),
            // Antisymmetric to the bit, as the matrix that it comes from.
            gyroscopic: (&gyroscopic - gyroscopic.transpose()) * 0.5,
            cross: inside(&cross),
            circulatory: inside(&system.circulatory),
            squares: squares[..modes].to_vec(),
            shapes,
            system: system.clone(),
        })
    }

    /// Eigenvalues and shapes of all modes at `spin` rad/s.
    ///
    /// # Errors
    /// [`BeamError::Parameter`] for a spin that is not finite,
    /// [`BeamError::NotConverged`].
    pub fn at(&self, spin: f64) -> Result<WhirlSpectrum, BeamError> {
        self.lowest(spin, usize::MAX)
    }

    /// The same, with shapes of the lowest `count` oscillating modes only: the others
    /// are left out.
    ///
    /// # Errors
    /// As [`WhirlAnalysis::at`].
    pub fn lowest(&self, spin: f64, count: usize) -> Result<WhirlSpectrum, BeamError> {
        let (oscillating, real) = self.eigenvalues(spin)?;
        let mut modes: Vec<WhirlMode> = Vec::new();
        // Vectors in modal coordinates: equal eigenvalues get different ones.
        let mut known: Vec<(Complex<f64>, DVector<Complex<f64>>)> = Vec::new();
        for (index, value) in oscillating.into_iter().take(count).enumerate() {
            let near =
                |(other, _): &&(Complex<f64>, _)| (other - value).norm() < 1e-8 * value.norm();
            let same: Vec<_> = known.iter().filter(near).map(|(_, v)| v.clone()).collect();
            let vector = self.vector(spin, value, index, &same)?;
            modes.push(self.mode(value, &vector));
            known.push((value, vector));
        }
        Ok(WhirlSpectrum { spin, modes, real })
    }

    /// Damped frequencies Im λ at `spin`, ascending, with a 0 for each pair of real
    /// eigenvalues, so that each place in the list is a continuous function of spin.
    pub(crate) fn frequencies(&self, spin: f64) -> Result<Vec<f64>, BeamError> {
        let (oscillating, _) = self.eigenvalues(spin)?;
        let mut out = vec![0.0; self.squares.len().saturating_sub(oscillating.len())];
        out.extend(oscillating.iter().map(|value| value.im));
        Ok(out)
    }

    /// Eigenvalues with Im > 0 by Im, and the real ones.
    fn eigenvalues(&self, spin: f64) -> Result<(Vec<Complex<f64>>, Vec<f64>), BeamError> {
        finite("spin", spin)?;
        let n = self.squares.len();
        let (state, rate) = self.state(spin);
        if !state.iter().all(|v| v.is_finite()) {
            return Err(BeamError::NotFinite { field: "state" });
        }
        let highest = state.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let schur = Schur::try_new(state, f64::EPSILON, 300 * n).ok_or(BeamError::NotConverged)?;
        let all = schur.complex_eigenvalues();
        // A rigid motion is a double eigenvalue 0, which rounding of the matrix spreads
        // by √(2⁻⁵² |A| d), d its entry; 2n is room for the order.
        let order = 2.0 * n as f64;
        let rigid = self.squares.contains(&0.0);
        let rounding = f64::EPSILON * highest * order;
        let zero = if rigid {
            (rounding * rate).sqrt().max(rounding)
        } else {
            rounding
        };
        let (mut oscillating, mut real) = (Vec::new(), Vec::new());
        for value in all.iter() {
            if !(value.re.is_finite() && value.im.is_finite()) {
                return Err(BeamError::NotConverged);
            }
            if value.norm() <= zero {
                real.push(0.0);
            } else if value.im.abs() <= zero {
                real.push(value.re);
            } else if value.im > 0.0 {
                oscillating.push(*value);
            }
        }
        oscillating.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
        real.sort_by(f64::total_cmp);
        Ok((oscillating, real))
    }

    /// d/dt (D η, η̇) = A (D η, η̇) with D = √|ω²|: A = [0, D; −(Λ + K_a + ΩK_c) D⁻¹, −C − ΩG].
    /// Without damping and cross stiffness A is antisymmetric, so that its low
    /// eigenvalues keep their digits beside the high ones. Also the entry of D for a
    /// rigid motion, 1 rad/s or the lowest frequency.
    fn state(&self, spin: f64) -> (DMatrix<f64>, f64) {
        let n = self.squares.len();
        let size = |s: &f64| s.abs().sqrt();
        let elastic = self.squares.iter().filter(|s| **s != 0.0).map(size);
        let rate = elastic.fold(1.0, f64::min);
        let rates: Vec<f64> = self
            .squares
            .iter()
            .map(|s| if *s == 0.0 { rate } else { size(s) })
            .collect();
        let mut state = DMatrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            state[(i, n + i)] = rates[i];
            state[(n + i, i)] = -self.squares[i] / rates[i];
            for j in 0..n {
                state[(n + i, j)] -= self.cross_at(spin, i, j) / rates[j];
                state[(n + i, n + j)] = -self.damping[(i, j)] - spin * self.gyroscopic[(i, j)];
            }
        }
        (state, rate)
    }

    /// Entry of K_a + Ω K_c.
    fn cross_at(&self, spin: f64, i: usize, j: usize) -> f64 {
        self.cross[(i, j)] + spin * self.circulatory[(i, j)]
    }

    /// Null vector of λ² + λ(C + ΩG) + Λ + K_a + ΩK_c by inverse iteration, free of the
    /// vectors `same` of equal eigenvalues.
    fn vector(
        &self,
        spin: f64,
        value: Complex<f64>,
        index: usize,
        same: &[DVector<Complex<f64>>],
    ) -> Result<DVector<Complex<f64>>, BeamError> {
        let n = self.squares.len();
        // Scaled by |λ|² or ω², so that rows are of one size.
        let scale: Vec<f64> = (self.squares.iter())
            .map(|s| s.abs().max(value.norm_sqr()).sqrt())
            .collect();
        // Off the eigenvalue by some roundings, so that the factor is not singular.
        let near = value * (1.0 + 1e-11);
        let pencil = DMatrix::from_fn(n, n, |i, j| {
            let rate = self.damping[(i, j)] + spin * self.gyroscopic[(i, j)];
            let diagonal = if i == j {
                near * near + self.squares[i]
            } else {
                ZERO
            };
            (diagonal + near * rate + self.cross_at(spin, i, j)) / (scale[i] * scale[j])
        });
        let factor = pencil.lu();
        // A fixed start with every mode in it, real: at standstill shapes stay planar.
        let turn = |k: usize| (0.7 + 1.3 * (k as f64 + 1.0) * (index as f64 + 1.0)).sin();
        let mut x = DVector::from_fn(n, |k, _| {
            Complex::new(1.5 + turn(k), 0.0) * scale[k].recip()
        });
        for _ in 0..4 {
            // In scaled coordinates y = scale · η; `same` are η.
            let mut eta = DVector::from_fn(n, |k, _| x[k] / scale[k]);
            for other in same {
                let share = other.dotc(&eta);
                eta -= other * share;
            }
            x = DVector::from_fn(n, |k, _| eta[k] * scale[k]);
            x = factor.solve(&x).ok_or(BeamError::NotConverged)?;
            let size = x.norm();
            if !(size.is_finite() && size > 0.0) {
                return Err(BeamError::NotConverged);
            }
            x /= Complex::new(size, 0.0);
        }
        let mut eta = DVector::from_fn(n, |k, _| x[k] / scale[k]);
        for other in same {
            let share = other.dotc(&eta);
            eta -= other * share;
        }
        let size = eta.norm();
        if !(size.is_finite() && size > 0.0) {
            return Err(BeamError::NotConverged);
        }
        Ok(eta / Complex::new(size, 0.0))
    }

    /// Shape and direction from modal coordinates of norm 1.
    pub(crate) fn mode(&self, eigenvalue: Complex<f64>, eta: &DVector<Complex<f64>>) -> WhirlMode {
        let part = |of: fn(&Complex<f64>) -> f64| &self.shapes * eta.map(|v| of(&v));
        let (re, im) = (part(|v| v.re), part(|v| v.im));
        let shape = DVector::from_fn(re.len(), |i, _| Complex::new(re[i], im[i]));
        let (direction, whirl_index) = direction(&self.system, &shape);
        WhirlMode {
            eigenvalue,
            shape,
            direction,
            whirl_index,
        }
    }
}

/// ω² (0 for rigid motions) and shapes of the undamped modes at standstill.
fn basis(system: &SystemMatrices) -> Result<(Vec<f64>, DMatrix<f64>), BeamError> {
    let stiffness = system.symmetric_stiffness();
    match natural_modes(&system.mass, &stiffness) {
        Ok(modes) => {
            let squares = modes.frequencies_rad_s.iter().map(|w| w * w).collect();
            Ok((squares, modes.shapes))
        }
        // Beyond buckling the modes are a basis still.
        Err(BeamError::StiffnessNegative) => {
            let cholesky =
                Cholesky::new(system.mass.clone()).ok_or(BeamError::MassNotPositiveDefinite)?;
            let pairs = dense::reduced(&cholesky, &stiffness)?;
            Ok((pairs.values, pairs.shapes))
        }
        Err(other) => Err(other),
    }
}

/// Circles of one direction below this share of the other are rounding.
const ROUND: f64 = 1e-6;

/// Nodes with orbits below this share of the largest say nothing of a direction.
const SMALL: f64 = 1e-6;

/// Direction of a shape and its index.
fn direction(system: &SystemMatrices, shape: &DVector<Complex<f64>>) -> (Whirl, f64) {
    let mut lateral = shape.clone();
    for (row, whole) in system.free().iter().enumerate() {
        if matches!(Dof::ALL[whole % 6], Dof::U | Dof::ThetaX) {
            lateral[row] = ZERO;
        }
    }
    let energy = |q: &DVector<Complex<f64>>| {
        let part = |x: DVector<f64>| x.dot(&(&system.mass * &x));
        part(q.map(|v| v.re)) + part(q.map(|v| v.im))
    };
    let orbits: Vec<Orbit> = (0..system.spinning())
        .map(|node| {
            Orbit::new(
                system.component(shape, node, Dof::V),
                system.component(shape, node, Dof::W),
            )
        })
        .collect();
    let squares = orbits
        .iter()
        .map(|o| (o.forward.norm_sqr(), o.backward.norm_sqr()));
    let (difference, sum) = squares.fold((0.0, 0.0), |(d, s), (f, b)| (d + f - b, s + f + b));
    let index = if sum > 0.0 { difference / sum } else { 0.0 };
    if energy(&lateral) < 0.5 * energy(shape) {
        return (Whirl::NotLateral, index);
    }
    let largest = orbits.iter().map(Orbit::major).fold(0.0, f64::max);
    let (mut with, mut against) = (false, false);
    for orbit in orbits.iter().filter(|o| o.major() > SMALL * largest) {
        // The minor axis over the major one.
        let round = orbit.minor() / orbit.major();
        with |= round > ROUND;
        against |= round < -ROUND;
    }
    let direction = match (with, against) {
        (true, false) => Whirl::Forward,
        (false, true) => Whirl::Backward,
        (true, true) => Whirl::Mixed,
        (false, false) => Whirl::Planar,
    };
    (direction, index)
}
