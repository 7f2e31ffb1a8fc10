//! Linear state space of a drive at one position.

use nalgebra::{Cholesky, Complex, DMatrix, DVector};

use crate::elastic::{ElasticDrive, Side};
use crate::error::frequency;
use crate::{Coordinate, DriveError, FeedDrive, NutCoupling};

/// What is seen of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum Quantity {
    /// Displacement, m or rad.
    Displacement,
    /// Speed, m/s or rad/s.
    Speed,
    /// Acceleration, m/s² or rad/s².
    Acceleration,
}

impl Quantity {
    /// What multiplies a receptance at ω: 1, iω (mobility) or −ω² (accelerance).
    pub(crate) fn of_receptance(self, w: f64) -> Complex<f64> {
        match self {
            Self::Displacement => Complex::new(1.0, 0.0),
            Self::Speed => Complex::new(0.0, w),
            Self::Acceleration => Complex::new(-w * w, 0.0),
        }
    }
}

/// `ẋ = A x + B u, y = C x + D u` with x = (q, q̇): for controller design, and for
/// comparison with other programs.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    /// A, 2n × 2n: [0, 1; −M⁻¹K, −M⁻¹C].
    pub a: DMatrix<f64>,
    /// B, 2n × number of inputs: [0; M⁻¹], a column for each input.
    pub b: DMatrix<f64>,
    /// C, number of outputs × 2n.
    pub c: DMatrix<f64>,
    /// D, outputs × inputs: not zero for accelerations only.
    pub d: DMatrix<f64>,
}

impl StateSpace {
    /// The transfer matrix C (iω − A)⁻¹ B + D at one angular frequency (rad/s), outputs
    /// × inputs.
    ///
    /// # Errors
    /// [`DriveError::Parameter`] if the frequency is not finite,
    /// [`DriveError::Singular`] at an eigenvalue of A, 0 included: the axis is free.
    pub fn transfer(&self, angular_frequency: f64) -> Result<DMatrix<Complex<f64>>, DriveError> {
        let w = frequency(angular_frequency)?;
        let complex = |m: &DMatrix<f64>| m.map(|v| Complex::new(v, 0.0));
        let mut dynamic = -complex(&self.a);
        for i in 0..dynamic.nrows() {
            dynamic[(i, i)] += Complex::new(0.0, w);
        }
        let finite =
            |m: &DMatrix<Complex<f64>>| m.iter().all(|v| v.re.is_finite() && v.im.is_finite());
        let states = dynamic.lu().solve(&complex(&self.b)).filter(finite);
        let states = states.ok_or(DriveError::Singular {
            angular_frequency: w,
        })?;
        Ok(complex(&self.c) * states + complex(&self.d))
    }

    /// From M, C, K, the rows of the inputs and the rows and quantities of the outputs.
    fn new(
        matrices: [&DMatrix<f64>; 3],
        inputs: &[usize],
        outputs: &[(usize, Quantity)],
    ) -> Result<Self, DriveError> {
        let [mass, damping, stiffness] = matrices;
        let n = mass.nrows();
        let factor =
            Cholesky::new(mass.clone()).ok_or(beam_fem::BeamError::MassNotPositiveDefinite)?;
        let (spring, rate) = (factor.solve(stiffness), factor.solve(damping));
        let mut a = DMatrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            a[(i, n + i)] = 1.0;
        }
        a.view_mut((n, 0), (n, n)).copy_from(&-spring);
        a.view_mut((n, n), (n, n)).copy_from(&-rate);
        let mut b = DMatrix::zeros(2 * n, inputs.len());
        for (column, row) in inputs.iter().enumerate() {
            let mut load = DVector::zeros(n);
            load[*row] = 1.0;
            b.view_mut((n, column), (n, 1))
                .copy_from(&factor.solve(&load));
        }
        let mut c = DMatrix::zeros(outputs.len(), 2 * n);
        let mut d = DMatrix::zeros(outputs.len(), inputs.len());
        for (index, (row, quantity)) in outputs.iter().enumerate() {
            match quantity {
                Quantity::Displacement => c[(index, *row)] = 1.0,
                Quantity::Speed => c[(index, n + row)] = 1.0,
                Quantity::Acceleration => {
                    c.row_mut(index).copy_from(&a.row(n + row));
                    d.row_mut(index).copy_from(&b.row(n + row));
                }
            }
        }
        Ok(Self { a, b, c, d })
    }
}

impl FeedDrive {
    /// The drive at `x` metres from the driven end as a linear state space, the states
    /// the coordinates of [`crate::DriveMatrices`] and their rates. Inputs are loads in
    /// the direction of their coordinate: a torque of the motor, a force on the table
    /// (minus a load that resists).
    ///
    /// # Errors
    /// [`DriveError::OffScrew`]; [`DriveError::Parameter`] for a screw node that does
    /// not exist.
    pub fn state_space(
        &self,
        x: f64,
        coupling: NutCoupling,
        inputs: &[Coordinate],
        outputs: &[(Coordinate, Quantity)],
    ) -> Result<StateSpace, DriveError> {
        let m = self.matrices(x, coupling)?;
        let input = |c: &Coordinate| self.checked_row(*c);
        let inputs: Vec<usize> = inputs.iter().map(input).collect::<Result<_, _>>()?;
        let output = |(c, q): &(Coordinate, Quantity)| self.checked_row(*c).map(|row| (row, *q));
        let outputs: Vec<_> = outputs.iter().map(output).collect::<Result<_, _>>()?;
        StateSpace::new([&m.mass, &m.damping, &m.stiffness], &inputs, &outputs)
    }

    /// Mobility iωH: speed at `output` per load at `input`, one value for each angular
    /// frequency (rad/s), H the [`FeedDrive::receptance`].
    ///
    /// # Errors
    /// Those of [`FeedDrive::receptance`].
    pub fn mobility(
        &self,
        x: f64,
        coupling: NutCoupling,
        [input, output]: [Coordinate; 2],
        angular_frequencies: &[f64],
    ) -> Result<Vec<Complex<f64>>, DriveError> {
        let h = self.receptance(x, coupling, [input, output], angular_frequencies)?;
        Ok(times(h, angular_frequencies, Quantity::Speed))
    }

    /// Accelerance −ω²H: acceleration at `output` per load at `input`, one value for
    /// each angular frequency (rad/s), H the [`FeedDrive::receptance`].
    ///
    /// # Errors
    /// Those of [`FeedDrive::receptance`].
    pub fn accelerance(
        &self,
        x: f64,
        coupling: NutCoupling,
        [input, output]: [Coordinate; 2],
        angular_frequencies: &[f64],
    ) -> Result<Vec<Complex<f64>>, DriveError> {
        let h = self.receptance(x, coupling, [input, output], angular_frequencies)?;
        Ok(times(h, angular_frequencies, Quantity::Acceleration))
    }
}

impl ElasticDrive {
    /// The drive with the load at `x` as a linear state space, its states (θ, y, θ̇, ẏ).
    /// Inputs are loads in the direction of their side (minus a load that resists).
    ///
    /// # Errors
    /// [`DriveError::Parameter`] if `x` is not finite or the stiffness there not valid.
    pub fn state_space(
        &self,
        x: f64,
        inputs: &[Side],
        outputs: &[(Side, Quantity)],
    ) -> Result<StateSpace, DriveError> {
        self.check_position(x)?;
        let p = self.parameters();
        let (r, k) = (p.travel_per_radian, p.stiffness.at(x));
        let mass =
            DMatrix::from_diagonal(&DVector::from_vec(vec![p.motor_inertia, p.load_inertia]));
        let stiffness = DMatrix::from_row_slice(2, 2, &[r * r * k, -r * k, -r * k, k]);
        let damping = &stiffness * p.stiffness_damping;
        let row = |side: &Side| match side {
            Side::Motor => 0,
            Side::Load => 1,
        };
        let inputs: Vec<usize> = inputs.iter().map(row).collect();
        let outputs: Vec<_> = outputs.iter().map(|(side, q)| (row(side), *q)).collect();
        StateSpace::new([&mass, &damping, &stiffness], &inputs, &outputs)
    }

    /// Mobility iωH, H the [`ElasticDrive::receptance`].
    ///
    /// # Errors
    /// Those of [`ElasticDrive::receptance`].
    pub fn mobility(
        &self,
        x: f64,
        [input, output]: [Side; 2],
        angular_frequencies: &[f64],
    ) -> Result<Vec<Complex<f64>>, DriveError> {
        let h = self.receptance(x, [input, output], angular_frequencies)?;
        Ok(times(h, angular_frequencies, Quantity::Speed))
    }

    /// Accelerance −ω²H, H the [`ElasticDrive::receptance`].
    ///
    /// # Errors
    /// Those of [`ElasticDrive::receptance`].
    pub fn accelerance(
        &self,
        x: f64,
        [input, output]: [Side; 2],
        angular_frequencies: &[f64],
    ) -> Result<Vec<Complex<f64>>, DriveError> {
        let h = self.receptance(x, [input, output], angular_frequencies)?;
        Ok(times(h, angular_frequencies, Quantity::Acceleration))
    }
}

/// Receptances times what makes another quantity of them.
fn times(
    receptance: Vec<Complex<f64>>,
    angular_frequencies: &[f64],
    quantity: Quantity,
) -> Vec<Complex<f64>> {
    let pairs = receptance.into_iter().zip(angular_frequencies);
    pairs.map(|(h, w)| h * quantity.of_receptance(*w)).collect()
}
