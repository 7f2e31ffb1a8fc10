//! A cascade-forward network that gives torque and force.

use alloc::boxed::Box;

use cfnn::{Network, Predictor};

use super::{Residual, ResidualAt};
use crate::CompensatorError;

/// Inputs of a [`ResidualNetwork`]: position (m or rad), sine and cosine of the motor's
/// angle, its speed (rad/s), share of the Coulomb level that the bristles hold.
pub const NETWORK_INPUTS: usize = 5;

/// Torque and force by a cascade-forward network, the kind that Liu et al. 2025 use
/// (doi:10.3390/machines13050433, Section 4.3).
#[derive(Clone, Debug)]
pub struct ResidualNetwork(Box<Predictor<NETWORK_INPUTS, 2>>);

impl ResidualNetwork {
    /// Of a network with [`NETWORK_INPUTS`] inputs and two outputs: torque at the motor
    /// (N·m), force on the load (N or N·m).
    ///
    /// # Errors
    /// [`CompensatorError::ResidualShape`] for other numbers of inputs or outputs.
    pub fn new(network: Network) -> Result<Self, CompensatorError> {
        let (inputs, outputs) = (network.shape().inputs, network.shape().outputs);
        let predictor = Predictor::new(network)
            .map_err(|_| CompensatorError::ResidualShape { inputs, outputs })?;
        Ok(Self(Box::new(predictor)))
    }

    /// The network inside.
    #[must_use]
    pub fn network(&self) -> &Network {
        self.0.network()
    }

    /// What it asks its network.
    pub(super) fn inputs(at: &ResidualAt) -> [f64; NETWORK_INPUTS] {
        let (sin, cos) = axis_scalar::Scalar::sin_cos(at.motor_angle);
        [at.position, sin, cos, at.motor_speed, at.direction]
    }
}

impl Residual for ResidualNetwork {
    fn besides(&mut self, at: &ResidualAt) -> [f64; 2] {
        self.0.predict(&Self::inputs(at))
    }
}
