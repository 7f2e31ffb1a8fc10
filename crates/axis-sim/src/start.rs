//! What a motion begins with.

/// Position and speed that a machine starts with, and what it was left with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// Position of the load, m or rad.
    pub position: f64,
    /// Its speed, m/s or rad/s.
    pub speed: f64,
    /// Its acceleration, m/s² or rad/s².
    pub acceleration: f64,
    /// Time since the motion began, s.
    pub time: f64,
    /// At rest, share of the Coulomb deflection that the bristles were left with,
    /// −1 to 1: an axis that came forward and stopped is held back by up to 1.
    pub friction: f64,
    /// Whether loads that stand from before on act at once, held by drive and bristles.
    /// Otherwise those of effects come up over 20 ms where the start is at rest.
    pub held: bool,
}

impl Start {
    /// At rest and relaxed.
    pub fn at(position: f64) -> Self {
        Self {
            position,
            ..Self::default()
        }
    }
}
