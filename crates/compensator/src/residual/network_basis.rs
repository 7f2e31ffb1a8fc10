//! A network whose hidden layers come from simulation and whose output layer is learned.
//!
//! Transfer learning: hidden layers that were trained on many simulated machines at once
//! are what those have in common (Caruana, Machine Learning 28 (1997) 41–75,
//! doi:10.1023/A:1007379606734). Of a new machine only the output layer is learned, which
//! is linear. Its prior is how the output layers of the simulated machines are spread, so
//! that a few moves do: it also tells a torque of the motor from a force on the load, which
//! no log tells apart.

use std::vec;
use std::vec::Vec;

use cfnn::{Network, Scaling, Scratch, Shape};
use nalgebra::{DMatrix, DVector};

use super::network::ResidualNetwork;
use super::{ResidualAt, ResidualBasis, ResidualRow, Unexplained, over_gaussian};
use crate::CompensatorError;
use crate::error::{require, within};

/// Share of the covariance of the simulated machines that is kept to its diagonal: their
/// number is finite.
const SHRUNK: f64 = 0.1;
/// Least deviation of an output weight, in the unit of the outputs.
const LEAST: f64 = 1e-3;

/// What the output layer of a network sees: bias, inputs and hidden layers.
#[derive(Clone, Debug)]
struct Seen {
    network: Network,
    scratch: Scratch,
    values: Vec<f64>,
}

impl Seen {
    /// A network with the hidden layers of `trained` whose outputs are its activations.
    fn of(trained: &Network) -> Result<Self, cfnn::Error> {
        trained.architecture().require_tansig()?;
        let count = trained.shape().activations();
        let mut weights = hidden(trained).to_vec();
        for i in 0..count {
            weights.extend((0..count).map(|j| f64::from(u8::from(i == j))));
        }
        let shape = Shape {
            outputs: count,
            ..trained.shape().clone()
        };
        let scaling = Scaling::from_ranges(&input_ranges(trained), &vec![(-1.0, 1.0); count])?;
        let network = Network::new(shape, scaling, weights)?;
        Ok(Self {
            scratch: network.scratch(),
            values: vec![0.0; count],
            network,
        })
    }

    fn at(&mut self, at: &Unexplained) -> &[f64] {
        let inputs = ResidualNetwork::inputs(&ResidualAt {
            motor_angle: at.motor_angle,
            motor_speed: at.motor_speed,
            position: at.position,
            direction: at.direction,
        });
        // All lengths were made to fit.
        let done = self
            .network
            .evaluate(&inputs, &mut self.scratch, &mut self.values);
        debug_assert!(done.is_ok());
        &self.values
    }
}

/// The output layer of a network as coefficients: first those of the torque, then those of
/// the force, bias, inputs and hidden neurons in the order of the network.
#[derive(Clone, Debug)]
pub struct NetworkBasis {
    trained: Network,
    seen: Seen,
    travel: f64,
    unit: f64,
    precision: DMatrix<f64>,
    mean: DVector<f64>,
}

impl NetworkBasis {
    /// Hidden layers and scaling of the inputs are those of `trained`, which has
    /// [`super::NETWORK_INPUTS`] inputs; `travel` is that of the load per radian of the
    /// motor, `unit` a torque (N·m) in units of which the coefficients are. `machines`
    /// gives torque (N·m) and force (N or N·m) of each simulated machine at each of
    /// `states`.
    ///
    /// # Errors
    /// [`CompensatorError::ResidualShape`] for a network of another shape,
    /// [`CompensatorError::Setting`] for fewer than two machines or states than the output
    /// layer has coefficients, for values that are not finite, and a travel or unit that
    /// is not above 0.
    pub fn new(
        trained: &Network,
        travel: f64,
        unit: f64,
        states: &[Unexplained],
        machines: &[Vec<[f64; 2]>],
    ) -> Result<Self, CompensatorError> {
        let (inputs, outputs) = (trained.shape().inputs, trained.shape().outputs);
        let shape = |_| CompensatorError::ResidualShape { inputs, outputs };
        if inputs != super::NETWORK_INPUTS {
            return Err(shape(()));
        }
        require(
            within(travel, 1e-9, 1e3),
            "travel",
            travel,
            "from 1e-9 to 1e3",
        )?;
        require(
            within(unit, 1e-12, 1e12),
            "unit",
            unit,
            "from 1e-12 to 1e12",
        )?;
        let mut seen = Seen::of(trained).map_err(|_| shape(()))?;
        let count = seen.values.len();
        let enough = states.len() >= count && machines.iter().all(|m| m.len() == states.len());
        let length = states.len() as f64;
        require(
            enough,
            "states",
            length,
            "at least the activations, in every machine",
        )?;
        let number = machines.len();
        require(number >= 2, "machines", number as f64, "at least 2")?;
        let layers = layers(&mut seen, states, machines, [unit, unit / travel]).ok_or(
            CompensatorError::Setting {
                name: "machines",
                value: number as f64,
                valid: "finite in all their values",
            },
        )?;
        let (mean, precision) = spread(&layers);
        Ok(Self {
            trained: trained.clone(),
            seen,
            travel,
            unit,
            precision,
            mean,
        })
    }
}

/// Output layers of the machines, by least squares: one a column, torque above force.
fn layers(
    seen: &mut Seen,
    states: &[Unexplained],
    machines: &[Vec<[f64; 2]>],
    units: [f64; 2],
) -> Option<DMatrix<f64>> {
    let count = seen.values.len();
    let mut normal = DMatrix::<f64>::zeros(count, count);
    let mut right = DMatrix::<f64>::zeros(count, 2 * machines.len());
    for (k, state) in states.iter().enumerate() {
        let values = DVector::from_column_slice(seen.at(state));
        normal.ger(1.0, &values, &values, 1.0);
        for (m, machine) in machines.iter().enumerate() {
            for (of, unit) in units.into_iter().enumerate() {
                right
                    .column_mut(2 * m + of)
                    .axpy(machine[k][of] / unit, &values, 1.0);
            }
        }
    }
    // Neurons that say nearly the same share what they say.
    let ridge = 1e-6 * normal.trace() / count as f64;
    let found = (normal + DMatrix::identity(count, count) * ridge)
        .cholesky()?
        .solve(&right);
    let finite = found.iter().all(|w| w.is_finite());
    // Columns 2m and 2m + 1 on end are one column.
    finite.then(|| DMatrix::from_column_slice(2 * count, machines.len(), found.as_slice()))
}

/// Mean and precision of the columns.
fn spread(layers: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let (size, number) = layers.shape();
    let mean = layers.column_mean();
    let mut away = layers.clone();
    for mut column in away.column_iter_mut() {
        column -= &mean;
    }
    let mut covariance = &away * away.transpose() / (number - 1) as f64;
    let diagonal = covariance.diagonal();
    covariance *= 1.0 - SHRUNK;
    for i in 0..size {
        covariance[(i, i)] += SHRUNK * diagonal[i] + LEAST * LEAST;
    }
    let precision = covariance
        .cholesky()
        .map_or_else(|| DMatrix::identity(size, size), |c| c.inverse());
    (mean, precision)
}

impl ResidualBasis for NetworkBasis {
    type Model = Option<ResidualNetwork>;

    fn size(&self) -> usize {
        self.mean.len()
    }

    fn prior(&self) -> (DMatrix<f64>, DVector<f64>) {
        (self.precision.clone(), self.mean.clone())
    }

    fn row(&mut self, at: &Unexplained, smoothing: f64) -> ResidualRow {
        let count = self.seen.values.len();
        let mut sums = vec![0.0; count];
        over_gaussian(at, self.travel, smoothing, |there, weight| {
            for (sum, value) in sums.iter_mut().zip(self.seen.at(there)) {
                *sum += weight * value;
            }
        });
        // A force on the load is as much torque at the motor, in this unit.
        let once = sums.iter().chain(&sums).map(|sum| self.unit * sum);
        ResidualRow {
            values: once.enumerate().collect(),
            fixed: 0.0,
        }
    }

    /// None if the coefficients have become no numbers.
    fn model(&self, coefficients: &[f64]) -> Option<ResidualNetwork> {
        let (torque, force) = coefficients.split_at(self.seen.values.len());
        let mut weights = hidden(&self.trained).to_vec();
        weights.extend(torque.iter().zip(force).flat_map(|(t, f)| [*t, *f]));
        let shape = Shape {
            outputs: 2,
            ..self.trained.shape().clone()
        };
        let force = self.unit / self.travel;
        let outputs = [(-self.unit, self.unit), (-force, force)];
        let scaling = Scaling::from_ranges(&input_ranges(&self.trained), &outputs).ok()?;
        let network = Network::new(shape, scaling, weights).ok()?;
        ResidualNetwork::new(network).ok()
    }
}

/// The weights of all hidden layers.
fn hidden(network: &Network) -> &[f64] {
    let layers = network.shape().layers();
    let end = layers.last().map_or(0, |output| output.first_parameter);
    &network.weights()[..end]
}

fn input_ranges(network: &Network) -> Vec<(f64, f64)> {
    let ranges = network.scaling().input().iter();
    ranges.map(|r| (r.minimum(), r.maximum())).collect()
}
