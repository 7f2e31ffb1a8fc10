//! Values as serde reads and writes them (feature `serde`): what the constructors refuse does not get in.

use axis_scalar::Scalar;

use crate::{FocError, MotorParameters, Pmsm};

impl<T: Scalar> TryFrom<MotorParameters<T>> for Pmsm<T> {
    type Error = FocError;

    /// Without magnets, a synchronous reluctance motor.
    fn try_from(parameters: MotorParameters<T>) -> Result<Self, FocError> {
        if parameters.flux_linkage == T::ZERO {
            return Self::reluctance(parameters);
        }
        Self::new(parameters)
    }
}

impl<T: Scalar> From<Pmsm<T>> for MotorParameters<T> {
    fn from(motor: Pmsm<T>) -> Self {
        *motor.parameters()
    }
}
