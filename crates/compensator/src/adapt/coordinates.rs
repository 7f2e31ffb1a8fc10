//! What is fitted beside the parameters of each move.

use super::parameter::COUNT;

/// Force that its bristles begin with, beside what the torque tells, in break-away levels.
pub(super) const HELD: usize = COUNT;

/// Angle between the two scales, rad.
pub(super) const OFFSET: usize = COUNT + 1;

/// Half the free travel, rad at the motor.
pub(super) const GAP: usize = COUNT + 2;
