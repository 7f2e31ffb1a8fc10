//! Noise that the upper spectra of a log foretell.

use super::channel::TorqueChannel;
use super::motion::Whose;
use super::prepared::inertia;
use crate::axis::Axis;

/// The least noise that the upper spectra of effort and motion leave possible, behind the low-pass, RMS.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foreseen {
    /// Of the effort, in its channel's unit.
    pub effort: f64,
    /// Of the measured acceleration, m/s² or rad/s².
    pub acceleration: f64,
    /// Whose motion that is.
    pub whose: Whose,
}

impl Foreseen {
    /// What both make in the channel of the effort, with this axis' inertia.
    pub fn noise(&self, axis: &Axis, channel: TorqueChannel) -> f64 {
        let of_motion = channel.per_torque(axis) * self.acceleration * inertia(axis, self.whose);
        self.effort.hypot(of_motion)
    }
}
