//! What effects see of the motion, and how steep their forces are.

/// The load as a force on it sees it.
#[derive(Clone, Copy, Debug, Default)]
pub struct TableState {
    /// Since the motion began, s.
    pub time: f64,
    /// m or rad, absolute.
    pub position: f64,
    /// m/s or rad/s.
    pub speed: f64,
    /// Unit bristle, −1 to 1: the direction of sliding, without a jump. 0 if no force on
    /// the load changes with it ([`Steepness::bristle`]).
    pub bristle: f64,
    /// Share of a constant load that acts: it comes up over 20 ms, so that a
    /// log may start with the machine at rest under it.
    pub loaded: f64,
    /// Force of the transmission on the load at the start of the step, N or N·m.
    ///
    /// It is that of one step before, as the one at the end is not known before the load
    /// is: what is made of it is of first order in the step. A force on the load of at most
    /// the share η < 1 of it is stable at every step, as an error of it that is carried
    /// from step to step shrinks by η.
    pub transmitted: f64,
    /// Way that the load has travelled to and fro since the log began, up to the start of
    /// the step, m or rad; never falls.
    pub travelled: f64,
}

/// The most by which a force on the load changes with each part of its motion, rising or
/// falling. The default is not at all.
///
/// It tells the search for the force at the end of a step how near it is
/// ([`feed_dynamics::TimeStepper::with_steepest_load`]); one that is given too small makes
/// that end wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steepness {
    /// With the position, N/m or N·m/rad.
    pub position: f64,
    /// With the speed, N·s/m or N·m·s/rad.
    pub speed: f64,
    /// With the unit bristle, N or N·m.
    pub bristle: f64,
    /// With the force of the transmission, N/N. No step is made shorter by it, as that is
    /// known before the step; but settled motion is searched for where it is not 0.
    pub transmitted: f64,
}

impl Steepness {
    /// Nobody knows: as steep as can be.
    pub const UNKNOWN: Self = Self {
        position: f64::INFINITY,
        speed: f64::INFINITY,
        bristle: f64::INFINITY,
        transmitted: f64::INFINITY,
    };

    /// That of two forces together.
    #[must_use]
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            position: self.position + other.position,
            speed: self.speed + other.speed,
            bristle: self.bristle + other.bristle,
            transmitted: self.transmitted + other.transmitted,
        }
    }
}

/// The transmission as an error of its kinematics sees it.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScrewState {
    /// Since the motion began, s.
    pub time: f64,
    /// Motor angle, rad, absolute.
    pub angle: f64,
    /// Motor speed, rad/s.
    pub rate: f64,
    /// Position of the load, m or rad.
    pub position: f64,
    /// Its speed, m/s or rad/s.
    pub speed: f64,
    /// Force of the transmission on the load, N or N·m: its course over the last step
    /// continued to the end of this one, of second order in the step.
    pub transmitted: f64,
}
