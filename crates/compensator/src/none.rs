//! No compensation: the servo as it is.

use axis_scalar::Scalar;

use crate::{Compensator, Correction, Sample};

/// Corrects nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoCompensation;

impl<T: Scalar> Compensator<T> for NoCompensation {
    fn reset(&mut self) {}

    fn correct(&mut self, _: &Sample<T>) -> Correction<T> {
        Correction::default()
    }
}
