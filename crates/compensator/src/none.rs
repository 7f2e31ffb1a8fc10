//! No compensation: the servo as it is.

use crate::{Compensator, Correction, Sample};

/// Corrects nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoCompensation;

impl Compensator for NoCompensation {
    fn reset(&mut self) {}

    fn correct(&mut self, _: &Sample) -> Correction {
        Correction::default()
    }
}
